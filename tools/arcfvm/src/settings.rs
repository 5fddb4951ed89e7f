//! Solvers and relaxation, from the scene.

use relax::{Krylov, Sor};

use crate::equation::{Method, Solver};
use crate::flow::pressure::{self, Relaxation};
use crate::scene::{Coupling, Iterate, LinearSolver};

/// Solvers and relaxation of every field.
#[derive(Debug, Clone)]
pub struct Settings {
    /// Solver of the potential.
    pub potential: Solver,
    /// Solver of each momentum equation.
    pub momentum: Solver,
    /// Solver of the pressure correction.
    pub pressure: Solver,
    /// Solver of the energy.
    pub energy: Solver,
    /// Relaxation of the flow.
    pub flow: Relaxation,
    /// Relaxation of the temperature.
    pub heat_relaxation: f64,
    /// Largest change of a temperature in one iteration \[K\].
    pub heat_step: f64,
    /// Whether what surfaces see is renewed in every iteration.
    pub view_always: bool,
}

impl From<&Iterate> for Settings {
    fn from(scene: &Iterate) -> Self {
        let rule = |reduction, iterations| Krylov {
            reduction,
            floor: 0.0,
            iterations,
        };
        let multigrid = |reduction, iterations| {
            Method::Multigrid(krylov::Krylov {
                reduction,
                floor: 0.0,
                iterations,
            })
        };
        let sor = |relaxation, sweeps, reduction| {
            Method::Sor(Sor {
                relaxation,
                sweeps,
                reduction,
            })
        };
        let (potential, momentum, pressure, energy) = match scene.solver {
            LinearSolver::Incomplete => (
                Method::Incomplete(rule(1e-2, 300)),
                Method::Incomplete(rule(1e-2, 20)),
                Method::Incomplete(rule(1e-2, 100)),
                Method::Incomplete(rule(1e-3, 50)),
            ),
            // Where gas is carried, incomplete factors follow the stream and multigrid does not.
            LinearSolver::Multigrid => (
                multigrid(1e-2, 60),
                Method::Incomplete(rule(1e-2, 20)),
                multigrid(1e-2, 60),
                Method::Incomplete(rule(1e-3, 50)),
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
            flow: Relaxation {
                velocity: scene.velocity(),
                pressure: scene.pressure(),
                coupling: match scene.coupling {
                    Coupling::Simple => pressure::Coupling::Simple,
                    Coupling::Simplec => pressure::Coupling::Simplec,
                },
            },
            heat_relaxation: scene.temperature_relaxation,
            heat_step: scene.temperature_step_k,
            view_always: false,
        }
    }
}
