//! Solvers and relaxation, from the scene.

use krylov::Rule;
use relax::Sor;

use crate::equation::{Method, Solver};
use crate::flow::pressure::{self, Relaxation};
use crate::scene::{Coupling, Iterate, LinearSolver};

/// How the fields of an arc are solved and iterated.
#[derive(Debug, Clone)]
pub struct Settings {
    /// Solvers.
    pub solvers: Solvers,
    /// How far an iteration goes.
    pub advance: Advance,
}

/// Solvers of the equations.
#[derive(Debug, Clone)]
pub struct Solvers {
    /// Of the potential.
    pub potential: Solver,
    /// Of each momentum equation.
    pub momentum: Solver,
    /// Of the pressure correction.
    pub pressure: Solver,
    /// Of the energy and of the iron.
    pub energy: Solver,
}

/// How far an iteration goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Advance {
    /// Relaxation of the flow.
    pub flow: Relaxation,
    /// Relaxation of temperature and iron.
    pub heat: f64,
    /// Largest change of a temperature in one iteration \[K\].
    pub heat_step: f64,
}

impl From<LinearSolver> for Solvers {
    fn from(chosen: LinearSolver) -> Self {
        let rule = |decrease, products| Rule {
            decrease,
            ..Rule::to(0.0, products)
        };
        let incomplete = |decrease, products| Method::Incomplete(rule(decrease, products));
        let multigrid = |decrease, products| Method::Multigrid(rule(decrease, products));
        let sor =
            |relaxation, sweeps, decrease| Method::Sor(Sor::new(relaxation, sweeps, decrease));
        // A product of each step, two where the matrix is not symmetric, and one for the first residual.
        let (potential, momentum, pressure, energy) = match chosen {
            LinearSolver::Incomplete => (
                incomplete(1e-2, 301),
                incomplete(1e-2, 41),
                incomplete(1e-2, 101),
                incomplete(1e-3, 101),
            ),
            // Where gas is carried, incomplete factors follow the stream and multigrid does not.
            LinearSolver::Multigrid => (
                multigrid(1e-2, 61),
                incomplete(1e-2, 41),
                multigrid(1e-2, 61),
                incomplete(1e-3, 101),
            ),
            // Enough sweeps that what an iteration changes travels as far as its relaxation lets it.
            LinearSolver::Sor => (
                sor(1.8, 200, 1e-2),
                sor(1.0, 16, 1e-2),
                sor(1.7, 100, 3e-2),
                sor(1.0, 60, 1e-2),
            ),
        };
        Self {
            potential: Solver::new(potential, true),
            momentum: Solver::new(momentum, false),
            pressure: Solver::new(pressure, true),
            energy: Solver::new(energy, false),
        }
    }
}

impl From<&Iterate> for Settings {
    fn from(scene: &Iterate) -> Self {
        let flow = Relaxation {
            velocity: scene.velocity(),
            pressure: scene.pressure(),
            coupling: match scene.coupling {
                Coupling::Simple => pressure::Coupling::Simple,
                Coupling::Simplec => pressure::Coupling::Simplec,
            },
        };
        Self {
            solvers: scene.solver.into(),
            advance: Advance {
                flow,
                heat: scene.temperature_relaxation,
                heat_step: scene.temperature_step_k,
            },
        }
    }
}
