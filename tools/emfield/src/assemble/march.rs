//! Eddy currents of a scene in time: from rest to the end.

use artefact::Checkpoint;
use krylov::{Ending, Rescue, Solved};
use num_complex::Complex;
use run::property::{Arguments, Curve, Property};
use run::{Failure, Session};

use super::charge::{Charges, Lack, spread};
use super::growth::Growth;
use super::magnetic::Driven;
use super::saturated;
use super::setting::Setting;
use super::steps::Steps;
use super::unfit::no_stencil;
use crate::cloud::Cloud;
use crate::magnetic::charge::stage::Charged;
use crate::magnetic::driven::right::{Drive, pairs};
use crate::magnetic::fields::Solution;
use crate::magnetic::open::multipoles::Multipoles;
use crate::magnetic::stage::{Alone, Equations};
use crate::march::scheme::{March, Settled, Stage, State, slope};
use crate::output::Found;
use crate::scene::currents::{OuterReaction, Transient};
use crate::scene::{EddyCurrents, Scene};
use crate::stencils::sides::{Form, Sides};

type C = Complex<f64>;

/// Rates that solves leave, over their tolerance times potentials over a stage.
const NOISE: f64 = 1e3;

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
    let (steps, wave) = (Steps::new(transient, &scene.output), Wave::new(transient)?);
    let drive = session.timed("source", || setting.drive::<K>());
    let flux = setting.source.flux(&cloud.position);
    let charges = setting.charges(session)?;
    let mut length = steps.step(0).1;
    let stage = stage(&setting, &drive, (charges.as_ref(), slope(length)), session)?;
    let source: Vec<f64> = drive.source.as_flattened().iter().map(|a| a.re).collect();
    let unknowns = source.len() + charges.as_ref().map_or(0, |c| c.stencils.len());
    let mut march = March::new(stage, source, unknowns, length);
    let view = View {
        setting: &setting,
        drive: &drive,
        flux: &flux,
        charges: charges.as_ref(),
    };
    let mut growth = Growth::new(setting.heating());
    let (mut taken, mut effort) = (0, Effort::default());
    if let Some(mut checkpoint) = session.restored() {
        (taken, length, effort) = restore((&mut march, &mut growth), &steps, &mut checkpoint)?;
    } else {
        write(0.0, view.fields(march.state(), (0.0, length)).0, session)?;
    }
    let rule = super::rule(scene, None);
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
        let rates = (&march.state().change[..K * cloud.len()], K);
        growth.watch(rates, still, (taken, time), cloud)?;
        session.progress(taken, steps.count(), || {
            vec![
                ("time", time, "s"),
                ("step", length, "s"),
                ("products", effort.products as f64, "1"),
            ]
        });
        if written {
            let wave = wave.at(time)?;
            let (found, out) =
                session.timed("fields", || view.fields(march.state(), (wave, length)));
            effort.lack.join(out);
            write(time, found, session)?;
        }
        if taken < steps.count() {
            session.keep(|checkpoint| save((&march, &growth), taken, effort, checkpoint))?;
        }
    }
    setting.tell(effort.lack, session);
    close(&steps, effort, session);
    setting.told(march.settled().map(|s| s.with(effort.settled)), session);
    Ok(())
}

/// Tells what the march took.
fn close(steps: &Steps, effort: Effort, session: &mut Session) {
    session.steps(steps.count());
    session.closing("step", "s", steps.longest());
    session.closing("products_march", "1", effort.products as f64);
    session.closing("residual_march", "1", effort.residual);
}

/// What coils and applied fields are multiplied by.
struct Wave(Curve);

impl Wave {
    fn new(transient: &Transient) -> Result<Self, Failure> {
        let on = Property::Constant(1.0);
        let wave = transient.wave.as_ref().unwrap_or(&on);
        Ok(Self(wave.compile("/eddy_currents/transient/wave", &["t"])?))
    }

    /// Whether it has one value at start, middle and end of a step.
    fn stands(&self, from: f64, to: f64) -> Result<bool, Failure> {
        let start = self.at(from)?;
        let others = [self.at(0.5 * (from + to))?, self.at(to)?];
        Ok(others.iter().all(|w| w.to_bits() == start.to_bits()))
    }

    fn at(&self, time: f64) -> Result<f64, Failure> {
        let value = self.0.value(&Arguments::at([0.0; 3], time));
        value.map_err(|error| Failure::Other(format!("wave at {time:.6e} s: {error}")))
    }
}

/// The equations of a stage, ready for a slope: of A alone, or with charges.
///
/// # Errors
/// Where stencils cannot be made, or the equations have no solution.
pub(super) fn stage<'a, const D: usize, const K: usize>(
    setting: &'a Setting<'_, D>,
    drive: &Drive<K>,
    (charges, slope): (Option<&'a Charges>, f64),
    session: &mut Session,
) -> Result<Box<dyn Stage + 'a>, Failure> {
    let Some(charges) = charges else {
        let equations = equations(setting, drive, session)?;
        let made = session.timed("factorise", || Alone::new(equations, slope));
        let alone = Box::new(made.map_err(|error| failed(&error))?);
        return Ok(setting.saturated::<K>(alone, session));
    };
    let given: Vec<[f64; 3]> = charges.given.iter().map(|g| g.map(|g| g.re)).collect();
    let source: Vec<[f64; K]> = drive.source.iter().map(|a| a.map(|a| a.re)).collect();
    let with = (slope, super::options(setting.scene));
    let made = session.timed("factorise", || {
        let driven = (&spread(&source)[..], given);
        Charged::new(&charges.equations, driven, with)
    });
    let charged = Box::new(made.map_err(|error| failed(&error))?);
    Ok(setting.saturated::<K>(charged, session))
}

