//! Sparse matrices and preconditioned Krylov solvers.
//!
//! Two families. Symmetric conduction, with positive diagonals, off-diagonals that are not positive and coefficients that
//! may jump by nine orders between neighbours:
//!
//! - [`Sparse`]: rows over a shared [`Pattern`], the diagonal apart;
//! - [`conjugate_gradient`] for symmetric, [`gmres`] for other matrices, flexible both: the preconditioner may differ from
//!   call to call; [`bicgstab`] for other matrices that a few iterations solve;
//! - [`Jacobi`] (the diagonal), [`Scaled`] (columns scaled by known factors) and [`Aggregation`] (algebraic multigrid),
//!   whose iteration count hardly knows the number of unknowns or the jumps.
//!
//! Unsymmetric rows of scattered points, real, or real with a complex diagonal, for one or three columns at once:
//!
//! - [`System`]: [`Rows`] scaled and reordered ([`Order`]), a [`Method`] chosen, multipoles as low-rank [`Pair`]s;
//! - [`bicgstab2`] (Sleijpen and Fokkema 1993), and [`minimal_residual`] where its short recurrence stagnates;
//! - [`Incomplete`] factors (ILU(0) and ILUT, in single precision), [`Multigrid`] smoothed by them, sparse [`Direct`] factors;
//! - [`Solved`] with the history of residuals, and an [`Ending`] that says why a solve stagnated or broke down.
//!
//! Fixed points of what is not linear: [`Anderson`].
//!
//! Sums run over chunks whose size depends on the length alone and whose results are added in
//! order, and smoothing runs over blocks of fixed size: results are bitwise independent of the
//! number of threads.

#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "bits are compared on purpose")
)]

mod aggregation;
mod anderson;
mod bicgstab;
mod columns;
mod conjugate;
mod direct;
mod ending;
mod factors;
mod gmres;
mod grouping;
mod incomplete;
mod jacobi;
mod lowrank;
mod minimal;
mod multigrid;
mod operator;
mod order;
mod rescue;
mod rows;
mod scalar;
mod sparse;
mod stabilised;
mod sums;
mod system;
mod unknown;

pub use aggregation::Aggregation;
pub use anderson::Anderson;
pub use bicgstab::bicgstab;
pub use conjugate::conjugate_gradient;
pub use direct::Direct;
pub use ending::{Breakdown, Ending, Rule, Solved, Stagnation};
pub use gmres::gmres;
pub use incomplete::{Incomplete, Keep};
pub use jacobi::{Jacobi, Scaled};
pub use lowrank::Pair;
pub use minimal::minimal_residual;
pub use multigrid::{Grids, Multigrid};
pub use operator::{Identity, Inverse, Operator, Shifted};
pub use order::Order;
pub use rescue::Rescue;
pub use rows::Rows;
pub use scalar::{Coefficient, Scalar};
pub use sparse::{Pattern, Sparse};
pub use stabilised::{Scratch, bicgstab2};
pub use system::{Method, Options, System};
pub use unknown::{Sides, Unknown};

use operator::{column, column_mut};
use thiserror::Error;

/// Stopping rule: `|r|_2 <= max(reduction * |r0|_2, floor)`, or `iterations` are spent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Krylov {
    /// Wanted last / first residual.
    pub reduction: f64,
    /// Residual below which nothing is gained, in the unit of the right side.
    pub floor: f64,
    /// Most iterations.
    pub iterations: usize,
}

impl Krylov {
    /// The residual at which a solve that began with `first` may stop.
    fn target(&self, first: f64) -> f64 {
        (self.reduction * first).max(self.floor)
    }

    /// The same with cycles of so many steps.
    #[must_use]
    pub fn restarted(self, after: usize) -> Restarted<Self> {
        Restarted { rule: self, after }
    }

