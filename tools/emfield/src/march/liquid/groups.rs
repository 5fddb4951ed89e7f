//! The march of drops that meet and part.

use artefact::Precision;
use run::{Failure, Session};
use steps::Legs;

use super::acting::Acting;
use super::course::Course;
use super::ledger::{Counts, Ledger};
use crate::assemble::liquid::groups::{groups as drops, rule};
use crate::assemble::liquid::matter::{matter, way};
use crate::assemble::liquid::{fastest, filled, start, steps};
use crate::liquid::effort::failed;
use crate::liquid::groups::{Groups, Parcel, Rule, Seen};
use crate::liquid::step::{Ended, Liquid, Matter, Step, Way};
use crate::liquid::told;
use crate::liquid::vector::{along, length};
use crate::scene::{Groups as Given, Liquid as Part, LiquidMarch, Scene};

/// Spacings that a point may move in a step; longer ones are divided.
const FARTHEST: f64 = 0.5;
/// Parts into which a step is divided at most.
const MOST: f64 = 500.0;
/// Steps, and their length over that of others, in which the flow of drops that have met becomes free of divergence.
const SETTLES: usize = 8;
const SHORT: f64 = 1e-3;

/// Least share of their fits that velocities take over in a step: what it damps grows by a part in each step, however short it is.
const QUIET: f64 = 0.4;

/// Rise of the energy, over that at the start, that is told, and that ends a march.
const RISEN: f64 = 0.01;
const BURST: f64 = 1.0;
/// What may be taken from the flow before it is told, over the same.
const TAKEN: f64 = 0.02;

/// Drops that are marched.
pub(super) struct March {
    matter: Matter<3>,
    pub(super) way: Way,
    rule: Rule,
    precision: Precision,
    pub(super) course: Course,
    pub(super) groups: Groups,
    pub(super) counts: Counts,
    pub(super) ledger: Ledger,
    /// Fields that act on them.
    pub(super) acting: Acting,
}

/// Moves the drops of a scene from their start to the end.
///
/// # Errors
/// Where the user interrupts, or the disk refuses.
pub(crate) fn groups(
    scene: &Scene,
    part: &Part,
    given: &Given,
    marched: &LiquidMarch,
    session: &mut Session,
) -> Result<(), Failure> {
    let filled = session.timed("points", || filled(scene, part))?;
    let liquid = start(part, filled)?;
    let steps = steps(scene, part, marched, &liquid);
    let mut march = March {
        matter: matter(part),
        way: way(scene, part),
        rule: rule(given),
        precision: scene.output.precision.into(),
        course: Course::default(),
        groups: drops(scene, part, &liquid)?,
        counts: Counts::default(),
        ledger: Ledger::default(),
        acting: Acting::new(scene, part, &liquid, session)?,
    };
    if let Some(mut checkpoint) = session.restored() {
        march.restore(&mut checkpoint)?;
    } else {
        march.begin(session)?;
    }
    while march.course.taken < steps.count() {
        let (_, length) = steps.step(march.course.taken);
        let seen = match march.step(length, session) {
            Ok(seen) => seen,
            // What is written stays; what would follow is not known.
            Err(Failure::Other(why)) => {
                let taken = march.course.taken;
                let time = if taken == 0 { 0.0 } else { steps.end(taken).0 };
                session.warn(format!("the march ended at {time:.6e} s: {why}"));
                break;
            }
            Err(other) => return Err(other),
        };
        march.course.taken += 1;
        let (time, written) = steps.end(march.course.taken);
        march.tell(&seen, time, session)?;
        if march.ledger.risen() > BURST {
            session.warn(format!(
                "the march ended at {time:.6e} s: points no longer resolve the flow"
            ));
            break;
        }
        if written {
            march.write(&seen, time, session)?;
        }
        session.progress(march.course.taken, steps.count(), || {
            vec![
                ("time", time, "s"),
                ("drops", march.groups.drops.len() as f64, "1"),
                ("fastest", march.fastest(), "m/s"),
            ]
        });
        if march.course.taken < steps.count() {
            session.keep(|checkpoint| {
                march.save(checkpoint);
                Ok(())
            })?;
        }
    }
    march.close(&steps, session);
    Ok(())
}

