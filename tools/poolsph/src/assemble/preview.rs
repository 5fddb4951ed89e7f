//! What would be there before a run: particles by body, grains and their walls, axis, path and droplets, and the faces.

use particles::POSITION;
use run::preview::{Coordinates, Marked, Preview, Spot, edges, face};
use run::{Failure, Inputs};
use shapes::Face;

use crate::domain::bodies::{self, Body};
use crate::grains::{self, RADIUS};
use crate::scene::{Scene, StartState};
use crate::source::arcs::OneArc;
use crate::source::bed;
use crate::state::State;

/// Particles, conditions, axis and path of a scene. The arc is not read; grains of a bed are shown where it is given.
///
/// # Errors
/// Faults of the scene; a bed that cannot be read.
pub fn preview(scene: &Scene, inputs: &Inputs) -> Result<Preview, Failure> {
    let mut faults = crate::scene::faults(scene);
    let mut all = Vec::with_capacity(scene.bodies.len());
    for (i, body) in scene.bodies.iter().enumerate() {
        match body.body(
            &format!("/bodies/{i}"),
            &scene.lattice(),
            scene.heat.is_some(),
        ) {
            Ok(body) => all.push(body),
            Err(fault) => faults.push(fault),
        }
    }
    if !faults.is_empty() {
        return Err(faults.into());
    }
    let mut preview = Preview::new(Coordinates::Space);
    metal(scene, &all, &mut preview)?;
    beside(scene, inputs, &mut preview)?;
    source(scene, &mut preview);
    torches(scene, &mut preview);
    for probe in &scene.output.probes {
        preview.mark(Marked::Probe, &probe.name, vec![vec![probe.place_m]]);
    }
    conditions(scene, &mut preview);
    Ok(preview)
}

/// Particles of the bodies of metal.
fn metal(scene: &Scene, all: &[Body], preview: &mut Preview) -> Result<(), Failure> {
    let made = scene.substances()?;
    let mut state = State::new(scene.metal());
    let filled = bodies::fill(&mut state, all, made.as_ref())?;
    let mut first = 0;
    for (i, (filled, body)) in filled.iter().zip(&scene.bodies).enumerate() {
        let kind = match body.state {
            StartState::Solid => "solid",
            StartState::Liquid => "liquid",
            StartState::Wall => "wall",
        };
        let material = preview.material(&format!("{kind} (body {i})"));
        let condition = match body.held_temperature_k {
            Some(_) => preview.condition("held temperature"),
            None => 0,
        };
        for place in &state.metal.column(&POSITION)[first..first + filled.placed] {
            preview.spot(Spot {
                place: *place,
                size: scene.lattice().pitch,
                material,
                condition,
            });
        }
        first += filled.placed;
    }
    Ok(())
}

/// Grains, and the layers of their walls that face them.
fn beside(scene: &Scene, inputs: &Inputs, preview: &mut Preview) -> Result<(), Failure> {
    let Some(grains) = &scene.grains else {
        return Ok(());
    };
    let bed = match inputs.get("bed") {
        Some(path) => bed::read(path)?.grains,
        None => Vec::new(),
    };
    let (set, _) = grains::fill::fill(grains, &bed);
    let material = preview.material("grains");
    let mut least = f64::INFINITY;
    for (place, radius) in set.column(&POSITION).iter().zip(set.column(&RADIUS)) {
        least = least.min(*radius);
        preview.spot(Spot {
            place: *place,
            size: [2.0 * radius; 3],
            material,
            condition: 0,
        });
    }
    let Some([low, high]) = preview.bounds().filter(|_| least.is_finite()) else {
        return Ok(());
    };
    let margin = 6.0 * least;
    let within = [low.map(|x| x - margin), high.map(|x| x + margin)];
    for (i, wall) in grains.walls.iter().enumerate() {
        let body = shapes::Body::new(&wall.shape, 3);
        let side = if wall.hollow { -1.0 } else { 1.0 };
        let name = format!("wall {i} of the grains");
        preview.wall(&name, within, 2.0 * least, |x| side * body.distance(x));
    }
    Ok(())
}

/// Where each torch starts, and its path.
fn torches(scene: &Scene, preview: &mut Preview) {
    for (number, torch) in scene.torches.iter().enumerate() {
        let stand = torch.stand(torch.path.burns()[0]);
        let away = 4.0 * torch.shape.least();
        let above = std::array::from_fn(|k| stand.place[k] - away * stand.axes[2][k]);
        let name = format!("torch {number}");
        preview.mark(Marked::Axis, &name, vec![vec![stand.place, above]]);
        let way = torch.way(scene.time.end_s);
        preview.mark(Marked::Path, &format!("path of {name}"), vec![way]);
    }
}

