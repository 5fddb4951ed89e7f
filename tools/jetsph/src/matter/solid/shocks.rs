//! Artificial viscosity in a solid: between neighbours at rest that approach, with the law of (38).
//!
//! Shinohara et al. (2004, section 2.4) take A = B = 2.5 in the solid. It damps what steps and cracks excite and the
//! solid itself would keep for ever.

use kernels::Kernel;
use neighbours::Grid;
use particles::{POSITION, Rows, Set, sweep};

use super::elastic::REST;
use crate::matter::water::friction::{Artificial, Friction};
use crate::stage::{Course, Entry, Limit, Stage, StageError};
use crate::state::{ACCELERATION, MASS, State, VELOCITY};

/// Part of the time in which friction evens out a kernel that a step may take.
const PART: f64 = 0.2;

/// The stage.
pub struct Shocks<K> {
    set: usize,
    density: f64,
    friction: Artificial,
    kernel: K,
    rows: Rows,
    course: Course<1>,
    entry: Entry,
}

impl<K: Kernel> Shocks<K> {
    /// The stage of a set at rest.
    #[must_use]
    pub fn new(place: usize, set: &Set, friction: Artificial, kernel: K) -> Self {
        let reach = kernel.support();
        let (mut grid, mut rows) = (Grid::new(0.5 * reach), Rows::new());
        let rest = set.column(&REST);
        grid.bin(rest);
        rows.within(rest, &grid, reach);
        Self {
            set: place,
            density: set.matter.density,
            friction,
            kernel,
            rows,
            course: Course::default(),
            entry: Entry::default(),
        }
    }
}

impl<K: Kernel> Stage for Shocks<K> {
    fn name(&self) -> &'static str {
        "shocks"
    }

    fn limit(&self, state: &State) -> Option<Limit> {
        let velocity = state.sets[self.set].column(&VELOCITY);
        let speed = |a: usize| velocity[a][0].hypot(velocity[a][1]).hypot(velocity[a][2]);
        let speed = sweep::greatest(velocity.len(), speed).map_or(0.0, |(_, most)| most);
        let h = 0.5 * self.kernel.support();
        let spread =
            (self.friction.linear + 2.0 * self.friction.quadratic * speed / h) / self.density;
        let axes = state.dimensions as f64 + 2.0;
        Some(Limit {
            seconds: PART * h * h * 2.0 * axes / spread,
            name: "viscous",
        })
    }

    fn act(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let set = &mut state.sets[self.set];
        let mut acceleration = set.take(&ACCELERATION);
        let (position, velocity) = (set.column(&POSITION), set.column(&VELOCITY));
        let mass = set.column(&MASS);
        let limit = self.kernel.support().powi(2);
        let pairs = |a: usize| {
            let mut sum = [0.0; 4];
            for b in self.rows.row(a) {
                let b = *b as usize;
                let dx = [0, 1, 2].map(|k| position[a][k] - position[b][k]);
                let du = [0, 1, 2].map(|k| velocity[a][k] - velocity[b][k]);
                let square = dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2];
                let approach = du[0] * dx[0] + du[1] * dx[1] + du[2] * dx[2];
                if approach < 0.0 && square < limit {
                    let volumes = mass[a] * mass[b] / (self.density * self.density);
                    let q = self.friction.pressure(approach, square);
                    let scale = volumes * q * self.kernel.slope(square.sqrt());
                    (0..3).for_each(|k| sum[k] -= scale * dx[k]);
                    sum[3] += 0.5 * scale * approach;
                }
            }
            sum
        };
        let mut forces = vec![[0.0; 4]; position.len()];
        sweep::fill(&mut forces, pairs);
        sweep::change(&mut acceleration, |a, own| {
            (0..3).for_each(|k| own[k] += forces[a][k] / mass[a]);
        });
        let lost = sweep::sum(forces.len(), |a| [forces[a][3]]);
        set.put(&ACCELERATION, acceleration);
        self.entry.spent += self.course.over(dt, lost)[0];
        Ok(())
    }

    fn entry(&self, _: &State) -> Entry {
        self.entry
    }

    fn bytes(&self) -> usize {
        self.rows.bytes()
    }

    fn save(&self) -> Vec<f64> {
        [&self.entry.save()[..], &self.course.last()].concat()
    }

    fn restore(&mut self, _: &State, saved: &[f64]) {
        let rest = self.entry.restore(saved);
        self.course.restore(rest);
    }
}
