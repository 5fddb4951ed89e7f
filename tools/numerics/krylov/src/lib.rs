//! Sparse matrices and preconditioned Krylov solvers.
//!
//! A method takes an [`Operator`] and an [`Inverse`] (its preconditioner), is ended by a [`Rule`] and returns [`Solved`]:
//! its history of residuals, and an [`Ending`] that says why it stagnated or broke down.
//!
//! For real numbers in one column:
//!
//! - [`conjugate_gradient`] for symmetric, [`gmres`] for other matrices, flexible both: the preconditioner may differ from
//!   call to call; [`bicgstab`] for other matrices that a few iterations solve;
//! - [`Sparse`]: rows of conduction over a shared [`Pattern`], the diagonal positive and apart, off-diagonals not positive;
//! - [`Jacobi`] (the diagonal), [`Scaled`] (columns scaled by known factors) and [`Aggregation`] (algebraic multigrid),
//!   whose iteration count hardly knows the number of unknowns or jumps of coefficients.
//!
//! For real or complex numbers, in one or three columns at once:
//!
//! - [`bicgstab2`] (Sleijpen and Fokkema 1993), and [`minimal_residual`] where its short recurrence stagnates;
//! - [`System`]: unsymmetric [`Rows`] of scattered points, scaled and reordered ([`Order`]), a [`Method`] chosen,
//!   multipoles as low-rank [`Pair`]s;
//! - [`Incomplete`] factors (ILU(0) and ILUT, in single precision), [`Multigrid`] smoothed by them, sparse [`Direct`] factors.
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
mod scratch;
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
pub use ending::{Breakdown, Ending, Restarted, Rule, Solved, Stagnation, Watch};
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
pub use scratch::Scratch;
pub use sparse::{Pattern, Sparse};
pub use stabilised::bicgstab2;
pub use system::{Method, Options, System};
pub use unknown::{Sides, Unknown};

use thiserror::Error;

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
    /// An iteration broke down.
    #[error("the iteration broke down: {0}")]
    BrokenDown(Breakdown),
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
