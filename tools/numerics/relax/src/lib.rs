//! Solvers of five-point equations on a structured grid.
//!
//! The equation of cell P (Komen 2019, eq. 3.2, with the implicit part of the source and the
//! under-relaxation already in the central coefficient) is
//!
//! ```text
//! AP x_P = AE x_E + AW x_W + AN x_N + AS x_S + SU
//! ```
//!
//! [`sor`] is red-black successive over-relaxation (eqs 3.58 to 3.63). The colour of a cell is
//! `(i + j) mod 2`; the printed `i * NJ + j` (eq. 3.61) is a checkerboard only for odd `NJ`. For the
//! methods of the crate `krylov` the equation is an operator, and [`StencilFactors`] precondition
//! it, whatever the contrast of its coefficients.
//!
//! Every cell gathers from its neighbours and every sum is serial, so results are bitwise
//! independent of the number of threads.

mod factors;
pub mod sor;
mod stencil;

pub use factors::StencilFactors;
pub use sor::Sor;
pub use stencil::{Coefficients, FivePoint};
