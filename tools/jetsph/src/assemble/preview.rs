//! What would be there before a run: solids with what holds and loads them, water, nozzles, walls.

use particles::POSITION;
use run::Fault;
use run::preview::{Coordinates, Marked, Preview, Spot};
use shapes::Body;
use shapes::frame::{along, direction};

use super::{Assembled, assemble, solid, vector};
use crate::matter::solid::bound::next_to;
use crate::scene::{NozzleScene, Scene, Solid};

/// Particles, conditions, nozzles and walls of a scene.
///
/// # Errors
/// Faults of the scene.
pub fn preview(scene: &Scene) -> Result<Preview, Vec<Fault>> {
    let Assembled { state, .. } = assemble(scene)?;
    let mut preview = Preview::new(match scene.dimensions {
        2 => Coordinates::Plane,
        _ => Coordinates::Space,
    });
    for set in &state.sets {
        let material = preview.material(set.name());
        let own = scene.solids.iter().find(|solid| solid.name == set.name());
        let mut conditions = vec![0; set.len()];
        if let Some(own) = own {
            held(own, scene.dimensions, &mut preview, &mut conditions)?;
        }
        let size = extent(set.matter.spacing, scene.dimensions);
        for (place, condition) in set.column(&POSITION).iter().zip(conditions) {
            preview.spot(Spot {
                place: *place,
                size,
                material,
                condition,
            });
        }
    }
    let water = scene.water.iter();
    for nozzle in water.flat_map(|water| &water.nozzles) {
        jet(nozzle, scene, &mut preview);
    }
    walls(scene, &mut preview);
    Ok(preview)
}

fn extent(spacing: f64, dimensions: usize) -> [f64; 3] {
    std::array::from_fn(|k| if k < dimensions { spacing } else { 0.0 })
}

/// Which particles are next to faces that are held or loaded.
fn held(
    of: &Solid,
    dimensions: usize,
    preview: &mut Preview,
    conditions: &mut [u32],
) -> Result<(), Vec<Fault>> {
    let (shape, lattice) = solid::filled(of, dimensions).map_err(|fault| vec![fault])?;
    let clamps = of.clamps.iter().map(|clamp| {
        let moved = clamp.velocity_m_s.is_some();
        let how = if moved { "moved" } else { "held" };
        (how, &clamp.on, &clamp.within)
    });
    let loads = of
        .loads
        .iter()
        .map(|load| ("loaded", &load.on, &load.within));
    for (how, on, within) in clamps.chain(loads) {
        let within = within.as_ref().map(|shape| Body::new(shape, dimensions));
        let next = next_to(&shape, &lattice, on, within.as_ref(), dimensions);
        let next = next.map_err(|what| vec![Fault::at("/solids", what)])?;
        let condition = preview.condition(&format!("{} {}: {how}", of.name, on.join(" ")));
        for (particle, _) in next {
            conditions[particle] = condition;
        }
    }
    Ok(())
}

/// The exit of a nozzle and the way of its jet, as far as the picture goes.
fn jet(nozzle: &NozzleScene, scene: &Scene, preview: &mut Preview) {
    let exit = vector(Some(&nozzle.exit_m));
    let towards = direction(vector(Some(&nozzle.direction)));
    let around = preview.bounds().unwrap_or([exit, exit]);
    let far = (0..3).map(|k| {
        let reach = |side: f64| (side - exit[k]).abs();
        reach(around[0][k]).max(reach(around[1][k]))
    });
    let far = far.fold(nozzle.width_m, f64::max);
    let way = vec![vec![exit, along(exit, far, towards)]];
    preview.mark(Marked::Droplets, &format!("jet of {}", nozzle.name), way);
    // The two edges across the jet that lie in the picture.
    let aside = match scene.dimensions {
        2 => vec![[-towards[1], towards[0], 0.0]],
        _ => shapes::frame::Frame::facing(exit, towards).axes[..2].to_vec(),
    };
    let half = 0.5 * nozzle.width_m;
    let edge = |axis: &[f64; 3]| vec![along(exit, -half, *axis), along(exit, half, *axis)];
    let edges = aside.iter().map(edge).collect();
    preview.mark(Marked::Axis, &format!("exit of {}", nozzle.name), edges);
}

/// The layer of each wall that faces what is there.
fn walls(scene: &Scene, preview: &mut Preview) {
    let solids = scene.solids.iter().map(|solid| solid.spacing_m);
    let water = scene.water.iter().map(|water| water.spacing_m);
    let spacing = solids.chain(water).fold(f64::INFINITY, f64::min);
    let Some([mut low, mut high]) = wide(preview) else {
        return;
    };
    let room = (0..scene.dimensions).map(|k| high[k] - low[k]);
    let margin = 0.1 * room.fold(0.0, f64::max) + 3.0 * spacing;
    for k in 0..scene.dimensions {
        low[k] -= margin;
        high[k] += margin;
    }
    for wall in &scene.walls {
        let body = Body::new(&wall.body, scene.dimensions);
        let name = format!("wall {}", wall.name);
        preview.wall(&name, [low, high], spacing, |x| body.distance(x));
    }
}

/// The box around all particles and marks.
fn wide(preview: &Preview) -> Option<[[f64; 3]; 2]> {
    let marks = preview.look.marks.iter();
    let places = marks.flat_map(|mark| mark.lines_m.iter().flatten());
    let each = places.map(|place| [*place, *place]);
    each.chain(preview.bounds())
        .reduce(|[low, high], [from, to]| {
            [
                std::array::from_fn(|k| low[k].min(from[k])),
                std::array::from_fn(|k| high[k].max(to[k])),
            ]
        })
}
