//! The march of drops that meet and part.

use artefact::{Checkpoint, Precision};
use run::{Failure, Session};

use super::course::Course;
use super::ledger::{Counts, Ledger};
use crate::assemble::liquid::groups::{groups as drops, rule};
use crate::assemble::liquid::matter::{matter, way};
use crate::assemble::liquid::{fastest, filled, start, steps};
use crate::liquid::effort::failed;
use crate::liquid::groups::{Group, Groups, Parcel, Rule, Seen, chosen};
use crate::liquid::step::{Ended, Liquid, Matter, Step, Way};
use crate::liquid::told;
use crate::liquid::vector::along;
use crate::march::steps::Steps;
use crate::scene::{Groups as Given, Liquid as Part, LiquidMarch, Scene};

/// Spacings that a point may move in a step; longer ones are divided.
const FARTHEST: f64 = 0.5;
/// Parts into which a step is divided at most.
const MOST: f64 = 500.0;
/// Steps, and their length over that of others, in which the flow of drops that have met becomes free of divergence.
const SETTLES: usize = 8;
const SHORT: f64 = 1e-3;

/// Rise of the energy, over that at the start, that is told, and that ends a march.
const RISEN: f64 = 0.01;
const BURST: f64 = 1.0;

/// Drops that are marched.
struct March {
    matter: Matter<3>,
    way: Way,
    rule: Rule,
    precision: Precision,
    course: Course,
    groups: Groups,
    counts: Counts,
    ledger: Ledger,
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
            self.groups.fly(&self.matter.gravity, part);
            session.timed("groups", || self.regroup(part))?;
            seen.clear();
            self.groups.each(|group| {
                seen.push(group.keep(spacing)?);
                Ok(())
            })?;
        }
        Ok(seen)
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
        let before = self.counts;
        self.counts.joined += self.groups.join(&self.rule, &self.way)?;
        self.counts.closed += self.groups.close(&self.rule, &self.way)?;
        self.counts.taken += self.groups.take_up(&self.way)?;
        if self.counts.joined > before.joined {
            let step = Step {
                way: &self.way,
                dt: SHORT * length,
            };
            let (effort, matter) = (&mut self.course.effort, &self.matter);
            self.groups.each(|group| {
                group.keep(step.way.spacing)?;
                for _ in 0..SETTLES {
                    group.liquid.advance(matter, step, effort)?;
                }
                // What a short step takes away at once is no rate for a long one.
                group.liquid.balance(matter, step.way, effort)?;
                Ok(())
            })?;
        }
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
        session.record("/liquid", time, &totals.row())?;
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
        session.frame("/groups", time, &self.groups.frame(self.precision))
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
    liquid.quiet(matter, step).map_err(|e| failed(&e))?;
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
    fn save(&self, checkpoint: &mut Checkpoint) {
        let Groups { drops, parcels } = &self.groups;
        let all = self.groups.together();
        self.course.save(&all.liquid, checkpoint);
        let sizes = drops.iter().map(|g| &g.liquid);
        let sizes = sizes.flat_map(|l| [l.surface() as u64, l.position.len() as u64]);
        checkpoint.put_u64("sizes", &sizes.collect::<Vec<_>>());
        let Counts {
            joined,
            closed,
            parted,
            taken,
        } = self.counts;
        checkpoint.put_u64("groups", &[joined, closed, parted, taken]);
        let Ledger {
            first,
            least,
            rise,
            strewn,
        } = self.ledger;
        checkpoint.put_f64("ledger", &[first, least, rise, strewn]);
        let kept = drops.iter().map(Group::parcel);
        let numbers = kept.chain(parcels.iter().copied()).flat_map(|p| {
            let ([x, y, z], [a, b, c]) = (p.centre, p.drift);
            [p.volume, x, y, z, a, b, c]
        });
        checkpoint.put_f64("kept", &numbers.collect::<Vec<_>>());
    }

    fn restore(&mut self, checkpoint: &mut Checkpoint) -> Result<(), Failure> {
        let Some(first) = self.groups.drops.first() else {
            return Ok(());
        };
        let mut all = first.liquid.clone();
        self.course.restore(&mut all, checkpoint)?;
        if let [joined, closed, parted, taken] = checkpoint.u64("groups")?[..] {
            self.counts = Counts {
                joined,
                closed,
                parted,
                taken,
            };
        }
        if let [first, least, rise, strewn] = checkpoint.f64("ledger")?[..] {
            self.ledger = Ledger {
                first,
                least,
                rise,
                strewn,
            };
        }
        let sizes = checkpoint.u64("sizes")?;
        let kept = checkpoint.f64("kept")?;
        self.groups = Groups::default();
        let parcels = kept.as_chunks::<7>().0.iter();
        let parcels = parcels.map(|&[volume, x, y, z, a, b, c]| Parcel {
            volume,
            centre: [x, y, z],
            drift: [a, b, c],
        });
        let (mut on, mut inside) = (0, all.surface());
        let sizes = sizes.as_chunks::<2>().0;
        for (k, parcel) in parcels.enumerate() {
            let Some(&[surface, count]) = sizes.get(k) else {
                self.groups.parcels.push(parcel);
                continue;
            };
            let (surface, inner) = (surface as usize, (count - surface) as usize);
            let liquid = chosen(
                &all,
                (on..on + surface).collect(),
                (inside..inside + inner).collect(),
            );
            (on, inside) = (on + surface, inside + inner);
            self.groups.drops.push(Group {
                liquid,
                volume: parcel.volume,
                centre: parcel.centre,
                drift: parcel.drift,
            });
        }
        Ok(())
    }

    fn close(&self, steps: &Steps, session: &mut Session) {
        self.course.close(steps, "m3", session);
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
}
