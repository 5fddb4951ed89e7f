//! Eddy currents in time: two stages of an implicit Runge-Kutta method of second order that damps what
//! is stiff (SDIRK2, Alexander 1977, SIAM J. Numer. Anal. 14, 1006), so that a field may be switched on
//! at once.
//!
//! The rows are those of the sinusoidal steady state with `d/dt` for `j w`: `row(A) = k d(A + A_s)/dt`
//! with `k` from [`super::diffusion::Conductors::rates`]. Where `k` is zero (air), the row holds at
//! each instant.

use krylov::{Error, Options, Rows, Rule, Solved, System};

/// `1 - 1/sqrt(2)`: with it the method is of second order and the last stage is the next state.
const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

/// What drives currents in time.
#[derive(Debug, Clone)]
pub struct Forcing<const K: usize> {
    /// What sources give of the unknown where their wave is 1, by point.
    pub source: Vec<[f64; K]>,
    /// What the unknown is held at where their wave is 1, at points where it is held.
    pub held: Vec<Option<[f64; K]>>,
}

/// A march from rest.
pub struct March<const K: usize> {
    system: System<f64, f64>,
    rates: Vec<f64>,
    forcing: Forcing<K>,
    step: f64,
    /// The unknown: the reaction.
    state: Vec<[f64; K]>,
    /// Sources and reaction together, where currents flow.
    total: Vec<[f64; K]>,
}

impl<const K: usize> March<K> {
    /// A march of `step` \[s\] with the rows and rates of a region.
    ///
    /// # Errors
    /// When a coefficient is no number or a row is empty.
    pub fn new(
        rows: Rows<f64>,
        rates: Vec<f64>,
        forcing: Forcing<K>,
        step: f64,
    ) -> Result<Self, Error> {
        let shift = rates.iter().map(|k| -k / (GAMMA * step)).collect();
        let none = vec![[0.0; K]; rates.len()];
        Ok(Self {
            system: System::new(rows, shift, Options::default())?,
            rates,
            forcing,
            step,
            state: none.clone(),
            total: none,
        })
    }

    /// The unknown now.
    #[must_use]
    pub fn state(&self) -> &[[f64; K]] {
        &self.state
    }

    /// Makes a step that begins at `time` \[s\]; the sources follow `wave`.
    pub fn advance(&mut self, time: f64, wave: impl Fn(f64) -> f64, rule: Rule) -> [Solved; 2] {
        let early = wave(time + GAMMA * self.step);
        let first = self.stage(early, rule);
        let slope = 1.0 / (GAMMA * self.step);
        for (i, total) in self.total.iter_mut().enumerate() {
            for (k, total) in total.iter_mut().enumerate() {
                let now = self.state[i][k] + self.forcing.source[i][k] * early;
                *total += (1.0 - GAMMA) * self.step * slope * (now - *total);
            }
        }
        let late = wave(time + self.step);
        let second = self.stage(late, rule);
        for (i, total) in self.total.iter_mut().enumerate() {
            for (k, total) in total.iter_mut().enumerate() {
                *total = self.state[i][k] + self.forcing.source[i][k] * late;
            }
        }
        [first, second]
    }

    fn stage(&mut self, wave: f64, rule: Rule) -> Solved {
        let slope = 1.0 / (GAMMA * self.step);
        let right: Vec<[f64; K]> = (0..self.rates.len())
            .map(|i| match self.forcing.held[i] {
                Some(held) => held.map(|h| h * wave),
                None => std::array::from_fn(|k| {
                    let driven = self.forcing.source[i][k] * wave - self.total[i][k];
                    self.rates[i] * slope * driven
                }),
            })
            .collect();
        self.system.solve(&right, &mut self.state, rule)
    }
}
