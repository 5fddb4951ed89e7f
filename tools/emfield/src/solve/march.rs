//! Eddy currents in time: two stages of an implicit Runge-Kutta method of second order that damps what
//! is stiff (SDIRK2, Alexander 1977, SIAM J. Numer. Anal. 14, 1006), so that a field may be switched on
//! at once.
//!
//! The rows are those of the sinusoidal steady state with `d/dt` for `j w`: `row(A) = k d(A + A_s)/dt`
//! with `k` from [`super::diffusion::Conductors::rates`]. Where `k` is zero (air), the row holds at
//! each instant.

use krylov::{Pair, Rule, Solved, System};

/// `1 - 1/sqrt(2)`: with it the method is of second order and the last stage is the next state.
const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

/// What the rates of a march of `step` \[s\] add to the diagonal of its rows, from
/// [`super::diffusion::Conductors::rates`].
#[must_use]
pub fn shift(rates: &[f64], step: f64) -> Vec<f64> {
    rates.iter().map(|k| -k / (GAMMA * step)).collect()
}

/// What drives currents in time.
#[derive(Debug, Clone)]
pub struct Forcing<const K: usize> {
    /// What sources give of the unknown where their wave is 1, by point.
    pub source: Vec<[f64; K]>,
    /// What the unknown is held at where their wave is 1, at points where it is held.
    pub held: Vec<Option<[f64; K]>>,
    /// Right sides that currents in coils make where the wave is 1, by point; empty where there are none.
    pub given: Vec<[f64; K]>,
    /// Pairs `(u, v)` of columns: `u` times the sum of `v d(A + A_s)/dt` is added to the rows.
    pub pairs: Vec<(Vec<f64>, Vec<f64>)>,
}

/// What a march has reached.
#[derive(Debug, Clone, PartialEq)]
pub struct State<const K: usize> {
    /// The unknown: the reaction.
    pub unknown: Vec<[f64; K]>,
    /// Sources and reaction together.
    pub total: Vec<[f64; K]>,
    /// Their rate, over a second.
    pub change: Vec<[f64; K]>,
}

/// A march from rest.
pub struct March<const K: usize> {
    system: System<f64, f64>,
    rates: Vec<f64>,
    forcing: Forcing<K>,
    pairs: Vec<Pair<f64>>,
    slope: f64,
    step: f64,
    state: State<K>,
}

impl<const K: usize> March<K> {
    /// A march of `step` \[s\] with the rows, shifted by [`shift`], and rates of a region.
    #[must_use]
    pub fn new(system: System<f64, f64>, rates: Vec<f64>, forcing: Forcing<K>, step: f64) -> Self {
        let none = vec![[0.0; K]; rates.len()];
        let mut march = Self {
            pairs: Vec::new(),
            system,
            rates,
            forcing,
            slope: 0.0,
            step,
            state: State {
                unknown: none.clone(),
                total: none.clone(),
                change: none,
            },
        };
        march.set(step);
        march
    }

    /// Goes on in steps of another length \[s\], for which `system` is shifted.
    pub fn pace(&mut self, system: System<f64, f64>, step: f64) {
        self.system = system;
        self.set(step);
    }

    fn set(&mut self, step: f64) {
        self.step = step;
        self.slope = 1.0 / (GAMMA * step);
        let slope = self.slope;
        let implicit = |(u, v): &(Vec<f64>, Vec<f64>)| {
            Pair::new(u.iter().copied(), v.iter().map(|v| slope * v))
        };
        self.pairs = self.forcing.pairs.iter().map(implicit).collect();
    }

    /// What has been reached.
    #[must_use]
    pub fn state(&self) -> &State<K> {
        &self.state
    }

    /// Goes on from another state.
    pub fn restore(&mut self, state: State<K>) {
        self.state = state;
    }

    /// Makes a step that begins at `time` \[s\]; the sources follow `wave`.
    ///
    /// # Errors
    /// Those of `wave`.
    pub fn advance<E>(
        &mut self,
        time: f64,
        wave: impl Fn(f64) -> Result<f64, E>,
        rule: Rule,
    ) -> Result<[Solved; 2], E> {
        let early = wave(time + GAMMA * self.step)?;
        let late = wave(time + self.step)?;
        let first = self.stage(early, rule);
        let part = (1.0 - GAMMA) * self.step;
        let state = &mut self.state;
        for (total, change) in state.total.iter_mut().zip(&state.change) {
            for (total, change) in total.iter_mut().zip(change) {
                *total += part * change;
            }
        }
        let second = self.stage(late, rule);
        let state = &mut self.state;
        for (i, total) in state.total.iter_mut().enumerate() {
            for (k, total) in total.iter_mut().enumerate() {
                *total = state.unknown[i][k] + self.forcing.source[i][k] * late;
            }
        }
        Ok([first, second])
    }

    /// A stage from the total of the state: its unknown, and the rate there.
    fn stage(&mut self, wave: f64, rule: Rule) -> Solved {
        let (slope, state) = (self.slope, &mut self.state);
        let source = &self.forcing.source;
        let driven =
            |i: usize, k: usize, from: &[[f64; K]]| slope * (source[i][k] * wave - from[i][k]);
        let mut right: Vec<[f64; K]> = (0..self.rates.len())
            .map(|i| match self.forcing.held[i] {
                Some(held) => held.map(|h| h * wave),
                None => std::array::from_fn(|k| self.rates[i] * driven(i, k, &state.total)),
            })
            .collect();
        for (right, given) in right.iter_mut().zip(&self.forcing.given) {
            for (right, given) in right.iter_mut().zip(given) {
                *right += given * wave;
            }
        }
        for (u, v) in &self.forcing.pairs {
            let given: [f64; K] = std::array::from_fn(|k| {
                let part = |(i, v): (usize, &f64)| v * driven(i, k, &state.total);
                v.iter().enumerate().map(part).sum()
            });
            for (right, u) in right.iter_mut().zip(u) {
                for (right, given) in right.iter_mut().zip(given) {
                    *right -= u * given;
                }
            }
        }
        let solved = self
            .system
            .solve_with(&self.pairs, &right, &mut state.unknown, rule);
        for (i, change) in state.change.iter_mut().enumerate() {
            for (k, change) in change.iter_mut().enumerate() {
                *change = slope * state.unknown[i][k] + driven(i, k, &state.total);
            }
        }
        solved
    }
}
