//! What is near the inverse of the matrix: the preconditioner in use.

use krylov::{Aggregation, Jacobi, Precondition};

/// The preconditioner in use.
#[derive(Debug)]
pub(super) enum Near {
    Nothing,
    Diagonal(Jacobi),
    Grid(Box<Aggregation>),
}

impl Precondition for Near {
    fn precondition(&mut self, rhs: &[f64], out: &mut [f64]) {
        match self {
            Self::Nothing => out.copy_from_slice(rhs),
            Self::Diagonal(jacobi) => jacobi.precondition(rhs, out),
            Self::Grid(grid) => grid.precondition(rhs, out),
        }
    }
}
