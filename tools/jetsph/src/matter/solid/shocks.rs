//! Artificial viscosity in a solid: between neighbours at rest, with the law of (38).
//!
//! Shinohara et al. (2004, section 2.4) take A = B = 2.5 in the solid, between what approaches. It damps what steps and
//! cracks excite and the solid itself would keep for ever. Fronts of tension overshoot as those of pressure do: between
//! what parts, it damps them alike.

use kernels::{Kernel, Number};
use neighbours::Grid;
use particles::{POSITION, Rows, Set, sweep};
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;
use steps::Limit;

use super::elastic::REST;
use super::fracture::BROKEN;
use crate::matter::four::{Lanes, Work, on_this_machine};
use crate::matter::water::friction::{Artificial, ArtificialViscosity, Friction};
use crate::stage::{Course, Entry, Stage, StageError};
use crate::state::{ACCELERATION, MASS, State, VELOCITY};

/// Particles per unit of parallel work.
const GRAIN: usize = 64;
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
    /// C in r^2 + C h^2 (eq. 39), which limits the viscosity of particles that nearly coincide.
    #[serde(default = "ArtificialViscosity::usual_guard")]
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub guard: f64,
    /// Whether it also acts between unbroken particles that move apart, as they do not in the source. Without it fronts of tension
    /// overshoot; with it the faces of a thin crack are braked.
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

/// Pulls of a chunk of particles \[N\], and half of the power that they take \[W\].
struct Pulls<'a, K, F> {
    shocks: &'a Shocks<K, F>,
    /// Places \[m\] and masses \[kg\].
    places: &'a [[f64; 4]],
    /// Velocities \[m/s\], and 1 where a particle is broken.
    speeds: &'a [[f64; 4]],
    /// Number of the first particle.
    first: usize,
    forces: &'a mut [[f64; 4]],
}

impl<K: Kernel, F: Friction> Work for Pulls<'_, K, F> {
    /// Four neighbours at once; the last four of a row are filled up with the particle, which does not pull itself.
    #[inline(always)]
    fn run(self, lanes: impl Lanes) {
        let (kernel, friction) = (&self.shocks.kernel, &self.shocks.friction);
        let none = lanes.take([0.0; 4]);
        let limit = none.of(kernel.support().powi(2));
        for (k, force) in self.forces.iter_mut().enumerate() {
            let a = self.first + k;
            let ([x, y, z, mass], [u, v, w, broken]) = (self.places[a], self.speeds[a]);
            let volume = none.of(mass / (self.shocks.density * self.shocks.density));
            let [x, y, z] = [none.of(x), none.of(y), none.of(z)];
            let [u, v, w, broken] = [none.of(u), none.of(v), none.of(w), none.of(broken)];
            let [mut along_x, mut along_y, mut along_z, mut power] = [none; 4];
            for four in self.shocks.rows.row(a).chunks(4) {
                let other = |k: usize| four.get(k).map_or(a, |b| *b as usize);
                let [b, c, d, e] = [other(0), other(1), other(2), other(3)];
                let [bx, by, bz, masses] = lanes.turn([
                    lanes.take(self.places[b]),
                    lanes.take(self.places[c]),
                    lanes.take(self.places[d]),
                    lanes.take(self.places[e]),
                ]);
                let [bu, bv, bw, flags] = lanes.turn([
                    lanes.take(self.speeds[b]),
                    lanes.take(self.speeds[c]),
                    lanes.take(self.speeds[d]),
                    lanes.take(self.speeds[e]),
                ]);
                let (dx, dy, dz) = (x - bx, y - by, z - bz);
                let square = dx * dx + dy * dy + dz * dz;
                let approach = (u - bu) * dx + (v - bv) * dy + (w - bw) * dz;
                let q = friction.pressure(approach, square);
                // What is broken bears compression alone.
                let q = none.below(broken + flags, q.greatest(none), q);
                let scale = volume * masses * q * kernel.slope(square.root());
                let scale = square.below(limit, scale, none);
                along_x = along_x - scale * dx;
                along_y = along_y - scale * dy;
                along_z = along_z - scale * dz;
                power = power + scale * approach;
            }
            let all = |four| {
                let [b, c, d, e] = lanes.give(four);
                b + c + d + e
            };
            *force = [all(along_x), all(along_y), all(along_z), 0.5 * all(power)];
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
        Some(Limit::dividing(
            "viscous",
            PART * h * h * 2.0 * axes / spread,
        ))
    }

    fn act(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let set = &mut state.sets[self.set];
        let mut acceleration = set.take(&ACCELERATION);
        let (position, velocity) = (set.column(&POSITION), set.column(&VELOCITY));
        let mass = set.column(&MASS);
        let broken = set.column(&BROKEN);
        let rows = 0..position.len();
        let places: Vec<[f64; 4]> = rows
            .clone()
            .map(|a| [position[a][0], position[a][1], position[a][2], mass[a]])
            .collect();
        let speeds: Vec<[f64; 4]> = rows
            .map(|a| {
                let is_broken = broken.get(a).is_some_and(|b| *b > 0);
                let [u, v, w] = velocity[a];
                [u, v, w, f64::from(u8::from(is_broken))]
            })
            .collect();
        let mut forces = vec![[0.0; 4]; places.len()];
        let each = forces.par_chunks_mut(GRAIN).enumerate();
        each.for_each(|(chunk, forces)| {
            on_this_machine(Pulls {
                shocks: self,
                places: &places,
                speeds: &speeds,
                first: chunk * GRAIN,
                forces,
            });
        });
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
