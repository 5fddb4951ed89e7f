//! Divergence and moments of a row of neighbours.
//!
//! With the weights w = -(dW/dr)/r of the pairs, s = -w, and B the inverse of the sum of w x x,
//!
//! ```text
//! grad p = B sum_b s x_ab (p_b - p_a)        div u = B : sum_b s x_ab (u_b - u_a)        (Bonet and Lok 1999)
//! lap p = 2/m sum_b w (p_b - p_a)            m = 1/3 sum_b w r^2                           (Brookshaw 1985)
//! ```
//!
//! Solid neighbours have the velocity -u_a: the face between both rests.
//!
//! What a particle of the surface lacks of the weights that the lattice has stands one layer away across the surface,
//! mirrored there: its pressure is 2 p_s - p_a, its velocity that of the particle, and it adds to the moments, so that
//! grad p is exact for a plane of the lattice. A layer is as thick as the neighbours beneath lie deep: where the surface
//! bends it stretches, and the surface with it. (With a surface that keeps its distance from the particle waves of 20
//! spacings are 4 % too slow. With moments of the present neighbours alone in div u they would not grow, but films of a few
//! particles, which then count whole, burst.) Where tension acts its scatter from particle to particle drives such a
//! surface on, and drops without viscosity broke up: there a layer is one spacing thick, and m that of the lattice. Where
//! particles lie scattered B means little, and the lattice's stands for it.

use super::filled::{Filled, within};
use super::openness::open;
use crate::near::{Near, Row};
use crate::vector::{dot, minus, plus, squared};

/// Lack of weight, in parts of the lattice's, from which on a particle lies at the surface, and at which it does so wholly.
/// A particle of a plane surface lacks a third.
const LACKS: [f64; 2] = [0.10, 0.20];
/// Part of the lattice's weight up to which B is the lattice's, and from which on it is the row's own.
const TRUST: [f64; 2] = [0.45, 0.60];
/// Depth in spacings from which on a neighbour begins to be, and is wholly, one of the layer beneath.
const BENEATH: [f64; 2] = [0.3, 0.7];
/// Least and greatest thickness of a layer in spacings.
const THICK: [f64; 2] = [0.6, 1.4];

/// What the operators need of a row.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    /// Sum of w over the liquid neighbours \[1/m5\].
    pub(super) liquid: f64,
    /// Weight that the surface lacks \[1/m5\].
    pub(super) missing: f64,
    /// Sum of s x at the surface, zero in the inside \[1/m4\].
    pub(super) open: [f64; 3],
    /// How sure it is that there is a surface, 0 to 1.
    pub(super) sure: f64,
    /// How far away what is missing stands \[m\].
    pub(super) layer: f64,
    /// B: xx, yy, zz, xy, xz, yz \[m3\].
    pub(super) inverse: [f64; 6],
    /// Mean moment along an axis, what is missing included \[1/m3\].
    pub(super) moment: f64,
    /// div u \[1/s\].
    pub(super) divergence: f64,
    /// grad u: of each axis the change of u along it \[1/s\].
    pub(super) slope: [[f64; 3]; 3],
}

impl Sums {
    /// The way from a particle of the surface to the surface \[m\]; shorter where what it lacks lies around it.
    pub(super) fn outwards(&self) -> [f64; 3] {
        let size = squared(self.open).sqrt().max(self.missing * self.layer);
        let half = if size > 0.0 {
            -0.5 * self.layer / size
        } else {
            0.0
        };
        self.open.map(|x| half * x)
    }
}

/// B x for a symmetric B.
#[inline(always)]
pub(super) fn times([a, b, c, d, e, f]: [f64; 6], [x, y, z]: [f64; 3]) -> [f64; 3] {
    [
        a * x + d * y + e * z,
        d * x + b * y + f * z,
        e * x + f * y + c * z,
    ]
}

