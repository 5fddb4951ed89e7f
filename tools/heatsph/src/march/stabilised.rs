//! The Runge-Kutta-Legendre method of second order (Meyer, Balsara and Aslam 2014, J. Comput. Phys. 257, 594,
//! eqs 14 to 17): `s` explicit stages carry a step of `(s^2 + s - 2) / 4` times the explicit limit.

use super::{End, Method, State, StepError, estimate};
use crate::system::{Rates, System};

/// Part of the stable step that is used: conductivities may rise within a step.
const SAFETY: f64 = 0.9;
/// Times that the limit may fall within a step, and its part that is then reckoned with.
const RISES: usize = 12;
const RISE: f64 = 0.8;
/// Shortest step over the time.
const SHORTEST: f64 = 1e-14;
/// Most stages.
const STAGES: usize = 201;

/// Runge-Kutta-Legendre of second order.
#[derive(Debug, Clone, Default)]
pub struct Stabilised {
    evaluations: u64,
    most_stages: usize,
    error: Vec<f64>,
    stages: [State; 3],
    rates: Rates,
    first: Rates,
}

/// Stages that carry `step` at an explicit limit of `limit`: odd, at least three.
fn stages(step: f64, limit: f64) -> usize {
    let s = 0.5 * ((9.0 + 16.0 * step / (SAFETY * limit)).sqrt() - 1.0);
    (s.ceil() as usize).max(3) | 1
}

/// `b_j` of the method.
fn b(j: usize) -> f64 {
    let j = j.max(2) as f64;
    (j * j + j - 2.0) / (2.0 * j * (j + 1.0))
}

impl Method for Stabilised {
    fn advance(
        &mut self,
        system: &System,
        state: &mut State,
        rates: &mut Rates,
        step: f64,
    ) -> Result<f64, StepError> {
        self.first.clone_from(rates);
        let mut limit = system.explicit_limit(rates);
        // Conductivity may rise within the step, and with it what the stages have to carry.
        for _ in 0..=RISES {
            let s = stages(step, limit);
            if s > STAGES {
                break;
            }
            match self.step(system, state, step, s, limit)? {
                Some(less) => limit = RISE * less,
                None => return self.finish(system, state, rates, step),
            }
        }
        // Two shorter steps see each rise sooner.
        if step <= SHORTEST * state.time.abs() {
            return Ok(f64::INFINITY);
        }
        let first = self.advance(system, state, rates, 0.5 * step)?;
        let second = self.advance(system, state, rates, 0.5 * step)?;
        Ok(first.max(second))
    }

    fn longest(&self, system: &System, rates: &Rates) -> f64 {
        SAFETY * system.explicit_limit(rates) * (STAGES * STAGES + STAGES - 2) as f64 / 4.0
    }

    fn report(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("evaluations", self.evaluations as f64),
            ("stages_most", self.most_stages as f64),
        ]
    }

    fn count_from(&mut self, done: &[f64]) {
        if let &[evaluations, most] = done {
            (self.evaluations, self.most_stages) = (evaluations as u64, most as usize);
        }
    }
}

impl Stabilised {
    /// The stages of a step from a state, of which the last becomes `stages[1]`; the limit of an explicit step where
    /// it falls below `limit`, for which `s` stages were reckoned.
    fn step(
        &mut self,
        system: &System,
        state: &State,
        step: f64,
        s: usize,
        limit: f64,
    ) -> Result<Option<f64>, StepError> {
        self.most_stages = self.most_stages.max(s);
        let w = 4.0 / (s * s + s - 2) as f64;
        let [older, old, new] = &mut self.stages;
        older.clone_from(state);
        old.clone_from(state);
        euler(system, old, state, &self.first, b(1) * w * step)?;
        for j in 2..=s {
            let n = j as f64;
            let mu = (2.0 * n - 1.0) / n * b(j) / b(j - 1);
            let nu = -(n - 1.0) / n * b(j) / b(j - 2);
            let mu_rate = mu * w * step;
            let first_rate = -(1.0 - b(j - 1)) * mu_rate;
            system.rates(old.time, &old.temperature, &mut self.rates)?;
            self.evaluations += 1;
            let now = system.explicit_limit(&self.rates);
            if now < SAFETY * limit {
                return Ok(Some(now));
            }
            let mix = |a: f64, b: f64, c: f64| mu * a + nu * b + (1.0 - mu - nu) * c;
            new.clone_from(state);
            new.time = mix(old.time, older.time, state.time) + mu_rate + first_rate;
            let (before, all) = (&self.first, &self.rates);
            let heat = |i: usize| mu_rate * all.heat[i] + first_rate * before.heat[i];
            for i in 0..new.heat.len() {
                new.heat[i] = mix(old.heat[i], older.heat[i], state.heat[i]);
            }
            if system.storage.varies().is_none() {
                for i in 0..new.temperature.len() {
                    new.temperature[i] = mix(
                        old.temperature[i],
                        older.temperature[i],
                        state.temperature[i],
                    );
                }
            }
            new.take(system, heat);
            for e in 0..new.entries.len() {
                new.entries[e] = mix(old.entries[e], older.entries[e], state.entries[e]);
            }
            new.source = mix(old.source, older.source, state.source);
            new.pass(&self.rates, mu_rate);
            new.pass(&self.first, first_rate);
            if j == s {
                new.time = state.time + step;
            }
            new.hold(system)?;
            std::mem::swap(older, old);
            std::mem::swap(old, new);
        }
        Ok(None)
    }

    /// Goes from the state before the stages to that after them.
    fn finish(
        &mut self,
        system: &System,
        state: &mut State,
        rates: &mut Rates,
        step: f64,
    ) -> Result<f64, StepError> {
        let old = &mut self.stages[1];
        old.settle(system, &state.temperature);
        system.rates(old.time, &old.temperature, rates)?;
        self.evaluations += 1;
        let first = End {
            state,
            rates: &self.first,
        };
        let last = End { state: old, rates };
        estimate(system, first, last, step, &mut self.error);
        std::mem::swap(state, old);
        let error = self.error.iter().zip(&state.temperature).enumerate();
        let kelvin = error.map(|(i, (e, t))| (e / system.storage.capacity(i, *t)).abs());
        Ok(kelvin.fold(0.0, f64::max))
    }
}

/// The first stage: a step of Euler's method.
fn euler(
    system: &System,
    new: &mut State,
    old: &State,
    rates: &Rates,
    step: f64,
) -> Result<(), StepError> {
    new.take(system, |i| step * rates.heat[i]);
    new.pass(rates, step);
    new.time = old.time + step;
    Ok(new.hold(system)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_carry_their_step() {
        for step in [0.1, 1.0, 10.0, 1e3] {
            let s = stages(step, 1.0);
            assert!(s % 2 == 1);
            assert!(SAFETY * (s * s + s - 2) as f64 / 4.0 >= step);
        }
    }
}
