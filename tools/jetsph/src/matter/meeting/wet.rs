//! The pressure between water and solids.
//!
//! ```text
//! f_ip         = -V_i V_p (2 p_i + q_ip) grad W_ip            on water i, and as much the other way on point p
//! d(rho_i)/dt += 2 rho_i sum_p V_p (u_i - u_f) . grad W_ip
//! ```
//!
//! by volumes and with the mean of both smoothing lengths (errata to section 3, step 1). Each point of the solid stands
//! for the water's mirror image there: it has the water's pressure, and closes twice as fast as itself. The force acts on the
//! face f between the two ([`super::faces`]), whose velocity counts. So the pair is a force and its reaction, it only
//! pushes, and its work is what the water stores.

use kernels::Kernel;
use particles::{POSITION, sweep};
use rayon::prelude::*;

use super::faces::{BEND, Moving, PULL, Place, TWIST, Taken, WARP};
use super::sight::Sight;
use crate::matter::water::friction::{Artificial, Friction};
use crate::matter::water::tait::Tait;
use crate::stage::{Course, Entry, Figure, Stage, StageError};
use crate::state::{ACCELERATION, DENSITY, DENSITY_RATE, MASS, State, VELOCITY};

/// Water per unit of parallel work.
const GRAIN: usize = 64;

/// A solid that meets water.
pub struct Wet<K> {
    /// Equation of state of the water.
    law: Tait,
    /// Friction between the two.
    friction: Artificial,
    /// Who meets whom.
    sight: Sight<K>,
    force: [f64; 3],
    course: Course<1>,
    entry: Entry,
}

/// A pair at work.
struct Pair {
    place: Place,
    /// On the water \[N\].
    force: [f64; 3],
    /// What friction takes \[W\].
    lost: f64,
}

impl<K: Kernel> Wet<K> {
    /// The stage of a solid and the water.
    #[must_use]
    pub fn new(law: Tait, friction: Artificial, sight: Sight<K>) -> Self {
        Self {
            law,
            friction,
            sight,
            force: [0.0; 3],
            course: Course::default(),
            entry: Entry::default(),
        }
    }

    /// Forces of the pairs of each particle of water, by its number.
    fn pairs(&self, state: &State) -> Vec<Vec<Pair>> {
        let set = &state.sets[self.sight.water];
        let (position, velocity) = (set.column(&POSITION), set.column(&VELOCITY));
        let (mass, density) = (set.column(&MASS), set.column(&DENSITY));
        let moving = Moving::of(&state.sets[self.sight.skin.set]);
        let of = |a: usize| -> Vec<Pair> {
            let row = self.sight.rows.row(a);
            if row.is_empty() {
                return Vec::new();
            }
            let volume = mass[a] / self.law.filling(density[a]);
            let pressure = 2.0 * self.law.pressure(density[a]);
            let pair = |p: &u32| {
                let point = &self.sight.skin.points[*p as usize];
                let dx = [0, 1, 2].map(|k| position[a][k] - point.x[k]);
                let place = self.sight.skin.pressed(&moving, *p, dx);
                let u = moving.velocity(&place);
                let du = [0, 1, 2].map(|k| velocity[a][k] - u[k]);
                let square = dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2];
                let approach = du[0] * dx[0] + du[1] * dx[1] + du[2] * dx[2];
                let q = self.friction.pressure(approach, square);
                let slope = volume * point.volume * self.sight.kernel.slope(square.sqrt());
                Pair {
                    place,
                    force: dx.map(|x| -slope * (pressure + q) * x),
                    lost: slope * q * approach,
                }
            };
            row.iter().map(pair).collect()
        };
        let all = (0..self.sight.rows.len())
            .into_par_iter()
            .with_min_len(GRAIN);
        all.map(of).collect()
    }
}

impl<K: Kernel> Stage for Wet<K> {
    fn name(&self) -> &'static str {
        "meeting"
    }

    fn declare(&self, state: &mut State) {
        let set = &mut state.sets[self.sight.skin.set];
        set.declare(&PULL);
        [TWIST, BEND, WARP].iter().for_each(|c| set.declare(c));
    }

    fn flows(&self) -> bool {
        true
    }

    fn flow(&mut self, state: &mut State, _: f64) -> Result<(), StageError> {
        self.sight.look(state);
        let mut rate = state.sets[self.sight.water].take(&DENSITY_RATE);
        let (set, moving) = (
            &state.sets[self.sight.water],
            Moving::of(&state.sets[self.sight.skin.set]),
        );
        let (position, velocity) = (set.column(&POSITION), set.column(&VELOCITY));
        let density = set.column(&DENSITY);
        if !self.sight.rows.is_empty() {
            sweep::change(&mut rate, |a, rate| {
                let mut sum = 0.0;
                for p in self.sight.rows.row(a) {
                    let point = &self.sight.skin.points[*p as usize];
                    let dx = [0, 1, 2].map(|k| position[a][k] - point.x[k]);
                    let u = moving.velocity(&self.sight.skin.pressed(&moving, *p, dx));
                    let du = [0, 1, 2].map(|k| velocity[a][k] - u[k]);
                    let square = dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2];
                    let approach = du[0] * dx[0] + du[1] * dx[1] + du[2] * dx[2];
                    sum += point.volume * self.sight.kernel.slope(square.sqrt()) * approach;
                }
                *rate += 2.0 * density[a] * sum;
            });
        }
        state.sets[self.sight.water].put(&DENSITY_RATE, rate);
        Ok(())
    }

    fn act(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        self.sight.look(state);
        let pairs = self.pairs(state);
        let set = &mut state.sets[self.sight.water];
        let mut acceleration = set.take(&ACCELERATION);
        let mass = set.column(&MASS);
        let mut pushed = Vec::new();
        let mut lost = 0.0;
        self.force = [0.0; 3];
        for (a, pairs) in pairs.iter().enumerate() {
            for pair in pairs {
                lost += pair.lost;
                (0..3).for_each(|k| {
                    acceleration[a][k] += pair.force[k] / mass[a];
                    self.force[k] -= pair.force[k];
                });
                pushed.push((pair.place, pair.force.map(|f| -f)));
            }
        }
        set.put(&ACCELERATION, acceleration);
        let solid = &mut state.sets[self.sight.skin.set];
        let mut taken = Taken::begin(solid);
        pushed
            .iter()
            .for_each(|(place, force)| taken.add(place, *force));
        taken.end(solid);
        self.entry.spent += self.course.over(dt, [lost])[0];
        Ok(())
    }

    fn entry(&self, _: &State) -> Entry {
        self.entry
    }

    fn figures(&self, state: &State) -> Vec<Figure> {
        let name = state.sets[self.sight.skin.set].name();
        let axes = ["x", "y", "z"]
            .iter()
            .zip(self.force)
            .take(state.dimensions);
        axes.map(|(axis, value)| Figure {
            name: format!("water_force_on_{name}_{axis}"),
            unit: "N",
            value,
        })
        .collect()
    }

    fn save(&self) -> Vec<f64> {
        [&self.entry.save()[..], &self.course.last(), &self.force].concat()
    }

    fn restore(&mut self, _: &State, saved: &[f64]) {
        let rest = self.entry.restore(saved);
        if let [x, y, z] = *self.course.restore(rest) {
            self.force = [x, y, z];
        }
    }
}
