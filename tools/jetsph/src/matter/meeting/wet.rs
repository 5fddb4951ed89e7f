//! The pressure between water and solids.
//!
//! ```text
//! f_ip         = -V_i V_p (p_i + p_p + q_ip) grad W_ip        on water i, and as much the other way on point p
//! p_p          = sum_j V_j p_j W_jp/S_p,   S_p = sum_j V_j W_jp
//! d(rho_i)/dt += rho_i sum_p V_p (c_ip + W_ip D_p/S_p)
//! c_ip         = (u_i - u_f) . grad W_ip,   D_p = sum_j V_j c_jp
//! ```
//!
//! by volumes and with the mean of both smoothing lengths (errata to section 3, step 1). Each point of the solid stands
//! for water: it has the mean pressure p_p of the water around it, and what it is compressed by is stored by that water, in
//! the same parts. So pressures that change along a face, as those of water at rest do, push nothing along it. The force acts
//! on the face f between the two ([`super::faces`]), whose velocity counts. The pair is a force and its reaction, it only
//! pushes, and its work is what the water stores. Images of the water in plain walls meet the solid, too ([`super::touch`]).

use kernels::Kernel;
use particles::{POSITION, Set};
use rayon::prelude::*;

use super::faces::{BEND, Moving, PULL, TWIST, Taken, WARP};
use super::sight::Sight;
use super::touch::Touch;
use crate::matter::water::friction::{Artificial, Friction};
use crate::matter::water::images::image;
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

/// A particle of water, or its image, and a point of the solid.
struct Pair {
    point: usize,
    touch: Touch,
    /// From the point to the water \[m\].
    dx: [f64; 3],
    /// W and grad W = slope . dx.
    weight: f64,
    slope: f64,
    /// (u_i - u_f) . dx \[m2/s\].
    approach: f64,
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

