//! Recombines and slows the iteration where it runs in circles or away, and hurries it again where it goes well.

use serde::{Deserialize, Serialize};

use crate::solver::Arc;

/// Iterations in which the greatest residual must fall.
const PATIENCE: usize = 150;
/// What it must fall to, as part of the smallest before.
const FALL: f64 = 0.5;
/// What it may grow to, over the smallest before.
const GROWTH: f64 = 10.0;
/// Iterations in a row beyond that which are no detour.
const DETOUR: usize = 40;
/// Falls in a row after which a slowed iteration is hurried.
const FALLS: usize = 4;
/// Smallest under-relaxations of velocities and temperatures that slowing leads to: a velocity slowed further would follow the
/// vortices that a jet casts off in time.
const LEAST: [f64; 2] = [0.8, 0.3];
/// Greatest residual with which the last iterations are recombined: farther from a solution they tell little of the way to it.
const NEAR: f64 = 0.1;
/// Iterations without a fall, at the slowest, after which it is given up.
const GIVE_UP: usize = 800;

/// Watches the greatest residual. Where it has not fallen for a while or has grown, the last iterations are recombined from
/// then on; the next time, what is not taken from the new solution doubles, and recombining goes on only if the residual has
/// fallen meanwhile. What is not taken halves again, never below that of the scene, where the residual falls.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pace {
    best: f64,
    /// Iterations since the best.
    since: usize,
    /// Iterations since the pace last changed or the residual last fell.
    waited: usize,
    /// Iterations in a row in which it was far above the best.
    grown: usize,
    /// Falls in a row since it was slowed.
    falls: usize,
    /// Falls that it takes to be hurried: twice as many after each attempt that failed.
    wanted: usize,
    /// Under-relaxations of the scene.
    first: [f64; 2],
    /// Whether the last iterations are recombined.
    pub recombines: bool,
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
            waited: 0,
            grown: 0,
            falls: 0,
            wanted: FALLS,
            first: [velocity, temperature],
            recombines: false,
            velocity,
            temperature,
        }
    }

    /// Takes note of the greatest residual; true if the pace changed.
    pub fn watch(&mut self, worst: f64) -> bool {
        if worst <= FALL * self.best {
            self.best = worst;
            (self.since, self.waited, self.grown) = (0, 0, 0);
            self.falls += 1;
            return self.hurry();
        }
        self.since += 1;
        self.waited += 1;
        let far = worst > GROWTH * self.best;
        self.grown = if far { self.grown + 1 } else { 0 };
        (self.waited >= PATIENCE || self.grown >= DETOUR) && self.slow(worst)
    }

    fn slow(&mut self, worst: f64) -> bool {
        let gained = self.falls > 0;
        (self.waited, self.grown, self.falls) = (0, 0, 0);
        if !self.recombines && worst < NEAR {
            self.recombines = true;
            return true;
        }
        if self.slowest() {
            return false;
        }
        // Where it has gained nothing, a slower iteration alone comes first, and the two together next.
        self.recombines = self.recombines && gained;
        let slower = |r: f64, least: f64| (1.0 - 2.0 * (1.0 - r)).max(least.min(r));
        self.velocity = slower(self.velocity, LEAST[0]);
        // A relaxation of 1 has nothing to double.
        self.temperature = slower(self.temperature.min(0.975), LEAST[1]);
        true
    }

    fn hurry(&mut self) -> bool {
        if self.falls < self.wanted || self.temperature >= self.first[1] {
            return false;
        }
        (self.falls, self.wanted) = (0, 2 * self.wanted);
        let faster = |r: f64, most: f64| (1.0 - 0.5 * (1.0 - r)).min(most);
        self.velocity = faster(self.velocity, self.first[0]);
        self.temperature = faster(self.temperature, self.first[1]);
        true
    }

    fn slowest(&self) -> bool {
        self.temperature <= LEAST[1]
    }

    /// Whether nothing is gained any more, however slow.
    #[must_use]
    pub fn stagnates(&self) -> bool {
        self.slowest() && self.since >= GIVE_UP
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
        for _ in 0..3000 {
            slowed += usize::from(pace.watch(0.99_f64.powi(2000)));
        }
        assert!(slowed >= 3 && pace.temperature <= LEAST[1] + 1e-12);
        assert!((pace.velocity - LEAST[0]).abs() < 1e-12);
        assert!(pace.stagnates());
    }

    #[test]
    fn slows_at_once_where_residuals_grow_to_where_nothing_is_to_be_recombined() {
        let mut pace = Pace::new(0.9, 0.99);
        pace.watch(1e-2);
        let at = (1..PATIENCE).find(|k| pace.watch(1e-2 * 1.1_f64.powi(*k as i32)));
        assert!(at.is_some_and(|k| k > DETOUR && k < 2 * DETOUR), "{at:?}");
        assert!(pace.temperature < 0.99 && !pace.recombines);
    }

    #[test]
    fn recombines_before_it_slows() {
        let mut pace = Pace::new(0.9, 0.99);
        let changes: Vec<_> = (0..3 * PATIENCE)
            .filter(|_| pace.watch(1e-4))
            .map(|_| 0)
            .collect();
        assert_eq!(changes.len(), 2);
        let mut pace = Pace::new(0.9, 0.99);
        while !pace.watch(1e-4) {}
        assert!(pace.recombines && pace.temperature >= 0.99 && pace.velocity >= 0.9);
        while !pace.watch(1e-4) {}
        assert!(!pace.recombines && pace.temperature < 0.99 && pace.velocity < 0.9);
        let slower = pace.temperature;
        while !pace.watch(1e-4) {}
        assert!(pace.recombines && pace.temperature >= slower);
        // What gains something is kept while it is slowed.
        pace.watch(4e-5);
        while !pace.watch(4e-5) {}
        assert!(pace.recombines && pace.temperature < slower);
    }

    #[test]
    fn hurries_again_where_they_fall_up_to_the_pace_of_the_scene() {
        let mut pace = Pace::new(0.9, 0.96);
        for _ in 0..2 * PATIENCE + 2 {
            pace.watch(1.0);
        }
        assert!(pace.temperature < 0.9);
        let mut residual = 1.0;
        for _ in 0..3000 {
            residual *= 0.98;
            pace.watch(residual);
        }
        assert!((pace.temperature - 0.96).abs() < 1e-12 && (pace.velocity - 0.9).abs() < 1e-12);
        assert!(!pace.stagnates());
    }
}
