//! Eddy currents of a scene in time: from rest to the end in even steps.

use artefact::Checkpoint;
use krylov::{Ending, Solved, System};
use num_complex::Complex;
use run::property::{Arguments, Curve, Property};
use run::{Failure, Session};

use super::currents::Setting;
use crate::cloud::Cloud;
use crate::output::Found;
use crate::scene::currents::{OuterReaction, Transient};
use crate::scene::{EddyCurrents, Scene};
use crate::solve::eddy::{Drive, Solution, pairs};
use crate::solve::march::{Forcing, March, State, shift};
use crate::solve::multipole::Multipoles;
use crate::solve::sides::Sides;

type C = Complex<f64>;

/// Part of a step that counts as rounding where steps and instants are compared.
const ROUNDING: f64 = 1e-6;

/// Even steps, and those after which fields are written.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Steps {
    count: u64,
    length: f64,
    every: Option<f64>,
}

impl Steps {
    /// Steps of at most the length that is asked for.
    fn new(transient: &Transient, every: Option<f64>) -> Self {
        let count = (transient.end_s / transient.step_s - ROUNDING)
            .ceil()
            .max(1.0);
        Self {
            count: count as u64,
            length: transient.end_s / count,
            every,
        }
    }

    /// The instant after so many steps \[s\].
    fn time(&self, taken: u64) -> f64 {
        self.length * taken as f64
    }

    /// Are fields written after so many steps?
    fn written(&self, taken: u64) -> bool {
        let passed = |every: f64, taken: u64| (self.time(taken) / every + ROUNDING).floor();
        let due = |every: f64| passed(every, taken) > passed(every, taken - 1);
        taken == self.count || self.every.is_some_and(due)
    }
}

/// What solves of a march have taken.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Effort {
    products: u64,
    residual: f64,
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
                other => session.warn(format!("eddy currents: {other}")),
            }
        }
        Ok(())
    }
}

/// Marches the eddy currents of a scene from rest to the end, in `D` coordinates with `K` unknowns a point: 3 in space,
/// else 1. `write` gets instants \[s\] and what is found there.
///
/// # Errors
/// Where a stencil cannot be made, a solve breaks down, the user interrupts, or those of `write`.
pub fn march<const D: usize, const K: usize>(
    scene: &Scene,
    (currents, transient): (&EddyCurrents, &Transient),
    cloud: &Cloud,
    session: &mut Session,
    mut write: impl FnMut(f64, Found, &mut Session) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let setting: Setting<'_, D> = Setting::new(scene, currents, cloud, session)?;
    let steps = Steps::new(transient, scene.output.every_s);
    let wave = Wave::new(transient)?;
    let drive = session.timed("source", || setting.drive::<K>());
    let flux = setting.source.flux(&cloud.position);
    let mut march = begin(&setting, &drive, steps.length, session)?;
    let (mut taken, mut effort) = (0, Effort::default());
    if let Some(mut checkpoint) = session.restored() {
        (taken, effort) = restore(&mut march, &mut checkpoint)?;
    }
    let rule = super::rule(scene);
    while taken < steps.count {
        let from = steps.time(taken);
        let solved = session.timed("march", || march.advance(from, |t| wave.at(t), rule))?;
        taken += 1;
        let time = steps.time(taken);
        effort.add(time, &solved, session)?;
        session.progress(taken, steps.count, || {
            vec![
                ("time", time, "s"),
                ("step", steps.length, "s"),
                ("products", effort.products as f64, "1"),
            ]
        });
        if steps.written(taken) {
            let found = session.timed("fields", || {
                fields(&setting, &drive, march.state(), (wave.at(time)?, &flux))
            })?;
            write(time, found, session)?;
        }
        if taken < steps.count {
            session.keep(|checkpoint| save(march.state(), taken, effort, checkpoint))?;
        }
    }
    session.steps(steps.count);
    session.closing("step", "s", steps.length);
    session.closing("products_march", "1", effort.products as f64);
    session.closing("residual_march", "1", effort.residual);
    Ok(())
}

/// What coils and applied fields are multiplied by.
struct Wave(Curve);

impl Wave {
    fn new(transient: &Transient) -> Result<Self, Failure> {
        let on = Property::Constant(1.0);
        let wave = transient.wave.as_ref().unwrap_or(&on);
        Ok(Self(wave.compile("/eddy_currents/transient/wave", &["t"])?))
    }

