//! The particles of metal that a run begins with.

use run::{Failure, Inputs};

use crate::domain::bodies::{self, Body, Filled};
use crate::heat::Substances;
use crate::scene::Scene;
use crate::source::start;
use crate::state::State;

/// Puts the particles of the bodies into `state` and tells how these came out, or those of the input `start`, which no body tells of.
pub(super) fn fill(
    scene: &Scene,
    inputs: &Inputs,
    bodies: &[Body],
    state: &mut State,
    made: Option<&Substances>,
) -> Result<Vec<Filled>, Failure> {
    match (scene.start, inputs.get("start")) {
        (None, None) => Ok(bodies::fill(state, bodies, made)?),
        (None, Some(_)) => Err(Failure::Usage(
            "the input 'start' is of no use: the scene has no key 'start'".to_owned(),
        )),
        (Some(start), _) => {
            let earlier = start::read(inputs.path("start")?)?;
            earlier.fill(state, start, made.map(|made| made.metal().as_ref()))?;
            Ok(Vec::new())
        }
    }
}
