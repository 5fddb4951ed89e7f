//! The divergence beside the interface of two liquids, along which these may slip.
//!
//! What crosses the interface is told by all neighbours, what goes along it by those of a particle's own liquid. With the unit
//! vector n across, and t how far the own liquid tells anything,
//!
//! ```text
//! div u = sum_b s (M_ab x_ab).(u_b - u_a)
//! M_ab = (1 - t) B + t (n n.B + (B_own - n n.B_own))        b of its own liquid, or solid
//! M_ab = (1 - t) B + t n n.B                                b of the other liquid
//! ```
//!
//! A mean of both over the interface would take a jump of u along it for a flow that thins out, and a wave between two
//! liquids would be slow by the first order of the spacing. What a step leaves of this divergence is damped as elsewhere
//! ([`super::grad_div`]): u <- u - alpha D^T D u.

use kernels::moments::{Moments, times};
use shapes::frame::{along, difference, dot};

use super::operators::Sums;
use crate::near::{Liquids, Near, Role, Row};

/// A matrix by rows.
type Matrix = [[f64; 3]; 3];

/// M of a particle beside neighbours of its own liquid, and beside those of the other.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sides {
    own: Matrix,
    other: Matrix,
}

impl Sides {
    /// M of the operators B of all neighbours and of its own, for the normal n and the trust t.
    pub(super) fn of(all: Moments, own: Moments, n: [f64; 3], t: f64) -> Self {
        let rows = |b: Moments| [[b[0], b[3], b[4]], [b[3], b[1], b[5]], [b[4], b[5], b[2]]];
        // n n.B: along n what B tells along it, B being symmetric.
        let across = |b: Moments| n.map(|n_i| times(b, n).map(|x| n_i * x));
        let (b, b_own) = (rows(all), rows(own));
        let (through, own_through) = (across(all), across(own));
        let mixed = |i: usize, j: usize| (1.0 - t) * b[i][j] + t * through[i][j];
        let each =
            |of: &dyn Fn(usize, usize) -> f64| [0, 1, 2].map(|i| [0, 1, 2].map(|j| of(i, j)));
        Self {
            other: each(&mixed),
            own: each(&|i, j| mixed(i, j) + t * (b_own[i][j] - own_through[i][j])),
        }
    }

    /// M x beside a neighbour of its own liquid or of the other.
    #[inline(always)]
    fn times(&self, alike: bool, x: [f64; 3]) -> [f64; 3] {
        let rows = if alike { &self.own } else { &self.other };
        rows.map(|row| dot(row, x))
    }

    /// `q` times both.
    fn by(self, q: f64) -> Self {
        let scaled = |m: Matrix| m.map(|row| row.map(|x| q * x));
        Self {
            own: scaled(self.own),
            other: scaled(self.other),
        }
    }

    /// That of an image, by the signs of its axes.
    fn turned(self, signs: [f64; 3]) -> Self {
        let turn = |m: Matrix| [0, 1, 2].map(|i| [0, 1, 2].map(|j| signs[i] * signs[j] * m[i][j]));
        Self {
            own: turn(self.own),
            other: turn(self.other),
        }
    }
}

/// div u of the particle `a` by its `sides`, of velocities `u` of particles and images.
fn divergence_at(
    near: &Near,
    liquids: &Liquids,
    sides: &Sides,
    u: &[[f64; 3]],
    a: usize,
    row: Row<'_>,
) -> f64 {
    let parts = row.slopes().map(|(b, slope)| {
        let (alike, step) = if near.role[b].flows() {
            (liquids.alike(a, b), difference(u[b], u[a]))
        } else {
            (true, u[a].map(|u| -2.0 * u))
        };
        let x = difference(near.position[a], near.position[b]);
        slope * dot(sides.times(alike, x), step)
    });
    parts.sum()
}

/// Puts div u by the `sides` of each particle `of` which is asked into `rows`.
pub(super) fn divergence(
    near: &Near,
    liquids: &Liquids,
    sides: &[Sides],
    u: &[[f64; 3]],
    of: impl Fn(usize) -> bool + Sync,
    rows: &mut [Sums],
) {
    near.each_row(rows, |a, row, sums| {
        if near.role[a] == Role::Liquid && of(a) {
            sums.divergence = divergence_at(near, liquids, &sides[a], u, a, row);
        }
    });
}

/// M of each particle times its div u and its `weight`, images included.
pub(super) fn stretch(
    near: &Near,
    liquids: &Liquids,
    sides: &[Sides],
    u: &[[f64; 3]],
    weight: impl Fn(usize) -> f64 + Sync,
    stretched: &mut Vec<Sides>,
) {
    near.each_row(stretched, |a, row, out| {
        *out = Sides::default();
        if near.role[a] == Role::Liquid {
            let divergence = divergence_at(near, liquids, &sides[a], u, a, row);
            *out = sides[a].by(weight(a) * divergence);
        }
    });
    near.complete(stretched, |sides, _, turn| {
        sides.turned(turn.vector([1.0; 3]))
    });
}

/// What D^T makes of what [`stretch`] gave, with the other sign.
pub(super) fn relax(
    near: &Near,
    liquids: &Liquids,
    stretched: &[Sides],
    change: &mut Vec<[f64; 3]>,
) {
    change.resize(near.len(), [0.0; 3]);
    near.each_row(change, |a, row, change| {
        *change = [0.0; 3];
        if near.role[a] != Role::Liquid {
            return;
        }
        for (b, slope) in row.slopes() {
            let x = difference(near.position[a], near.position[b]);
            let both = if near.role[b].flows() {
                let alike = liquids.alike(a, b);
                let other = stretched[b].times(alike, x);
                along(stretched[a].times(alike, x), 1.0, other)
            } else {
                // What is solid mirrors the velocity of the particle itself.
                stretched[a].times(true, x).map(|x| 2.0 * x)
            };
            *change = along(*change, slope, both);
        }
    });
}
