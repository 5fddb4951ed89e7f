//! From the first iteration to the steady state, with everything that the record keeps.

use run::{Failure, Session};

use crate::heat::balance::Balance;
use crate::pace::Pace;
use crate::residual::{Residuals, part};
use crate::resume;
use crate::scene::Iterate;
use crate::solver::Arc;
use crate::surface;

/// Iterations between two points of the recorded history.
const HISTORY_EVERY: usize = 10;

/// Iterates until every residual is within the tolerance or the iterations are spent.
///
/// # Errors
/// When a field diverges or the user interrupts.
pub fn march(arc: &mut Arc, rule: &Iterate, session: &mut Session) -> Result<(), Failure> {
    let mut pace = Pace::new(rule.velocity_relaxation, rule.temperature_relaxation);
    if let Some(mut checkpoint) = session.restored() {
        resume::restore(arc, &mut checkpoint)?;
        pace = checkpoint.json("pace")?;
        pace.set(arc);
    }
    let mut last = Residuals::default();
    while arc.iteration < rule.most {
        last = arc.iterate(session)?;
        let done = last.within(rule.tolerance) && arc.iteration > 2;
        if done || arc.iteration.is_multiple_of(HISTORY_EVERY) {
            for (name, value) in last.named() {
                session.history(name, "1", arc.iteration as f64, value);
            }
        }
        session.progress(arc.iteration as u64, rule.most as u64, || {
            status(arc, &last)
        });
        if done {
            session.steps(arc.iteration as u64);
            return Ok(());
        }
        if pace.watch(last.worst()) {
            pace.set(arc);
            session.history(
                "temperature_relaxation",
                "1",
                arc.iteration as f64,
                pace.temperature,
            );
        }
        session.keep(|c| {
            c.put_json("pace", &pace)?;
            resume::keep(arc, c)
        })?;
    }
    session.warn(format!(
        "not converged after {} iterations: greatest residual {:.1e}, wanted {:.1e}",
        arc.iteration,
        last.worst(),
        rule.tolerance
    ));
    Ok(())
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
    if let (Some(electric), Some(current)) = (
        &arc.electric,
        arc.case.potential.as_ref().and_then(|p| p.driven),
    ) {
        let cathode = surface::cathode_power(arc) / current.abs();
        session.closing("voltage_v", "V", electric.potential.drive.abs() + cathode);
    }
    if let Some(balance) = balance {
        let scale = surface::power(arc, balance);
        session.closing("power_w", "W", scale);
        session.closing("energy_balance", "1", part(balance.closure(), scale));
    }
    if let Some(flowing) = &arc.flowing {
        let grid = &arc.case.grid;
        let cells = (0..grid.nz).flat_map(|j| (0..grid.nr).map(move |i| (i, j)));
        let lost: f64 = cells
            .map(|(i, j)| flowing.flow.imbalance(grid, i, j).abs())
            .sum();
        session.closing("mass_unbalanced_kg_s", "kg/s", lost);
    }
}
