//! What is near the inverse of the matrix: the preconditioner in use.

use krylov::{Aggregation, Inverse, Jacobi};

/// The preconditioner in use.
#[derive(Debug)]
pub(super) enum Near {
    Nothing,
    Diagonal(Jacobi),
    Grid(Box<Aggregation>),
}

impl Inverse<f64> for Near {
    fn invert(&mut self, rhs: &[[f64; 1]], out: &mut [[f64; 1]]) {
        match self {
            Self::Nothing => out.copy_from_slice(rhs),
            Self::Diagonal(jacobi) => jacobi.invert(rhs, out),
            Self::Grid(grid) => grid.invert(rhs, out),
        }
    }
}
