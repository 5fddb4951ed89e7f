//! What solves of a liquid and of its fields took, and how they fail.

use krylov::{Ending, Solved};
use run::Failure;

/// What steps took.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effort {
    /// Products of a matrix.
    pub products: u64,
    /// Largest residual.
    pub residual: f64,
    /// Solves that did not converge.
    pub unsolved: u64,
    /// Stages whose friction and pressure did not settle.
    pub unsettled: u64,
    /// Products, largest residual and solves that did not converge, of fields.
    pub field_products: u64,
    /// Largest residual of fields.
    pub field_residual: f64,
    /// Solves of fields that did not converge.
    pub field_unsolved: u64,
}

impl Effort {
    pub(super) fn add(&mut self, solved: &Solved) -> Result<(), Failure> {
        self.products += solved.products as u64;
        self.residual = self.residual.max(solved.worst());
        match solved.ending {
            Ending::Converged => {}
            Ending::BrokenDown(why) => return Err(failed(&why)),
            _ => self.unsolved += 1,
        }
        Ok(())
    }

    /// What a reader of the run must be told.
    #[must_use]
    pub fn doubts(&self) -> Vec<String> {
        let told = [
            (self.unsolved, "solves of the liquid"),
            (
                self.unsettled,
                "stages, whose friction and pressure did not settle",
            ),
        ];
        let told = told.iter().filter(|(n, _)| *n > 0);
        told.map(|(n, what)| format!("not converged: {n} {what}"))
            .collect()
    }
}

pub(crate) fn failed(why: &dyn std::fmt::Display) -> Failure {
    Failure::Other(format!("liquid: {why}"))
}
