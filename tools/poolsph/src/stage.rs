//! What a physical effect promises to the march.
//!
//! A stage declares the columns it needs, advances the state by one step, bounds the step and may
//! say a few numbers. The march knows nothing else of it; dispatch is dynamic once per stage and
//! step, never per pair.
//!
//! Order of a step (Komen 2019, fig. 3.16; listed once, in `assemble`):
//!
//! ```text
//! domain   source moves, droplets appear and arrive, box moves      writes State
//! gather   moving particles and all that they touch                 writes State::near (march)
//! surface  free surface, normals, areas                             writes its own columns
//! cover    what grains lie on                                       takes it out of State::exposed
//! heat     conduction, arc, losses                                  writes enthalpy, temperature
//! grains   their steps within the step, heat with metal, impulses   writes State::grains, enthalpy; adds to State::near.force
//! melting  phase change                                             writes phase
//! forces   each adds a force density                                adds to State::near.force
//! motion   viscosity, prediction, density homogenising              writes position, velocity, pressure
//! ```

use artefact::Frame;
use steps::{Figure, Limit};
use thiserror::Error;

use crate::state::State;

/// Why a stage could not go on.
#[derive(Debug, Error)]
pub enum StageError {
    /// A quantity left every reasonable range.
    #[error(
        "step {step}: {quantity} of particle {particle} at ({:.4}, {:.4}, {:.4}) mm is {value:e} {unit}, \
         beyond {limit:e} {unit}", place[0] * 1e3, place[1] * 1e3, place[2] * 1e3
    )]
    Diverged {
        /// Step in which it happened.
        step: u64,
        /// Index of the particle.
        particle: usize,
        /// Where it is \[m\].
        place: [f64; 3],
        /// Name of the quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// The bound.
        limit: f64,
        /// Unit of both.
        unit: &'static str,
    },
    /// An input table was asked beyond its end, or other trouble with data.
    #[error("{0}")]
    Data(String),
}

/// One physical effect.
pub trait Stage: Send {
    /// Name in the status, the record and the plan.
    fn name(&self) -> &'static str;

    /// Declares the columns that it reads or writes, ahead of the particles.
    fn declare(&self, _state: &mut State) {}

    /// Its bound on the step in the present state, if it has one.
    fn limit(&self, _state: &State) -> Option<Limit> {
        None
    }

    /// The longest step that follows what it does \[s\], where the scene lets steps grow: its limit, unless it divides
    /// steps at little cost.
    fn follows(&self, state: &State) -> f64 {
        let limit = self.limit(state);
        limit.map_or(f64::INFINITY, |limit| limit.seconds)
    }

    /// The next instant \[s\] after `time` at which a step has to end.
    fn next(&self, _time: f64) -> Option<f64> {
        None
    }

    /// In how many parts it has taken the last step.
    fn parts(&self) -> u64 {
        1
    }

    /// Advances the state by `dt` \[s\].
    ///
    /// # Errors
    /// When a quantity diverges or a table ends.
    fn advance(&mut self, state: &mut State, dt: f64) -> Result<(), StageError>;

    /// Fills columns that only frames show.
    fn show(&self, _state: &mut State) {}

    /// Whether what the run is for has come about, ahead of its time.
    fn ends(&self) -> bool {
        false
    }

    /// What it leaves at the end of a run for another to go on from: a channel and its frame.
    fn leaves(&self, _state: &State) -> Option<(&'static str, Frame)> {
        None
    }

    /// Numbers of the last step.
    fn figures(&self) -> Vec<Figure> {
        Vec::new()
    }

    /// What a reader of the run must be told when it has ended.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }

    /// What a reader of the run may want to know when it has ended, and need not be warned of.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }

    /// Bytes that the stage holds beside the state's columns.
    fn bytes(&self) -> usize {
        0
    }

    /// Internal state that a checkpoint must keep so that a resumed run gives the same bytes.
    /// Whatever follows from [`State`] alone is left out.
    fn save(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Takes back what [`Stage::save`] gave.
    fn restore(&mut self, _saved: &[f64]) {}
}
