//! What would be there before a run: points by material, and what happens at the surface.

use run::Fault;
use run::preview::{Coordinates, Marked, Preview, Spot};
use shapes::Body;
use shapes::frame::Vector;

use super::filled;
use crate::boundary::{self, Condition, Surface};
use crate::scene::Scene;

/// What a point of the surface without a condition is called.
const INSULATED: &str = "insulated";

/// Points, conditions and monitors of a scene.
///
/// # Errors
/// Faults of the scene.
pub fn preview(scene: &Scene) -> Result<Preview, Vec<Fault>> {
    let (_, cloud) = filled(scene)?;
    let surface = boundary::setup::surface(scene, &cloud)?;
    let mut preview = Preview::new(match scene.dimensions {
        2 => Coordinates::Plane,
        _ => Coordinates::Space,
    });
    for material in &scene.materials {
        preview.material(&material.name);
    }
    let at = at_points(&surface, cloud.position.len());
    let mut bare = vec![false; cloud.position.len()];
    for patch in &cloud.patches {
        bare[patch.point as usize] = true;
    }
    let regions = regions(scene);
    for (i, place) in cloud.position.iter().enumerate() {
        let condition = match &at[i] {
            Some(entries) => preview.condition(&name(&surface, entries)),
            None if bare[i] => preview.condition(INSULATED),
            None => 0,
        };
        preview.spot(Spot {
            place: *place,
            size: std::array::from_fn(|k| {
                if k < scene.dimensions {
                    cloud.spacing[i]
                } else {
                    0.0
                }
            }),
            material: material(&regions, *place),
            condition,
        });
    }
    for monitor in &scene.output.monitors {
        let place = std::array::from_fn(|k| monitor.place_m.get(k).copied().unwrap_or(0.0));
        preview.mark(Marked::Probe, &monitor.name, vec![vec![place]]);
    }
    let end = scene.time.as_ref().map_or(0.0, |time| time.end_s);
    for (number, torch) in scene.torches.iter().enumerate() {
        let stand = torch.stand(torch.path.burns()[0]);
        let away = 4.0 * torch.shape.least();
        let above = std::array::from_fn(|k| stand.place[k] - away * stand.axes[2][k]);
        let name = format!("torch {number}");
        preview.mark(Marked::Axis, &name, vec![vec![stand.place, above]]);
        preview.mark(
            Marked::Path,
            &format!("path of {name}"),
            vec![torch.way(end)],
        );
    }
    Ok(preview)
}

/// Where each material is; everywhere without a region.
fn regions(scene: &Scene) -> Vec<Option<Body>> {
    let region = |shape| Body::new(shape, scene.dimensions);
    let materials = scene.materials.iter();
    materials.map(|m| m.region.as_ref().map(region)).collect()
}

/// The first material whose region holds a place; the last where none does.
fn material(regions: &[Option<Body>], place: Vector) -> u32 {
    let holds = |region: &Option<Body>| region.as_ref().is_none_or(|r| r.holds(place));
    let found = regions.iter().position(holds);
    found.unwrap_or(regions.len().saturating_sub(1)) as u32
}

/// The entries of each point: of its temperature, or of its largest piece of surface.
fn at_points(surface: &Surface, points: usize) -> Vec<Option<Vec<u32>>> {
    let mut largest = vec![0.0; points];
    let mut at: Vec<Option<Vec<u32>>> = vec![None; points];
    for film in &surface.films {
        let i = film.point as usize;
        if film.area > largest[i] {
            largest[i] = film.area;
            at[i] = Some(film.entries.clone());
        }
    }
    for held in &surface.held {
        at[held.point as usize] = Some(vec![held.entry]);
    }
    at
}

/// What entries are called together: `top: convection + radiation`.
fn name(surface: &Surface, entries: &[u32]) -> String {
    let kind = |entry: u32| match &surface.conditions[entry as usize] {
        Condition::Temperature(_) => "temperature",
        Condition::Flux(_) => "heat flux",
        Condition::Convection(..) => "convection",
        Condition::Radiation(..) => "radiation",
    };
    let each = entries
        .iter()
        .map(|e| format!("{}: {}", surface.names[*e as usize], kind(*e)));
    each.collect::<Vec<_>>().join(" + ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_show_their_material_and_condition() {
        let scene: Scene = serde_json::from_str(
            r#"{"dimensions": 2, "body": {"box": {"min_m": [0, 0], "max_m": [1, 1]}},
            "points": {"spacing_m": 0.1},
            "materials": [
                {"name": "left", "region": {"box": {"min_m": [0, 0], "max_m": [0.45, 1]}},
                 "density_kg_m3": 1, "specific_heat_j_kg_k": 1, "conductivity_w_m_k": 1},
                {"name": "right", "density_kg_m3": 1, "specific_heat_j_kg_k": 1, "conductivity_w_m_k": 1}],
            "initial_temperature_k": 300, "time": {"end_s": 1},
            "boundaries": [
                {"on": ["y+"], "name": "top", "convection": {"coefficient_w_m2_k": 1, "ambient_k": 300}},
                {"on": ["y+"], "name": "sky", "radiation": {"emissivity": 1, "surroundings_k": 300}},
                {"on": ["x-"], "temperature_k": 400}],
            "output": {"monitors": [{"name": "middle", "place_m": [0.5, 0.5]}]}}"#,
        )
        .unwrap();
        let preview = preview(&scene).unwrap();
        assert_eq!(preview.spots().len(), 121);
        let left = |spot: &&Spot| spot.material == 0;
        assert_eq!(preview.spots().iter().filter(left).count(), 5 * 11);
        let of = |condition: &str| {
            let names = &preview.look.conditions;
            let number = names.iter().position(|name| name == condition).unwrap() as u32 + 1;
            let all = preview.spots().iter();
            all.filter(|spot| spot.condition == number).count()
        };
        assert_eq!(of("x-: temperature"), 11);
        assert_eq!(of("top: convection + sky: radiation"), 10);
        assert_eq!(of(INSULATED), 19);
        assert_eq!(preview.look.marks.len(), 1);
    }
}
