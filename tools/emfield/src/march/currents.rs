//! Eddy currents in time: from rest to the end.

use artefact::Checkpoint;
use krylov::{Ending, Rescue, Rule, Solved};
use run::{Failure, Session};
use steps::Legs;

use super::adaptive::Adaptive;
use super::growth::Growth;
use super::modes::Modes;
use super::scheme::{March, Settled, slope};
use super::wave::Wave;
use crate::cloud::Cloud;
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

/// A march under way.
struct Marching<'a> {
    march: March<'a>,
    steps: Legs,
    wave: Wave,
    adaptive: Option<Adaptive>,
    growth: Growth,
    modes: Modes,
    /// Unknowns of all points.
    points: usize,
    /// Steps of the scene's length that are done.
    taken: u64,
    /// Length of the last step \[s\].
    length: f64,
    effort: Effort,
}

impl Marching<'_> {
    /// Takes a step, with as many of the scene's as it holds; the instant of its end \[s\], and whether fields are written
    /// there.
    fn step(
        &mut self,
        rule: Rule,
        cloud: &Cloud,
        session: &mut Session,
    ) -> Result<(f64, bool), Failure> {
        let (from, own) = self.steps.step(self.taken);
        let stride = loop {
            let stride = self.stride(from, own)?;
            self.pace(own, stride, session)?;
            let (march, wave) = (&mut self.march, &self.wave);
            let solved = session.timed("march", || march.advance(from, |t| wave.at(t), rule))?;
            self.effort.add(from + self.length, &solved, session)?;
            let length = self.length;
            let adaptive = self.adaptive.as_mut();
            if adaptive.is_none_or(|adaptive| adaptive.stands(march, length)) {
                break stride;
            }
        };
        self.taken += stride;
        let (time, written) = self.steps.end(self.taken);
        self.modes.step(from, self.length, &self.wave)?;
        if written {
            self.modes.written(time);
        }
        let still = self.wave.stands(from, time)?;
        let rates = &self.march.state().change[..self.points];
        self.growth.watch(rates, still, self.taken, time, cloud)?;
        Ok((time, written))
    }

    /// How many steps of the scene's length the next one holds.
    fn stride(&mut self, from: f64, own: f64) -> Result<u64, Failure> {
        let (left, wave) = (self.steps.left(self.taken), &self.wave);
        let Some(adaptive) = &mut self.adaptive else {
            return Ok(1);
        };
        adaptive.keep(&self.march);
        adaptive.stride(left, own, |length| wave.follows(from, length))
    }

    /// Makes the equations ready for so many steps of `own` length \[s\].
    fn pace(&mut self, own: f64, stride: u64, session: &mut Session) -> Result<(), Failure> {
        let wanted = if stride == 1 {
            own
        } else {
            stride as f64 * own
        };
        if wanted.to_bits() != self.length.to_bits() {
            self.length = wanted;
            let paced = session.timed("factorise", || self.march.pace(wanted));
            paced.map_err(|error| failed(&error))?;
        }
        Ok(())
    }

    fn ended(&self) -> bool {
        self.taken == self.steps.count()
    }

    fn status(&self, time: f64) -> Vec<(&'static str, f64, &'static str)> {
        vec![
            ("time", time, "s"),
            ("step", self.length, "s"),
            ("products", self.effort.products as f64, "1"),
        ]
    }

    /// Tells what the march took.
    fn close(&self, session: &mut Session) {
        let steps = &self.steps;
        if let Some(adaptive) = &self.adaptive {
            let [taken, rejected] = adaptive.counts();
            session.steps(taken);
            session.closing("steps_rejected", "1", rejected as f64);
            let end = steps.end(steps.count()).0;
            session.closing("step_mean", "s", end / taken as f64);
        } else {
            session.steps(steps.count());
            session.closing("step", "s", steps.longest());
        }
        self.modes.tell(self.steps.longest(), session);
        session.closing("products_march", "1", self.effort.products as f64);
        session.closing("residual_march", "1", self.effort.residual);
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
    let steps = transient.steps(output);
    let wave = Wave::new(transient, &steps)?;
    judge(problem, &wave, &steps, session)?;
    let drive = session.timed("source", || problem.drive::<K>());
    let flux = problem.source.flux(&problem.cloud.position);
    let charges = problem.charges(session)?;
    let length = steps.step(0).1;
    let stage = stage(problem, &drive, charges.as_ref(), slope(length), session)?;
    let source: Vec<f64> = drive.source.as_flattened().iter().map(|a| a.re).collect();
    let unknowns = source.len() + charges.as_ref().map_or(0, |c| c.stencils.len());
    let march = March::new(stage, source, unknowns, length);
    let view = View {
        problem,
        drive: &drive,
        flux: &flux,
        charges: charges.as_ref(),
    };
    let wanted = transient.adaptive.as_ref();
    let mut run = Marching {
        adaptive: wanted.map(|a| Adaptive::new(a, length, problem.heating(), K, march.state())),
        growth: Growth::new(problem.heating(), K),
        modes: Modes::new(problem.slowest(), length, steps.end(steps.count()).0),
        points: K * problem.cloud.len(),
        march,
        wave,
        taken: 0,
        length,
        effort: Effort::default(),
        steps,
    };
    if let Some(mut checkpoint) = session.restored() {
        run.restore(&mut checkpoint)?;
    } else {
        write(0.0, view.fields(run.march.state(), 0.0, length).0, session)?;
    }
    let rule = problem.parameters.numerics.rule(None);
    while !run.ended() {
        let (time, written) = run.step(rule, problem.cloud, session)?;
        session.progress(run.taken, run.steps.count(), || run.status(time));
        if written {
            let (wave, state) = (run.wave.at(time)?, run.march.state());
            let (found, out) = session.timed("fields", || view.fields(state, wave, run.length));
            run.effort.lack.join(out);
            write(time, found, session)?;
        }
        if !run.ended() {
            session.keep(|checkpoint| run.save(checkpoint))?;
        }
    }
    problem.tell(run.effort.lack, session);
    run.close(session);
    let settled = run.march.settled();
    problem.told(settled.map(|s| s.with(run.effort.settled)), session);
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

fn failed(error: &dyn std::fmt::Display) -> Failure {
    Failure::Other(format!("eddy currents: {error}"))
}

/// What a march keeps, so that it goes on from a checkpoint.
impl Marching<'_> {
    /// Puts all that the rest depends on into a checkpoint.
    fn save(&self, checkpoint: &mut Checkpoint) -> artefact::Result<()> {
        let (march, effort) = (&self.march, self.effort);
        let Lack { largest, worst } = effort.lack;
        checkpoint.put_u64("count", &[self.taken, effort.products, worst.1 as u64]);
        checkpoint.put_f64("effort", &[effort.residual, largest, worst.0]);
        let (last, most, rises) = self.growth.seen;
        checkpoint.put_f64("growth", &[last, most, f64::from(rises)]);
        self.modes.save(checkpoint);
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
        if let Some(adaptive) = &self.adaptive {
            checkpoint.put_f64("length", &[self.length]);
            adaptive.save(&march.state().change, checkpoint);
        }
        Ok(())
    }

    /// Takes back what [`Marching::save`] put.
    fn restore(&mut self, checkpoint: &mut Checkpoint) -> Result<(), Failure> {
        let lacks = |what: &str| Failure::Other(format!("the checkpoint lacks a part{what}"));
        let wanted = self.march.state().unknown.len();
        let mut column = |name: &str| -> Result<Vec<f64>, Failure> {
            let values = checkpoint.f64(name)?;
            let whole = values.len() == wanted;
            whole
                .then_some(values)
                .ok_or_else(|| lacks(&format!(" of \"{name}\"")))
        };
        let (unknown, total) = (column("unknown")?, column("total")?);
        let (count, effort) = (checkpoint.u64("count")?, checkpoint.f64("effort")?);
        let (&[taken, products, place], &[residual, largest, worst]) = (&count[..], &effort[..])
        else {
            return Err(lacks(""));
        };
        let rescued = match checkpoint.u8("rescued")?[..] {
            [0] => None,
            [1] => Some(Rescue::Direct),
            [2] => Some(Rescue::Incomplete),
            _ => return Err(lacks(" of \"rescued\"")),
        };
        self.taken = taken;
        // What was rescued are the equations of the last step.
        let last = match &mut self.adaptive {
            None => self.steps.step(taken.max(1) - 1).1,
            Some(adaptive) => {
                self.march.set_rates(adaptive.restore(checkpoint)?);
                checkpoint
                    .f64("length")?
                    .first()
                    .copied()
                    .ok_or_else(|| lacks(""))?
            }
        };
        if last.to_bits() != self.length.to_bits() {
            self.length = last;
            self.march.pace(last).map_err(|error| failed(&error))?;
        }
        let restored = self.march.restore(unknown, total, rescued);
        restored.map_err(|error| failed(&error))?;
        if let &[last, most, rises] = &checkpoint.f64("growth")?[..] {
            self.growth.seen = (last, most, rises as u32);
        }
        self.modes.restore(checkpoint)?;
        self.effort = Effort {
            settled: match self.march.settled() {
                Some(_) => bodies::restored(checkpoint)?,
                None => Settled::default(),
            },
            products,
            residual,
            lack: Lack {
                largest,
                worst: (worst, place as usize),
            },
        };
        Ok(())
    }
}
