//! An outlet: water that leaves the scene, and is counted.
//!
//! Shinohara et al. (2004, fig. 7) take away what flows back out of a cut, since in the plane it has no other way: an
//! outlet of what moves one way alone.

use particles::{POSITION, sweep};
use shapes::Body;

use super::tait::Tait;
use crate::stage::{Entry, Figure, Stage, StageError};
use crate::state::{ACCELERATION, DENSITY, MASS, State, VELOCITY};

/// The stage.
pub struct Outlet {
    /// Its name.
    pub name: String,
    /// Number of the set of water.
    pub set: usize,
    /// Where it is.
    pub body: Body,
    /// Whether it takes what is outside of the body instead.
    pub beyond: bool,
    /// It takes only what moves along this direction \[m/s\], faster than its length.
    pub moving: Option<[f64; 3]>,
    /// Equation of state, for what leaves.
    pub law: Tait,
    left: f64,
    /// Forces on what has left, which it no longer takes: what pushed it is pushed back for half a step \[N\].
    pending: [f64; 3],
    entry: Entry,
}

impl Outlet {
    /// An outlet from which nothing has left yet.
    #[must_use]
    pub fn new(
        name: String,
        set: usize,
        body: Body,
        beyond: bool,
        moving: Option<[f64; 3]>,
        law: Tait,
    ) -> Self {
        Self {
            name,
            set,
            body,
            beyond,
            moving,
            law,
            left: 0.0,
            pending: [0.0; 3],
            entry: Entry::default(),
        }
    }

    fn takes(&self, place: [f64; 3], velocity: [f64; 3]) -> bool {
        let moves = self.moving.is_none_or(|along| {
            let (there, whole) = (0..3).fold((0.0, 0.0), |(there, whole), k| {
                (there + along[k] * velocity[k], whole + along[k] * along[k])
            });
            there > whole
        });
        moves && self.body.holds(place) != self.beyond
    }
}

impl Stage for Outlet {
    fn name(&self) -> &'static str {
        "outlet"
    }

    fn act(&mut self, _: &mut State, dt: f64) -> Result<(), StageError> {
        let pending = std::mem::take(&mut self.pending);
        (0..3).for_each(|k| self.entry.impulse[k] -= 0.5 * dt * pending[k]);
        Ok(())
    }

    fn exchange(&mut self, state: &mut State, _: f64) -> Result<(), StageError> {
        let set = &mut state.sets[self.set];
        let (position, velocity) = (set.column(&POSITION), set.column(&VELOCITY));
        let (mass, density) = (set.column(&MASS), set.column(&DENSITY));
        let acceleration = set.column(&ACCELERATION);
        let mut leaves = vec![false; set.len()];
        sweep::fill(&mut leaves, |a| self.takes(position[a], velocity[a]));
        for a in (0..leaves.len()).filter(|a| leaves[*a]) {
            let stored = mass[a] * self.law.energy(density[a]);
            self.entry.bring(-1.0, mass[a], velocity[a], stored);
            self.left += mass[a];
            (0..3).for_each(|k| self.pending[k] += mass[a] * acceleration[a][k]);
        }
        if leaves.contains(&true) {
            set.remove(|a| leaves[a]);
            state.exchanges += 1;
        }
        Ok(())
    }

    fn entry(&self, _: &State) -> Entry {
        self.entry
    }

    fn figures(&self, _: &State) -> Vec<Figure> {
        vec![Figure {
            name: format!("{}_left", self.name),
            unit: "kg",
            value: self.left,
        }]
    }

    fn save(&self) -> Vec<f64> {
        [&self.entry.save()[..], &self.pending, &[self.left]].concat()
    }

    fn restore(&mut self, _: &State, saved: &[f64]) {
        if let [x, y, z, left] = *self.entry.restore(saved) {
            (self.pending, self.left) = ([x, y, z], left);
        }
    }
}