    /// Did the solve reach what was asked for, or what rounding allows?
    #[must_use]
    pub fn reached(&self, outcome: &Outcome) -> bool {
        outcome.last <= self.target(outcome.first).max(outcome.rounding)
    }
}

/// A stopping rule for a method that starts anew after so many steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Restarted<R> {
    /// When to stop.
    pub rule: R,
    /// Steps of a cycle.
    pub after: usize,
}

/// How a solve ended; [`Krylov::reached`] tells whether it converged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// Iterations done.
    pub iterations: usize,
    /// Euclidean norm of the residual before, in the unit of the right side.
    pub first: f64,
    /// Euclidean norm of the residual after, `b - A x` evaluated anew (but for [`bicgstab`]), in the same unit.
    pub last: f64,
    /// What rounding leaves of a residual, about ([`Operator::rounding`]), in the same unit.
    pub rounding: f64,
}

/// Scratch columns of a solve, kept between solves.
#[derive(Debug, Clone, Default)]
pub struct Workspace {
    columns: Vec<Vec<f64>>,
    /// Columns of the Hessenberg matrix, rotations and the rotated right side.
    small: Vec<f64>,
}

impl Workspace {
    /// At least `count` columns of `n` numbers.
    fn fit(&mut self, count: usize, n: usize) -> &mut [Vec<f64>] {
        if self.columns.len() < count {
            self.columns.resize_with(count, Vec::new);
        }
        for column in &mut self.columns[..count] {
            column.resize(n, 0.0);
        }
        &mut self.columns
    }
}

/// Why a solve failed.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Error {
    /// A value or coefficient is not a number.
    #[error("row {index}: {what} is not a finite number")]
    NotFinite {
        /// Row.
        index: usize,
        /// Which quantity.
        what: &'static str,
    },
    /// A diagonal is zero or negative.
    #[error("row {index}: the diagonal {value} is not positive")]
    NotPositive {
        /// Row.
        index: usize,
        /// The diagonal.
        value: f64,
    },
    /// Rows hang together, but nothing fixes their level.
    #[error("row {index} and the rows it hangs together with have no unique solution")]
    Singular {
        /// One of the rows.
        index: usize,
    },
    /// The matrix (or its preconditioner) is not positive definite.
    #[error(
        "iteration {iteration}: curvature {value} is not positive, the matrix is not positive definite"
    )]
    Indefinite {
        /// Iteration at which it showed.
        iteration: usize,
        /// The curvature.
        value: f64,
    },
    /// Memory does not suffice for the factors.
    #[error("memory does not suffice for sparse factors")]
    Memory,
    /// Vectors and matrix do not fit.
    #[error("a vector or matrix of {found} rows where {expected} are expected")]
    Size {
        /// Rows of the matrix.
        expected: usize,
        /// Rows given.
        found: usize,
    },
}

/// Refuses columns of the wrong length.
fn sizes(a: &impl Operator<f64>, rhs: &[f64], x: &[f64]) -> Result<(), Error> {
    let expected = a.len();
    for found in [rhs.len(), x.len()] {
        if found != expected {
            return Err(Error::Size { expected, found });
        }
    }
    Ok(())
}

/// Names the first number that is none.
fn finite(what: &'static str, values: &[f64]) -> Result<(), Error> {
    match values.iter().position(|v| !v.is_finite()) {
        Some(index) => Err(Error::NotFinite { index, what }),
        None => Ok(()),
    }
}

/// `r = b - A x` and its norm.
fn residual(a: &impl Operator<f64>, rhs: &[f64], x: &[f64], r: &mut [f64]) -> Result<f64, Error> {
    a.apply(column(x), column_mut(r));
    let norm = sums::subtract_from(rhs, r).sqrt();
    if !norm.is_finite() {
        finite("the right side", rhs)?;
        finite("the value", x)?;
        finite("the residual", r)?;
        return Err(Error::NotFinite {
            index: 0,
            what: "the norm of the residual",
        });
    }
    Ok(norm)
}
