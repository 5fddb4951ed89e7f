//! The explicit Euler method (Rong and Kisu 2010, eq. 3).

use super::{Method, State, StepError};
use crate::system::{Rates, System};

/// Explicit Euler.
#[derive(Debug, Clone, Default)]
pub struct Explicit {
    steps: u64,
    before: Vec<f64>,
}

impl Method for Explicit {
    fn advance(
        &mut self,
        system: &System,
        state: &mut State,
        rates: &mut Rates,
        step: f64,
    ) -> Result<f64, StepError> {
        self.before.clone_from(&state.temperature);
        if system.varies() {
            // Heat that varies in time is taken at the middle of the step: its sum is of second order.
            system.rates(state.time + 0.5 * step, &state.temperature, rates)?;
        }
        state.take(system, |i| step * rates.heat[i]);
        state.pass(rates, step);
        state.time += step;
        state.hold(system)?;
        state.settle(system, &self.before);
        system.rates(state.time, &state.temperature, rates)?;
        self.steps += 1;
        Ok(0.0)
    }

    fn longest(&self, system: &System, rates: &Rates) -> f64 {
        system.explicit_limit(rates)
    }

    fn report(&self) -> Vec<(&'static str, f64)> {
        vec![("explicit_steps", self.steps as f64)]
    }

    fn count_from(&mut self, done: &[f64]) {
        if let &[steps] = done {
            self.steps = steps as u64;
        }
    }
}
