//! Currents on the way to that of the scene.
//!
//! A strong or a weak current may have no way from a cold start that the iteration can follow; from
//! the solution at a current not far from it, it has.

use serde::{Deserialize, Serialize};

use crate::residual::Residuals;
use crate::scene::Continuation;
use crate::solver::Arc;

/// Current at which automatic steps begin \[A\]: arcs of this current converge from a cold start.
const FIRST: f64 = 200.0;
/// Greatest factor from one automatic step to the next.
const FACTOR: f64 = 1.5;
/// Residual at which a step is left.
const ENOUGH: f64 = 1e-2;
/// Iterations after which it is left anyway.
const MOST: usize = 200;

/// The currents that are still to come.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Steps {
    /// Currents, the next one first \[A\].
    rest: Vec<f64>,
    /// Iterations at the present current.
    since: usize,
}

impl Steps {
    /// The steps to `last` \[A\].
    #[must_use]
    pub fn new(continuation: Option<&Continuation>, last: f64) -> Self {
        let mut rest = match continuation {
            None => return Self::default(),
            Some(Continuation::Currents(currents)) => currents.clone(),
            Some(Continuation::Automatic) => automatic(last),
        };
        rest.push(last);
        Self { rest, since: 0 }
    }

    /// Drives the first current.
    pub fn begin(&mut self, arc: &mut Arc) {
        if !self.rest.is_empty() {
            arc.drive(self.rest.remove(0));
        }
    }

    /// Whether the present current is the last.
    #[must_use]
    pub fn over(&self) -> bool {
        self.rest.is_empty()
    }

    /// Goes on to the next current where the present one has been followed far enough; gives it
    /// \[A\].
    pub fn watch(&mut self, arc: &mut Arc, residuals: &Residuals) -> Option<f64> {
        self.since += 1;
        let enough = residuals.within(ENOUGH) || self.since >= MOST;
        if self.over() || !enough {
            return None;
        }
        self.since = 0;
        let current = self.rest.remove(0);
        arc.drive(current);
        Some(current)
    }

    /// Drives the present current after a checkpoint: the one before those to come.
    pub fn resume(&self, arc: &mut Arc, all: &Self) {
        let done = all.rest.len() - self.rest.len().min(all.rest.len());
        if let Some(current) = done.checked_sub(1).and_then(|k| all.rest.get(k)) {
            arc.drive(*current);
        }
    }
}

impl Arc {
    /// Sends another current through the driven faces \[A\].
    pub fn drive(&mut self, current: f64) {
        if let Some(setup) = &mut self.case.potential {
            setup.driven = setup.driven.map(|_| current);
        }
    }
}

/// Even factors from [`FIRST`] to `last`, neither of them included twice.
fn automatic(last: f64) -> Vec<f64> {
    let ratio = (last.abs() / FIRST).ln();
    let count = (ratio.abs() / FACTOR.ln() - 1e-9).ceil().max(0.0) as usize;
    let step = |k: usize| (FIRST * (ratio * k as f64 / count as f64).exp()).copysign(last);
    (0..count).map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn automatic_steps_grow_by_no_more_than_the_factor() {
        for last in [5.0, 50.0, 200.0, 299.0, 1000.0, -1000.0] {
            let steps = Steps::new(Some(&Continuation::Automatic), last).rest;
            assert!((steps[steps.len() - 1] - last).abs() < 1e-12);
            for pair in steps.windows(2) {
                let factor = (pair[1] / pair[0]).ln().abs();
                assert!(factor <= FACTOR.ln() + 1e-9 && factor > 0.0, "{steps:?}");
            }
        }
        assert_eq!(
            Steps::new(Some(&Continuation::Automatic), 200.0).rest,
            [200.0]
        );
        assert!(Steps::new(None, 300.0).over());
    }
}
