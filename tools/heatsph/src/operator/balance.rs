//! Balanced weights: conservative, positive and exact for linear fields on any cloud.
//!
//! For a linear field to be exact, the weights of every point i must satisfy
//!
//! ```text
//! sum_j a_ij (x_j - x_i) + sum_e A_e n_e = 0                                     (1)
//! ```
//!
//! with its patches e of surface, and for a quadratic field without Laplacian, `q(x) = (x - x_i) M (x - x_i)`,
//!
//! ```text
//! sum_j a_ij q(x_j) + sum_e A_e n_e . grad q(x_e) = 0                            (2)
//! ```
//!
//! A renormalised gradient meets (1) row by row and loses the symmetry `a_ij = a_ji`, and with it the heat.
//! Here all rows are met at once: of all symmetric positive weights that satisfy (1), the ones nearest to the
//! kernel's in the sense of relative entropy, `sum a ln(a / a0) - a`, are
//!
//! ```text
//! a_ij = a0_ij exp( (l_i - l_j) . (x_j - x_i) + (x_j - x_i) (M_i + M_j) (x_j - x_i) )     (3)
//! ```
//!
//! The multipliers `l` and `M` of (1) and (2) minimise a smooth convex function, so that Newton's method finds
//! them; its matrix is that of a net of springs. (1) is a truss in equilibrium under the pressure of its surface:
//! it has a solution when the forces of the surface balance, which [`close`] sees to. (2) need not have one; it
//! is met in the sense of least squares, with the softness [`SOFT`], before (1) is met to rounding.
//!
//! The trace of the second moment gives the volume that a point stands for,
//!
//! ```text
//! D V_i = 1/2 sum_j a_ij |x_j - x_i|^2 + sum_e A_e n_e . (x_e - x_i)             (4)
//! ```
//!
//! whose sum is the volume of the body by Gauss' theorem.

use std::sync::Arc;

use krylov::{Krylov, Linear, Pattern, Precondition, Workspace, conjugate_gradient};
use nalgebra::{DMatrix, DVector, SMatrix, SVector};
use rayon::prelude::*;

use super::basis::{Basis, MOST};
use super::{Links, OperatorError};
use crate::body::frame::{Vector, along, cross, difference, dot};
use crate::cloud::Cloud;

/// Weight of the square of a multiplier of (2), in the part that the point's own links have.
const SOFT: f64 = 0.03;
/// Second moments within this part are left as they are.
const MOMENTS: f64 = 1e-3;
/// Linear fields are exact to this part, or to what the rounding of coordinates leaves.
const EXACT: f64 = 1e-13;
/// Roundings of coordinates that an imbalance may hold.
const ROUNDING: f64 = 16.0;
/// Linear fields must be exact to this part at least.
const NEEDED: f64 = 1e-11;
/// Most Newton steps.
const STEPS: usize = 30;
/// Newton steps for the second moments, and iterations in each.
const MOMENT_STEPS: (usize, usize) = (6, 60);
/// Iterations within a Newton step.
const ITERATIONS: usize = 2000;
/// A Newton step changes no weight by more than this factor's logarithm.
const LARGEST: f64 = 2.0;

/// How weights were balanced.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Balance {
    /// Newton steps.
    pub steps: usize,
    /// Iterations of the linear solver in all of them.
    pub iterations: usize,
    /// Error of linear fields, relative.
    pub linear: f64,
    /// Error of second moments, relative.
    pub quadratic: f64,
}

/// Balances trial weights.
///
/// # Errors
/// When no positive weights are exact for linear fields.
pub fn balanced(
    cloud: &Cloud,
    pattern: Arc<Pattern>,
    trial: Vec<f64>,
) -> Result<Links, OperatorError> {
    let patches = close(cloud);
    let unit = cloud.spacing.iter().sum::<f64>() / cloud.spacing.len() as f64;
    let net = |moments: bool| Net::new(cloud, &patches, &pattern, (unit, moments));
    // In units of the spacing weights are numbers about one.
    let scale = unit.powi(2 - cloud.dimensions as i32);
    let mut weight: Vec<f64> = trial.iter().map(|a| a * scale).collect();
    let mut done = Balance::default();
    let linear = net(false);
    if linear.residual(&weight, &[]) > linear.exact {
        net(true).relax(&mut weight, &mut done);
    }
    linear.solve(&mut weight, &mut done)?;
    let volume = linear.volumes(&weight, cloud, &patches);
    weight.iter_mut().for_each(|a| *a /= scale);
    Ok(Links {
        pattern,
        weight,
        volume,
        balance: Some(done),
    })
}

