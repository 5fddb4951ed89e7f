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
//! it has a solution when the forces of the surface balance, which the areas of the patches are made for. (2) need not have one; it
//! is met in the sense of least squares, with some softness, before (1) is met to rounding.
//!
//! The trace of the second moment gives the volume that a point stands for,
//!
//! ```text
//! D V_i = 1/2 sum_j a_ij |x_j - x_i|^2 + sum_e A_e n_e . (x_e - x_i)             (4)
//! ```
//!
//! whose sum is the volume of the body by Gauss' theorem.

use std::sync::Arc;

use krylov::{Pattern, Rule, Scratch, conjugate_gradient};
use rayon::prelude::*;

use super::net::{Blocks, Net, Springs};
use super::{Links, OperatorError};
use crate::cloud::Cloud;
use shapes::frame::{difference, dot};

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
/// Newton steps for the second moments, and products in each.
const MOMENT_STEPS: (usize, usize) = (6, 61);
/// Products within a Newton step.
const PRODUCTS: usize = 1001;
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
    mut weight: Vec<f64>,
) -> Result<Links, OperatorError> {
    let unit = cloud.spacing.iter().sum::<f64>() / cloud.spacing.len() as f64;
    // In units of the spacing weights are numbers about one.
    let scale = unit.powi(2 - cloud.dimensions as i32);
    weight.iter_mut().for_each(|a| *a *= scale);
    let done = match cloud.dimensions {
        2 => found::<2, 4>(cloud, &pattern, unit, &mut weight)?,
        _ => found::<3, 8>(cloud, &pattern, unit, &mut weight)?,
    };
    weight.iter_mut().for_each(|a| *a /= scale);
    let volume = volumes(cloud, &pattern, &weight);
    Ok(Links {
        pattern,
        weight,
        volume,
        balance: Some(done),
    })
}

/// Meets (2) as far as it can be met, then (1).
fn found<const D: usize, const K: usize>(
    cloud: &Cloud,
    pattern: &Pattern,
    unit: f64,
    weight: &mut [f64],
) -> Result<Balance, OperatorError> {
    let far = cloud
        .position
        .iter()
        .flatten()
        .fold(0.0_f64, |m, x| m.max(x.abs()));
    let exact = EXACT.max(ROUNDING * f64::EPSILON * far / unit);
    let mut done = Balance::default();
    let linear = Net::<D, D>::new(cloud, pattern, unit);
    if greatest(&linear.imbalance(weight, &[])) > exact {
        relax(&Net::<D, K>::new(cloud, pattern, unit), weight, &mut done);
    }
    solve(&linear, weight, exact, &mut done)?;
    Ok(done)
}

/// Brings the second moments near (2).
fn relax<const D: usize, const K: usize>(
    net: &Net<'_, D, K>,
    weight: &mut [f64],
    done: &mut Balance,
) {
    let trial = weight.to_vec();
    let mut multipliers = vec![0.0; net.len()];
    let rule = Rule::to(1e-2, MOMENT_STEPS.1);
    let mut work = Scratch::default();
    for _ in 0..MOMENT_STEPS.0 {
        let imbalance = net.imbalance(weight, &multipliers);
        if greatest(&imbalance) < MOMENTS {
            break;
        }
        done.iterations += step(net, weight, &imbalance, &mut multipliers, rule, &mut work);
        done.steps += 1;
        net.weigh(&trial, &multipliers, weight);
    }
    done.quadratic = greatest(&net.imbalance(weight, &[]));
}

/// Meets (1) to rounding.
fn solve<const D: usize>(
    net: &Net<'_, D, D>,
    weight: &mut [f64],
    exact: f64,
    done: &mut Balance,
) -> Result<(), OperatorError> {
    let trial = weight.to_vec();
    let mut multipliers = vec![0.0; net.len()];
    let mut work = Scratch::default();
    let needed = NEEDED.max(exact);
    let motions = net.motions();
    let mut best = (f64::INFINITY, Vec::new());
    for _ in 0..STEPS {
        let mut imbalance = net.imbalance(weight, &[]);
        let residual = greatest(&imbalance);
        if residual < best.0 {
            best = (residual, multipliers.clone());
        } else if best.0 < needed {
            break;
        }
        if residual < exact {
            break;
        }
        // The matrix is singular for motions of the whole body: what rounding has left of them is taken out.
        for motion in &motions {
            let part = product(motion, &imbalance);
            for (sum, m) in imbalance.iter_mut().zip(motion) {
                *sum -= part * m;
            }
        }
        // Newton's method squares the residual: to ask for more is in vain.
        let reduction = residual.clamp(1e-4, 1e-2).max(0.1 * exact / residual);
        let rule = Rule::to(reduction, PRODUCTS);
        done.iterations += step(net, weight, &imbalance, &mut multipliers, rule, &mut work);
        done.steps += 1;
        net.weigh(&trial, &multipliers, weight);
    }
    net.weigh(&trial, &best.1, weight);
    done.linear = best.0;
    if best.0 < needed {
        return Ok(());
    }
    let imbalance = net.imbalance(weight, &[]);
    let worst = (0..imbalance.len()).fold(0, |m, k| {
        if imbalance[k].abs() > imbalance[m].abs() {
            k
        } else {
            m
        }
    });
    Err(OperatorError::Unbalanced {
        place: net.place(worst / D),
        residual: best.0,
    })
}

/// One Newton step of the multipliers; gives the iterations of the linear solver.
fn step<const D: usize, const K: usize>(
    net: &Net<'_, D, K>,
    weight: &[f64],
    imbalance: &[f64],
    multipliers: &mut [f64],
    rule: Rule,
    work: &mut Scratch<f64>,
) -> usize {
    let springs = Springs { net, weight };
    let right: Vec<f64> = imbalance.iter().map(|g| -g).collect();
    let mut change = vec![0.0; right.len()];
    let mut blocks = Blocks::new(&springs);
    let solved = conjugate_gradient(&springs, &right, &mut change, &mut blocks, rule, work);
    let length = (LARGEST / net.greatest_exponent(&change)).min(1.0);
    for (multiplier, change) in multipliers.iter_mut().zip(&change) {
        *multiplier += length * change;
    }
    solved.sound().map_or(0, |solved| solved.steps)
}

/// The volumes (4).
fn volumes(cloud: &Cloud, pattern: &Pattern, weight: &[f64]) -> Vec<f64> {
    let each = 1.0 / cloud.dimensions as f64;
    let x = &cloud.position;
    let mut volume: Vec<f64> = (0..x.len())
        .into_par_iter()
        .with_min_len(256)
        .map(|i| {
            let square = |k: usize| {
                let d = difference(x[pattern.columns()[k] as usize], x[i]);
                weight[k] * dot(d, d)
            };
            0.5 * each * pattern.row(i).map(square).sum::<f64>()
        })
        .collect();
    for patch in &cloud.patches {
        volume[patch.point as usize] += each * patch.area * cloud.depth(patch);
    }
    volume
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn greatest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}
