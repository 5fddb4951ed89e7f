//! The march of a liquid: its steps, what they keep, and what is written.

pub(crate) mod acting;
pub(crate) mod between;
mod course;
mod groups;
pub(crate) mod heated;
mod ledger;
mod stored;

use artefact::{Checkpoint, Precision};
use run::{Failure, Session};
use steps::Legs;

use self::acting::Acting;
use self::between::between;
use self::course::Course;
use self::groups::groups;
use self::heated::Heated;
use crate::assemble::liquid::matter::{matter, way};
use crate::assemble::liquid::{fastest, filled, start, steps};
use crate::geometry::Geometry;
use crate::liquid::effort::failed;
use crate::liquid::operators::{divergence, operators};
use crate::liquid::outline::Outline;
use crate::liquid::passing::Passing;
use crate::liquid::step::{Ended, Liquid, Matter, Step, Way};
use crate::liquid::surface::{Patch, patches};
use crate::liquid::told::{self, Totals};
use crate::liquid::vector::{along, difference, length};
use crate::scene::{Liquid as Part, LiquidMarch, Scene};

/// Spacings that a point may move in a step; longer ones are divided.
const FARTHEST: f64 = 0.5;
/// Change of the volume, over it, that one even move of the surface puts right.
const EVEN: f64 = 1e-3;
/// Moves that put right what is more.
const SWELLS: usize = 2;
/// Divergence over gradient of a velocity at the start that is no longer called free of divergence.
const SOURCES: f64 = 0.05;

/// What a march keeps beside the liquid.
struct March {
    matter: Matter<3>,
    way: Way,
    precision: Precision,
    /// Velocity of the centre, as gravity and fields say \[m/s\].
    drift: [f64; 3],
    /// Centre that was told last \[m\].
    centre: [f64; 3],
    course: Course,
    /// Fields that act on it.
    acting: Acting,
    /// Heat in it; none where the scene has none.
    heat: Option<Heated>,
    /// How fast a stirred liquid passes its points.
    passing: Passing,
}

/// Moves the liquid of a scene from its start to the end.
///
/// # Errors
/// Where fits or equations fail, the user interrupts, or the disk refuses.
pub(crate) fn flow(
    scene: &Scene,
    part: &Part,
    marched: &LiquidMarch,
    session: &mut Session,
) -> Result<(), Failure> {
    if let Some(faces) = &part.faces {
        return match scene.geometry {
            Geometry::Space => between::<3>(scene, part, faces, marched, session),
            _ => between::<2>(scene, part, faces, marched, session),
        };
    }
    if let Some(given) = &part.groups {
        return groups(scene, part, given, marched, session);
    }
    let filled = session.timed("points", || filled(scene, part))?;
    let mut liquid = start(part, filled)?;
    let steps = steps(scene, part, marched, &liquid);
    let mut march = March {
        matter: matter(part),
        way: way(scene, part),
        precision: scene.output.precision.into(),
        drift: [0.0; 3],
        centre: [0.0; 3],
        course: Course::default(),
        acting: Acting::new(scene, part, &liquid, session)?,
        heat: Heated::new(part, &liquid)?,
        passing: Passing::default(),
    };
    if let Some(mut checkpoint) = session.restored() {
        march.restore(&mut liquid, &mut checkpoint)?;
    } else {
        march.begin(&mut liquid, part, session)?;
    }
    while march.course.taken < steps.count() {
        let (_, length) = steps.step(march.course.taken);
        let made = march.step(&mut liquid, length, session)?;
        march.course.taken += 1;
        let (time, written) = steps.end(march.course.taken);
        march.tell(&mut liquid, time, &made, session)?;
        if written {
            march.write(&liquid, time, &made, session)?;
        }
        let speed = fastest(&liquid);
        session.progress(march.course.taken, steps.count(), || {
            vec![
                ("time", time, "s"),
                ("step", length, "s"),
                ("fastest", speed, "m/s"),
            ]
        });
        if march.course.taken < steps.count() {
            session.keep(|checkpoint| march.save(&liquid, checkpoint))?;
        }
    }
    march.close(&liquid, &steps, session);
    Ok(())
}

impl March {
    /// The liquid at its start: what it is, and its pressure.
    fn begin(
        &mut self,
        liquid: &mut Liquid<3>,
        part: &Part,
        session: &mut Session,
    ) -> Result<(), Failure> {
        self.centre = liquid.middle();
        let (way, centre) = (&self.way, self.centre);
        let (step, effort) = (Step { way, dt: 0.0 }, &mut self.course.effort);
        self.acting.pull(liquid, step, centre, effort, session)?;
        self.acting.hold(part, &self.matter, liquid, way, centre)?;
        let made = liquid.balance(&self.matter, &self.way, &mut self.course.effort)?;
        let rows = operators(&liquid.position, &self.way).map_err(|e| failed(&e))?;
        let (mut sources, mut slopes) = (0.0_f64, 0.0_f64);
        for i in 0..liquid.position.len() {
            sources += divergence(&rows, &liquid.velocity, i).powi(2);
            for k in 0..3 {
                let slope = rows.derivative(i, k).apply_with(|j| liquid.velocity[j][k]);
                slopes += slope * slope;
            }
        }
        if sources > SOURCES * SOURCES * slopes {
            session.warn(format!(
                "the velocity at the start has sources: the root of the mean square of its divergence is {:.3e} 1/s",
                (sources / liquid.position.len() as f64).sqrt()
            ));
        }
        self.tell(liquid, 0.0, &made, session)?;
        self.write(liquid, 0.0, &made, session)
    }

