//! From a scene to sets of particles and the list of stages: the only place that asks what a scene contains.

mod beside;
mod pouring;
mod preview;
mod room;
mod solid;
mod water;

use particles::Set;
use run::Fault;

pub use preview::preview;

use crate::march::March;
use crate::motion::gravity::Gravity;
use crate::motion::repulsion::{Repulsion, Wall};
use crate::scene::{Method, RepulsionScene, Scene, WallScene};
use crate::stage::Stage;
use crate::state::State;

/// A scene put together.
pub struct Assembled {
    /// All particles.
    pub state: State,
    /// All stages in the order of a step.
    pub march: March,
    /// Physics that the scene leaves out, and why.
    pub left_out: Vec<(&'static str, String)>,
    /// What a person should know before a run.
    pub notes: Vec<String>,
}

/// Puts a scene together.
///
/// # Errors
/// Every fault that can be found at once.
pub fn assemble(scene: &Scene) -> Result<Assembled, Vec<Fault>> {
    let faults = scene.faults();
    if !faults.is_empty() {
        return Err(faults);
    }
    let mut state = State::new(scene.dimensions);
    let mut faults = Vec::new();
    let (solids, mut stages) = solid::solids(scene, &mut state, &mut faults);
    faults.extend(room::faults(scene, &state));
    let (mut left_out, mut notes) = (Vec::new(), Vec::new());
    let mut last = Vec::new();
    if let Some(of) = &scene.water {
        match water::water(scene, of, &solids, &mut state) {
            Ok(flowing) => {
                let (law, stage) = (flowing.law, flowing.stage);
                (last, notes) = (flowing.last, flowing.notes);
                if of.method == Method::DivergenceFree {
                    // Its pressure answers what all others do.
                    last.insert(0, stage);
                } else {
                    let meet = |solid| beside::meet(scene, of, law, solid, &mut state);
                    stages.splice(0..0, solids.iter().map(meet).collect::<Vec<_>>());
                    stages.push(stage);
                }
            }
            Err(fault) => faults.push(fault.within("/water")),
        }
    } else {
        left_out.push(("water", "no key 'water'".to_owned()));
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let touches = solid::touches(scene);
    if touches {
        // After the solids: what breaks between two steps is a contact in the next.
        stages.push(solid::contact(scene, &solids));
    }
    if let Some(gravity) = &scene.gravity_m_s2 {
        stages.push(Box::new(Gravity::new(vector(Some(gravity)))));
    }
    let pushing = scene
        .walls
        .iter()
        .filter_map(|wall| Some((wall, wall.repulsion.as_ref()?)));
    stages.extend(pushing.map(|(wall, of)| repulsion(wall, of, &state)));
    stages.append(&mut last);
    for stage in &stages {
        stage.declare(&mut state);
    }
    if !touches && !solids.is_empty() {
        let why = "one solid that does not break, and no plain wall";
        left_out.push(("contact", why.to_owned()));
    }
    Ok(Assembled {
        state,
        march: March { stages },
        left_out,
        notes,
    })
}

/// The stage of a wall that pushes.
fn repulsion(wall: &WallScene, of: &RepulsionScene, state: &State) -> Box<dyn Stage> {
    let law = |set: &Set| Repulsion {
        strength: of.strength_m2_s2,
        range: of.range_m.unwrap_or(0.5 * set.matter.spacing),
        exponents: [of.exponent_near, of.exponent_far],
    };
    let body = shapes::Body::new(&wall.body, state.dimensions);
    let laws = state.sets.iter().map(law).collect();
    Box::new(Wall::new(wall.name.clone(), body, laws))
}

/// Plain walls with their names.
fn plain_walls(walls: &[WallScene], dimensions: usize) -> Vec<(String, shapes::Body)> {
    let plain = walls.iter().filter(|wall| wall.repulsion.is_none());
    plain
        .map(|wall| (wall.name.clone(), shapes::Body::new(&wall.body, dimensions)))
        .collect()
}

/// Numbers of a scene as a vector.
fn vector(numbers: Option<&[f64]>) -> [f64; 3] {
    std::array::from_fn(|k| numbers.and_then(|n| n.get(k)).copied().unwrap_or(0.0))
}
