//! How the equation of a field is solved within an outer iteration.
//!
//! Three ways: red-black SOR, the way of the source (Komen 2019, eqs 3.62, 3.63); Krylov methods
//! with incomplete factors; Krylov methods with algebraic multigrid. They differ in time, not in the
//! solution: the outer iteration ends only where the residuals before any solve are small.

use relax::{FivePoint, Incomplete, Krylov, Outcome, Sor, Workspace, bicgstab, conjugate_gradient};

use crate::equation::multigrid::Multigrid;

/// How the equation of a field is solved within an outer iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// Red-black SOR (Komen 2019, eqs 3.62, 3.63).
    Sor(Sor),
    /// A Krylov method preconditioned by incomplete factors.
    Incomplete(Krylov),
    /// A Krylov method preconditioned by multigrid.
    Multigrid(krylov::Krylov),
}

/// Why an equation could not be solved, and the cell where it showed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("cell ({column}, {row}): {what}")]
pub struct Unsolved {
    /// Radial index.
    pub column: usize,
    /// Axial index.
    pub row: usize,
    /// What is wrong.
    pub what: String,
}

impl From<relax::Error> for Unsolved {
    fn from(error: relax::Error) -> Self {
        let (column, row, what) = match error {
            relax::Error::NotFinite { column, row, what } => {
                (column, row, format!("{what} is not a finite number"))
            }
            relax::Error::NotPositive { column, row, value } => (
                column,
                row,
                format!("central coefficient {value} is not positive"),
            ),
        };
        Self { column, row, what }
    }
}

/// A solver with its memory.
#[derive(Debug, Clone)]
pub struct Solver {
    /// The method.
    pub method: Method,
    symmetric: bool,
    factors: Incomplete,
    multigrid: Multigrid,
    work: Workspace,
    /// What the sweeps need, or the values before a Krylov method.
    kept: Vec<f64>,
}

impl Solver {
    /// A solver; `symmetric` equations take conjugate gradients.
    #[must_use]
    pub fn new(method: Method, symmetric: bool) -> Self {
        Self {
            method,
            symmetric,
            factors: Incomplete::default(),
            multigrid: Multigrid::new(symmetric),
            work: Workspace::default(),
            kept: Vec::new(),
        }
    }

    /// What the next solve needs to know of those before, for a checkpoint.
    pub(crate) fn memory(&self) -> (Vec<f64>, Option<usize>) {
        self.multigrid.memory()
    }

    /// Takes what [`Self::memory`] gave, for an equation of `columns` in a row.
    pub(crate) fn restore(&mut self, columns: usize, values: &[f64], fresh: Option<usize>) {
        self.multigrid.restore(columns, values, fresh);
    }

    /// Improves `x`.
    ///
    /// # Errors
    /// When the equation is not usable or the values leave the numbers.
    pub fn solve(&mut self, equation: &FivePoint, x: &mut [f64]) -> Result<Outcome, Unsolved> {
        match self.method {
            Method::Sor(sor) => Ok(sor.solve_within(equation, x, &mut self.kept)?),
            Method::Incomplete(rule) => {
                self.factors.rebuild(equation)?;
                Ok(self.factorised(equation, x, rule)?)
            }
            Method::Multigrid(rule) => {
                equation.check()?;
                self.kept.clear();
                self.kept.extend_from_slice(x);
                if let Some(outcome) = self.multigrid.solve(equation, x, rule) {
                    return Ok(outcome);
                }
                x.copy_from_slice(&self.kept);
                Ok(FALLBACK.solve_within(equation, x, &mut self.kept)?)
            }
        }
    }

    /// Solves with the incomplete factors that there are.
    fn factorised(
        &mut self,
        equation: &FivePoint,
        x: &mut [f64],
        rule: Krylov,
    ) -> Result<Outcome, relax::Error> {
        let (factors, work) = (&mut self.factors, &mut self.work);
        if self.symmetric {
            return conjugate_gradient(equation, x, factors, rule, work);
        }
        self.kept.clear();
        self.kept.extend_from_slice(x);
        match bicgstab(equation, x, factors, rule, work) {
            Ok(found) if found.last <= found.first => Ok(found),
            // BiCGSTAB can break down; sweeps over a dominant diagonal cannot.
            _ => {
                x.copy_from_slice(&self.kept);
                FALLBACK.solve_within(equation, x, &mut self.kept)
            }
        }
    }
}

/// Sweeps where a Krylov method made things worse.
const FALLBACK: Sor = Sor {
    relaxation: 1.0,
    sweeps: 100,
    reduction: 1e-2,
};
