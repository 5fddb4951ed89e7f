//! The net of springs that weights are, and the matrix of a Newton step for its multipliers.

use krylov::{Inverse, Operator, Pattern};
use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;

use super::basis::{slopes, values};
use super::kernel::rows;
use crate::cloud::Cloud;
use shapes::frame::{Frame, Vector, cross, difference};

/// Weight of the square of a multiplier of a quadratic function, in the part that the point's own links have.
const SOFT: f64 = 0.12;
/// Points that one task gathers.
const POINTS: usize = 256;

/// Links and surface of a cloud in the unit of its spacing, with `K` functions of `D` coordinates to be exact for.
pub(super) struct Net<'a, const D: usize, const K: usize> {
    position: &'a [Vector],
    pattern: &'a Pattern,
    inverse_unit: f64,
    /// What the patches contribute to the balance, point after point.
    surface: Vec<f64>,
    /// Softness of each point in the quadratic functions.
    soft: Vec<f64>,
}

impl<'a, const D: usize, const K: usize> Net<'a, D, K> {
    /// The net of a cloud with the given links and spacing.
    pub(super) fn new(cloud: &'a Cloud, pattern: &'a Pattern, unit: f64) -> Self {
        let mut surface = vec![0.0; K * cloud.position.len()];
        let scale = unit.powi(1 - D as i32);
        for patch in &cloud.patches {
            let point = patch.point as usize;
            let away = difference(patch.place, cloud.position[point]).map(|d| d / unit);
            let own = slopes::<D, K>(patch.normal.map(|n| scale * patch.area * n), away);
            for (sum, slope) in surface[point * K..][..K].iter_mut().zip(own) {
                *sum += slope;
            }
        }
        let soft = |s: &f64| SOFT * (s / unit).powi(D as i32 + 2);
        Self {
            position: &cloud.position,
            pattern,
            inverse_unit: 1.0 / unit,
            surface,
            soft: cloud.spacing.iter().map(soft).collect(),
        }
    }

    /// Number of multipliers.
    pub(super) fn len(&self) -> usize {
        self.surface.len()
    }

    /// Where a point is \[m\].
    pub(super) fn place(&self, i: usize) -> Vector {
        self.position[i]
    }

    /// Shifts and turns of the whole body as multipliers of the coordinates, orthonormal: they change no weight.
    pub(super) fn motions(&self) -> Vec<Vec<f64>> {
        let axes = if D == 2 { 2..3 } else { 0..3 };
        let shifts = (0..D).map(|k| self.motion(|_| Frame::SCENE.axes[k]));
        let turns = axes.map(|k| self.motion(move |x| cross(Frame::SCENE.axes[k], x)));
        let mut found: Vec<Vec<f64>> = Vec::new();
        for mut motion in shifts.chain(turns) {
            // Twice, for rounding.
            for other in found.iter().chain(&found) {
                let part: f64 = motion.iter().zip(other).map(|(a, b)| a * b).sum();
                motion
                    .iter_mut()
                    .zip(other)
                    .for_each(|(a, b)| *a -= part * b);
            }
            let square: f64 = motion.iter().map(|a| a * a).sum();
            if square > 0.0 {
                motion.iter_mut().for_each(|a| *a /= square.sqrt());
                found.push(motion);
            }
        }
        found
    }

    fn motion(&self, of: impl Fn(Vector) -> Vector) -> Vec<f64> {
        let each = self.position.iter();
        each.flat_map(|x| of(*x).into_iter().take(D)).collect()
    }

    /// Values of the functions at the displacement from i to j.
    #[inline]
    fn values(&self, i: usize, j: usize) -> [f64; K] {
        let d = difference(self.position[j], self.position[i]);
        values::<D, K>(d.map(|d| d * self.inverse_unit))
    }

    /// The links of point `i`: their other ends and what `weight` gives them.
    #[inline]
    fn links<'w>(&'w self, i: usize, weight: &'w [f64]) -> impl Iterator<Item = (usize, f64)> + 'w {
        let row = self.pattern.row(i);
        let ends = self.pattern.columns()[row.clone()].iter();
        ends.zip(&weight[row]).map(|(j, a)| (*j as usize, *a))
    }

    /// The exponent of the link from i to j, at whose displacement the functions have the values `s`.
    #[inline]
    fn exponent(own: &[f64; K], other: &[f64; K], s: &[f64; K]) -> f64 {
        let mut sum = 0.0;
        for k in 0..D {
            sum += (own[k] - other[k]) * s[k];
        }
        for k in D..K {
            sum += (own[k] + other[k]) * s[k];
        }
        sum
    }

