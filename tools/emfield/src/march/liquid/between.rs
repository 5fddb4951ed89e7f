//! The march of a liquid between faces: in a plane or in space.

use artefact::{Precision, Record};
use run::{Failure, Session};
use steps::Legs;

use super::course::Course;
use crate::assemble::liquid::between::{fastest, start, steps};
use crate::assemble::liquid::matter::{matter, way};

use crate::liquid::room::level::Level;
use crate::liquid::step::{Ended, Liquid, Matter, Step, Way};
use crate::liquid::surface::Patch;
use crate::liquid::told;
use crate::liquid::vector::{along, dot};
use crate::scene::{Faces, Liquid as Part, LiquidMarch, Scene};

/// Spacings that the liquid may pass in a step; longer ones are divided.
const FARTHEST: f64 = 0.5;
/// Names of axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// A liquid between faces, and how it is moved.
struct March<const D: usize> {
    matter: Matter<D>,
    way: Way,
    precision: Precision,
    course: Course,
}

/// Moves the liquid of a scene from its start to the end.
///
/// # Errors
/// Where fits or equations fail, the user interrupts, or the disk refuses.
pub(crate) fn between<const D: usize>(
    scene: &Scene,
    part: &Part,
    faces: &Faces,
    marched: &LiquidMarch,
    session: &mut Session,
) -> Result<(), Failure> {
    let mut liquid = session.timed("points", || start::<D>(scene, part, faces))?;
    let steps = steps(scene, part, marched, &liquid);
    let mut march = March {
        matter: matter(part),
        way: way(scene, part),
        precision: scene.output.precision.into(),
        course: Course::default(),
    };
    if let Some(mut checkpoint) = session.restored() {
        march.course.restore(&mut liquid, &mut checkpoint)?;
    } else {
        let made = liquid.balance(&march.matter, &march.way, &mut march.course.effort)?;
        march.tell(&mut liquid, 0.0, session)?;
        march.write(&liquid, 0.0, &made, session)?;
    }
    while march.course.taken < steps.count() {
        let (_, length) = steps.step(march.course.taken);
        let ended = march.step(&mut liquid, length, session)?;
        march.course.taken += 1;
        let (time, written) = steps.end(march.course.taken);
        march.tell(&mut liquid, time, session)?;
        if written {
            march.write(&liquid, time, &ended.patches, session)?;
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
            session.keep(|checkpoint| {
                march.course.save(&liquid, checkpoint);
                Ok(())
            })?;
        }
    }
    march.close(&steps, session);
    Ok(())
}

impl<const D: usize> March<D> {
    /// One step, in parts where the liquid would pass too many spacings.
    fn step(
        &mut self,
        liquid: &mut Liquid<D>,
        length: f64,
        session: &mut Session,
    ) -> Result<Ended<D>, Failure> {
        let far = fastest(liquid) * length / (FARTHEST * self.way.spacing);
        let parts = far.ceil().max(1.0);
        if parts > 1.0 {
            self.course.divided += 1;
            session.substepped();
        }
        let mut left = parts as u64;
        loop {
            let step = Step {
                way: &self.way,
                dt: length / parts,
            };
            let effort = &mut self.course.effort;
            let ended = session.timed("step", || liquid.advance(&self.matter, step, effort))?;
            if liquid.surface() > 0 {
                liquid.smooth(&ended.patches, &ended.images);
                let Ended { rows, images, .. } = &ended;
                liquid.spread(rows, images, &ended.patches, self.way.spacing);
                for x in &mut liquid.position {
                    liquid.room.wrap(x);
                }
            }
            left -= 1;
            if left == 0 {
                return Ok(ended);
            }
        }
    }

    /// Keeps the volume, and writes a row.
    fn tell(
        &mut self,
        liquid: &mut Liquid<D>,
        time: f64,
        session: &mut Session,
    ) -> Result<(), Failure> {
        let level =
            |liquid: &Liquid<D>| Level::new(&liquid.room, &liquid.position[..liquid.surface()]);
        let mut now = level(liquid);
        match (&now, self.course.volume) {
            (Some(found), None) => {
                self.course.volume = Some(found.volume);
                self.course.keep(found.volume, found.volume);
            }
            (Some(found), Some(volume)) => {
                let before = found.volume;
                let free = liquid.room.free().map_or(0, |f| f.0);
                let across = (0..D).filter(|k| *k != free);
                let base: f64 = across.map(|k| liquid.room.length(k)).product();
                // A surface that rises evenly by a height encloses that much more over its shadow, however steep.
                liquid.lift((volume - found.volume) / base);
                now = level(liquid);
                let after = now.as_ref().map_or(volume, |level| level.volume);
                self.course.keep(before, after);
            }
            (None, _) => {}
        }
        session.record("/liquid", time, &self.row(liquid, now.as_ref()))
    }

    /// Mean velocity and kinetic energy by even shares of the volume, and the surface.
    fn row(&self, liquid: &Liquid<D>, level: Option<&Level>) -> Record {
        let sides = liquid.walls().end;
        let share = |i: usize| if i < sides { 0.5 } else { 1.0 };
        let box_volume: f64 = (0..D).map(|k| liquid.room.length(k)).product();
        let volume = level.map_or(box_volume, |l| l.volume);
        let (mut whole, mut mean, mut square) = (0.0, [0.0; D], 0.0);
        for (i, u) in liquid.velocity.iter().enumerate() {
            whole += share(i);
            mean = along(&mean, share(i), u);
            square += share(i) * dot(u, u);
        }
        let kinetic = 0.5 * self.matter.density * volume * square / whole;
        let units = if D == 2 { ["m2", "J/m"] } else { ["m3", "J"] };
        let mut record = Record::new().with("volume", units[0], volume);
        for (axis, u) in AXES.iter().zip(mean) {
            record = record.with(&format!("velocity_{axis}"), "m/s", u / whole);
        }
        record = record.with("kinetic_energy", units[1], kinetic).with(
            "fastest",
            "m/s",
            fastest(liquid),
        );
        let Some(level) = level else { return record };
        record = record.with("height", "m", level.height);
        for (axis, number, amplitude) in &level.waves {
            let name = format!("wave_{}_{number}", AXES[*axis]);
            record = record.with(&name, "m", *amplitude);
        }
        record.with("level_residual", "m", level.residual)
    }

    fn write(
        &self,
        liquid: &Liquid<D>,
        time: f64,
        patches: &[Patch<D>],
        session: &mut Session,
    ) -> Result<(), Failure> {
        let points = told::points(liquid, &self.matter, &[], self.precision);
        session.frame("/points", time, &points)?;
        if patches.is_empty() {
            return Ok(());
        }
        let surface = told::surface(liquid, patches, self.precision);
        session.frame("/surface", time, &surface)
    }

    fn close(&self, steps: &Legs, session: &mut Session) {
        self.course
            .close(steps, if D == 2 { "m2" } else { "m3" }, session);
        if self.course.divided > 0 {
            session.note(format!(
                "{} steps were divided: the liquid would have passed more than {FARTHEST} spacings",
                self.course.divided
            ));
        }
        for doubt in self.course.effort.doubts() {
            session.warn(doubt);
        }
    }
}
