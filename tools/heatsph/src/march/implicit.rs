//! The singly diagonally implicit Runge-Kutta method of second order, L-stable (Alexander 1977, SIAM J. Numer.
//! Anal. 14, 1006), with gamma = 1 - 1/sqrt(2):
//!
//! ```text
//! T1 = T + gamma dt F(T1),   T2 = T + (1 - gamma) dt F(T1) + gamma dt F(T2)
//! ```
//!
//! with heats in the place of temperatures on the left, `E(T1) = E(T) + ...`, where capacities depend on temperature.
//!
//! No method of second order keeps temperatures between their neighbours at any step (Bolley and Crouzeix 1978).
//! Where a step of given length is so long that the error estimate is a good part of the range of temperature, or
//! where its result leaves the range of what came before, it is taken by the implicit Euler method, which does.

use super::nothing;
use super::{End, Method, State, StepError, estimate};
use crate::solve::{Goal, Problem, Solver};
use crate::system::{Rates, System, extent};

/// Part of the range of temperature that an error of a second-order step may be.
const SMOOTH: f64 = 0.01;
/// Overshoot of the range that is left to rounding.
const OVER: f64 = 1e-9;
/// Newton steps of a stage.
const NEWTON: usize = 40;

/// Implicit Runge-Kutta of second order.
#[derive(Debug)]
pub struct Implicit {
    solver: Solver,
    goal: Goal,
    /// Whether a rough step is taken by the implicit Euler method: where steps are given.
    guard: bool,
    newton: u64,
    iterations: u64,
    euler: u64,
    first: Rates,
    middle: Rates,
    guess: Vec<f64>,
    base: Vec<f64>,
    error: Vec<f64>,
}

impl Implicit {
    /// The method with stages solved to `residual` of the heat that passes; `guard`ed where steps are given.
    #[must_use]
    pub fn new(system: &System, residual: f64, guard: bool) -> Self {
        Self {
            solver: Solver::new(system),
            goal: Goal {
                residual,
                steps: NEWTON,
            },
            guard,
            newton: 0,
            iterations: 0,
            euler: 0,
            first: Rates::default(),
            middle: Rates::default(),
            guess: Vec::new(),
            base: Vec::new(),
            error: Vec::new(),
        }
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.solver.bytes()
    }

    /// Solves `T = base + length F(T)`; `temperature` is the first guess.
    fn stage(
        &mut self,
        system: &System,
        time: f64,
        length: f64,
        temperature: &mut Vec<f64>,
        rates: &mut Rates,
    ) -> Result<(), StepError> {
        system.hold(temperature, time)?;
        let problem = Problem {
            shift: 1.0 / length,
            from: &self.base,
            time,
        };
        let effort = self
            .solver
            .newton(system, problem, temperature, rates, self.goal)?;
        self.newton += effort.newton as u64;
        self.iterations += effort.iterations as u64;
        Ok(())
    }

    /// What the second stage starts from, and its first guess: on with the rate of the first, which has ended at
    /// `temperature`.
    fn lead(&mut self, system: &System, before: &State, temperature: &mut [f64]) {
        let gamma = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
        for (i, base) in self.base.iter_mut().enumerate() {
            let rate = (temperature[i] - before.temperature[i]) / gamma;
            *base = match system.storage.varies() {
                None => before.temperature[i] + (1.0 - gamma) * rate,
                Some(content) => {
                    let heat = before.heat[i];
                    heat + (1.0 - gamma) / gamma * (content.at(i, temperature[i]).1 - heat)
                }
            };
            temperature[i] = before.temperature[i] + rate.clamp(-f64::MAX, f64::MAX);
        }
    }

    /// A step of the implicit Euler method.
    fn euler(
        &mut self,
        system: &System,
        state: &mut State,
        rates: &mut Rates,
        step: f64,
    ) -> Result<(), StepError> {
        self.base.clone_from(stored(system, state));
        let mut temperature = state.temperature.clone();
        let end = state.time + step;
        self.solver.forget();
        self.stage(system, end, step, &mut temperature, rates)?;
        let before = std::mem::replace(&mut state.temperature, temperature);
        keep(system, state);
        state.pass(rates, step);
        state.time = end;
        state.settle(system, &before);
        self.euler += 1;
        Ok(())
    }
}