/// Area times normal of each patch, changed so little that their sum and their moment about any place are zero.
#[must_use]
pub fn close(cloud: &Cloud) -> Vec<Vector> {
    let mut vectors: Vec<Vector> = cloud
        .patches
        .iter()
        .map(|p| p.normal.map(|n| p.area * n))
        .collect();
    let area: f64 = cloud.patches.iter().map(|p| p.area).sum();
    let place = |p: u32| cloud.position[p as usize];
    let middle = cloud
        .patches
        .iter()
        .fold([0.0; 3], |s, p| along(s, p.area / area, place(p.point)));
    // Unknown: a shift and a turn that the area of each patch carries.
    let turns: &[usize] = if cloud.dimensions == 2 {
        &[2]
    } else {
        &[0, 1, 2]
    };
    let size = cloud.dimensions + turns.len();
    let motion = |k: usize, x: Vector| -> Vector {
        let mut unit = [0.0; 3];
        if k < cloud.dimensions {
            unit[k] = 1.0;
            unit
        } else {
            unit[turns[k - cloud.dimensions]] = 1.0;
            cross(unit, difference(x, middle))
        }
    };
    let mut matrix = DMatrix::<f64>::zeros(size, size);
    let mut right = DVector::<f64>::zeros(size);
    for (patch, vector) in cloud.patches.iter().zip(&vectors) {
        let x = place(patch.point);
        for a in 0..size {
            right[a] -= dot(motion(a, x), *vector);
            for b in 0..size {
                matrix[(a, b)] += patch.area * dot(motion(a, x), motion(b, x));
            }
        }
    }
    if let Some(factors) = matrix.cholesky() {
        let motions = factors.solve(&right);
        for (patch, vector) in cloud.patches.iter().zip(&mut vectors) {
            for k in 0..size {
                let move_k = motion(k, place(patch.point));
                *vector = along(*vector, patch.area * motions[k], move_k);
            }
        }
    }
    vectors
}

/// The net of springs that the weights are.
struct Net<'a> {
    position: &'a [Vector],
    pattern: &'a Pattern,
    basis: Basis,
    inverse_unit: f64,
    /// What the patches contribute to (1) and (2), point after point.
    surface: Vec<f64>,
    /// Softness of each point in (2).
    soft: Vec<f64>,
    /// Imbalance that cannot be told from none.
    exact: f64,
}

impl<'a> Net<'a> {
    fn new(
        cloud: &'a Cloud,
        patches: &[Vector],
        pattern: &'a Pattern,
        (unit, moments): (f64, bool),
    ) -> Self {
        let basis = Basis {
            dimensions: cloud.dimensions,
            moments,
        };
        let size = basis.size();
        let mut surface = vec![0.0; size * cloud.position.len()];
        let scale = unit.powi(1 - cloud.dimensions as i32);
        for (patch, vector) in cloud.patches.iter().zip(patches) {
            let point = patch.point as usize;
            let away = difference(patch.place, cloud.position[point]).map(|d| d / unit);
            let slopes = basis.slopes(vector.map(|v| scale * v), away);
            for (sum, slope) in surface[point * size..][..size].iter_mut().zip(slopes) {
                *sum += slope;
            }
        }
        let far = cloud
            .position
            .iter()
            .flatten()
            .fold(0.0_f64, |m, x| m.max(x.abs()));
        let soft = if moments {
            let power = cloud.dimensions as i32 + 2;
            cloud
                .spacing
                .iter()
                .map(|s| SOFT * 4.0 * (s / unit).powi(power))
                .collect()
        } else {
            Vec::new()
        };
        Self {
            position: &cloud.position,
            pattern,
            basis,
            inverse_unit: 1.0 / unit,
            surface,
            soft,
            exact: EXACT.max(ROUNDING * f64::EPSILON * far / unit),
        }
    }

    /// Displacement from i to j in the unit of the spacing.
    #[inline]
    fn displacement(&self, i: usize, j: usize) -> Vector {
        difference(self.position[j], self.position[i]).map(|d| d * self.inverse_unit)
    }

    /// The exponent of (3) on the link from i to j, the displacement's values being `s`.
    #[inline]
    fn exponent(&self, multipliers: &[f64], (i, j): (usize, usize), s: &[f64; MOST]) -> f64 {
        let (size, d) = (self.basis.size(), self.basis.dimensions);
        let (own, other) = (
            &multipliers[i * size..][..size],
            &multipliers[j * size..][..size],
        );
        let mut sum = 0.0;
        for k in 0..d {
            sum += (own[k] - other[k]) * s[k];
        }
        for k in d..size {
            sum += (own[k] + other[k]) * s[k];
        }
        sum
    }

