//! Artificial viscosity in a solid: between neighbours at rest, with the law of (38).
//!
//! Shinohara et al. (2004, section 2.4) take A = B = 2.5 in the solid, between what approaches. It damps what steps and
//! cracks excite and the solid itself would keep for ever. Fronts of tension overshoot as those of pressure do: between
//! what parts, it damps them alike.

use kernels::Kernel;
use neighbours::Grid;
use particles::{POSITION, Rows, Set, sweep};
use schemars::JsonSchema;
use serde::Deserialize;

use super::elastic::REST;
use crate::matter::water::friction::{Artificial, ArtificialViscosity, Friction};
use crate::stage::{Course, Entry, Limit, Stage, StageError};
use crate::state::{ACCELERATION, MASS, State, VELOCITY};

/// Part of the time in which friction evens out a kernel that a step may take.
const PART: f64 = 0.2;

/// Artificial viscosity of a solid in a scene.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShockViscosity {
    /// A of the linear term; 2.5 in the source.
    #[schemars(range(min = 0.0), extend("x-unit" = "1"))]
    pub linear: f64,
    /// B of the quadratic term.
    #[serde(default)]
    #[schemars(range(min = 0.0), extend("x-unit" = "1"))]
    pub quadratic: f64,
    /// C, which keeps near pairs from counting too much.
    #[serde(default = "ArtificialViscosity::usual_guard")]
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub guard: f64,
    /// Whether it acts between what parts, too: without, fronts of tension overshoot. In the source it does not.
    #[serde(default)]
    pub in_tension: bool,
}

impl ShockViscosity {
    /// Its terms.
    #[must_use]
    pub const fn terms(&self) -> ArtificialViscosity {
        ArtificialViscosity {
            linear: self.linear,
            quadratic: self.quadratic,
            guard: self.guard,
        }
    }
}

/// The stage.
pub struct Shocks<K, F> {
    set: usize,
    density: f64,
    artificial: Artificial,
    friction: F,
    kernel: K,
    rows: Rows,
    course: Course<1>,
    entry: Entry,
}

impl<K: Kernel, F: Friction> Shocks<K, F> {
    /// The stage of a set at rest; `friction` is that of `artificial`, one way or both.
    #[must_use]
    pub fn new(place: usize, set: &Set, artificial: Artificial, friction: F, kernel: K) -> Self {
        let reach = kernel.support();
        let (mut grid, mut rows) = (Grid::new(0.5 * reach), Rows::new());
        let rest = set.column(&REST);
        grid.bin(rest);
        rows.within(rest, &grid, reach);
        Self {
            set: place,
            density: set.matter.density,
            artificial,
            friction,
            kernel,
            rows,
            course: Course::default(),
            entry: Entry::default(),
        }
    }
}

impl<K: Kernel, F: Friction + Send> Stage for Shocks<K, F> {
    fn name(&self) -> &'static str {
        "shocks"
    }

    fn limit(&self, state: &State) -> Option<Limit> {
        let velocity = state.sets[self.set].column(&VELOCITY);
        let speed = |a: usize| velocity[a][0].hypot(velocity[a][1]).hypot(velocity[a][2]);
        let speed = sweep::greatest(velocity.len(), speed).map_or(0.0, |(_, most)| most);
        let h = 0.5 * self.kernel.support();
        let spread =
            (self.artificial.linear + 2.0 * self.artificial.quadratic * speed / h) / self.density;
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
                let q = self.friction.pressure(approach, square);
                if q != 0.0 && square < limit {
                    let volumes = mass[a] * mass[b] / (self.density * self.density);
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
