//! How much a face gives way to a force of the water at once.
//!
//! A face moves with the fit of its cell, u_f = sum_b L_b u_b, and a force on it acts on the same particles in the same parts. An
//! impulse J changes the velocity of the face by
//!
//! ```text
//! du_f = J sum_b L_b^2/m_b
//! ```
//!
//! which is several times J/m of its cell, and most beside cracks. Impulses on all faces of a flat side give it, in whatever pattern,
//! at most the sum over layers l of the lattice
//!
//! ```text
//! s = sum_l (sum_(b in l) |L_b|)^2/m
//! ```
//!
//! since no wave along a layer gets more of it than the sum of its parts.
//!
//! The impulses are taken up here, too, between the two halves of the
//! kick, where the energy that they bring is J.(u + dt a/2 + du/2) to the last bit.

use particles::Set;

use super::elastic::{Elastic, REST};
use super::quadratic::{second, terms};
use crate::matter::meeting::faces::{BEND, GIVING, MIXED, PRESSED, PULL, PULLED, TWIST, WARP};
use crate::state::{ACCELERATION, MASS, VELOCITY};

/// Where on a face it is asked for, in cells from its middle along each other axis.
const ASIDE: [f64; 2] = [-0.25, 0.25];
/// By how much more than its bound a face is taken to give way: parts of faces are met at other places than those asked for, and
/// water of ten times the density of a bar shook it by the bound alone.
const MARGIN: f64 = 1.3;
/// Layers that a fit may reach.
const LAYERS: usize = 9;

impl<const L: usize, const T: usize> Elastic<L, T> {
    /// Shows how much the faces of pressed cells give way.
    pub(super) fn show_giving(&mut self, set: &mut Set) {
        let broken = self.breaking.as_ref().map_or(0, |b| b.list.len());
        let holds = std::mem::replace(&mut self.cracked, broken) == broken;
        let mut giving = set.take(&GIVING);
        let pressed = set.column(&PRESSED);
        for (a, giving) in giving.iter_mut().enumerate() {
            if pressed[a] == 0 {
                *giving = 0.0;
            } else if !holds || *giving <= 0.0 {
                *giving = MARGIN * self.gives(a, set);
            }
        }
        set.put(&GIVING, giving);
    }

    /// The most of what the faces of a cell give way to an impulse \[1/kg\].
    fn gives(&self, a: usize, set: &Set) -> f64 {
        let d = L.min(3);
        let size = self.body.size;
        let mut most = 1.0 / set.column(&MASS)[a];
        if !self.is_whole(a) {
            return most;
        }
        for axis in 0..d {
            for side in [-0.5, 0.5] {
                for corner in 0..1_usize << (d - 1) {
                    let mut offset = [0.0; 3];
                    let others = (0..d).filter(|k| *k != axis);
                    for (bit, k) in others.enumerate() {
                        offset[k] = ASIDE[corner >> bit & 1] * size[k];
                    }
                    offset[axis] = side * size[axis];
                    let mut depth = [0.0; 3];
                    depth[axis] = offset[axis];
                    most = most.max(self.gives_at(a, axis, [offset, depth], set));
                }
            }
        }
        most
    }

    /// The same of a place of a face across `axis`, of a pattern of impulses.
    fn gives_at(&self, a: usize, axis: usize, place: [[f64; 3]; 2], set: &Set) -> f64 {
        let (rest, mass) = (set.column(&REST), set.column(&MASS));
        let d = L.min(3);
        let (place, deep): ([f64; T], [f64; T]) = (terms(place[0]), terms(place[1]));
        let row = self.links.row(a);
        let mut own = 1.0;
        // Layers around that of the cell, with their sums of |L| and 1/m.
        let mut layers: [[f64; 2]; LAYERS] = Default::default();
        let mut add = |layer: f64, part: f64, mass: f64| {
            let number = (layer + 0.5 * (LAYERS as f64 - 1.0)).clamp(0.0, LAYERS as f64 - 1.0);
            let [sum, light] = &mut layers[number as usize];
            *sum += part.abs();
            *light = light.max(1.0 / mass);
        };
        for (b, weight) in row.other.iter().zip(row.weight) {
            let parts = weight.iter().enumerate();
            let part: f64 = parts
                .map(|(m, w)| w * (place[m] + if m < d { 0.0 } else { deep[m] }))
                .sum();
            own -= part;
            // Anchors stand behind the particles and give way to nothing.
            if let Some(mass) = mass.get(*b as usize) {
                let away = rest[*b as usize][axis] - rest[a][axis];
                add((away / self.body.size[axis]).round(), part, *mass);
            }
        }
        add(0.0, own, mass[a]);
        layers.iter().map(|[sum, light]| sum * sum * light).sum()
    }

