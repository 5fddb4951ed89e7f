//! The steady state: one linear solve, or Newton's method with a line search where conductivity depends on
//! temperature (what Rong and Kisu 2010, section 1, leave to "another paper").

use run::{Failure, Session};

use crate::march::State;
use crate::output::{Event, Output};
use crate::scene::{Scene, Steady};
use crate::solve::{Goal, Problem, SolveError, Solver};
use crate::system::{Rates, System};

/// How often tables of conductivity are widened.
const WIDENINGS: usize = 20;

/// Solves and writes the steady state.
///
/// # Errors
/// When the system has no steady state, or none is found.
pub fn solve(
    scene: &Scene,
    steady: Steady,
    (system, temperature): (&mut System, Vec<f64>),
    session: &mut Session,
) -> Result<(), Failure> {
    let mut state = State::new(temperature, system.surface.conditions.len());
    let mut rates = Rates::default();
    let mut solver = Solver::new(system);
    let goal = Goal {
        residual: steady.tolerance,
        steps: steady.newton_steps,
    };
    let (mut newton, mut iterations) = (0, 0);
    for _ in 0..WIDENINGS {
        let from = state.temperature.clone();
        let problem = Problem {
            shift: 0.0,
            from: &from,
            time: 0.0,
        };
        let solved = session.timed("solve", || {
            solver.newton(system, problem, (&mut state.temperature, &mut rates), goal)
        });
        let effort = match solved {
            Ok(effort) => effort,
            Err(SolveError::NotConverged { residual, steps }) => {
                session.warn(format!(
                    "not converged: the residual is {residual:.1e} of the heat that passes after {steps} Newton steps"
                ));
                crate::solve::Effort {
                    newton: steps,
                    iterations: 0,
                    residual,
                }
            }
            Err(error) => return Err(lost(&error.to_string())),
        };
        newton += effort.newton;
        iterations += effort.iterations;
        session.history("residual", "1", newton as f64, effort.residual);
        let grown = system.reach(&state.temperature);
        if !grown.map_err(|error| lost(&error.to_string()))? {
            session.closing("residual", "1", effort.residual);
            break;
        }
    }
    session.stopped()?;
    session.steps(newton as u64);
    session.closing("newton_steps", "1", newton as f64);
    session.closing("linear_iterations", "1", iterations as f64);
    session.memory("matrix and preconditioner", solver.bytes());
    let mut output = Output::new(scene, system, &state.temperature);
    output.write(system, (&state, &rates), Event::whole(0.0), session)?;
    output.close_steady(system, &rates, session);
    Ok(())
}

fn lost(what: &str) -> Failure {
    let hint = "a steady state needs a temperature, convection or radiation somewhere";
    Failure::Diverged {
        step: 1,
        time_s: 0.0,
        place: "all points".to_owned(),
        quantity: "temperature [K]".to_owned(),
        what: format!("{what}; {hint}"),
    }
}
