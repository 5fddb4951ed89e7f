//! How much a face gives way to a force of the water at once.
//!
//! A face moves with the fit of its cell, u_f = sum_b L_b u_b, and a force on it acts on the same particles in the same parts. An
//! impulse J changes the velocity of the face by
//!
//! ```text
//! du_f = J sum_b L_b^2/m_b
//! ```
//!
//! which is several times J/m of its cell, and most beside cracks.

use particles::Set;

use super::elastic::Elastic;
use super::quadratic::terms;
use crate::matter::meeting::faces::{GIVING, PRESSED};
use crate::state::MASS;

/// Where on a face it is asked for, in cells from its middle along each other axis.
const ASIDE: [f64; 2] = [-0.25, 0.25];

impl<const L: usize, const T: usize> Elastic<L, T> {
    /// Shows how much the faces of pressed cells give way.
    pub(super) fn show_giving(&mut self, set: &mut Set) {
        let broken = self.breaking.as_ref().map_or(0, |b| b.list.len());
        let holds = std::mem::replace(&mut self.cracked, broken) == broken;
        let mut giving = set.take(&GIVING);
        let (pressed, mass) = (set.column(&PRESSED), set.column(&MASS));
        for (a, giving) in giving.iter_mut().enumerate() {
            if pressed[a] == 0 {
                *giving = 0.0;
            } else if !holds || *giving <= 0.0 {
                *giving = self.gives(a, mass);
            }
        }
        set.put(&GIVING, giving);
    }

    /// The most of what the faces of a cell give way to an impulse \[1/kg\].
    fn gives(&self, a: usize, mass: &[f64]) -> f64 {
        let d = L.min(3);
        let size = self.body.size;
        let mut most = 1.0 / mass[a];
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
                    most = most.max(self.gives_at(a, offset, depth, mass));
                }
            }
        }
        most
    }

    /// The same of a place of a face.
    fn gives_at(&self, a: usize, offset: [f64; 3], depth: [f64; 3], mass: &[f64]) -> f64 {
        let d = L.min(3);
        let (place, deep): ([f64; T], [f64; T]) = (terms(offset), terms(depth));
        let row = self.links.row(a);
        let (mut own, mut sum) = (1.0, 0.0);
        for (b, weight) in row.other.iter().zip(row.weight) {
            let parts = weight.iter().enumerate();
            let part: f64 = parts
                .map(|(m, w)| w * (place[m] + if m < d { 0.0 } else { deep[m] }))
                .sum();
            own -= part;
            // Anchors stand behind the particles and give way to nothing.
            if let Some(mass) = mass.get(*b as usize) {
                sum += part * part / mass;
            }
        }
        sum + own * own / mass[a]
    }
}