impl March {
    /// Drops at their start, and their pressure.
    fn begin(&mut self, session: &mut Session) -> Result<(), Failure> {
        let mut seen = Vec::new();
        for group in &mut self.groups.drops {
            let effort = &mut self.course.effort;
            group.liquid.balance(&self.matter, &self.way, effort)?;
            let first = group.seen(self.way.spacing)?;
            group.starts(&first);
            seen.push(first);
        }
        if let Some(applied) = self.acting.applied() {
            self.groups.charge(applied.charge);
            self.pull(&seen, 0.0, session)?;
            for group in &mut self.groups.drops {
                let effort = &mut self.course.effort;
                group.liquid.balance(&self.matter, &self.way, effort)?;
            }
        }
        self.tell(&seen, 0.0, session)?;
        self.write(&seen, 0.0, session)
    }

    /// One step: drops move, meet, take up and part; the surfaces then.
    fn step(&mut self, length: f64, session: &mut Session) -> Result<Vec<Seen>, Failure> {
        let spacing = self.way.spacing;
        let parts = (self.fastest() * length / (FARTHEST * spacing))
            .ceil()
            .max(1.0);
        if parts > MOST {
            return Err(failed(&format!(
                "points would pass {:.0} spacings in a step; take a smaller spacing",
                parts * FARTHEST
            )));
        }
        if parts > 1.0 {
            self.course.divided += 1;
            session.substepped();
        }
        let (mut seen, part) = (Vec::new(), length / parts);
        for _ in 0..parts as u64 {
            self.flow(part, session)?;
            self.fly(part);
            session.timed("groups", || self.regroup(part))?;
            seen.clear();
            self.groups.each(|group| {
                seen.push(group.keep(spacing)?);
                Ok(())
            })?;
            self.pull(&seen, part, session)?;
            self.keep_down(&seen);
        }
        Ok(seen)
    }

    /// Counts the momentum that was put back. Where no field works on the drops, takes from their flow what the energies rose by.
    fn keep_down(&mut self, seen: &[Seen]) {
        let density = self.matter.density;
        for (group, seen) in self.groups.drops.iter().zip(seen) {
            self.course.pushed += density * group.volume * length(&seen.pushed);
        }
        if self.acting.any() {
            return;
        }
        let totals = self.groups.totals(seen, &self.matter);
        let excess = totals.energy() - self.ledger.least;
        let taken = self.groups.calm(seen, density, excess);
        self.ledger.calmed(totals.energy(), taken);
    }

    /// Moves parcels under gravity and in the applied field.
    fn fly(&mut self, dt: f64) {
        let Matter {
            density, gravity, ..
        } = self.matter;
        let field = self.acting.applied().map_or([0.0; 3], |a| a.field);
        let pulled = |p: &Parcel| along(&gravity, p.charge / (density * p.volume), &field);
        self.groups.fly(pulled, dt);
    }

    /// What a field does where the drops are, `passed` after the last time \[s\].
    fn pull(&mut self, seen: &[Seen], passed: f64, session: &mut Session) -> Result<(), Failure> {
        let Some(applied) = self.acting.applied().filter(|_| !seen.is_empty()) else {
            return Ok(());
        };
        let together = self.groups.together();
        let mut all = together.liquid;
        let patches = seen.iter().flat_map(|s| &s.patches);
        all.normal = patches.map(|p| p.normal).collect();
        self.acting.part(self.groups.surfaces(together.group, seen));
        let (way, effort) = (&self.way, &mut self.course.effort);
        let (step, density) = (Step { way, dt: passed }, self.matter.density);
        (self.acting).pull(&mut all, step, [0.0; 3], effort, session)?;
        self.groups.feel(&all);
        let power = (self.groups).drive(seen, &applied.field, density, passed);
        self.ledger.work(power, passed);
        Ok(())
    }

    /// Moves each drop.
    fn flow(&mut self, dt: f64, session: &mut Session) -> Result<(), Failure> {
        let (course, matter) = (&mut self.course, &self.matter);
        let step = Step { way: &self.way, dt };
        self.groups.each(|group| {
            let advanced = || moved(&mut group.liquid, matter, step, course);
            session.timed("step", advanced)?;
            // What comes next needs its surface.
            group
                .liquid
                .skin(step.way.spacing)
                .map_err(|e| failed(&e))?;
            let mean = along(&group.drift, 0.5 * dt, &matter.gravity);
            group.centre = along(&group.centre, dt, &mean);
            group.drift = along(&group.drift, dt, &matter.gravity);
            Ok(())
        })
    }

