//! Divergence and moments of a row of neighbours.
//!
//! With the weights w = -(dW/dr)/r of the pairs, s = -w, and B the inverse of the sum of w x x,
//!
//! ```text
//! grad p = B sum_b s x_ab (p_b - p_a)        div u = B : sum_b s x_ab (u_b - u_a)        (Bonet and Lok 1999)
//! lap p = 2/m sum_b w (p_b - p_a)            m = sum of w x^2 over the lattice            (Brookshaw 1985)
//! ```
//!
//! Solid neighbours have the velocity -u_a: the face between both rests.
//!
//! A particle lies at the surface where it lacks a part of the weights that the lattice has. What it lacks stands one
//! spacing away across the surface, and adds to the moments: for a plane of the lattice these are then exact. Where
//! particles lie scattered B means little, and the lattice's stands for it.

use kernels::CubicSpline;

use crate::near::{Near, Row};
use crate::state::Metal;
use crate::vector::{minus, plus, squared};

/// Lack of weight, in parts of the lattice's, from which on a particle lies at the surface, and at which it does so
/// wholly. A particle of a plane surface lacks a third.
const LACKS: [f64; 2] = [0.10, 0.20];
/// Part of the lattice's weight up to which B is the lattice's, and from which on it is the row's own.
const TRUST: [f64; 2] = [0.45, 0.60];

/// Sums over the filled lattice.
#[derive(Debug, Clone, Copy)]
pub(super) struct Filled {
    /// Of W, the own one included \[1/m3\].
    pub(super) number: f64,
    /// Of w \[1/m5\].
    pub(super) weight: f64,
    /// Of w x^2 along one axis \[1/m3\].
    pub(super) moment: f64,
    /// d \[m\].
    pub(super) spacing: f64,
}

impl Filled {
    /// The lattice of `metal`.
    pub(super) fn of(metal: Metal) -> Self {
        let kernel = CubicSpline::<3>::new(metal.smoothing_length);
        let d = metal.spacing;
        let reach = (kernel.support() / d).ceil() as i32;
        let mut filled = Self {
            number: kernel.value(0.0),
            weight: 0.0,
            moment: 0.0,
            spacing: d,
        };
        let axis = || -reach..=reach;
        let points = axis().flat_map(|i| axis().flat_map(move |j| axis().map(move |k| (i, j, k))));
        for (i, j, k) in points.filter(|point| *point != (0, 0, 0)) {
            let r = d * f64::from(i * i + j * j + k * k).sqrt();
            filled.number += kernel.value(r);
            filled.weight -= kernel.slope(r);
            filled.moment -= kernel.slope(r) * (d * f64::from(i)).powi(2);
        }
        filled
    }
}

/// What the operators need of a row.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    /// Sum of w over the liquid neighbours \[1/m5\].
    pub(super) liquid: f64,
    /// Weight that the surface lacks \[1/m5\].
    pub(super) missing: f64,
    /// Sum of s x at the surface, zero in the inside \[1/m4\].
    pub(super) open: [f64; 3],
    /// B: xx, yy, zz, xy, xz, yz \[m3\].
    pub(super) inverse: [f64; 6],
    /// div u \[1/s\].
    pub(super) divergence: f64,
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

/// Inverse of a symmetric matrix.
fn inverse([a, b, c, d, e, f]: [f64; 6]) -> [f64; 6] {
    let minors = [
        b * c - f * f,
        a * c - e * e,
        a * b - d * d,
        e * f - d * c,
        d * f - e * b,
        d * e - a * f,
    ];
    let determinant = a * minors[0] + d * minors[3] + e * minors[4];
    minors.map(|x| x / determinant)
}

/// How far `x` is on its way through a range, 0 to 1.
fn within(x: f64, [from, to]: [f64; 2]) -> f64 {
    ((x - from) / (to - from)).clamp(0.0, 1.0)
}

impl Sums {
    /// Those of particle `a` with the velocities `u`.
    #[inline(always)]
    pub(super) fn of(
        near: &Near,
        u: &[[f64; 3]],
        (a, row): (usize, Row<'_>),
        filled: Filled,
    ) -> Self {
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
        let fill = all / filled.weight;
        let part = within(1.0 - fill, LACKS);
        let missing = part * (filled.weight - all).max(0.0);
        let mut open = [0.0; 3];
        if missing > 0.0 {
            open = near.gradient[a].map(|x| part * x);
            beyond(&mut moments, open, missing, filled.spacing);
        }
        let own = within(fill, TRUST);
        for (i, moment) in moments.iter_mut().enumerate() {
            let lattice = if i < 3 { filled.moment } else { 0.0 };
            *moment = own * *moment + (1.0 - own) * lattice;
        }
        let b = inverse(moments);
        let [x, y, z] = change;
        let divergence = times(b, [x[0], y[0], z[0]])[0]
            + times(b, [x[1], y[1], z[1]])[1]
            + times(b, [x[2], y[2], z[2]])[2];
        Self {
            liquid,
            missing,
            open,
            inverse: b,
            divergence,
        }
    }
}

/// Adds the moments of what is missing: all of it one spacing `d` away, along `open` as far as that tells, evenly around
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
