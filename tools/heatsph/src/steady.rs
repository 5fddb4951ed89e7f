//! The steady state: one linear solve, or Newton's method with a line search where conductivity depends on
//! temperature (what Rong and Kisu 2010, section 1, leave to "another paper").

use run::{Failure, Session};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::march::{ROUNDED, State, too_cold};
use crate::solve::{Effort, Goal, Problem, SolveError, Solver};
use crate::system::{Rates, System, extent};

/// The steady state, without a march.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Steady {
    /// Largest residual at which Newton's method ends, relative to the heat that flows. What ends above 1e-3 is told as not converged.
    #[serde(default = "tolerance")]
    #[schemars(range(min = 1e-15, max = 1e-2), extend("x-unit" = "1"))]
    pub tolerance: f64,
    /// Greatest number of Newton steps.
    #[serde(default = "newton_steps")]
    #[schemars(range(min = 1))]
    pub newton_steps: usize,
}

fn tolerance() -> f64 {
    1e-12
}

fn newton_steps() -> usize {
    60
}

/// Greatest residual, over the heat that flows, of a state whose figures hold: heat through a face of k = exp(T) is then 0.2 % off, with
/// 1e-2 it is 3 %.
const HOLDS: f64 = 1e-3;

/// How often tables of conductivity are widened.
const WIDENINGS: usize = 20;

/// Powers of two of a temperature \[K\] between which that of a body is sought, and halvings of the range.
const POWERS: (f64, f64) = (-40.0, 60.0);
const HALVINGS: usize = 40;

/// Solves for the steady state: temperatures, and the heat that passes then.
///
/// # Errors
/// When the system has no steady state, or none is found.
pub fn solve(
    steady: Steady,
    system: &mut System,
    temperature: Vec<f64>,
    session: &mut Session,
) -> Result<(State, Rates), Failure> {
    let mut state = State::new(system, temperature);
    let mut rates = Rates::default();
    let mut solver = Solver::new(system);
    let goal = Goal {
        residual: steady.tolerance,
        steps: steady.newton_steps,
    };
    let (mut newton, mut iterations) = (0, 0);
    let (low, high) = system.surface.extent(extent(&state.temperature));
    let usual = low.abs().max(high.abs());
    let (mut guessed, mut settled) = (true, false);
    for _ in 0..WIDENINGS {
        let from = state.temperature.clone();
        let problem = Problem {
            shift: 0.0,
            from: &from,
            time: 0.0,
        };
        let solved = session.timed("solve", || {
            solver.newton(system, problem, &mut state.temperature, &mut rates, goal)
        });
        let far = matches!(
            solved,
            Err(SolveError::NotConverged { .. } | SolveError::Linear(_))
        );
        if far && std::mem::take(&mut guessed) && restart(system, &mut state, &mut rates, session)?
        {
            solver.forget();
            continue;
        }
        let effort = found(solved, session)?;
        newton += effort.newton;
        iterations += effort.iterations;
        session.history("residual", "1", newton as f64, effort.residual);
        let grown = system.reach(&state.temperature);
        if !grown.map_err(|error| lost(&error.to_string()))? {
            session.closing("residual", "1", effort.residual);
            settled = true;
            break;
        }
    }
    if !settled {
        session.warn(unsettled(extent(&state.temperature)));
    }
    warm(system, &state, usual)?;
    session.stopped()?;
    if rates.hidden {
        session.warn(crate::source::HIDDEN);
    }
    session.steps(newton as u64);
    session.closing("newton_steps", "1", newton as f64);
    session.closing("linear_iterations", "1", iterations as f64);
    session.memory("matrix and preconditioner", solver.bytes());
    Ok((state, rates))
}

/// The effort of a solve; one that did not converge is told.
fn found(solved: Result<Effort, SolveError>, session: &mut Session) -> Result<Effort, Failure> {
    match solved {
        Ok(effort) => {
            if effort.residual > HOLDS {
                session.warn(format!(
                    "ended where the scene lets it, but not converged: the residual is {:.1e} of the heat that passes; lower \
                     \"steady/tolerance\"",
                    effort.residual
                ));
            }
            Ok(effort)
        }
        Err(SolveError::NotConverged { residual, steps }) => {
            session.warn(format!(
                "not converged: the residual is {residual:.1e} of the heat that passes after {steps} Newton steps"
            ));
            Ok(Effort {
                newton: steps,
                iterations: 0,
                residual,
            })
        }
        Err(error) => Err(lost(&error.to_string())),
    }
}

/// Goes on from one temperature of the whole body, where a guess has led nowhere; whether there is one.
fn restart(
    system: &mut System,
    state: &mut State,
    rates: &mut Rates,
    session: &mut Session,
) -> Result<bool, Failure> {
    let Some(even) = even(system, &state.temperature, rates) else {
        return Ok(false);
    };
    for (i, t) in state.temperature.iter_mut().enumerate() {
        if !system.is_held(i) {
            *t = even;
        }
    }
    session.note(format!(
        "the first guess leads to no solution: {even:.4} K everywhere is the next"
    ));
    let reached = system.reach(&state.temperature);
    reached.map_err(|error| lost(&error.to_string()))?;
    Ok(true)
}

/// The mean of the held temperatures, or else the one temperature of a whole body at which as much heat enters as
/// leaves \[K\].
///
/// Where a body radiates, the slope of its heat by temperature vanishes with T^3, and from a guess that is cold by a
/// factor n Newton's method leaps to some n^3 times the solution, from where it comes back by a quarter in each step.
fn even(system: &System, temperature: &[f64], rates: &mut Rates) -> Option<f64> {
    let held = &system.surface.held;
    if !held.is_empty() {
        let sum: f64 = held.iter().map(|h| temperature[h.point as usize]).sum();
        return Some(sum / held.len() as f64);
    }
    let mut gained = |power: f64| system.gained(power.exp2(), rates).ok();
    // Powers of two between which a temperature can lie, whatever is the unit of heat.
    let (mut low, mut high) = POWERS;
    if gained(low)? <= 0.0 || gained(high)? >= 0.0 {
        return None;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if gained(middle)? > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some((0.5 * (low + high)).exp2())
}

/// What is said of a solution that leaves the tables after all widenings.
fn unsettled(range: (f64, f64)) -> String {
    let (low, high) = range;
    format!(
        "not converged: from {low:.4e} K to {high:.4e} K the solution still leaves the tables of conductivity, which were \
         widened {WIDENINGS} times; a body whose conductivity vanishes with temperature may have no steady state"
    )
}

/// Refuses a steady state below 0 K; `usual` is one that is given \[K\].
fn warm(system: &System, state: &State, usual: f64) -> Result<(), Failure> {
    match state.cold(ROUNDED * usual) {
        Some(i) => Err(Failure::Diverged {
            step: 1,
            time_s: 0.0,
            place: system.spot(i),
            quantity: "temperature [K]".to_owned(),
            what: too_cold(state.temperature[i], system.takes()),
        }),
        None => Ok(()),
    }
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