    /// (1) and (2) at every point, with the softness of the multipliers (none: an empty slice).
    fn imbalance(&self, weight: &[f64], multipliers: &[f64]) -> Vec<f64> {
        let (size, d) = (self.basis.size(), self.basis.dimensions);
        let mut out = self.surface.clone();
        out.par_chunks_mut(size)
            .enumerate()
            .with_min_len(256)
            .for_each(|(i, out)| {
                for k in self.pattern.row(i) {
                    let j = self.pattern.columns()[k] as usize;
                    let s = self.basis.values(self.displacement(i, j));
                    for (out, s) in out.iter_mut().zip(s) {
                        *out += weight[k] * s;
                    }
                }
                if !multipliers.is_empty() {
                    for k in d..size {
                        out[k] += self.soft[i] * multipliers[i * size + k];
                    }
                }
            });
        out
    }

    /// Greatest imbalance.
    fn residual(&self, weight: &[f64], multipliers: &[f64]) -> f64 {
        greatest(&self.imbalance(weight, multipliers))
    }

    /// Brings the second moments near (2).
    fn relax(&self, weight: &mut [f64], done: &mut Balance) {
        let trial = weight.to_vec();
        let mut multipliers = vec![0.0; self.surface.len()];
        let mut work = Workspace::default();
        for _ in 0..MOMENT_STEPS.0 {
            let rule = Krylov {
                reduction: 1e-2,
                floor: 0.0,
                iterations: MOMENT_STEPS.1,
            };
            let imbalance = self.imbalance(weight, &multipliers);
            if greatest(&imbalance) < MOMENTS {
                break;
            }
            done.iterations += self.step(weight, &mut multipliers, &imbalance, (rule, &mut work));
            done.steps += 1;
            self.weigh(&trial, &multipliers, weight);
        }
        done.quadratic = self.residual(weight, &[]);
    }

    /// Meets (1) to rounding.
    fn solve(&self, weight: &mut [f64], done: &mut Balance) -> Result<(), OperatorError> {
        let trial = weight.to_vec();
        let mut multipliers = vec![0.0; self.surface.len()];
        let mut work = Workspace::default();
        let mut best = (f64::INFINITY, Vec::new());
        for _ in 0..STEPS {
            let imbalance = self.imbalance(weight, &[]);
            let residual = greatest(&imbalance);
            if residual < best.0 {
                best = (residual, multipliers.clone());
            } else if best.0 < NEEDED.max(self.exact) {
                break;
            }
            if residual < self.exact {
                break;
            }
            // Newton's method squares the residual: to ask for more is in vain, as it is beyond rounding.
            let rule = Krylov {
                reduction: residual.clamp(1e-7, 1e-2).max(0.1 * self.exact / residual),
                floor: 0.0,
                iterations: ITERATIONS,
            };
            done.iterations += self.step(weight, &mut multipliers, &imbalance, (rule, &mut work));
            done.steps += 1;
            self.weigh(&trial, &multipliers, weight);
        }
        self.weigh(&trial, &best.1, weight);
        done.linear = best.0;
        if best.0 < NEEDED.max(self.exact) {
            return Ok(());
        }
        let imbalance = self.imbalance(weight, &[]);
        let worst = (0..imbalance.len()).fold(0, |m, k| {
            if imbalance[k].abs() > imbalance[m].abs() {
                k
            } else {
                m
            }
        });
        Err(OperatorError::Unbalanced {
            place: self.position[worst / self.basis.size()],
            residual: best.0,
        })
    }

    /// One Newton step of the multipliers; gives the iterations of the linear solver.
    fn step(
        &self,
        weight: &[f64],
        multipliers: &mut [f64],
        imbalance: &[f64],
        (rule, work): (Krylov, &mut Workspace),
    ) -> usize {
        let springs = Springs { net: self, weight };
        let right: Vec<f64> = imbalance.iter().map(|g| -g).collect();
        let mut change = vec![0.0; right.len()];
        let mut blocks = Blocks::new(&springs);
        let solved = conjugate_gradient(&springs, &right, &mut change, &mut blocks, rule, work);
        let largest = (0..self.position.len())
            .into_par_iter()
            .with_min_len(256)
            .map(|i| {
                let exponents = self.pattern.row(i).map(|k| {
                    let j = self.pattern.columns()[k] as usize;
                    let s = self.basis.values(self.displacement(i, j));
                    self.exponent(&change, (i, j), &s).abs()
                });
                exponents.fold(0.0_f64, f64::max)
            })
            .reduce(|| 0.0, f64::max);
        let length = (LARGEST / largest).min(1.0);
        for (multiplier, change) in multipliers.iter_mut().zip(&change) {
            *multiplier += length * change;
        }
        solved.map_or(0, |outcome| outcome.iterations)
    }

