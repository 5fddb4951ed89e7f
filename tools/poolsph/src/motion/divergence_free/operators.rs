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
//! mirrored there: its pressure is 2 p_s - p_a, and it adds to the moments of the gradient, so that grad p is exact for a
//! plane of the lattice. A layer is as thick as the neighbours beneath lie deep: where the surface bends it stretches, and
//! the surface with it.
//!
//! div u at the surface has two forms. Over deep liquid B is that of the present neighbours alone, exact for linear u: waves
//! have the exact speed but for the second order, and neither grow nor fall. In films, beside solids, and where tension
//! acts B has the moments of what is missing as well, as if it moved with the particle: by the first form thin films gain
//! energy as they spread, and burst. (By the second form alone waves of 20 spacings gained 5 % of energy in a period.)
//! Where tension acts a layer is one spacing thick, and m that of the lattice. Where particles lie scattered B means little,
//! and the lattice's stands for it.

use kernels::moments::{Moments, beyond, inverse, within};
use shapes::frame::{along, difference, dot, squared};

use super::filled::Filled;
use super::openness::{lack, open};
use crate::near::{Near, Row};

/// Lack of weight, in parts of the lattice's, from which on a particle lies at the surface, and at which it does so wholly.
/// A particle of a plane surface lacks a third.
const LACKS: [f64; 2] = [0.10, 0.20];
/// Part of the lattice's weight up to which B is the lattice's, and from which on it is the row's own.
const TRUST: [f64; 2] = [0.45, 0.60];
/// Part of the layer beneath that is inside, from which on the divergence begins to be, and is wholly, that of the present neighbours.
const DEEP: [f64; 2] = [0.7, 1.0];
/// Lack of neighbours, in parts of the lattice's, up to which a particle is inside, and from which on it is not.
const INSIDE: [f64; 2] = [0.08, 0.16];
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
    /// B of the gradient of p, what is missing included: xx, yy, zz, xy, xz, yz \[m3\].
    pub(super) inverse: Moments,
    /// B of the present neighbours alone \[m3\].
    pub(super) present: Moments,
    /// B of div u \[m3\].
    shared: Moments,
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

    /// |grad u| \[1/s\].
    pub(super) fn steep(&self) -> f64 {
        self.slope.map(squared).iter().sum::<f64>().sqrt()
    }
}

/// B M for a symmetric B.
#[inline(always)]
fn multiplied([a, b, c, d, e, f]: Moments, [x, y, z]: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let row = |p: f64, q: f64, r: f64| std::array::from_fn(|i| p * x[i] + q * y[i] + r * z[i]);
    [row(a, d, e), row(d, b, f), row(e, f, c)]
}

impl Sums {
    /// What the places around particle `a` tell.
    #[inline(always)]
    pub(super) fn of(near: &Near, a: usize, row: Row<'_>, filled: Filled) -> Self {
        let (mut all, mut liquid, mut moments) = (0.0, 0.0, [0.0; 6]);
        for (b, slope) in row.slopes() {
            let x = difference(near.position[a], near.position[b]);
            all -= slope;
            if near.role[b].flows() {
                liquid -= slope;
            }
            let [p, q, r] = x.map(|x| slope * x);
            let squares = [p * x[0], q * x[1], r * x[2], p * x[1], p * x[2], q * x[2]];
            moments = std::array::from_fn(|i| moments[i] - squares[i]);
        }
        let (fill, tense) = (all / filled.weight, !near.tension.is_empty());
        let part = within(1.0 - fill, LACKS);
        let missing = part * (filled.weight - all).max(0.0);
        let present = inverse(moments, filled.moment, within(fill, TRUST));
        let mut sums = Self {
            liquid,
            missing,
            divergence: 0.0,
            slope: [[0.0; 3]; 3],
            layer: filled.spacing,
            inverse: present,
            present,
            shared: present,
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
            let mut deep = 0.0;
            if !tense {
                let floor = beneath(near, a, row, inwards, filled);
                sums.layer = floor.depth;
                deep = within(floor.deep, DEEP);
            }
            beyond::<3>(&mut moments, sums.open, missing, sums.layer);
            sums.inverse = inverse(moments, filled.moment, within(fill, TRUST));
            sums.shared =
                std::array::from_fn(|i| deep * present[i] + (1.0 - deep) * sums.inverse[i]);
        }
        sums
    }

    /// Adds what the velocities `u` tell.
    #[inline(always)]
    pub(super) fn flow(&mut self, near: &Near, u: &[[f64; 3]], a: usize, row: Row<'_>) {
        let mut change = [[0.0; 3]; 3];
        for (b, slope) in row.slopes() {
            let x = difference(near.position[a], near.position[b]);
            let step = if near.role[b].flows() {
                difference(u[b], u[a])
            } else {
                u[a].map(|u| -2.0 * u)
            };
            let [p, q, r] = x.map(|x| slope * x);
            change[0] = along(change[0], p, step);
            change[1] = along(change[1], q, step);
            change[2] = along(change[2], r, step);
        }
        self.slope = multiplied(self.shared, change);
        self.divergence = (0..3).map(|i| self.slope[i][i]).sum();
    }
}

/// The layer beneath a particle of the surface.
struct Beneath {
    /// Its mean depth \[m\].
    depth: f64,
    /// The part of it that lies inside the liquid, away from any other surface and from solids.
    deep: f64,
}

/// The neighbours beneath a particle of the surface.
fn beneath(near: &Near, a: usize, row: Row<'_>, inwards: [f64; 3], filled: Filled) -> Beneath {
    let d = filled.spacing;
    let (size, mut found) = (
        squared(inwards).sqrt(),
        Beneath {
            depth: d,
            deep: 0.0,
        },
    );
    if size <= 0.0 {
        return found;
    }
    let (mut sum, mut inside, mut weight) = (0.0, 0.0, 0.0);
    for (b, slope) in row.slopes() {
        let depth = dot(difference(near.position[b], near.position[a]), inwards) / (size * d);
        let part = -slope * within(depth, BENEATH);
        sum += part * depth;
        weight += part;
        if part > 0.0 && near.role[b].flows() {
            let lack = lack(near, filled, near.images().original(b));
            inside += part * (1.0 - within(lack, INSIDE));
        }
    }
    let [least, most] = THICK;
    if weight > 0.0 {
        found.depth = d * (sum / weight).clamp(least, most);
        found.deep = inside / weight;
    }
    found
}