/// The equations of A alone, and what drives them.
fn equations<const D: usize, const K: usize>(
    setting: &Setting<'_, D>,
    drive: &Drive<K>,
    session: &mut Session,
) -> Result<Equations<K>, Failure> {
    let mut given = setting.given_rows::<K>();
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
    let low = low.transpose();
    let unfit =
        |error: wls::Error| no_stencil("eddy currents", &error, (setting.scene, setting.cloud));
    let held = |i| {
        let held = conductors.held(region, unknown, i);
        held.then(|| drive.held.map(|h| h.re))
    };
    let open = setting.currents.outer == OuterReaction::Multipole;
    let multipoles = open.then(|| Multipoles::new(region, &setting.weights));
    let bound = multipoles
        .iter()
        .flat_map(|all| setting.bound(all, &mut given));
    let bound = bound.collect();
    Ok(Equations {
        low: low.map_err(unfit)?,
        rates: session.timed("assemble", || conductors.rates(region, sides, unknown)),
        rows: session.timed("assemble", || conductors.rows(region, sides, unknown)),
        held: (0..region.len()).map(held).collect(),
        given: given.iter().map(|g| g.map(|g| g.re)).collect(),
        pairs: multipoles
            .iter()
            .flat_map(|all| pairs(conductors, (region, unknown), all))
            .collect(),
        bound,
        options: super::options(setting.scene),
    })
}

fn failed(error: &dyn std::fmt::Display) -> Failure {
    Failure::Other(format!("eddy currents: {error}"))
}

/// What fields of a state are made from.
pub(super) struct View<'a, const D: usize, const K: usize> {
    pub(super) setting: &'a Setting<'a, D>,
    pub(super) drive: &'a Drive<K>,
    /// Flux density of the sources where their wave is 1 \[T\].
    pub(super) flux: &'a [[C; 3]],
    pub(super) charges: Option<&'a Charges>,
}

impl<const D: usize, const K: usize> View<'_, D, K> {
    /// Columns and totals of a state, with the wave then and the step before it \[s\]; and how far fields point out of
    /// conductors.
    pub(super) fn fields(&self, state: &State, (wave, step): (f64, f64)) -> (Found, Lack) {
        let Self { setting, drive, .. } = *self;
        let real = |values: &[f64]| -> Vec<[C; K]> {
            let points = values.as_chunks::<K>().0.iter();
            let points = points.take(setting.region.len());
            points.map(|v| v.map(C::from)).collect()
        };
        let source: Vec<[C; K]> = drive.source.iter().map(|a| a.map(|a| a * wave)).collect();
        let flux: Vec<[C; 3]> = self.flux.iter().map(|b| b.map(|b| b * wave)).collect();
        let mut change = real(&state.change);
        let charges = self.charges.filter(|charges| charges.charged());
        let charged = charges.map(|charges| {
            let potential = |phi: &[f64]| -> Vec<C> {
                let whole = charges.equations.whole(phi);
                whole.into_iter().map(C::from).collect()
            };
            let phi = potential(&state.change[K * setting.region.len()..]);
            let voltage = potential(&state.following);
            setting.charged(&charges.stencils, (&phi, &voltage), &mut change)
        });
        // What solves leave is no field.
        let most = state.total.iter().fold(0.0, |m: f64, a| m.max(a.abs()));
        let least = NOISE * setting.scene.solver.tolerance * slope(step) * most;
        let lack = setting.lack(&change, least);
        let solution = Solution {
            found: &real(&state.unknown),
            source: &source,
            change: &change,
            waves: None,
        };
        let windings = setting.windings.as_ref().map(|w| w.times(wave));
        let driven = Driven {
            source: &setting.source.times(wave),
            flux: &flux,
            windings: windings.as_ref(),
        };
        (setting.found(solution, charged.as_ref(), driven), lack)
    }
}

/// Puts all that the rest of a march depends on into a checkpoint.
fn save(
    (march, growth): (&March<'_>, &Growth),
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
        saturated::save(settled.with(effort.settled), checkpoint);
    }
    checkpoint.put_f64("unknown", &march.state().unknown);
    checkpoint.put_f64("total", &march.state().total);
    Ok(())
}

/// Takes back what [`save`] put: the steps taken, the length of the last one \[s\] and the effort.
fn restore(
    (march, growth): (&mut March<'_>, &mut Growth),
    steps: &Steps,
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
    let reached = (column("unknown")?, column("total")?);
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
        .restore(reached, rescued)
        .map_err(|error| failed(&error))?;
    if let &[last, most, rises] = &checkpoint.f64("growth")?[..] {
        growth.seen = (last, most, rises as u32);
    }
    let settled = match march.settled() {
        Some(_) => saturated::restored(checkpoint)?,
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