    /// Lets drops meet, take up parcels and part. The flow of those that met becomes free of divergence.
    fn regroup(&mut self, length: f64) -> Result<(), Failure> {
        self.counts.joined += self.groups.join(&self.rule, &self.way)?;
        self.counts.closed += self.groups.close(&self.rule, &self.way)?;
        self.counts.taken += self.groups.take_up(&self.way)?;
        let step = Step {
            way: &self.way,
            dt: SHORT * length,
        };
        let (effort, matter) = (&mut self.course.effort, &self.matter);
        self.groups.each(|group| {
            if !std::mem::take(&mut group.met) {
                return Ok(());
            }
            group.keep(step.way.spacing)?;
            for _ in 0..SETTLES {
                group.liquid.advance(matter, step, effort)?;
            }
            // What a short step takes away at once is no rate for a long one.
            group.liquid.balance(matter, step.way, effort)?;
            Ok(())
        })?;
        self.counts.parted += self.groups.part(&self.rule, &self.way)?;
        Ok(())
    }

    fn fastest(&self) -> f64 {
        let drops = self.groups.drops.iter().map(|g| fastest(&g.liquid));
        drops.fold(0.0, f64::max)
    }

    /// Writes a row.
    fn tell(&mut self, seen: &[Seen], time: f64, session: &mut Session) -> Result<(), Failure> {
        let totals = self.groups.totals(seen, &self.matter);
        self.ledger.look(&totals);
        let mut row = totals.row();
        if self.acting.any() {
            row = row.with("field_work", "J", self.ledger.work);
        }
        session.record("/liquid", time, &row)?;
        Ok(())
    }

    fn write(&self, seen: &[Seen], time: f64, session: &mut Session) -> Result<(), Failure> {
        if !self.groups.drops.is_empty() {
            let all = self.groups.together();
            let points = told::points(&all.liquid, &self.matter, &[], self.precision);
            session.frame("/points", time, &points.id("group", all.group))?;
            let patches: Vec<_> = seen.iter().flat_map(|s| s.patches.clone()).collect();
            let surface = told::surface(&all.liquid, &patches, self.precision);
            session.frame("/surface", time, &surface)?;
        }
        let charged = self.acting.applied().is_some_and(|a| a.conducts());
        let frame = self.groups.frame(charged, self.precision);
        session.frame("/groups", time, &frame)
    }
}

/// Moves the points of a drop.
fn moved(
    liquid: &mut Liquid<3>,
    matter: &Matter<3>,
    step: Step<'_>,
    course: &mut Course,
) -> Result<(), Failure> {
    let ended = liquid.advance(matter, step, &mut course.effort)?;
    if liquid.loose() {
        liquid.quiet(matter, step, QUIET).map_err(|e| failed(&e))?;
    }
    let Ended {
        rows,
        images,
        patches,
        ..
    } = &ended;
    liquid.smooth(patches, images);
    liquid.spread(rows, images, patches, step.way.spacing);
    course.renewed.add(liquid.renew(step.way)?);
    Ok(())
}

impl March {
    fn close(&self, steps: &Legs, session: &mut Session) {
        self.course.close(steps, "m3", session);
        self.course.tell_momentum(session);
        self.acting.close(&self.course.effort, session);
        session.closing("drops", "1", self.groups.drops.len() as f64);
        session.closing("parcels", "1", self.groups.parcels.len() as f64);
        session.closing("drops_joined", "1", self.counts.joined as f64);
        session.closing("sheets_closed", "1", self.counts.closed as f64);
        session.closing("drops_parted", "1", self.counts.parted as f64);
        session.closing("parcels_taken_up", "1", self.counts.taken as f64);
        session.closing("points_added", "1", self.course.renewed.added as f64);
        session.closing("points_merged", "1", self.course.renewed.merged as f64);
        let Ledger { strewn, .. } = self.ledger;
        session.closing("strewn", "1", strewn);
        if strewn > 0.0 {
            session.warn(format!(
                "up to {:.2} % of the liquid were parcels without a shape: drops too small for points, or what had become thinner than about {} spacings; a smaller spacing resolves more of it",
                100.0 * strewn,
                2.0 * self.rule.part
            ));
        }
        self.tell_taken(session);
        let risen = self.ledger.risen();
        session.closing("energy_rise", "1", risen);
        if risen > RISEN {
            session.warn(format!(
                "the sum of the energies rose by {:.2} % of what it was at first: points do not resolve the flow; take a smaller spacing",
                100.0 * risen
            ));
        }
        for doubt in self.course.effort.doubts() {
            session.warn(doubt);
        }
    }

    /// Tells what was taken from the flow so that the energies do not rise.
    fn tell_taken(&self, session: &mut Session) {
        if self.acting.any() {
            return;
        }
        let taken = self.ledger.taken();
        session.closing("energy_taken", "1", taken);
        if taken > TAKEN {
            session.warn(format!(
                "{:.1} % of the energies at first was taken from the flow, since new points and fits had added it: take a smaller spacing",
                100.0 * taken
            ));
        }
    }
}