    /// What the forces on the face of a cell put on its neighbours, anchors included, by what they weigh there: `each` gets the number of
    /// each and the force \[N\]. Gives what is left for the cell itself.
    fn spread(&self, set: &Set, a: usize, mut each: impl FnMut(usize, [f64; 3])) -> [f64; 3] {
        let mut own = set.column(&PULL)[a];
        if !self.is_whole(a) {
            return own;
        }
        let moments = self.moments(set, a);
        let row = self.links.row(a);
        for (b, weight) in row.other.iter().zip(row.weight) {
            let mut force = [0.0; 3];
            for (moment, w) in moments.iter().zip(weight) {
                (0..3).for_each(|k| force[k] += w * moment[k]);
            }
            (0..3).for_each(|k| own[k] -= force[k]);
            each(*b as usize, force);
        }
        own
    }

    /// Moments of the forces on a cell, by what its derivatives are.
    fn moments(&self, set: &Set, a: usize) -> [[f64; 3]; T] {
        let d = L.min(3);
        let (twist, bend, warp) = (
            set.column(&TWIST)[a],
            set.column(&BEND)[a],
            set.column(&WARP)[a],
        );
        let mut moments = [[0.0; 3]; T];
        for i in 0..d {
            for k in 0..d {
                moments[k][i] += twist[i][k];
                moments[second(d, k, k)][i] += bend[i][k];
            }
            for (column, (k, l)) in MIXED.into_iter().enumerate().filter(|(_, p)| p.1 < d) {
                moments[second(d, k, l)][i] += warp[i][column];
            }
        }
        moments
    }

    /// Forces of the water on all particles \[N\].
    fn pulls(&self, set: &Set) -> Vec<[f64; 3]> {
        let mut forces = vec![[0.0; 3]; set.len()];
        let pressed = set.column(&PRESSED).iter().enumerate();
        for (a, _) in pressed.filter(|(_, pressed)| **pressed > 0) {
            let own = self.spread(set, a, |b, force| {
                if let Some(sum) = forces.get_mut(b) {
                    (0..3).for_each(|k| sum[k] += force[k]);
                }
            });
            (0..3).for_each(|k| forces[a][k] += own[k]);
        }
        forces
    }

    /// Shows what the last forces of the water give each particle.
    pub(super) fn show_pulled(&self, set: &mut Set) {
        let forces = self.pulls(set);
        let mut pulled = set.take(&PULLED);
        let all = pulled.iter_mut().zip(&forces).zip(set.column(&MASS));
        for ((pulled, force), mass) in all {
            *pulled = force.map(|f| f / mass);
        }
        set.put(&PULLED, pulled);
    }

    /// Takes up what the water has pushed with over a step of `dt` \[s\].
    pub(super) fn take_impulses(&mut self, set: &mut Set, dt: f64) {
        let forces = self.pulls(set);
        let mut velocity = set.take(&VELOCITY);
        let (mass, acceleration) = (set.column(&MASS), set.column(&ACCELERATION));
        for (a, force) in forces.iter().enumerate() {
            for k in 0..3 {
                let change = dt * force[k] / mass[a];
                let middle = velocity[a][k] + 0.5 * (dt * acceleration[a][k] + change);
                velocity[a][k] += change;
                self.entry.spent -= dt * force[k] * middle;
                self.entry.impulse[k] += dt * force[k];
            }
        }
        set.put(&VELOCITY, velocity);
    }

    /// What the water puts on the clamps at once \[N\], as a force on the body.
    pub(super) fn leaning(&self, set: &Set) -> [f64; 3] {
        let mut sum = [0.0; 3];
        let pressed = set.column(&PRESSED).iter().enumerate();
        for (a, _) in pressed.filter(|(_, pressed)| **pressed > 0) {
            self.spread(set, a, |b, force| {
                if b >= set.len() {
                    (0..3).for_each(|k| sum[k] -= force[k]);
                }
            });
        }
        sum
    }
}