    /// One step, in parts where points would move too far.
    fn step(
        &mut self,
        liquid: &mut Liquid<3>,
        length: f64,
        session: &mut Session,
    ) -> Result<Vec<Patch<3>>, Failure> {
        if let Some(heat) = self.heat.as_mut().filter(|h| h.still) {
            let surface = &liquid.position[..liquid.surface()];
            let patches = patches(surface, &liquid.normal, self.way.spacing);
            let patches = patches.map_err(|e| failed(&e))?;
            let (way, dt) = (&self.way, length);
            let (step, effort) = (Step { way, dt }, &mut self.course.effort);
            session.timed("heat", || {
                heat.rest(liquid, &patches, &self.acting, step, effort)
            })?;
            return Ok(patches);
        }
        let far = fastest(liquid) * length / (FARTHEST * self.way.spacing);
        let parts = far.ceil().max(1.0);
        if parts > 1.0 {
            self.course.divided += 1;
            session.substepped();
        }
        let mut made = Vec::new();
        for _ in 0..parts as u64 {
            let step = Step {
                way: &self.way,
                dt: length / parts,
            };
            let effort = &mut self.course.effort;
            let ended = session.timed("step", || liquid.advance(&self.matter, step, effort))?;
            if let Some(heat) = &mut self.heat {
                heat.flow(liquid, &ended, &self.acting, step, effort)?;
            }
            if liquid.loose() {
                let quiet = || liquid.quiet(&self.matter, step, 0.0);
                session.timed("ripples", quiet).map_err(|e| failed(&e))?;
            }
            liquid.smooth(&ended.patches, &ended.images);
            let apart = self.heat.is_some().then(|| liquid.position.clone());
            let Ended { rows, images, .. } = &ended;
            liquid.spread(rows, images, &ended.patches, self.way.spacing);
            if let (Some(heat), Some(before)) = (&mut self.heat, apart) {
                heat.carry(&ended.rows, &before, &liquid.position);
            }
            made = ended.patches;
            if liquid.loose() {
                self.renew(liquid, &mut made, session)?;
            }
            self.pull(liquid, length / parts, session)?;
        }
        self.drift = along(&self.drift, length, &self.matter.gravity);
        Ok(made)
    }

    /// Lets points of a drop in the open merge and come, and finds its surface again where they did.
    fn renew(
        &mut self,
        liquid: &mut Liquid<3>,
        made: &mut Vec<Patch<3>>,
        session: &mut Session,
    ) -> Result<(), Failure> {
        let way = &self.way;
        let mut none = Vec::new();
        let borne = (self.heat.as_mut()).map_or(&mut none, |heat| &mut heat.enthalpy);
        let renew = || liquid.renew_with(way, borne);
        let count = session.timed("renewal of points", renew)?;
        if count.any() {
            *made = liquid.skin(way.spacing).map_err(|e| failed(&e))?;
            if let Some(heat) = &mut self.heat {
                heat.divide(liquid, made, way.spacing);
            }
        }
        self.course.renewed.add(count);
        Ok(())
    }

    /// What fields do where the liquid is, `passed` after the last time \[s\].
    fn pull(
        &mut self,
        liquid: &mut Liquid<3>,
        passed: f64,
        session: &mut Session,
    ) -> Result<(), Failure> {
        let (way, dt) = (&self.way, passed);
        let (step, effort) = (Step { way, dt }, &mut self.course.effort);
        let impulse = (self.acting).pull(liquid, step, self.centre, effort, session)?;
        if let Some(volume) = self.course.volume {
            let mass = self.matter.density * volume;
            self.drift = along(&self.drift, mass.recip(), &impulse);
        }
        Ok(())
    }

