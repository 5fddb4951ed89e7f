//! From the first iteration to the steady state, with everything that the record keeps.

pub mod continuation;
pub mod pace;
pub mod recombination;
pub mod stagnation;

use artefact::Checkpoint;
use run::{Failure, Session};

use crate::heat::balance::Balance;
use crate::march::continuation::Steps;
use crate::march::pace::Pace;
use crate::march::recombination::Recombination;
use crate::march::stagnation::Trail;
use crate::residual::{EQUATIONS, Residuals};
use crate::resume;
use crate::scene::Iterate;
use crate::solver::Arc;

/// Iterations between two points of the recorded history.
const HISTORY_EVERY: usize = 10;

/// What the iteration keeps beside the fields.
struct Course<'a> {
    rule: &'a Iterate,
    pace: Pace,
    trail: Trail,
    steps: Steps,
    recombination: Option<Recombination>,
}

impl<'a> Course<'a> {
    /// The course from the start, or on from a checkpoint.
    fn new(arc: &mut Arc, rule: &'a Iterate, session: &mut Session) -> Result<Self, Failure> {
        let driven = arc.case.potential.as_ref().and_then(|p| p.driven);
        let mut course = Self {
            rule,
            pace: Pace::new(rule.velocity(), rule.temperature_relaxation),
            trail: Trail::default(),
            steps: Steps::new(rule.continuation.as_ref(), driven.unwrap_or(0.0)),
            recombination: None,
        };
        let Some(mut checkpoint) = session.restored() else {
            course.steps.begin(arc);
            return Ok(course);
        };
        resume::restore(arc, &mut checkpoint)?;
        let all = std::mem::replace(&mut course.steps, checkpoint.json("steps")?);
        course.steps.resume(arc, &all);
        course.pace = checkpoint.json("pace")?;
        course.pace.set(arc);
        course.trail = checkpoint.json("trail")?;
        if course.pace.recombines {
            course.recombination = Some(Recombination::restored(&mut checkpoint)?);
        }
        Ok(course)
    }

    fn keep(&self, c: &mut Checkpoint) -> artefact::Result<()> {
        c.put_json("pace", &self.pace)?;
        c.put_json("trail", &self.trail)?;
        c.put_json("steps", &self.steps)?;
        match &self.recombination {
            Some(recombination) => recombination.keep(c),
            None => Ok(()),
        }
    }

    /// Whether the residuals end the iteration.
    fn done(&self, arc: &Arc, residuals: &Residuals) -> bool {
        let met = residuals.met(self.rule.tolerance, &self.rule.stop);
        met && arc.iteration > 2 && self.steps.over()
    }

    /// Whether no more is gained at the last current, however slow. What falls goes on, even where it
    /// was once smaller: an arc can pass from one state to another.
    fn stagnates(&self) -> bool {
        self.steps.over() && self.pace.stagnates() && !self.trail.falls()
    }

    /// Acts on the residuals of an iteration: next current, pace, and the state that the next one begins from.
    fn act(&mut self, arc: &mut Arc, residuals: &Residuals, session: &mut Session) {
        self.trail.push(residuals.worst());
        let at = arc.iteration as f64;
        if let Some(current) = self.steps.watch(arc, residuals) {
            session.history("current", "A", at, current);
            self.pace = Pace::new(self.rule.velocity(), self.rule.temperature_relaxation);
            self.pace.set(arc);
            self.recombination = None;
        } else if self.pace.watch(residuals.worst()) {
            self.pace.set(arc);
            session.history("temperature_relaxation", "1", at, self.pace.temperature);
            let again = self.pace.recombines;
            self.recombination = again.then(|| Recombination::new(arc));
        } else if let Some(recombination) = &mut self.recombination {
            recombination.recombine(arc, residuals);
        }
    }
}

/// Iterates until every equation holds as the scene asks, or the iterations are spent.
///
/// # Errors
/// When a field diverges or the user interrupts.
pub fn march(arc: &mut Arc, rule: &Iterate, session: &mut Session) -> Result<(), Failure> {
    let mut course = Course::new(arc, rule, session)?;
    let mut last = Residuals::default();
    while arc.iteration < rule.most {
        last = arc.iterate(session)?;
        let done = course.done(arc, &last);
        if done || arc.iteration.is_multiple_of(HISTORY_EVERY) {
            record(arc, &last, session);
        }
        session.progress(arc.iteration as u64, rule.most as u64, || {
            status(arc, &last)
        });
        if done {
            session.steps(arc.iteration as u64);
            if let Some(told) = last.loose() {
                session.warn(told);
            }
            return Ok(());
        }
        course.act(arc, &last, session);
        if course.stagnates() {
            break;
        }
        session.keep(|c| {
            course.keep(c)?;
            resume::keep(arc, c)
        })?;
    }
    let early = match arc.iteration < rule.most {
        true => format!(" and stopped early, of {} iterations", rule.most),
        false => String::new(),
    };
    session.warn(format!(
        "not converged after {} iterations{early}: {}",
        arc.iteration,
        stagnation::told(arc, &last, rule.tolerance, &rule.stop, &course.trail)
    ));
    Ok(())
}

/// Residuals as parts of their scales and as amounts.
fn record(arc: &Arc, residuals: &Residuals, session: &mut Session) {
    let at = arc.iteration as f64;
    for (name, value) in residuals.named() {
        session.history(name, "1", at, value);
    }
    for ((name, unit), found) in EQUATIONS.iter().zip(&residuals.unbalanced) {
        if let Some(found) = found {
            session.history(&format!("unbalanced_{name}"), unit, at, found.amount);
        }
    }
}

fn status(arc: &Arc, residuals: &Residuals) -> Vec<(&'static str, f64, &'static str)> {
    let mut row = Vec::new();
    if let Some(electric) = arc.electric.as_ref().filter(|_| arc.heating.is_some()) {
        row.push(("column", electric.potential.drive, "V"));
    }
    if arc.heating.is_some() {
        let hottest = arc.temperature().iter().copied().fold(0.0, f64::max);
        row.push(("hottest", hottest, "K"));
    }
    row.extend(
        residuals
            .named()
            .map(|(name, value)| (short(name), value, "")),
    );
    row
}

fn short(name: &'static str) -> &'static str {
    name.strip_prefix("residual_").unwrap_or(name)
}

/// Closing block: voltages, powers, and what does not add up.
pub fn close(arc: &Arc, balance: Option<&Balance>, session: &mut Session) {
    let supply = balance.map(|balance| arc.supply(balance));
    if let Some(voltage) = arc.voltage(supply.as_ref()) {
        session.closing("voltage_v", "V", voltage.all());
    }
    if let Some(balance) = balance {
        arc.tell_supply(balance, session);
    }
    if let Some(flowing) = &arc.flowing {
        let lost = flowing.flow.unbalanced(&arc.case.grid);
        session.closing("mass_unbalanced_kg_s", "kg/s", lost);
    }
}
