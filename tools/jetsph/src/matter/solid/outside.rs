//! What acts on an elastic solid from outside: held faces, loads, damping, water.

use particles::{POSITION, Set, sweep};

use super::bound::Load;
use super::elastic::Elastic;
use super::forces::add;
use super::quadratic::second;
use crate::matter::meeting::faces::{BEND, MIXED, PRESSED, PULL, TWIST, WARP};
use crate::state::{ACCELERATION, MASS, State, VELOCITY};

impl<const L: usize, const T: usize> Elastic<L, T> {
    /// Force on the body at its anchors and their power.
    fn reaction(&self) -> ([f64; 3], f64) {
        let n = self.answers.len();
        if self.body.anchors.is_empty() {
            return ([0.0; 3], 0.0);
        }
        let [x, y, z, power] = sweep::sum(n, |a| {
            let row = self.links.row(a);
            let mut sum = [0.0; 4];
            // Neighbours are in order, anchors behind particles.
            if row.other.last().is_none_or(|b| (*b as usize) < n) {
                return sum;
            }
            for (b, weight) in row.other.iter().zip(row.weight) {
                if let Some(anchor) = (*b as usize).checked_sub(n) {
                    let mut force = [0.0; L];
                    add(&mut force, &self.answers[a], weight);
                    let velocity = self.body.anchors[anchor].velocity;
                    (0..L.min(3)).for_each(|k| {
                        sum[k] += force[k];
                        sum[3] += force[k] * velocity[k];
                    });
                }
            }
            sum
        });
        ([x, y, z], power)
    }

    /// Force and power at the anchors with which the next step begins.
    pub(super) fn hold_anew(&mut self) {
        self.held = self.reaction();
    }

    /// Accelerations by the loads and by damping, and the balances of all from outside.
    pub(super) fn outside(&mut self, state: &mut State, dt: f64) {
        let set = &mut state.sets[self.body.set];
        let mut acceleration = set.take(&ACCELERATION);
        let (mass, velocity) = (set.column(&MASS), set.column(&VELOCITY));
        let mut total = [0.0; 3];
        let time = state.time + dt;
        for load in &self.body.loads {
            let (a, force) = (load.particle, load.at(time));
            for k in 0..3 {
                acceleration[a][k] += force[k] / mass[a];
                total[k] += force[k];
            }
        }
        if self.body.damping > 0.0 {
            let rate = self.body.damping;
            sweep::change(&mut acceleration, |a, own| {
                (0..3).for_each(|k| own[k] -= rate * velocity[a][k]);
            });
            let loss = |a: usize| {
                let u = velocity[a];
                let square = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
                [
                    mass[a] * square,
                    mass[a] * u[0],
                    mass[a] * u[1],
                    mass[a] * u[2],
                ]
            };
            let [lost, x, y, z] = sweep::sum(set.len(), loss);
            self.entry.spent += dt * rate * lost;
            for (sum, part) in self.entry.impulse.iter_mut().zip([x, y, z]) {
                *sum -= dt * rate * part;
            }
        }
        if !set.has(&PRESSED) {
            let pulls = set.column(&PULL).iter().zip(mass);
            for (own, (pull, mass)) in acceleration.iter_mut().zip(pulls) {
                (0..3).for_each(|k| own[k] += pull[k] / mass);
            }
        }
        set.put(&ACCELERATION, acceleration);
        let held = self.reaction();
        let before = std::mem::replace(&mut self.held, held);
        self.entry.work += 0.5 * dt * (held.1 + before.1);
        let mean = |k: usize| 0.5 * (held.0[k] + before.0[k]);
        let impulse = self.entry.impulse.iter_mut().zip(total);
        for (k, (sum, load)) in impulse.enumerate() {
            *sum += dt * (mean(k) + load);
        }
        // What a load that rises can still do grows by its rise: no work of the solid's.
        if self.body.loads.iter().any(|load| load.rise > 0.0) {
            let position = set.column(&POSITION);
            let rate = self.load_work(position, |load| load.rate(time));
            self.entry.work -= self.rising.over(dt, [rate])[0];
        }
    }

    /// Takes the moments of the water's forces off the slopes of the energy.
    pub(super) fn twisted(&mut self, set: &Set) {
        let d = L.min(3);
        let moments = set.column(&TWIST).iter().zip(set.column(&BEND));
        let moments = moments.zip(set.column(&WARP));
        for (answer, ((twist, bend), warp)) in self.answers.iter_mut().zip(moments) {
            for i in 0..d {
                for k in 0..d {
                    answer[k][i] -= twist[i][k];
                    answer[second(d, k, k)][i] -= bend[i][k];
                }
                for (column, (k, l)) in MIXED.into_iter().enumerate().filter(|(_, p)| p.1 < d) {
                    answer[second(d, k, l)][i] -= warp[i][column];
                }
            }
        }
    }

    /// Work that loads can no longer do \[J\].
    pub(super) fn load_potential(&self, position: &[[f64; 3]], time: f64) -> f64 {
        self.load_work(position, |load| load.at(time))
    }

    /// Forces of the loads by the ways of the places where they act \[J\].
    fn load_work(&self, position: &[[f64; 3]], force: impl Fn(&Load) -> [f64; 3]) -> f64 {
        let each = self.body.loads.iter().map(|load| {
            let derivatives = self.derivatives(load.particle);
            let parts: [f64; T] = load.parts();
            let moved = |k: usize| -> f64 {
                let there = derivatives
                    .iter()
                    .zip(parts)
                    .map(|(column, part)| part * column[k]);
                position[load.particle][k] - load.place[k] + there.sum::<f64>()
            };
            let force = force(load);
            (0..L.min(3)).map(|k| force[k] * moved(k)).sum::<f64>()
        });
        each.sum()
    }
}
