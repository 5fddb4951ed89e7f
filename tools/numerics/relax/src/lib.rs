//! Solvers of five-point equations on a structured grid.
//!
//! The equation of cell P (Komen 2019, eq. 3.2, with the implicit part of the source and the
//! under-relaxation already in the central coefficient) is
//!
//! ```text
//! AP x_P = AE x_E + AW x_W + AN x_N + AS x_S + SU
//! ```
//!
//! Three solvers share it:
//! - [`sor`]: red-black successive over-relaxation (eqs 3.58 to 3.63). The colour of a cell is
//!   `(i + j) mod 2`; the printed `i * NJ + j` (eq. 3.61) is a checkerboard only for odd `NJ`.
//! - [`Incomplete`]: an incomplete factorisation; a preconditioner that any contrast of coefficients
//!   leaves calm.
//! - [`conjugate_gradient`] for symmetric and [`bicgstab`] for other equations, both preconditioned.
//!
//! Every cell gathers from its neighbours and every sum is serial, so results are bitwise
//! independent of the number of threads.

mod incomplete;
mod krylov;
pub mod sor;
mod stencil;

pub use incomplete::Incomplete;
pub use krylov::{Krylov, Workspace, bicgstab, conjugate_gradient};
pub use sor::Sor;
pub use stencil::{Coefficients, FivePoint};

use thiserror::Error;

/// An approximate inverse.
pub trait Precondition {
    /// `out` becomes an approximate solution with `rhs` as the source.
    fn precondition(&mut self, rhs: &[f64], out: &mut [f64]);
}

/// How a solve ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// Iterations or sweeps done.
    pub iterations: usize,
    /// L1 norm of the residual before, in the unit of the source.
    pub first: f64,
    /// L1 norm of the residual after, in the unit of the source.
    pub last: f64,
}

/// Why a solve failed.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Error {
    /// A value or coefficient is not a number.
    #[error("cell ({column}, {row}): {what} is not a finite number")]
    NotFinite {
        /// Radial index of the cell.
        column: usize,
        /// Axial index of the cell.
        row: usize,
        /// Which quantity.
        what: &'static str,
    },
    /// A central coefficient is zero or negative.
    #[error("cell ({column}, {row}): central coefficient {value} is not positive")]
    NotPositive {
        /// Radial index of the cell.
        column: usize,
        /// Axial index of the cell.
        row: usize,
        /// The coefficient.
        value: f64,
    },
}