    /// Each function's balance at every point, with the softness of the multipliers (none: an empty slice).
    pub(super) fn imbalance(&self, weight: &[f64], multipliers: &[f64]) -> Vec<f64> {
        let mut out = self.surface.clone();
        let gather = |(i, out): (usize, &mut [f64])| {
            for (j, a) in self.links(i, weight) {
                for (out, s) in out.iter_mut().zip(self.values(i, j)) {
                    *out += a * s;
                }
            }
            if !multipliers.is_empty() {
                for k in D..K {
                    out[k] += self.soft[i] * multipliers[i * K + k];
                }
            }
        };
        out.par_chunks_mut(K)
            .enumerate()
            .with_min_len(POINTS)
            .for_each(gather);
        out
    }

    /// The greatest exponent that multipliers make.
    pub(super) fn greatest_exponent(&self, multipliers: &[f64]) -> f64 {
        let (each, _) = multipliers.as_chunks::<K>();
        (0..each.len())
            .into_par_iter()
            .with_min_len(POINTS)
            .map(|i| {
                let exponents = self.pattern.row(i).map(|k| {
                    let j = self.pattern.columns()[k] as usize;
                    Self::exponent(&each[i], &each[j], &self.values(i, j)).abs()
                });
                exponents.fold(0.0_f64, f64::max)
            })
            .reduce(|| 0.0, f64::max)
    }

    /// Trial weights times the exponentials of the multipliers.
    pub(super) fn weigh(&self, trial: &[f64], multipliers: &[f64], weight: &mut [f64]) {
        let (each, _) = multipliers.as_chunks::<K>();
        weight.copy_from_slice(trial);
        rows(self.pattern, weight, |i, columns, row| {
            for (a, j) in row.iter_mut().zip(columns) {
                let j = *j as usize;
                *a *= Self::exponent(&each[i], &each[j], &self.values(i, j)).exp();
            }
        });
    }
}

/// The matrix of a Newton step: `sum_j a_ij s_ij (s_ij . (l_i - l_j), ...)`.
pub(super) struct Springs<'a, const D: usize, const K: usize> {
    /// The net.
    pub(super) net: &'a Net<'a, D, K>,
    /// Stiffness of its springs.
    pub(super) weight: &'a [f64],
}

impl<const D: usize, const K: usize> Operator<f64> for Springs<'_, D, K> {
    fn len(&self) -> usize {
        self.net.len()
    }

    fn apply(&self, x: &[[f64; 1]], out: &mut [[f64; 1]]) {
        let net = self.net;
        let (each, _) = x.as_flattened().as_chunks::<K>();
        let (out, _) = out.as_flattened_mut().as_chunks_mut::<K>();
        out.par_iter_mut()
            .enumerate()
            .with_min_len(POINTS)
            .for_each(|(i, out)| {
                let own = &each[i];
                let mut sum = [0.0; K];
                for (j, a) in net.links(i, self.weight) {
                    let s = net.values(i, j);
                    let pull = a * Net::<D, K>::exponent(own, &each[j], &s);
                    for m in 0..K {
                        sum[m] += pull * s[m];
                    }
                }
                for m in D..K {
                    sum[m] += net.soft[i] * own[m];
                }
                *out = sum;
            });
    }
}

/// Inverse of the part of the matrix that couples a point with itself.
pub(super) struct Blocks<const K: usize> {
    inverse: Vec<SMatrix<f64, K, K>>,
}

impl<const K: usize> Blocks<K> {
    /// Of a Newton step.
    pub(super) fn new<const D: usize>(springs: &Springs<'_, D, K>) -> Self {
        let net = springs.net;
        let inverse = (0..net.position.len())
            .into_par_iter()
            .with_min_len(POINTS)
            .map(|i| {
                let mut block = SMatrix::<f64, K, K>::zeros();
                let mut trace = 0.0;
                for (j, a) in net.links(i, springs.weight) {
                    let s = SVector::from(net.values(i, j));
                    block += a * s * s.transpose();
                    trace += a * s.norm_squared();
                }
                for m in 0..K {
                    // A point whose links lie in one plane has no stiffness across it.
                    block[(m, m)] += 1e-9 * trace + if m < D { 0.0 } else { net.soft[i] };
                }
                block
                    .cholesky()
                    .map_or_else(SMatrix::identity, |c| c.inverse())
            })
            .collect();
        Self { inverse }
    }
}

impl<const K: usize> Inverse<f64> for Blocks<K> {
    fn invert(&mut self, rhs: &[[f64; 1]], out: &mut [[f64; 1]]) {
        let (rhs, _) = rhs.as_flattened().as_chunks::<K>();
        let (out, _) = out.as_flattened_mut().as_chunks_mut::<K>();
        out.par_iter_mut()
            .zip(rhs)
            .zip(&self.inverse)
            .with_min_len(POINTS)
            .for_each(|((out, rhs), block)| {
                let product = block * SVector::from(*rhs);
                out.copy_from_slice(product.as_slice());
            });
    }
}
