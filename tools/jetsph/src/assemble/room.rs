//! Places that two parts of a scene would fill: solids within solids, exits of nozzles within walls or solids.

use particles::POSITION;
use run::Fault;
use shapes::Body;

use super::vector;
use crate::scene::Scene;
use crate::stage::place_text;
use crate::state::State;

/// Deeper than this part of a spacing, what stands there bursts.
const DEEP: f64 = 0.25;

/// Every such place, but for bodies of water, which leave room for all else.
pub(super) fn faults(scene: &Scene, state: &State) -> Vec<Fault> {
    let mut faults = Vec::new();
    let body = |shape| Body::new(shape, scene.dimensions);
    let solids: Vec<Body> = scene.solids.iter().map(|of| body(&of.body)).collect();
    for (k, solid) in scene.solids.iter().enumerate() {
        let own = state.sets.iter().find(|set| set.name() == solid.name);
        let places = own.map_or(&[][..], |set| set.column(&POSITION));
        for (other, shape) in scene.solids[..k].iter().zip(&solids) {
            let least = -DEEP * solid.spacing_m.min(other.spacing_m);
            let within = |place: &&[f64; 3]| shape.distance(**place) < least;
            let count = places.iter().filter(within).count();
            if count > 0 {
                let what = format!(
                    "{count} of its {} particles are inside of solid \"{}\": they would burst apart",
                    places.len(),
                    other.name
                );
                faults.push(Fault::at(&format!("/solids/{k}/body"), what));
            }
        }
    }
    let walls = scene.walls.iter();
    let walls = walls.map(|of| (format!("wall \"{}\"", of.name), body(&of.body)));
    let names = scene.solids.iter();
    let names = names.map(|of| format!("solid \"{}\"", of.name));
    let standing: Vec<(String, Body)> = walls.chain(names.zip(solids)).collect();
    if let Some(water) = &scene.water {
        for (k, nozzle) in water.nozzles.iter().enumerate() {
            let exit = vector(Some(&nozzle.exit_m));
            let deep = |(_, body): &&(String, Body)| body.distance(exit) < -DEEP * water.spacing_m;
            if let Some((name, _)) = standing.iter().find(deep) {
                let what = format!(
                    "{} is inside of {name}: no water can leave it",
                    place_text(exit)
                );
                faults.push(Fault::at(&format!("/water/nozzles/{k}/exit_m"), what));
            }
        }
    }
    faults
}
