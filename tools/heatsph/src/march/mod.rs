//! The march in time: explicit, stabilised, implicit.

pub mod choice;
pub mod explicit;
pub mod implicit;
pub mod stabilised;

use rayon::prelude::*;
use run::property::OutOfRange;

use crate::solve::SolveError;
use crate::system::storage::{Content, Storage};
use crate::system::{Rates, System, extent};

/// Part of the range of temperature at an instant by which schemes undershoot 0 K.
const UNDERSHOOT: f64 = 0.02;
/// Part of a usual temperature that is rounding.
pub const ROUNDED: f64 = 1e-9;
/// Cells that one task goes over.
const CELLS: usize = 256;

/// Temperatures at an instant, and what has passed until then.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct State {
    /// \[s\].
    pub time: f64,
    /// Of each point \[K\].
    pub temperature: Vec<f64>,
    /// Heat of each point's cell \[J\], where capacities depend on temperature: temperatures follow from it.
    pub heat: Vec<f64>,
    /// Heat through each entry of the surface since the start \[J\].
    pub entries: Vec<f64>,
    /// Heat of the source since the start \[J\].
    pub source: f64,
}

/// Part of a temperature below which differences are none.
const NOTHING: f64 = 1e-10;

/// The difference of temperature below which there is none, where temperatures lie between `low` and `high` \[K\]:
/// errors over the range of temperature say nothing of a body of one temperature.
#[must_use]
pub fn nothing(low: f64, high: f64) -> f64 {
    NOTHING * low.abs().max(high.abs())
}

/// What is said of a temperature \[K\] below 0 K, where fluxes and sources may take heat out whatever the temperature, or where none do.
#[must_use]
pub fn too_cold(temperature: f64, taken: bool) -> String {
    let why = if taken {
        "more heat is taken out than the body holds; fluxes and sources that take heat out are negative, and end before it is \
         gone"
    } else {
        "nothing takes heat out of what is cold, so steps or points err by as much: a smaller \"tolerance\" or \"step_s\", or more \
         points where it cools, help"
    };
    format!("{temperature:.4e} K is below 0 K: {why}")
}

/// Why a step failed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StepError {
    /// A property has no value.
    #[error(transparent)]
    Property(#[from] OutOfRange),
    /// An implicit stage was not solved.
    #[error(transparent)]
    Solve(#[from] SolveError),
}

/// A method that takes steps.
pub trait Method {
    /// Takes `state` from its time over `step` \[s\]; `rates` are those of the state, before and after. Gives the
    /// greatest error of a temperature, as estimated \[K\].
    ///
    /// # Errors
    /// [`StepError`]; the state is then not to be used.
    fn advance(
        &mut self,
        system: &System,
        state: &mut State,
        rates: &mut Rates,
        step: f64,
    ) -> Result<f64, StepError>;

    /// The longest step that the method can take at these rates \[s\].
    fn longest(&self, system: &System, rates: &Rates) -> f64;

    /// Names and numbers of what it has done so far.
    fn report(&self) -> Vec<(&'static str, f64)>;

    /// Goes on from these numbers, in the order of [`Method::report`].
    fn count_from(&mut self, done: &[f64]);
}

impl State {
    /// The state at the start.
    #[must_use]
    pub fn new(system: &System, temperature: Vec<f64>) -> Self {
        let content = system.storage.varies();
        Self {
            time: 0.0,
            heat: content.map_or_else(Vec::new, |content| content.heats(&temperature)),
            temperature,
            entries: vec![0.0; system.surface.conditions.len()],
            source: 0.0,
        }
    }

    /// Gives held points their temperatures at its time.
    ///
    /// # Errors
    /// Where a property has no value.
    pub fn hold(&mut self, system: &System) -> Result<(), OutOfRange> {
        system.hold(&mut self.temperature, self.time)?;
        if let Some(content) = system.storage.varies() {
            for held in &system.surface.held {
                let i = held.point as usize;
                self.heat[i] = content.at(i, self.temperature[i]).1;
            }
        }
        Ok(())
    }

    /// Takes heat \[J\] into every cell, and the temperatures that follow.
    pub(crate) fn take(&mut self, system: &System, heat: impl Fn(usize) -> f64 + Sync) {
        match &system.storage {
            Storage::Fixed(capacity) => {
                for (i, t) in self.temperature.iter_mut().enumerate() {
                    *t += heat(i) / capacity[i];
                }
            }
            Storage::Varies(content) => {
                for (i, stored) in self.heat.iter_mut().enumerate() {
                    *stored += heat(i);
                }
                self.follow(content);
            }
        }
    }

    /// Temperatures that follow from the heats.
    pub(crate) fn follow(&mut self, content: &Content) {
        let cells = self.temperature.par_iter_mut().zip(&self.heat).enumerate();
        cells.with_min_len(CELLS).for_each(|(i, (t, heat))| {
            *t = content.temperature(i, *heat, *t);
        });
    }

    /// Adds the heat of `rates` over `time` \[s\].
    pub(crate) fn pass(&mut self, rates: &Rates, time: f64) {
        for (sum, rate) in self.entries.iter_mut().zip(&rates.entries) {
            *sum += time * rate;
        }
        self.source += time * rates.source;
    }

    /// Adds what held points have stored themselves since `before` \[K\].
    pub(crate) fn settle(&mut self, system: &System, before: &[f64]) {
        for held in &system.surface.held {
            let i = held.point as usize;
            let heat = system.storage.rise(i, before[i], self.temperature[i]);
            self.entries[held.entry as usize] += heat;
        }
    }

    /// The first point whose temperature is no number.
    #[must_use]
    pub fn lost(&self) -> Option<usize> {
        self.temperature.iter().position(|t| !t.is_finite())
    }

    /// The coldest point, where it is below 0 K by more than schemes undershoot and by more than `error` \[K\].
    #[must_use]
    pub fn cold(&self, error: f64) -> Option<usize> {
        let (low, high) = extent(&self.temperature);
        let below = (UNDERSHOOT * (high - low)).max(error);
        let coldest = |t: &f64| *t <= low;
        (low < -below).then(|| self.temperature.iter().position(coldest))?
    }
}

/// An end of a step.
#[derive(Clone, Copy)]
pub(crate) struct End<'a> {
    pub(crate) state: &'a State,
    /// Those of the state.
    pub(crate) rates: &'a Rates,
}

/// Estimate of the error of a step of second order from the rates at its ends (Sommeijer, Shampine and Verwer
/// 1998, eq. 2.9): `(12 (T_n - T_n+1) + 6 dt (F_n + F_n+1)) / 15`, here times the capacity \[J\].
pub(crate) fn estimate(
    system: &System,
    first: End<'_>,
    last: End<'_>,
    step: f64,
    out: &mut Vec<f64>,
) {
    let (before, after) = (first.state, last.state);
    out.clear();
    out.extend((0..before.temperature.len()).map(|i| {
        if system.is_held(i) {
            return 0.0;
        }
        let change = match &system.storage {
            Storage::Fixed(capacity) => {
                capacity[i] * (before.temperature[i] - after.temperature[i])
            }
            Storage::Varies(_) => before.heat[i] - after.heat[i],
        };
        (12.0 * change + 6.0 * step * (first.rates.heat[i] + last.rates.heat[i])) / 15.0
    }));
}

#[cfg(test)]
mod tests;
