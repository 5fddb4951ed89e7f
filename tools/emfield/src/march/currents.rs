//! Eddy currents in time: from rest to the end.

use artefact::Checkpoint;
use krylov::{Ending, Rescue, Solved};
use run::{Failure, Session};
use steps::Legs;

use super::growth::Growth;
use super::scheme::{March, Settled, slope};
use super::wave::Wave;
use crate::frames::Found;
use crate::magnetic::charge::fields::Lack;
use crate::magnetic::problem::Problem;
use crate::magnetic::saturation::bodies;
use crate::magnetic::transient::{View, stage};
use crate::scene::Output;
use crate::scene::currents::Transient;

/// What solves of a march have taken, and what they lack.
#[derive(Debug, Clone, Copy, Default)]
struct Effort {
    products: u64,
    residual: f64,
    lack: Lack,
    /// Before the march was resumed.
    settled: Settled,
}

impl Effort {
    /// Counts the solves of a step.
    ///
    /// # Errors
    /// Where one broke down.
    fn add(
        &mut self,
        time: f64,
        solved: &[Solved; 2],
        session: &mut Session,
    ) -> Result<(), Failure> {
        for solved in solved {
            self.products += solved.products as u64;
            self.residual = self.residual.max(solved.worst());
            match &solved.ending {
                Ending::Converged => {}
                Ending::BrokenDown(why) => {
                    let what = format!("eddy currents at {time:.6e} s: {why}");
                    return Err(Failure::Other(what));
                }
                other => session.warn(format!("not converged: eddy currents: {other}")),
            }
        }
        Ok(())
    }
}

/// Marches eddy currents from rest to the end, with `K` unknowns a point: 3 in space, else 1. `write` gets instants \[s\]
/// and what is found there.
///
/// # Errors
/// Where a stencil cannot be made, a solve breaks down, the user interrupts, or those of `write`.
pub(crate) fn march<const D: usize, const K: usize>(
    problem: &Problem<'_, D>,
    transient: &Transient,
    output: &Output,
    session: &mut Session,
    mut write: impl FnMut(f64, Found, &mut Session) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let (steps, wave) = (transient.steps(output), Wave::new(transient)?);
    judge(problem, &wave, &steps, session)?;
    let drive = session.timed("source", || problem.drive::<K>());
    let flux = problem.source.flux(&problem.cloud.position);
    let charges = problem.charges(session)?;
    let mut length = steps.step(0).1;
    let stage = stage(problem, &drive, charges.as_ref(), slope(length), session)?;
    let source: Vec<f64> = drive.source.as_flattened().iter().map(|a| a.re).collect();
    let unknowns = source.len() + charges.as_ref().map_or(0, |c| c.stencils.len());
    let mut march = March::new(stage, source, unknowns, length);
    let view = View {
        problem,
        drive: &drive,
        flux: &flux,
        charges: charges.as_ref(),
    };
    let mut growth = Growth::new(problem.heating(), K);
    let (mut taken, mut effort) = (0, Effort::default());
    if let Some(mut checkpoint) = session.restored() {
        (taken, length, effort) = restore(&mut march, &mut growth, &steps, &mut checkpoint)?;
    } else {
        write(0.0, view.fields(march.state(), 0.0, length).0, session)?;
    }
    let rule = problem.parameters.numerics.rule(None);
    while taken < steps.count() {
        let (from, wanted) = steps.step(taken);
        if wanted.to_bits() != length.to_bits() {
            length = wanted;
            let paced = session.timed("factorise", || march.pace(length));
            paced.map_err(|error| failed(&error))?;
        }
        let solved = session.timed("march", || march.advance(from, |t| wave.at(t), rule))?;
        taken += 1;
        let (time, written) = steps.end(taken);
        effort.add(time, &solved, session)?;
        let still = wave.stands(from, time)?;
        let rates = &march.state().change[..K * problem.cloud.len()];
        growth.watch(rates, still, taken, time, problem.cloud)?;
        session.progress(taken, steps.count(), || {
            vec![
                ("time", time, "s"),
                ("step", length, "s"),
                ("products", effort.products as f64, "1"),
            ]
        });
        if written {
            let wave = wave.at(time)?;
            let (found, out) = session.timed("fields", || view.fields(march.state(), wave, length));
            effort.lack.join(out);
            write(time, found, session)?;
        }
        if taken < steps.count() {
            session.keep(|checkpoint| save(&march, &growth, taken, effort, checkpoint))?;
        }
    }
    problem.tell(effort.lack, session);
    close(&steps, effort, session);
    problem.told(march.settled().map(|s| s.with(effort.settled)), session);
    Ok(())
}