impl Method for Implicit {
    fn advance(
        &mut self,
        system: &System,
        state: &mut State,
        rates: &mut Rates,
        step: f64,
    ) -> Result<f64, StepError> {
        let gamma = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
        // What is left of the last step must not change the bits of this one: runs are taken up between steps.
        self.solver.forget();
        self.first.clone_from(rates);
        let before = state.clone();
        // First stage.
        self.base.clone_from(stored(system, &before));
        let mut temperature = std::mem::take(&mut self.guess);
        temperature.clone_from(&before.temperature);
        let mut middle = std::mem::take(&mut self.middle);
        let early = before.time + gamma * step;
        let solved = self.stage(system, early, gamma * step, &mut temperature, &mut middle);
        self.middle = middle;
        solved?;
        // Second stage, from where the first one's rate leads.
        self.lead(system, &before, &mut temperature);
        let end = before.time + step;
        let (low, high) = extent(&before.temperature);
        let outside = |t: &f64| !(*t >= low && *t <= high);
        if temperature.iter().any(outside) {
            // A guess beyond all that was is a bad one.
            temperature.clone_from(&before.temperature);
        }
        self.stage(system, end, gamma * step, &mut temperature, rates)?;
        self.guess = std::mem::replace(&mut state.temperature, temperature);
        keep(system, state);
        state.pass(&self.middle, (1.0 - gamma) * step);
        state.pass(rates, gamma * step);
        state.time = end;
        state.settle(system, &before.temperature);
        // The estimate, filtered: a stiff part that the step has damped is no error.
        let first = End {
            state: &before,
            rates: &self.first,
        };
        estimate(system, first, End { state, rates }, step, &mut self.error);
        let shift = 1.0 / (gamma * step);
        let scaled: Vec<f64> = self.error.iter().map(|e| shift * e).collect();
        let problem = Problem {
            shift,
            from: &self.base,
            time: end,
        };
        let temperature = &state.temperature;
        let filtered = self
            .solver
            .filter(system, problem, temperature, rates, &scaled)?;
        let error = filtered.iter().fold(0.0_f64, |m, e| m.max(e.abs()));
        if self.guard && rough(system, &before, state, error) {
            state.clone_from(&before);
            self.euler(system, state, rates, step)?;
        }
        Ok(error)
    }

    fn longest(&self, _: &System, _: &Rates) -> f64 {
        f64::INFINITY
    }

    fn report(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("newton_steps", self.newton as f64),
            ("linear_iterations", self.iterations as f64),
            ("euler_steps", self.euler as f64),
        ]
    }

    fn count_from(&mut self, done: &[f64]) {
        if let &[newton, iterations, euler] = done {
            (self.newton, self.iterations, self.euler) =
                (newton as u64, iterations as u64, euler as u64);
        }
    }
}

/// What a stage starts from: heats where capacities depend on temperature, else temperatures.
fn stored<'a>(system: &System, state: &'a State) -> &'a Vec<f64> {
    match system.storage.varies() {
        None => &state.temperature,
        Some(_) => &state.heat,
    }
}

/// The heats that go with the temperatures of a stage.
fn keep(system: &System, state: &mut State) {
    if let Some(content) = system.storage.varies() {
        state.heat = content.heats(&state.temperature);
    }
}

/// Whether a step is too long for the second order: its error is a good part of the range of temperature, or its
/// result leaves the range of what came before and of what is prescribed now.
fn rough(system: &System, before: &State, after: &State, error: f64) -> bool {
    let (mut low, mut high) = extent(&before.temperature);
    for held in &system.surface.held {
        let t = after.temperature[held.point as usize];
        (low, high) = (low.min(t), high.max(t));
    }
    let (least, greatest) = extent(&after.temperature);
    let floor = nothing(least, greatest);
    let range = high - low;
    let sources = system.has_source() || !system.surface.films.is_empty();
    let beyond = (low - least).max(greatest - high) > OVER * range + floor;
    error > SMOOTH * range.max(greatest - least) + floor || (beyond && !sources)
}