/// The axis of the arc at the start, its path, and the way of the droplets.
fn source(scene: &Scene, preview: &mut Preview) {
    let Some(source) = &scene.source else {
        return;
    };
    let (start, end) = (source.position(0.0), source.position(scene.time.end_s));
    let above = |height: f64| vec![start, [start[0], start[1], start[2] + height]];
    let height = match (&scene.droplets, preview.bounds()) {
        (Some(droplets), _) => droplets.height_m,
        (None, Some([low, high])) => 0.2 * (high[1] - low[1]).max(high[0] - low[0]),
        (None, None) => scene.spacing_m,
    };
    let alone = [OneArc::default()];
    let (arcs, several) = match scene.arcs.as_slice() {
        [] => (alone.as_slice(), false),
        arcs => (arcs, true),
    };
    for (number, arc) in arcs.iter().enumerate() {
        let burning = arc.burning();
        let name = if several {
            format!("arc {number}")
        } else {
            "the arc".to_owned()
        };
        let axis = above(height).into_iter().map(|x| burning.axis(x));
        preview.mark(
            Marked::Axis,
            &format!("axis of {name}"),
            vec![axis.collect()],
        );
        let way = vec![burning.axis(start), burning.axis(end)];
        preview.mark(Marked::Path, &format!("path of {name}"), vec![way]);
    }
    if let Some(droplets) = &scene.droplets {
        let mut way = above(droplets.height_m);
        way.reverse();
        preview.mark(Marked::Droplets, "way of the droplets", vec![way]);
    }
}

/// Faces of flow and heat by what they are, and the box in which metal is followed.
fn conditions(scene: &Scene, preview: &mut Preview) {
    let mut told = |name: &str, corners: [[f64; 3]; 2], faces: &[(usize, bool)]| {
        if !faces.is_empty() {
            let outlines = faces
                .iter()
                .flat_map(|(axis, upper)| face(corners, *axis, *upper));
            preview.mark(Marked::Condition, name, outlines.collect());
        }
    };
    let sides = |faces: &[Face]| faces.iter().map(|f| f.side()).collect::<Vec<_>>();
    if let Some(faces) = &scene.faces {
        let corners = [faces.min_m, faces.max_m];
        let along = faces.periodic.iter().map(|axis| axis.index());
        let periodic: Vec<_> = along.flat_map(|k| [(k, false), (k, true)]).collect();
        told("flow: periodic", corners, &periodic);
        told("flow: mirror", corners, &sides(&faces.mirror));
        let held = |held: bool| {
            let walls = faces.wall.iter();
            let of = walls.filter(|wall| wall.temperature_k.is_some() == held);
            of.map(|wall| wall.face.side()).collect::<Vec<_>>()
        };
        told("flow: wall", corners, &held(false));
        told("flow: wall of a held temperature", corners, &held(true));
    }
    if let Some(faces) = scene.heat.as_ref().and_then(|heat| heat.faces.as_ref()) {
        let corners = [faces.min_m, faces.max_m];
        told("heat: mirror", corners, &sides(&faces.mirror));
        told("heat: open", corners, &sides(&faces.open));
    }
    if let Some(bounds) = &scene.bounds {
        let box_ = edges([bounds.min_m, bounds.max_m]);
        preview.mark(Marked::Wall, "box in which metal is followed", box_);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_weld_shows_plate_path_droplets_and_faces_without_its_arc() {
        let path = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../pipelines/gmaw-300a/pool.json"
        );
        let (kind, version) = crate::scene::KIND;
        let expected = run::scene::Expected {
            kind,
            version,
            migrations: &[],
        };
        let schema = run::scene::schema_of::<Scene>(expected);
        let loaded = run::scene::load::<Scene>(path.as_ref(), &[], &schema, expected);
        let scene = loaded.unwrap().scene;
        let preview = preview(&scene, &Inputs::none()).unwrap();
        assert_eq!(preview.spots().len(), 40 * 130 * 10);
        let names: Vec<&str> = (preview.look.marks.iter())
            .map(|mark| mark.name.as_str())
            .collect();
        assert_eq!(
            names,
            [
                "axis of the arc",
                "path of the arc",
                "way of the droplets",
                "heat: mirror",
                "heat: open",
                "box in which metal is followed"
            ]
        );
        let path = &preview.look.marks[1].lines_m[0];
        assert!(path[0].iter().all(|x| x.abs() < 1e-15));
        assert!((path[1][1] - 0.05).abs() < 1e-12);
    }
}