    /// The pairs of each visitor.
    fn pairs(&self, state: &State) -> Vec<Vec<Pair>> {
        let set = &state.sets[self.sight.water];
        let (position, velocity) = (set.column(&POSITION), set.column(&VELOCITY));
        let skin = &self.sight.skin;
        let moving = Moving::of(&state.sets[skin.set]);
        let of = |v: usize| -> Vec<Pair> {
            let row = self.sight.row(v);
            let (a, mirror) = self.sight.visitor(v);
            let own = position[a];
            let seen = image(mirror, own, own, velocity[a]);
            let Some((x, u)) = seen.filter(|_| !row.is_empty()) else {
                return Vec::new();
            };
            let pair = |p: &u32| {
                let point = &skin.points[*p as usize];
                let dx = [0, 1, 2].map(|k| x[k] - point.x[k]);
                let touch = skin.touch(&moving, *p, dx, own, mirror);
                let face = touch.seen(mirror, moving.velocity(&touch.place));
                let du = [0, 1, 2].map(|k| u[k] - face[k]);
                let r = (dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2]).sqrt();
                Pair {
                    point: *p as usize,
                    touch,
                    dx,
                    weight: self.sight.kernel.value(r),
                    slope: self.sight.kernel.slope(r),
                    approach: du[0] * dx[0] + du[1] * dx[1] + du[2] * dx[2],
                }
            };
            row.iter().map(pair).collect()
        };
        let all = (0..self.sight.visitors())
            .into_par_iter()
            .with_min_len(GRAIN);
        all.map(of).collect()
    }

    /// What the water around each point has of something, on average by volumes and weights; `of` tells what a pair has of it times
    /// its weight.
    fn around_points(
        &self,
        pairs: &[Vec<Pair>],
        volumes: &[f64],
        of: impl Fn(usize, &Pair) -> f64,
    ) -> Vec<f64> {
        let mut sums = vec![[0.0; 2]; self.sight.skin.points.len()];
        for (v, pairs) in pairs.iter().enumerate() {
            let (a, _) = self.sight.visitor(v);
            for pair in pairs {
                let [sum, weights] = &mut sums[pair.point];
                *sum += volumes[a] * of(a, pair);
                *weights += volumes[a] * pair.weight;
            }
        }
        let mean = |[sum, weights]: [f64; 2]| if weights > 0.0 { sum / weights } else { 0.0 };
        sums.into_iter().map(mean).collect()
    }

    /// Volumes of the water \[m3\].
    fn volumes(&self, water: &Set) -> Vec<f64> {
        let each = water.column(&MASS).iter().zip(water.column(&DENSITY));
        each.map(|(mass, density)| mass / self.law.filling(*density))
            .collect()
    }

    /// Adds the forces of pairs to the accelerations of the water and to what the solid and the walls take; gives what friction
    /// takes \[W\].
    fn push(
        &mut self,
        pairs: &[Vec<Pair>],
        state: &mut State,
        taken: &mut Taken,
        acceleration: &mut [[f64; 3]],
    ) -> f64 {
        let water = &state.sets[self.sight.water];
        let (mass, density) = (water.column(&MASS), water.column(&DENSITY));
        let volumes = self.volumes(water);
        let pressure: Vec<f64> = density.iter().map(|d| self.law.pressure(*d)).collect();
        let mean = self.around_points(pairs, &volumes, |a, pair| pressure[a] * pair.weight);
        let mut lost = 0.0;
        for (v, pairs) in pairs.iter().enumerate() {
            let (a, mirror) = self.sight.visitor(v);
            for pair in pairs {
                let square: f64 = pair.dx.iter().map(|x| x * x).sum();
                let q = self.friction.pressure(pair.approach, square);
                let volume = self.sight.skin.points[pair.point].volume;
                let slope = volumes[a] * volume * pair.slope;
                let force = pair
                    .dx
                    .map(|x| -slope * (pressure[a] + mean[pair.point] + q) * x);
                lost += slope * q * pair.approach;
                let on_solid = pair.touch.seen(mirror, force).map(|f| -f);
                let back = mirror.iter().rev();
                let on_water = back.fold(force, |force, plane| plane.mirrored(force));
                (0..3).for_each(|k| {
                    acceleration[a][k] += on_water[k] / mass[a];
                    self.force[k] += on_solid[k];
                });
                let rest = [0, 1, 2].map(|k| -on_water[k] - on_solid[k]);
                pair.touch.bear(mirror, rest, &mut state.on_walls);
                taken.add(&pair.touch.place, on_solid);
            }
        }
        lost
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
        state.on_walls.resize(self.sight.walls(), [0.0; 3]);
    }

    fn flows(&self) -> bool {
        true
    }

    fn flow(&mut self, state: &mut State, _: f64) -> Result<(), StageError> {
        self.sight.look(state);
        let pairs = self.pairs(state);
        let set = &mut state.sets[self.sight.water];
        let volumes = self.volumes(set);
        let shared = self.around_points(&pairs, &volumes, |_, pair| pair.slope * pair.approach);
        let mut rate = set.take(&DENSITY_RATE);
        let density = set.column(&DENSITY);
        for (v, pairs) in pairs.iter().enumerate() {
            let (a, _) = self.sight.visitor(v);
            let each = pairs.iter().map(|pair| {
                let closing = pair.slope * pair.approach + pair.weight * shared[pair.point];
                self.sight.skin.points[pair.point].volume * closing
            });
            rate[a] += density[a] * each.sum::<f64>();
        }
        set.put(&DENSITY_RATE, rate);
        Ok(())
    }

    fn act(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        self.sight.look(state);
        let pairs = self.pairs(state);
        self.force = [0.0; 3];
        let mut acceleration = state.sets[self.sight.water].take(&ACCELERATION);
        let mut taken = Taken::begin(&mut state.sets[self.sight.skin.set]);
        let lost = self.push(&pairs, state, &mut taken, &mut acceleration);
        state.sets[self.sight.water].put(&ACCELERATION, acceleration);
        taken.end(&mut state.sets[self.sight.skin.set]);
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
