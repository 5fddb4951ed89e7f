//! What a physical effect promises to the march.
//!
//! A stage declares the columns it needs, adds the accelerations that it causes, bounds the step and may say a few
//! numbers. The march knows nothing else of it; dispatch is dynamic once per stage and step, never per pair.

use steps::Limit;
use thiserror::Error;

use crate::state::State;

/// A number that a stage wants shown and recorded; names hold those of sets.
pub type Figure = steps::Figure<String>;

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
    /// Mass that it has brought in, less what it took away \[kg\].
    pub mass: f64,
}

impl Entry {
    /// Both together.
    pub fn add(&mut self, other: &Self) {
        self.stored += other.stored;
        self.work += other.work;
        self.spent += other.spent;
        self.mass += other.mass;
        for (sum, part) in self.impulse.iter_mut().zip(other.impulse) {
            *sum += part;
        }
    }

    /// Counts what comes in from outside: its mass \[kg\], velocity \[m/s\] and its energy at rest \[J\]; a negative
    /// `sign` takes it away.
    pub fn bring(&mut self, sign: f64, mass: f64, velocity: [f64; 3], stored: f64) {
        let square: f64 = velocity.iter().map(|u| u * u).sum();
        self.mass += sign * mass;
        self.work += sign * (0.5 * mass * square + stored);
        for (sum, u) in self.impulse.iter_mut().zip(velocity) {
            *sum += sign * mass * u;
        }
    }

    /// The numbers that a checkpoint keeps.
    #[must_use]
    pub fn save(&self) -> Vec<f64> {
        let [x, y, z] = self.impulse;
        vec![self.work, self.spent, self.mass, x, y, z]
    }

    /// Takes back what [`Entry::save`] gave; gives the rest.
    pub fn restore<'a>(&mut self, saved: &'a [f64]) -> &'a [f64] {
        if let [work, spent, mass, x, y, z, rest @ ..] = saved {
            (self.work, self.spent, self.mass) = (*work, *spent, *mass);
            self.impulse = [*x, *y, *z];
            return rest;
        }
        saved
    }
}

/// Rates that are known at the ends of steps, summed over time as the march does it: half a step with each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course<const N: usize> {
    before: [f64; N],
}

impl<const N: usize> Default for Course<N> {
    fn default() -> Self {
        Self { before: [0.0; N] }
    }
}

impl<const N: usize> Course<N> {
    /// What rates have given over a step of `dt` \[s\] that ended with `now`.
    pub fn over(&mut self, dt: f64, now: [f64; N]) -> [f64; N] {
        let before = std::mem::replace(&mut self.before, now);
        std::array::from_fn(|k| 0.5 * dt * (before[k] + now[k]))
    }

    /// The last rates, which a checkpoint keeps.
    #[must_use]
    pub fn last(&self) -> [f64; N] {
        self.before
    }

    /// Takes them back; gives the rest.
    pub fn restore<'a>(&mut self, saved: &'a [f64]) -> &'a [f64] {
        if let Some((before, rest)) = saved.split_first_chunk::<N>() {
            self.before = *before;
            return rest;
        }
        saved
    }
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

    /// Shows others what they need of it at the present positions and at a time \[s\], before any flows or acts.
    fn look(&mut self, _state: &mut State, _time: f64) {}

    /// Whether it changes densities, at the middle of a step.
    fn flows(&self) -> bool {
        false
    }

    /// Adds its rates of density at the middle of a step of `dt` \[s\].
    ///
    /// # Errors
    /// When a quantity diverges.
    fn flow(&mut self, _state: &mut State, _dt: f64) -> Result<(), StageError> {
        Ok(())
    }

    /// Adds its accelerations at the present positions; `dt` \[s\] is the step that led there, 0 at the start.
    ///
    /// # Errors
    /// When a quantity diverges.
    fn act(&mut self, state: &mut State, dt: f64) -> Result<(), StageError>;

    /// Takes up the impulses that later stages have left for it over a step of `dt` \[s\], after all have acted.
    fn receive(&mut self, _state: &mut State, _dt: f64) {}

    /// Brings particles in and takes them away, at the end of a step of `dt` \[s\]; `state.time` is that of its start.
    ///
    /// # Errors
    /// When data of the scene end.
    fn exchange(&mut self, _state: &mut State, _dt: f64) -> Result<(), StageError> {
        Ok(())
    }

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

    /// What the end of a run tells beside the totals.
    fn closing(&self, _state: &State) -> Vec<Figure> {
        Vec::new()
    }

    /// What must be known of a run before its results are used, in one sentence.
    fn warning(&self, _state: &State) -> Option<String> {
        None
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
