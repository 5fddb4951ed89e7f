//! The fields: each owns its columns, its equation and its solver.

pub mod edge_shear;
pub mod energy;
pub mod energy_edges;
pub mod flow;
pub mod magnetic;
pub mod momentum_axial;
pub mod momentum_radial;
pub mod potential;
pub mod pressure;

use relax::{
    Error, FivePoint, Incomplete, Krylov, Multigrid, Outcome, Precondition, Sor, Workspace,
    bicgstab, conjugate_gradient,
};

/// How the equation of a field is solved within an outer iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// Red-black SOR (Komen 2019, eqs 3.62, 3.63).
    Sor(Sor),
    /// A Krylov method preconditioned by incomplete factors.
    Incomplete(Krylov),
    /// A Krylov method preconditioned by a multigrid cycle.
    Multigrid(Krylov),
}

/// A solver with its memory.
#[derive(Debug, Clone)]
pub struct Solver {
    /// The method.
    pub method: Method,
    symmetric: bool,
    factors: Incomplete,
    grid: Multigrid,
    work: Workspace,
}

impl Solver {
    /// A solver; `symmetric` equations take conjugate gradients.
    #[must_use]
    pub fn new(method: Method, symmetric: bool) -> Self {
        Self {
            method,
            symmetric,
            factors: Incomplete::default(),
            grid: Multigrid::default(),
            work: Workspace::default(),
        }
    }

    /// Improves `x`.
    ///
    /// # Errors
    /// When the equation is not usable or the values leave the numbers.
    pub fn solve(&mut self, equation: &FivePoint, x: &mut [f64]) -> Result<Outcome, Error> {
        match self.method {
            Method::Sor(sor) => sor.solve(equation, x),
            Method::Incomplete(rule) => {
                self.factors.rebuild(equation)?;
                krylov(
                    self.symmetric,
                    equation,
                    x,
                    &mut self.factors,
                    rule,
                    &mut self.work,
                )
            }
            Method::Multigrid(rule) => {
                self.grid.rebuild(equation)?;
                krylov(
                    self.symmetric,
                    equation,
                    x,
                    &mut self.grid,
                    rule,
                    &mut self.work,
                )
            }
        }
    }
}

fn krylov(
    symmetric: bool,
    equation: &FivePoint,
    x: &mut [f64],
    inverse: &mut impl Precondition,
    rule: Krylov,
    work: &mut Workspace,
) -> Result<Outcome, Error> {
    if symmetric {
        return conjugate_gradient(equation, x, inverse, rule, work);
    }
    let before = x.to_vec();
    let outcome = bicgstab(equation, x, inverse, rule, work);
    match outcome {
        Ok(found) if found.last <= found.first => Ok(found),
        // BiCGSTAB can break down; sweeps over a dominant diagonal cannot.
        _ => {
            x.copy_from_slice(&before);
            FALLBACK.solve(equation, x)
        }
    }
}

/// Sweeps where a Krylov method made things worse.
const FALLBACK: Sor = Sor {
    relaxation: 1.0,
    sweeps: 100,
    reduction: 1e-2,
};
