//! The pressure between water and solids.
//!
//! ```text
//! f_ip         = -V_i V_p (2 p_i + q_ip) grad W_ip            on water i, and as much the other way on point p
//! d(rho_i)/dt += 2 rho_i sum_p V_p (u_i - u_p) . grad W_ip
//! ```
//!
//! by volumes and with the mean of both smoothing lengths (errata to section 3, step 1). Each point of the solid stands
//! for the water's mirror image there: it has the water's pressure, and closes twice as fast as itself. So the pair is a
//! force and its reaction, it only pushes, and its work is what the water stores.

use kernels::Kernel;
use neighbours::Grid;
use particles::{POSITION, Rows, sweep};
use rayon::prelude::*;

use super::skin::{PULL, Skin, TWIST};
use crate::matter::water::friction::{Artificial, Friction};
use crate::matter::water::tait::Tait;
use crate::stage::{Course, Entry, Figure, Stage, StageError};
use crate::state::{ACCELERATION, DENSITY, DENSITY_RATE, MASS, State, VELOCITY};

/// Water per unit of parallel work.
const GRAIN: usize = 64;

/// A solid that meets water.
pub struct Wet<K> {
    /// Number of the set of water.
    pub water: usize,
    /// Its equation of state.
    pub law: Tait,
    /// Friction between the two.
    pub friction: Artificial,
    /// The solid.
    pub skin: Skin,
    /// Kernel of the mean smoothing length.
    pub kernel: K,
    grid: Grid,
    points: Grid,
    rows: Rows,
    force: [f64; 3],
    course: Course<1>,
    entry: Entry,
}

/// A pair at work.
struct Pair {
    point: u32,
    /// On the water \[N\].
    force: [f64; 3],
    /// What friction takes \[W\].
    lost: f64,
}

impl<K: Kernel> Wet<K> {
    /// The stage of a solid and the water.
    #[must_use]
    pub fn new((water, law): (usize, Tait), friction: Artificial, skin: Skin, kernel: K) -> Self {
        let reach = kernel.support();
        Self {
            water,
            law,
            friction,
            skin,
            kernel,
            grid: Grid::new(reach),
            points: Grid::new(reach),
            rows: Rows::new(),
            force: [0.0; 3],
            course: Course::default(),
            entry: Entry::default(),
        }
    }

    /// Finds who meets whom.
    fn look(&mut self, state: &State) {
        let water = state.sets[self.water].column(&POSITION);
        let reach = self.kernel.support();
        self.grid.bin(water);
        let grid = &self.grid;
        self.skin.look(&state.sets[self.skin.set], reach, |x, r| {
            grid.any_within(x, r)
        });
        let places: Vec<[f64; 3]> = self.skin.points.iter().map(|p| p.x).collect();
        self.points.bin(&places);
        if places.is_empty() {
            self.rows.between(&[], &self.points, reach);
        } else {
            self.rows.between(water, &self.points, reach);
        }
    }

    /// Forces of the pairs of each particle of water, by its number.
    fn pairs(&self, state: &State) -> Vec<Vec<Pair>> {
        let set = &state.sets[self.water];
        let (position, velocity) = (set.column(&POSITION), set.column(&VELOCITY));
        let (mass, density) = (set.column(&MASS), set.column(&DENSITY));
        let of = |a: usize| -> Vec<Pair> {
            let row = self.rows.row(a);
            if row.is_empty() {
                return Vec::new();
            }
            let volume = mass[a] / self.law.filling(density[a]);
            let pressure = 2.0 * self.law.pressure(density[a]);
            let pair = |p: &u32| {
                let point = &self.skin.points[*p as usize];
                let dx = [0, 1, 2].map(|k| position[a][k] - point.x[k]);
                let du = [0, 1, 2].map(|k| velocity[a][k] - point.u[k]);
                let square = dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2];
                let approach = du[0] * dx[0] + du[1] * dx[1] + du[2] * dx[2];
                let q = self.friction.pressure(approach, square);
                let slope = volume * point.volume * self.kernel.slope(square.sqrt());
                Pair {
                    point: *p,
                    force: dx.map(|x| -slope * (pressure + q) * x),
                    lost: slope * q * approach,
                }
            };
            row.iter().map(pair).collect()
        };
        let all = (0..self.rows.len()).into_par_iter().with_min_len(GRAIN);
        all.map(of).collect()
    }
}

impl<K: Kernel> Stage for Wet<K> {
    fn name(&self) -> &'static str {
        "meeting"
    }

    fn declare(&self, state: &mut State) {
        let set = &mut state.sets[self.skin.set];
        set.declare(&PULL);
        set.declare(&TWIST);
    }

    fn flows(&self) -> bool {
        true
    }

    fn flow(&mut self, state: &mut State, _: f64) -> Result<(), StageError> {
        self.look(state);
        let set = &mut state.sets[self.water];
        let mut rate = set.take(&DENSITY_RATE);
        let (position, velocity) = (set.column(&POSITION), set.column(&VELOCITY));
        let density = set.column(&DENSITY);
        if !self.rows.is_empty() {
            sweep::change(&mut rate, |a, rate| {
                let mut sum = 0.0;
                for p in self.rows.row(a) {
                    let point = &self.skin.points[*p as usize];
                    let dx = [0, 1, 2].map(|k| position[a][k] - point.x[k]);
                    let du = [0, 1, 2].map(|k| velocity[a][k] - point.u[k]);
                    let square = dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2];
                    let approach = du[0] * dx[0] + du[1] * dx[1] + du[2] * dx[2];
                    sum += point.volume * self.kernel.slope(square.sqrt()) * approach;
                }
                *rate += 2.0 * density[a] * sum;
            });
        }
        set.put(&DENSITY_RATE, rate);
        Ok(())
    }

    fn act(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        self.look(state);
        let pairs = self.pairs(state);
        let set = &mut state.sets[self.water];
        let mut acceleration = set.take(&ACCELERATION);
        let mass = set.column(&MASS);
        let mut on_points = vec![[0.0; 3]; self.skin.points.len()];
        let mut lost = 0.0;
        self.force = [0.0; 3];
        for (a, pairs) in pairs.iter().enumerate() {
            for pair in pairs {
                lost += pair.lost;
                for k in 0..3 {
                    acceleration[a][k] += pair.force[k] / mass[a];
                    on_points[pair.point as usize][k] -= pair.force[k];
                    self.force[k] -= pair.force[k];
                }
            }
        }
        set.put(&ACCELERATION, acceleration);
        let solid = &mut state.sets[self.skin.set];
        solid.column_mut(&PULL).fill([0.0; 3]);
        solid.column_mut(&TWIST).fill([[0.0; 3]; 3]);
        let (mut pull, mut twist) = (solid.take(&PULL), solid.take(&TWIST));
        for (point, force) in self.skin.points.iter().zip(on_points) {
            let cell = point.cell as usize;
            for k in 0..3 {
                pull[cell][k] += force[k];
                (0..3).for_each(|l| twist[cell][k][l] += force[k] * point.offset[l]);
            }
        }
        solid.put(&PULL, pull);
        solid.put(&TWIST, twist);
        self.entry.spent += self.course.over(dt, [lost])[0];
        Ok(())
    }

    fn entry(&self, _: &State) -> Entry {
        self.entry
    }

    fn figures(&self, state: &State) -> Vec<Figure> {
        let name = state.sets[self.skin.set].name();
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
