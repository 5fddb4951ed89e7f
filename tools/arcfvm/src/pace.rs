//! Slows the iteration where it runs in circles.

use serde::{Deserialize, Serialize};

use crate::solver::Arc;

/// Iterations in which the greatest residual must fall.
const PATIENCE: usize = 150;
/// What it must fall to, as part of the smallest before.
const FALL: f64 = 0.5;
/// Smallest under-relaxation that slowing leads to.
const LEAST: f64 = 0.5;

/// Watches the greatest residual. What is not taken from the new solution doubles each time it has
/// not fallen for a while.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pace {
    best: f64,
    since: usize,
    /// Under-relaxation of the velocities.
    pub velocity: f64,
    /// Under-relaxation of the temperature.
    pub temperature: f64,
}

impl Pace {
    /// Starts with the relaxations of the scene.
    #[must_use]
    pub fn new(velocity: f64, temperature: f64) -> Self {
        Self {
            best: f64::INFINITY,
            since: 0,
            velocity,
            temperature,
        }
    }

    /// Takes note of the greatest residual; true if it slowed down.
    pub fn watch(&mut self, worst: f64) -> bool {
        if worst <= FALL * self.best {
            self.best = worst;
            self.since = 0;
            return false;
        }
        self.since += 1;
        if self.since < PATIENCE || self.temperature <= LEAST {
            return false;
        }
        self.since = 0;
        let slower = |r: f64| (1.0 - 2.0 * (1.0 - r)).max(LEAST);
        self.velocity = slower(self.velocity);
        // A relaxation of 1 has nothing to double.
        self.temperature = slower(self.temperature.min(0.975));
        true
    }

    /// Gives the relaxations to the solver.
    pub fn set(&self, arc: &mut Arc) {
        arc.relax(self.velocity, self.temperature);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slows_only_where_residuals_stand_still() {
        let mut pace = Pace::new(0.9, 0.99);
        for k in 0..2000 {
            assert!(!pace.watch(0.99_f64.powi(k)));
        }
        let mut slowed = 0;
        for _ in 0..2000 {
            slowed += usize::from(pace.watch(0.99_f64.powi(2000)));
        }
        assert!(slowed >= 3 && pace.temperature <= LEAST + 1e-12 && pace.velocity >= LEAST);
    }
}