    fn at(&self, time: f64) -> Result<f64, Failure> {
        let value = self.0.value(&Arguments::at([0.0; 3], time));
        value.map_err(|error| Failure::Other(format!("wave at {time:.6e} s: {error}")))
    }
}

/// A march at rest, its equations factorised.
fn begin<const D: usize, const K: usize>(
    setting: &Setting<'_, D>,
    drive: &Drive<K>,
    step: f64,
    session: &mut Session,
) -> Result<March<K>, Failure> {
    let (region, sides, unknown) = (&setting.region, &setting.sides, setting.unknown);
    let conductors = &setting.conductors;
    let (rates, rows) = session.timed("assemble", || {
        let rates = conductors.rates(region, sides, unknown);
        (rates, conductors.rows(region, sides, unknown))
    });
    let low = super::low_order(setting.scene, region.len()).map(|low| {
        let sides = session.timed("weights", || Sides::new(region, &low))?;
        Ok(conductors.rows(region, &sides, unknown))
    });
    let low = low
        .transpose()
        .map_err(|error: wls::Error| failed(&error))?;
    let held = |i| {
        let held = conductors.held(region, unknown, i);
        held.then(|| drive.held.map(|h| h.re))
    };
    let forcing = Forcing {
        source: drive.source.iter().map(|a| a.map(|a| a.re)).collect(),
        held: (0..region.len()).map(held).collect(),
        pairs: if setting.currents.outer == OuterReaction::Multipole {
            let multipoles = Multipoles::new(region, &setting.weights);
            pairs(conductors, (region, unknown), &multipoles)
        } else {
            Vec::new()
        },
    };
    let (shift, options) = (shift(&rates, step), super::options(setting.scene));
    let system = session.timed("factorise", || match low {
        Some(low) => System::with_low_order(rows, shift, low, options),
        None => System::new(rows, shift, options),
    });
    let system = system.map_err(|error| failed(&error))?;
    Ok(March::new(system, rates, forcing, step))
}

fn failed(error: &dyn std::fmt::Display) -> Failure {
    Failure::Other(format!("eddy currents: {error}"))
}

/// Columns and totals of a state, with the wave then and the flux density of the sources where it is 1.
fn fields<const D: usize, const K: usize>(
    setting: &Setting<'_, D>,
    drive: &Drive<K>,
    state: &State<K>,
    (wave, flux): (f64, &[[C; 3]]),
) -> Result<Found, Failure> {
    let real =
        |values: &[[f64; K]]| -> Vec<[C; K]> { values.iter().map(|v| v.map(C::from)).collect() };
    let source: Vec<[C; K]> = drive.source.iter().map(|a| a.map(|a| a * wave)).collect();
    let flux: Vec<[C; 3]> = flux.iter().map(|b| b.map(|b| b * wave)).collect();
    let solution = Solution {
        found: &real(&state.unknown),
        source: &source,
        change: &real(&state.change),
    };
    Ok(setting.found(solution, &flux, &setting.source.times(wave)))
}

/// Puts all that the rest of a march depends on into a checkpoint.
fn save<const K: usize>(
    state: &State<K>,
    taken: u64,
    effort: Effort,
    checkpoint: &mut Checkpoint,
) -> artefact::Result<()> {
    checkpoint.put_u64("count", &[taken, effort.products]);
    checkpoint.put_f64("residual", &[effort.residual]);
    checkpoint.put_f64("unknown", state.unknown.as_flattened());
    checkpoint.put_f64("total", state.total.as_flattened());
    checkpoint.put_f64("change", state.change.as_flattened());
    Ok(())
}

/// Takes back what [`save`] put.
fn restore<const K: usize>(
    march: &mut March<K>,
    checkpoint: &mut Checkpoint,
) -> Result<(u64, Effort), Failure> {
    let mut column = |name: &str| -> Result<Vec<[f64; K]>, Failure> {
        let values = checkpoint.f64(name)?;
        let (parts, _) = values.as_chunks::<K>();
        if parts.len() == march.state().unknown.len() {
            Ok(parts.to_vec())
        } else {
            Err(Failure::Other(format!(
                "the checkpoint lacks a part of \"{name}\""
            )))
        }
    };
    let state = State {
        unknown: column("unknown")?,
        total: column("total")?,
        change: column("change")?,
    };
    let (count, residual) = (checkpoint.u64("count")?, checkpoint.f64("residual")?);
    let (&[taken, products], &[residual]) = (&count[..], &residual[..]) else {
        return Err(Failure::Other("the checkpoint lacks a part".to_owned()));
    };
    march.restore(state);
    Ok((taken, Effort { products, residual }))
}
