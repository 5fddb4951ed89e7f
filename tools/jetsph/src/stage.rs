//! What a physical effect promises to the march.
//!
//! A stage declares the columns it needs, adds the accelerations that it causes, bounds the step and may say a few
//! numbers. The march knows nothing else of it; dispatch is dynamic once per stage and step, never per pair.

use thiserror::Error;

use crate::state::State;

/// Why a stage could not go on.
#[derive(Debug, Error)]
pub enum StageError {
    /// A quantity left every reasonable range.
    #[error("particle {particle} of {set} at {}: {quantity} {what}", place_text(*.place))]
    Diverged {
        /// Name of the set.
        set: String,
        /// Number of the particle.
        particle: usize,
        /// Where it is \[m\].
        place: [f64; 3],
        /// Name of the quantity with its unit.
        quantity: &'static str,
        /// What became of it.
        what: String,
    },
    /// Data of the scene ended.
    #[error("{0}")]
    Data(String),
}

/// A place for people.
#[must_use]
pub fn place_text([x, y, z]: [f64; 3]) -> String {
    format!("({x:.4e}, {y:.4e}, {z:.4e}) m")
}

/// A bound on the step and who sets it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// Largest stable step \[s\].
    pub seconds: f64,
    /// For example `acoustic`.
    pub name: &'static str,
}

/// A number that a stage wants shown and recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// For example `elastic_energy`.
    pub name: String,
    /// SI unit, `1` for none.
    pub unit: &'static str,
    /// Value now.
    pub value: f64,
}

/// What a stage puts into the balances of energy and momentum.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Entry {
    /// Energy that it stores \[J\].
    pub stored: f64,
    /// Work that it has done on the particles from outside \[J\].
    pub work: f64,
    /// Energy that it has turned into heat or into new surface \[J\].
    pub spent: f64,
    /// Impulse that it has given from outside \[N s\].
    pub impulse: [f64; 3],
}

/// One physical effect.
pub trait Stage: Send {
    /// Name in the status, the record and the plan.
    fn name(&self) -> &'static str;

    /// Declares columns, before the first step and before a checkpoint is taken up.
    fn declare(&self, _state: &mut State) {}

    /// Its bound on the step in the present state, if it has one.
    fn limit(&self, _state: &State) -> Option<Limit> {
        None
    }

    /// Adds its accelerations at the present positions; `dt` \[s\] is the step that led there, 0 at the start.
    ///
    /// # Errors
    /// When a quantity diverges.
    fn act(&mut self, state: &mut State, dt: f64) -> Result<(), StageError>;

    /// Fills columns that only frames show.
    fn show(&self, _state: &mut State) {}

    /// Its part of the balances.
    fn entry(&self, _state: &State) -> Entry {
        Entry::default()
    }

    /// Numbers of the present state.
    fn figures(&self, _state: &State) -> Vec<Figure> {
        Vec::new()
    }

    /// Bytes that the stage holds beside the columns.
    fn bytes(&self) -> usize {
        0
    }

    /// What a checkpoint must keep beside the columns.
    fn save(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Takes back what [`Stage::save`] gave; the columns have been restored.
    fn restore(&mut self, _state: &State, _saved: &[f64]) {}
}