/// Says where steps do not follow the wave, and points not what it drives.
fn judge<const D: usize>(
    problem: &Problem<'_, D>,
    wave: &Wave,
    steps: &Legs,
    session: &mut Session,
) -> Result<(), Failure> {
    problem.warn_over(wave.lasts(steps)?, session);
    if let Some(doubt) = wave.doubt(steps)? {
        session.warn(doubt);
    }
    Ok(())
}

/// Tells what the march took.
fn close(steps: &Legs, effort: Effort, session: &mut Session) {
    session.steps(steps.count());
    session.closing("step", "s", steps.longest());
    session.closing("products_march", "1", effort.products as f64);
    session.closing("residual_march", "1", effort.residual);
}

fn failed(error: &dyn std::fmt::Display) -> Failure {
    Failure::Other(format!("eddy currents: {error}"))
}

/// Puts all that the rest of a march depends on into a checkpoint.
fn save(
    march: &March<'_>,
    growth: &Growth,
    taken: u64,
    effort: Effort,
    checkpoint: &mut Checkpoint,
) -> artefact::Result<()> {
    let Lack { largest, worst } = effort.lack;
    checkpoint.put_u64("count", &[taken, effort.products, worst.1 as u64]);
    checkpoint.put_f64("effort", &[effort.residual, largest, worst.0]);
    let (last, most, rises) = growth.seen;
    checkpoint.put_f64("growth", &[last, most, f64::from(rises)]);
    let rescued = match march.rescued() {
        None => 0,
        Some(Rescue::Direct) => 1,
        Some(Rescue::Incomplete) => 2,
    };
    checkpoint.put_u8("rescued", &[rescued]);
    if let Some(settled) = march.settled() {
        bodies::save(settled.with(effort.settled), checkpoint);
    }
    checkpoint.put_f64("unknown", &march.state().unknown);
    checkpoint.put_f64("total", &march.state().total);
    Ok(())
}

/// Takes back what [`save`] put: the steps taken, the length of the last one \[s\] and the effort.
fn restore(
    march: &mut March<'_>,
    growth: &mut Growth,
    steps: &Legs,
    checkpoint: &mut Checkpoint,
) -> Result<(u64, f64, Effort), Failure> {
    let lacks = |what: &str| Failure::Other(format!("the checkpoint lacks a part{what}"));
    let wanted = march.state().unknown.len();
    let mut column = |name: &str| -> Result<Vec<f64>, Failure> {
        let values = checkpoint.f64(name)?;
        let whole = values.len() == wanted;
        whole
            .then_some(values)
            .ok_or_else(|| lacks(&format!(" of \"{name}\"")))
    };
    let (unknown, total) = (column("unknown")?, column("total")?);
    let (count, effort) = (checkpoint.u64("count")?, checkpoint.f64("effort")?);
    let (&[taken, products, place], &[residual, largest, worst]) = (&count[..], &effort[..]) else {
        return Err(lacks(""));
    };
    let rescued = match checkpoint.u8("rescued")?[..] {
        [0] => None,
        [1] => Some(Rescue::Direct),
        [2] => Some(Rescue::Incomplete),
        _ => return Err(lacks(" of \"rescued\"")),
    };
    // What was rescued are the equations of the last step.
    let last = steps.step(taken.max(1) - 1).1;
    if last.to_bits() != steps.step(0).1.to_bits() {
        march.pace(last).map_err(|error| failed(&error))?;
    }
    march
        .restore(unknown, total, rescued)
        .map_err(|error| failed(&error))?;
    if let &[last, most, rises] = &checkpoint.f64("growth")?[..] {
        growth.seen = (last, most, rises as u32);
    }
    let settled = match march.settled() {
        Some(_) => bodies::restored(checkpoint)?,
        None => Settled::default(),
    };
    let effort = Effort {
        settled,
        products,
        residual,
        lack: Lack {
            largest,
            worst: (worst, place as usize),
        },
    };
    Ok((taken, last, effort))
}
