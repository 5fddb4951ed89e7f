//! Laplacians whose weights of other points are not negative.
//!
//! Least squares gives, of all weights that obey the moment conditions, those of least norm
//! sum_j W_j^2 / w_j. Some of another point's may be negative; a matrix of such rows is no M-matrix,
//! and its solutions may overshoot. With W_j >= 0 for all points but the own one, the weights of
//! least norm are the solution of a quadratic program. It is solved by `clarabel`, and then made
//! exact: points whose weight is zero are left out, and least squares over the others gives the
//! same weights to rounding.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, ZeroConeT,
};

use crate::basis::Basis;
use crate::fit::Fit;
use crate::moments::Coefficients;

/// A weight below this part of the own one counts as zero.
const ZERO: f64 = 1e-12;
/// Weights of the program below this part of the greatest are tried as zero.
const ACTIVE: [f64; 3] = [1e-6, 1e-4, 1e-8];
/// Condition number of the fit over the remaining points at most.
const GOOD: f64 = 1e8;

/// Replaces the weights of the functional `row` (`e` over the monomials) in `fit`, if some weight of
/// a point other than `own` is negative; tells whether that could be done. The fit has no condition but that on the own
/// value, which any weights of nonnegative others that are exact for constants obey.
pub(crate) fn improve<const D: usize>(
    fit: &mut Fit<D>,
    basis: &Basis<D>,
    e: &Coefficients,
    row: usize,
    own: usize,
) -> Option<bool> {
    let points = fit.points.len();
    let count = fit.shares.len() * points / fit.weights.len();
    let shares = row * count..(row + 1) * count;
    let mut plain = fit.weights[row * points..(row + 1) * points].to_vec();
    // What the own point has from the condition that the fit passes through its value.
    plain[own] += fit.shares[shares.clone()].iter().sum::<f64>();
    if nonnegative(&plain, own) {
        return None;
    }
    let Some(program) = program(fit, basis, e, own) else {
        return Some(false);
    };
    let (kept, whole) = (fit.weights.clone(), fit.shares.clone());
    let (condition, way) = (fit.condition, fit.way);
    let found = exact(fit, basis, e, &program, own);
    let weights = std::mem::replace(&mut fit.weights, kept);
    fit.shares = whole;
    (fit.condition, fit.way) = (condition, way);
    if found {
        fit.weights[row * points..(row + 1) * points].copy_from_slice(&weights);
        fit.shares[shares].fill(0.0);
    }
    Some(found)
}

fn nonnegative(weights: &[f64], own: usize) -> bool {
    let least = -ZERO * weights[own].abs();
    weights
        .iter()
        .enumerate()
        .all(|(j, w)| j == own || *w >= least)
}

/// Solves the program for z_j = W_j / sqrt(w_j); none where it has no solution.
fn program<const D: usize>(
    fit: &Fit<D>,
    basis: &Basis<D>,
    e: &Coefficients,
    own: usize,
) -> Option<Vec<f64>> {
    let (points, many) = (fit.points.len(), basis.len());
    let scale = fit.scale();
    // Rows: moment conditions, then -z_j <= 0 for all but the own point.
    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    let mut bound = many;
    for j in 0..points {
        let (s, weight) = fit.points.point(j);
        for (k, factor) in scale.iter().enumerate().take(many) {
            rows.push(k);
            values.push(weight.sqrt() * factor * basis.derivative(k, &[], s));
        }
        if j != own {
            rows.push(bound);
            values.push(-1.0);
            bound += 1;
        }
        starts.push(rows.len());
    }
    let size = (0..many).fold(0.0_f64, |most, k| most.max((e[k] * scale[k]).abs()));
    let mut right = vec![0.0; bound];
    for k in 0..many {
        right[k] = e[k] * scale[k] / size;
    }
    let conditions = CscMatrix::new(bound, points, starts, rows, values);
    nearest(&conditions, &right, points, many)
}

/// The shortest vector of `points` entries with `conditions` of which the first `many` are met
/// exactly and the rest as upper bounds. Of no number of dimensions, so that it is compiled here.
fn nearest(
    conditions: &CscMatrix<f64>,
    right: &[f64],
    points: usize,
    many: usize,
) -> Option<Vec<f64>> {
    let settings = DefaultSettings {
        verbose: false,
        max_threads: 1,
        ..DefaultSettings::default()
    };
    let mut solver = DefaultSolver::new(
        &CscMatrix::identity(points),
        &vec![0.0; points],
        conditions,
        right,
        &[ZeroConeT(many), NonnegativeConeT(points - 1)],
        settings,
    )
    .ok()?;
    solver.solve();
    let solved = matches!(
        solver.solution.status,
        SolverStatus::Solved | SolverStatus::AlmostSolved
    );
    solved.then(|| solver.solution.x.clone())
}

/// Least squares over the points that the program keeps; the weights stand in `fit` where they are
/// nonnegative.
fn exact<const D: usize>(
    fit: &mut Fit<D>,
    basis: &Basis<D>,
    e: &Coefficients,
    program: &[f64],
    own: usize,
) -> bool {
    let most = program
        .iter()
        .enumerate()
        .filter(|(j, _)| *j != own)
        .fold(0.0_f64, |most, (_, z)| most.max(*z));
    let whole = fit.points.clone();
    for least in ACTIVE {
        fit.points.clone_from(&whole);
        for (j, z) in program.iter().enumerate() {
            if j != own && *z < least * most {
                fit.points.drop_point(j);
            }
        }
        fit.assemble(basis, &[]);
        let factored = fit.factor(basis, GOOD) || fit.factor_spectrum(basis);
        if factored && fit.solve(basis, std::slice::from_ref(e)) && nonnegative(&fit.weights, own) {
            return true;
        }
    }
    false
}