/// B M for a symmetric B.
#[inline(always)]
fn multiplied([a, b, c, d, e, f]: [f64; 6], [x, y, z]: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let row = |p: f64, q: f64, r: f64| std::array::from_fn(|i| p * x[i] + q * y[i] + r * z[i]);
    [row(a, d, e), row(d, b, f), row(e, f, c)]
}

impl Sums {
    /// Those of particle `a` with the velocities `u`.
    #[inline(always)]
    pub(super) fn of(near: &Near, u: &[[f64; 3]], a: usize, row: Row<'_>, filled: Filled) -> Self {
        let (mut all, mut liquid) = (0.0, 0.0);
        let (mut moments, mut change) = ([0.0; 6], [[0.0; 3]; 3]);
        for (b, slope) in row.slopes() {
            let x = minus(near.position[a], near.position[b]);
            all -= slope;
            let step = if near.role[b].flows() {
                liquid -= slope;
                minus(u[b], u[a])
            } else {
                u[a].map(|u| -2.0 * u)
            };
            let [p, q, r] = x.map(|x| slope * x);
            change[0] = plus(change[0], p, step);
            change[1] = plus(change[1], q, step);
            change[2] = plus(change[2], r, step);
            let squares = [p * x[0], q * x[1], r * x[2], p * x[1], p * x[2], q * x[2]];
            moments = std::array::from_fn(|i| moments[i] - squares[i]);
        }
        let (fill, tense) = (all / filled.weight, !near.tension.is_empty());
        let part = within(1.0 - fill, LACKS);
        let missing = part * (filled.weight - all).max(0.0);
        let mut sums = Self {
            liquid,
            missing,
            divergence: 0.0,
            slope: [[0.0; 3]; 3],
            layer: filled.spacing,
            inverse: [0.0; 6],
            open: [0.0; 3],
            sure: 0.0,
            moment: if tense {
                filled.moment
            } else {
                (moments[0] + moments[1] + moments[2] + missing * filled.beside) / 3.0
            },
        };
        if missing > 0.0 {
            let inwards = near.gradient[a];
            sums.open = inwards.map(|x| part * x);
            sums.sure = open(near, filled, a, row);
            if !tense {
                sums.layer = beneath(near, a, row, inwards, filled.spacing);
            }
            beyond(&mut moments, sums.open, missing, sums.layer);
        }
        sums.inverse = filled.inverse(moments, within(fill, TRUST));
        sums.slope = multiplied(sums.inverse, change);
        sums.divergence = (0..3).map(|i| sums.slope[i][i]).sum();
        sums
    }
}

/// Mean depth \[m\] of the neighbours beneath a particle of the surface.
fn beneath(near: &Near, a: usize, row: Row<'_>, inwards: [f64; 3], d: f64) -> f64 {
    let size = squared(inwards).sqrt();
    if size <= 0.0 {
        return d;
    }
    let (mut sum, mut weight) = (0.0, 0.0);
    for (b, slope) in row.slopes() {
        let depth = dot(minus(near.position[b], near.position[a]), inwards) / (size * d);
        let part = -slope * within(depth, BENEATH);
        sum += part * depth;
        weight += part;
    }
    let [least, most] = THICK;
    if weight > 0.0 {
        d * (sum / weight).clamp(least, most)
    } else {
        d
    }
}

/// Adds the moments of what is missing: all of it `d` away, along `open` as far as that tells, evenly around
/// for the rest.
fn beyond(moments: &mut [f64; 6], open: [f64; 3], missing: f64, d: f64) {
    let size = squared(open).sqrt();
    let across = if size > 0.0 { d / size } else { 0.0 };
    let around = ((missing * d - size) * d).max(0.0) / 3.0;
    let [x, y, z] = open;
    let added = [x * x, y * y, z * z, x * y, x * z, y * z];
    for (i, (moment, added)) in moments.iter_mut().zip(added).enumerate() {
        *moment += across * added + if i < 3 { around } else { 0.0 };
    }
}