    /// Keeps volume and momentum, and writes a row.
    fn tell(
        &mut self,
        liquid: &mut Liquid<3>,
        time: f64,
        patches: &[Patch<3>],
        session: &mut Session,
    ) -> Result<(), Failure> {
        if let Some(viscosity) = self.stirs(liquid) {
            let diffusion = viscosity / self.matter.density;
            self.passing.look(liquid, diffusion, self.way.spacing, time);
        }
        let Some((_, totals)) = self.outline(liquid) else {
            session.warn("the drop is no longer one whose surface every ray from its centre meets once: its radii, modes and volume are neither told nor kept");
            return Ok(());
        };
        match self.course.volume {
            None => {
                self.course.volume = Some(totals.volume);
                self.drift = totals.drift;
            }
            Some(volume) => {
                self.swell(liquid, volume, &totals);
                let lack = difference(&self.drift, &totals.drift);
                for u in &mut liquid.velocity {
                    *u = along(u, 1.0, &lack);
                }
                self.course.pushed += self.matter.density * volume * length(&lack);
            }
        }
        let before = totals.volume;
        if let Some((outline, totals)) = self.outline(liquid) {
            self.course.keep(before, totals.volume);
            self.centre = totals.centre;
            let mut row = self.acting.row(totals.row(&self.matter, &outline));
            if let Some(heat) = &mut self.heat {
                heat.keep(&totals, liquid, patches, self.way.spacing);
                row = heat.row(row);
            }
            session.record("/liquid", time, &row)?;
        }
        Ok(())
    }

    /// Gives a liquid its volume back by an even move of its surface; more of them where the first leaves some of it.
    fn swell(&self, liquid: &mut Liquid<3>, volume: f64, totals: &Totals) {
        liquid.swell((volume - totals.volume) / totals.area);
        if (volume - totals.volume).abs() < EVEN * volume {
            return;
        }
        for _ in 0..SWELLS {
            let Some((_, totals)) = self.outline(liquid) else {
                return;
            };
            liquid.swell((volume - totals.volume) / totals.area);
        }
    }

    /// The viscosity that bounds what a force stirs \[Pa s\], where points are passed.
    fn stirs(&self, liquid: &Liquid<3>) -> Option<f64> {
        self.matter.viscosity.filter(|_| !liquid.follow.is_empty())
    }

    /// The outline from the centre that was told last.
    fn outline(&self, liquid: &Liquid<3>) -> Option<(Outline, Totals)> {
        let surface = &liquid.position[..liquid.surface()];
        let outline = Outline::new(surface, &liquid.normal, self.centre)?;
        let totals = Totals::new(liquid, &self.matter, &outline)?;
        Some((outline, totals))
    }

    fn write(
        &self,
        liquid: &Liquid<3>,
        time: f64,
        patches: &[Patch<3>],
        session: &mut Session,
    ) -> Result<(), Failure> {
        let carried = &self.acting.pressure;
        let mut points = told::points(liquid, &self.matter, carried, self.precision);
        if let Some(heat) = &self.heat {
            points = heat.frame(points);
        }
        session.frame("/points", time, &points)?;
        session.frame(
            "/surface",
            time,
            &told::surface(liquid, patches, self.precision),
        )
    }

    fn save(&self, liquid: &Liquid<3>, checkpoint: &mut Checkpoint) -> artefact::Result<()> {
        self.course.save(liquid, checkpoint);
        self.acting.save(liquid, &self.course.effort, checkpoint);
        if let Some(heat) = &self.heat {
            heat.save(checkpoint);
        }
        if self.stirs(liquid).is_some() {
            checkpoint.put_f64("passing", &self.passing.save());
        }
        checkpoint.put_vectors("centre", &[self.drift, self.centre]);
        Ok(())
    }

    fn restore(
        &mut self,
        liquid: &mut Liquid<3>,
        checkpoint: &mut Checkpoint,
    ) -> Result<(), Failure> {
        self.course.restore(liquid, checkpoint)?;
        let (spacing, effort) = (self.way.spacing, &mut self.course.effort);
        self.acting.restore(liquid, effort, spacing, checkpoint)?;
        if let Some(heat) = &mut self.heat {
            heat.restore(checkpoint)?;
        }
        if self.stirs(liquid).is_some() {
            self.passing = Passing::restored(&checkpoint.f64("passing")?);
        }
        if let [drift, centre] = checkpoint.vectors("centre")?[..] {
            (self.drift, self.centre) = (drift, centre);
        }
        Ok(())
    }

    fn close(&self, liquid: &Liquid<3>, steps: &Legs, session: &mut Session) {
        self.course.close(steps, "m3", session);
        self.course.tell_momentum(session);
        self.acting.close(&self.course.effort, session);
        if let Some(heat) = &self.heat {
            heat.close(session);
        }
        if self.course.divided > 0 {
            session.note(format!(
                "{} steps were divided: points would have moved farther than {FARTHEST} spacings",
                self.course.divided
            ));
        }
        if liquid.loose() {
            session.closing("points_added", "1", self.course.renewed.added as f64);
            session.closing("points_merged", "1", self.course.renewed.merged as f64);
        }
        if self.stirs(liquid).is_some() {
            session.closing("cell_reynolds", "1", self.passing.greatest);
        }
        let doubts = self.course.effort.doubts().into_iter();
        for doubt in doubts.chain(self.passing.doubt()) {
            session.warn(doubt);
        }
    }
}
