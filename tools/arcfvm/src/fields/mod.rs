//! The fields: each owns its columns, its equation and its solver.

pub mod edge_shear;
pub mod energy;
pub mod energy_edges;
mod faces;
pub mod flow;
pub mod magnetic;
mod mixing;
pub mod momentum_axial;
pub mod momentum_radial;
pub mod potential;
pub mod pressure;
pub mod sheath;
pub mod vapour;

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
            grid: Multigrid::default(),
            work: Workspace::default(),
            kept: Vec::new(),
        }
    }

    /// Improves `x`.
    ///
    /// # Errors
    /// When the equation is not usable or the values leave the numbers.
    pub fn solve(&mut self, equation: &FivePoint, x: &mut [f64]) -> Result<Outcome, Error> {
        match self.method {
            Method::Sor(sor) => sor.solve_within(equation, x, &mut self.kept),
            Method::Incomplete(rule) => {
                self.factors.rebuild(equation)?;
                let memory = (&mut self.work, &mut self.kept);
                krylov(self.symmetric, equation, x, &mut self.factors, rule, memory)
            }
            Method::Multigrid(rule) => {
                self.grid.rebuild(equation)?;
                let memory = (&mut self.work, &mut self.kept);
                krylov(self.symmetric, equation, x, &mut self.grid, rule, memory)
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
    (work, before): (&mut Workspace, &mut Vec<f64>),
) -> Result<Outcome, Error> {
    if symmetric {
        return conjugate_gradient(equation, x, inverse, rule, work);
    }
    before.clear();
    before.extend_from_slice(x);
    let outcome = bicgstab(equation, x, inverse, rule, work);
    match outcome {
        Ok(found) if found.last <= found.first => Ok(found),
        // BiCGSTAB can break down; sweeps over a dominant diagonal cannot.
        _ => {
            x.copy_from_slice(before);
            FALLBACK.solve_within(equation, x, before)
        }
    }
}

/// Sweeps where a Krylov method made things worse.
const FALLBACK: Sor = Sor {
    relaxation: 1.0,
    sweeps: 100,
    reduction: 1e-2,
};