    /// The weights (3).
    fn weigh(&self, trial: &[f64], multipliers: &[f64], weight: &mut [f64]) {
        weight.copy_from_slice(trial);
        super::kernel::rows(self.pattern, weight, |i, columns, row| {
            for (a, j) in row.iter_mut().zip(columns) {
                let j = *j as usize;
                let s = self.basis.values(self.displacement(i, j));
                *a *= self.exponent(multipliers, (i, j), &s).exp();
            }
        });
    }

    /// The volumes (4).
    fn volumes(&self, weight: &[f64], cloud: &Cloud, patches: &[Vector]) -> Vec<f64> {
        let unit = 1.0 / self.inverse_unit;
        let scale = unit.powi(cloud.dimensions as i32);
        let each = 1.0 / cloud.dimensions as f64;
        let mut volume: Vec<f64> = (0..self.position.len())
            .into_par_iter()
            .with_min_len(256)
            .map(|i| {
                let sum: f64 = self
                    .pattern
                    .row(i)
                    .map(|k| {
                        let d = self.displacement(i, self.pattern.columns()[k] as usize);
                        weight[k] * dot(d, d)
                    })
                    .sum();
                0.5 * each * scale * sum
            })
            .collect();
        for (patch, vector) in cloud.patches.iter().zip(patches) {
            let point = patch.point as usize;
            volume[point] += each * dot(*vector, difference(patch.place, cloud.position[point]));
        }
        volume
    }
}

fn greatest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}

/// The matrix of a Newton step: `sum_j a_ij s_ij (s_ij . (l_i - l_j), ...)`.
struct Springs<'a> {
    net: &'a Net<'a>,
    weight: &'a [f64],
}

impl Linear for Springs<'_> {
    fn len(&self) -> usize {
        self.net.surface.len()
    }

    fn apply(&self, x: &[f64], out: &mut [f64]) {
        let net = self.net;
        let (size, d) = (net.basis.size(), net.basis.dimensions);
        out.par_chunks_mut(size)
            .enumerate()
            .with_min_len(256)
            .for_each(|(i, out)| {
                let mut sum = [0.0; MOST];
                for k in net.pattern.row(i) {
                    let j = net.pattern.columns()[k] as usize;
                    let s = net.basis.values(net.displacement(i, j));
                    let pull = self.weight[k] * net.exponent(x, (i, j), &s);
                    for m in 0..size {
                        sum[m] += pull * s[m];
                    }
                }
                if !net.soft.is_empty() {
                    for m in d..size {
                        sum[m] += net.soft[i] * x[i * size + m];
                    }
                }
                out.copy_from_slice(&sum[..size]);
            });
    }
}

/// Inverse of the part of the matrix that couples a point with itself.
struct Blocks {
    size: usize,
    inverse: Vec<SMatrix<f64, MOST, MOST>>,
}

impl Blocks {
    fn new(springs: &Springs<'_>) -> Self {
        let net = springs.net;
        let (size, d) = (net.basis.size(), net.basis.dimensions);
        let inverse = (0..net.position.len())
            .into_par_iter()
            .with_min_len(256)
            .map(|i| {
                let mut block = SMatrix::<f64, MOST, MOST>::identity();
                block.view_mut((0, 0), (size, size)).fill(0.0);
                let mut trace = 0.0;
                for k in net.pattern.row(i) {
                    let j = net.pattern.columns()[k] as usize;
                    let s = SVector::from(net.basis.values(net.displacement(i, j)));
                    block += springs.weight[k] * s * s.transpose();
                    trace += springs.weight[k] * s.norm_squared();
                }
                for m in 0..size {
                    // A point whose links lie in one plane has no stiffness across it.
                    block[(m, m)] += 1e-9 * trace
                        + if m < d || net.soft.is_empty() {
                            0.0
                        } else {
                            net.soft[i]
                        };
                }
                block.try_inverse().unwrap_or_else(SMatrix::identity)
            })
            .collect();
        Self { size, inverse }
    }
}

impl Precondition for Blocks {
    fn precondition(&mut self, rhs: &[f64], out: &mut [f64]) {
        let size = self.size;
        out.par_chunks_mut(size)
            .zip(rhs.par_chunks(size))
            .zip(&self.inverse)
            .with_min_len(256)
            .for_each(|((out, rhs), block)| {
                for (m, out) in out.iter_mut().enumerate() {
                    *out = (0..size).map(|k| block[(m, k)] * rhs[k]).sum();
                }
            });
    }
}
