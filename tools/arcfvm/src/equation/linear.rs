//! How the equation of a field is solved within an outer iteration.
//!
//! Three ways: red-black SOR, the way of the source (Komen 2019, eqs 3.62, 3.63); Krylov methods
//! with incomplete factors; Krylov methods with algebraic multigrid. They differ in time, not in the
//! solution: the outer iteration ends only where the residuals before any solve are small.

use krylov::{Breakdown, Ending, Error, Rule, Scratch, bicgstab, conjugate_gradient};
use relax::{FivePoint, Sor, StencilFactors};

use crate::equation::aggregated::Aggregated;

/// How the equation of a field is solved within an outer iteration.
#[derive(Debug, Clone, Copy)]
pub enum Method {
    /// Red-black SOR (Komen 2019, eqs 3.62, 3.63).
    Sor(Sor),
    /// A Krylov method preconditioned by incomplete factors.
    Incomplete(Rule<'static>),
    /// A Krylov method preconditioned by multigrid.
    Multigrid(Rule<'static>),
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

impl Unsolved {
    /// Of an equation with `columns` cells in a row.
    fn new(error: Error, columns: usize) -> Self {
        let (index, what) = match error {
            Error::NotFinite { index, what } => (index, format!("{what} is not a finite number")),
            Error::NotPositive { index, value } => {
                let what = format!("central coefficient {value} is not positive");
                (index, what)
            }
            other => (0, other.to_string()),
        };
        Self {
            column: index % columns,
            row: index / columns,
            what,
        }
    }
}

/// A solver with its memory.
#[derive(Debug, Clone)]
pub struct Solver {
    /// The method.
    pub method: Method,
    symmetric: bool,
    factors: StencilFactors,
    aggregated: Aggregated,
    scratch: Scratch<f64>,
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
            factors: StencilFactors::default(),
            aggregated: Aggregated::new(symmetric),
            scratch: Scratch::default(),
            kept: Vec::new(),
        }
    }

    /// What the next solve needs to know of those before, for a checkpoint.
    pub(crate) fn memory(&self) -> (Vec<f64>, Option<usize>) {
        self.aggregated.memory()
    }

    /// Takes what [`Self::memory`] gave, for an equation of `columns` in a row.
    pub(crate) fn restore(&mut self, columns: usize, values: &[f64], fresh: Option<usize>) {
        self.aggregated.restore(columns, values, fresh);
    }

    /// Improves `x`.
    ///
    /// # Errors
    /// When the equation is not usable or the values leave the numbers.
    pub fn solve(&mut self, equation: &FivePoint, x: &mut [f64]) -> Result<(), Unsolved> {
        let improved = self.improve(equation, x);
        improved.map_err(|error| Unsolved::new(error, equation.columns))
    }

    fn improve(&mut self, equation: &FivePoint, x: &mut [f64]) -> Result<(), Error> {
        self.kept.clear();
        self.kept.extend_from_slice(x);
        let better = match self.method {
            Method::Sor(sor) => {
                equation.check()?;
                return self.swept(sor, equation, x);
            }
            Method::Incomplete(rule) => {
                self.factors.rebuild(equation)?;
                self.factorised(equation, x, rule)
            }
            Method::Multigrid(rule) => {
                equation.check()?;
                self.aggregated.solve(equation, x, rule)
            }
        };
        if better {
            return Ok(());
        }
        // Krylov methods can break down; sweeps over a dominant diagonal cannot.
        x.copy_from_slice(&self.kept);
        self.swept(FALLBACK, equation, x)
    }

    fn swept(&mut self, sor: Sor, equation: &FivePoint, x: &mut [f64]) -> Result<(), Error> {
        sor.solve(equation, x, &mut self.kept);
        let what = "the value";
        let lost = x.iter().position(|x| !x.is_finite());
        lost.map_or(Ok(()), |index| Err(Error::NotFinite { index, what }))
    }

    /// Solves with the incomplete factors that there are; whether `x` is better.
    fn factorised(&mut self, equation: &FivePoint, x: &mut [f64], rule: Rule) -> bool {
        let (factors, scratch, source) = (&mut self.factors, &mut self.scratch, &equation.source);
        let found = if self.symmetric {
            conjugate_gradient(equation, source, x, factors, rule, scratch)
        } else {
            bicgstab(equation, source, x, factors, rule, scratch)
        };
        // What was found before a divisor vanished serves.
        let sound = match found.ending {
            Ending::BrokenDown(why) => why == Breakdown::Shadow,
            _ => true,
        };
        sound && found.last <= found.first
    }
}

/// Sweeps where a Krylov method made things worse.
const FALLBACK: Sor = Sor::new(1.0, 100, 1e-2);
