//! Eddy currents of a scene in time: from rest to the end.

use artefact::Checkpoint;
use krylov::{Ending, Rows, Solved, System};
use num_complex::Complex;
use run::property::{Arguments, Curve, Property};
use run::{Failure, Session};

use super::currents::Setting;
use super::magnetic::Driven;
use super::steps::Steps;
use crate::cloud::Cloud;
use crate::output::Found;
use crate::scene::currents::{OuterReaction, Transient};
use crate::scene::{EddyCurrents, Scene};
use crate::solve::eddy::{Drive, Solution, pairs};
use crate::solve::march::{Forcing, March, State, shift};
use crate::solve::multipole::Multipoles;
use crate::solve::sides::{Form, Sides};

type C = Complex<f64>;

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
    let steps = Steps::new(transient, &scene.output);
    let wave = Wave::new(transient)?;
    let drive = session.timed("source", || setting.drive::<K>());
    let flux = setting.source.flux(&cloud.position);
    let equations = Equations::new(&setting, session)?;
    let mut length = steps.step(0).1;
    let system = equations.system(&setting, length, session)?;
    let forcing = forcing(&setting, &drive);
    let mut march = March::new(system, equations.rates.clone(), forcing, length);
    let (mut taken, mut effort) = (0, Effort::default());
    if let Some(mut checkpoint) = session.restored() {
        (taken, effort) = restore(&mut march, &mut checkpoint)?;
    } else {
        write(
            0.0,
            fields(&setting, &drive, march.state(), (0.0, &flux)),
            session,
        )?;
    }
    let rule = super::rule(scene, None);
    while taken < steps.count() {
        let (from, wanted) = steps.step(taken);
        if wanted.to_bits() != length.to_bits() {
            length = wanted;
            march.pace(equations.system(&setting, length, session)?, length);
        }
        let solved = session.timed("march", || march.advance(from, |t| wave.at(t), rule))?;
        taken += 1;
        let (time, written) = steps.end(taken);
        effort.add(time, &solved, session)?;
        session.progress(taken, steps.count(), || {
            vec![
                ("time", time, "s"),
                ("step", length, "s"),
                ("products", effort.products as f64, "1"),
            ]
        });
        if written {
            let wave = wave.at(time)?;
            let found = session.timed("fields", || {
                fields(&setting, &drive, march.state(), (wave, &flux))
            });
            write(time, found, session)?;
        }
        if taken < steps.count() {
            session.keep(|checkpoint| save(march.state(), taken, effort, checkpoint))?;
        }
    }
    session.steps(steps.count());
    session.closing("step", "s", steps.longest());
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

/// What the rows of a march hold whatever its step.
struct Equations {
    rates: Vec<f64>,
    rows: Rows<f64>,
    /// Rows of low order, which precondition those of high order.
    low: Option<Rows<f64>>,
}

impl Equations {
    fn new<const D: usize>(
        setting: &Setting<'_, D>,
        session: &mut Session,
    ) -> Result<Self, Failure> {
        let (region, sides, unknown) = (&setting.region, &setting.sides, setting.unknown);
        let conductors = &setting.conductors;
        let low = super::low_order(setting.scene, region.len()).map(|low| {
            let low = Form {
                around: unknown.around(),
                ..low
            };
            let sides = session.timed("weights", || Sides::new(region, &low))?;
            Ok(conductors.rows(region, &sides, unknown))
        });
        Ok(Self {
            low: low
                .transpose()
                .map_err(|error: wls::Error| failed(&error))?,
            rates: session.timed("assemble", || conductors.rates(region, sides, unknown)),
            rows: session.timed("assemble", || conductors.rows(region, sides, unknown)),
        })
    }

    /// The equations of a step of this length \[s\], factorised.
    fn system<const D: usize>(
        &self,
        setting: &Setting<'_, D>,
        step: f64,
        session: &mut Session,
    ) -> Result<System<f64, f64>, Failure> {
        let (shift, options) = (shift(&self.rates, step), super::options(setting.scene));
        let rows = self.rows.clone();
        let system = session.timed("factorise", || match &self.low {
            Some(low) => System::with_low_order(rows, shift, low.clone(), options),
            None => System::new(rows, shift, options),
        });
        system.map_err(|error| failed(&error))
    }
}

/// What drives a march.
fn forcing<const D: usize, const K: usize>(
    setting: &Setting<'_, D>,
    drive: &Drive<K>,
) -> Forcing<K> {
    let (region, unknown) = (&setting.region, setting.unknown);
    let conductors = &setting.conductors;
    let held = |i| {
        let held = conductors.held(region, unknown, i);
        held.then(|| drive.held.map(|h| h.re))
    };
    Forcing {
        source: drive.source.iter().map(|a| a.map(|a| a.re)).collect(),
        held: (0..region.len()).map(held).collect(),
        given: setting.wound().iter().map(|g| g.map(|g| g.re)).collect(),
        pairs: if setting.currents.outer == OuterReaction::Multipole {
            let multipoles = Multipoles::new(region, &setting.weights);
            pairs(conductors, (region, unknown), &multipoles)
        } else {
            Vec::new()
        },
    }
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
) -> Found {
    let real =
        |values: &[[f64; K]]| -> Vec<[C; K]> { values.iter().map(|v| v.map(C::from)).collect() };
    let source: Vec<[C; K]> = drive.source.iter().map(|a| a.map(|a| a * wave)).collect();
    let flux: Vec<[C; 3]> = flux.iter().map(|b| b.map(|b| b * wave)).collect();
    let solution = Solution {
        found: &real(&state.unknown),
        source: &source,
        change: &real(&state.change),
    };
    let windings = setting.windings.as_ref().map(|w| w.times(wave));
    let driven = Driven {
        source: &setting.source.times(wave),
        flux: &flux,
        windings: windings.as_ref(),
    };
    setting.found(solution, None, driven)
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
