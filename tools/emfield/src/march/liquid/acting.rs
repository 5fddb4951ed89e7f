//! Fields that act on a liquid as it moves: what they do at every step, and what is told and kept of it.

use artefact::{Checkpoint, Record};
use run::{Failure, Session};

use crate::assemble::liquid::alternating::{alternating, hold};
use crate::liquid::air::Place;
use crate::liquid::effort::Effort;
use crate::liquid::electric::{Applied, Drops, Electric};
use crate::liquid::magnetic::{Magnetic, outline};
use crate::liquid::step::{Liquid, Matter, Step, Way};
use crate::liquid::vector::along;
use crate::scene::{Liquid as Part, Scene};

/// Current through the surface over that along it from which charges, which are left out, matter.
const THROUGH: f64 = 0.02;

/// The fields of a scene that act on its liquid, and what they took.
pub(crate) struct Acting {
    electric: Option<Electric>,
    magnetic: Option<Magnetic>,
    /// By what the currents of coils were multiplied.
    factor: f64,
    /// What the field adds to the pressure that the liquid carries, by point \[Pa\].
    pub(crate) pressure: Vec<f64>,
    /// Power of currents, by point \[W\]; nothing where the scene has no heat.
    pub(crate) heat: Vec<f64>,
    /// Greatest current through the surface so far, over that along it.
    through: f64,
    /// Numbers of the drops of the points of the liquid; nothing where it is one.
    of: Vec<u32>,
}

impl Acting {
    /// Those of a scene about a liquid at its start.
    ///
    /// # Errors
    /// Where the points of a field cannot be made.
    pub(crate) fn new(
        scene: &Scene,
        part: &Part,
        liquid: &Liquid<3>,
        session: &mut Session,
    ) -> Result<Self, Failure> {
        let mut magnetic = match &part.magnetic {
            Some(given) => {
                let made = || alternating(scene, given, liquid);
                Some(session.timed("points about a ball", made)?)
            }
            None => None,
        };
        if let Some(magnetic) = &mut magnetic {
            magnetic.warms = part.heat.is_some();
        }
        Ok(Self {
            electric: electric(part),
            magnetic,
            factor: 1.0,
            pressure: Vec::new(),
            heat: Vec::new(),
            through: 0.0,
            of: Vec::new(),
        })
    }

    /// Whether there is any.
    pub(crate) fn any(&self) -> bool {
        self.electric.is_some() || self.magnetic.is_some()
    }

    /// Lets an electric field know which drops its liquid is.
    pub(crate) fn part(&mut self, drops: Drops) {
        self.of.clone_from(&drops.of);
        if let Some(electric) = &mut self.electric {
            electric.drops = Some(drops);
        }
    }

    /// What acts of an electric field.
    pub(crate) fn applied(&self) -> Option<Applied> {
        self.electric.as_ref().map(|electric| electric.applied)
    }

    /// Makes currents so strong that what fields did last holds the liquid, where the scene asks for that.
    ///
    /// # Errors
    /// Where the field does not lift it.
    pub(crate) fn hold(
        &mut self,
        part: &Part,
        matter: &Matter<3>,
        liquid: &mut Liquid<3>,
        way: &Way,
        centre: [f64; 3],
    ) -> Result<(), Failure> {
        let balanced = part.magnetic.as_ref().is_some_and(|m| m.balanced);
        if let Some(magnetic) = self.magnetic.as_mut().filter(|_| balanced) {
            let skin = Place::of(&liquid.position, &liquid.normal, way.spacing).skin;
            let volume = outline(skin, centre)?.volume().0;
            let factor = hold(magnetic, matter, volume)?;
            magnetic.strengthen(factor);
            self.factor *= factor;
            let force = liquid.force[0].as_flattened_mut().iter_mut();
            let all = force.chain(&mut liquid.pull[0]).chain(&mut self.pressure);
            let all = all.chain(&mut self.heat);
            all.for_each(|p| *p *= factor * factor);
        }
        Ok(())
    }

    /// What fields do where the liquid is, a step after the last time; the impulse of it \[N s\].
    ///
    /// # Errors
    /// Where the fields cannot be found.
    pub(crate) fn pull(
        &mut self,
        liquid: &mut Liquid<3>,
        step: Step<'_>,
        centre: [f64; 3],
        effort: &mut Effort,
        session: &mut Session,
    ) -> Result<[f64; 3], Failure> {
        let Step { way, dt: passed } = step;
        let mut place = Place::of(&liquid.position, &liquid.normal, way.spacing);
        place.of = &self.of;
        let rule = way.of_fields();
        let (traction, force, impulse) = if let Some(electric) = &mut self.electric {
            let stood = session.timed("points of the field", || electric.stand(place))?;
            let sides = session.timed("weights of the field", || electric.fit(&stood))?;
            let now = session.timed("electric field", || {
                electric.traction(&stood, &sides, rule, effort)
            })?;
            liquid.drag.clone_from(&electric.drag);
            liquid.charge.clone_from(&electric.charge);
            (now, Vec::new(), electric.force().map(|f| passed * f))
        } else if let Some(magnetic) = &mut self.magnetic {
            let about = outline(place.skin, centre)?;
            let stood = session.timed("points of the field", || magnetic.stand(&about, centre));
            let sides = session.timed("weights of the field", || magnetic.fit(&stood))?;
            let before = magnetic.force();
            let act = session.timed("magnetic field", || {
                magnetic.act(&stood, &sides, place, rule, effort)
            })?;
            self.through = self.through.max(magnetic.out);
            let both = along(&before, 1.0, &magnetic.force());
            self.heat = act.heat;
            let mut force = act.pull;
            let stirred = || liquid.stirred(&mut force, &act.phi, way, effort);
            let phi = session.timed("stirring", stirred)?;
            let added = act.pressure.iter().zip(&phi);
            self.pressure = added.map(|(p, phi)| p + phi).collect();
            let skin = &self.pressure[..act.phi.len()];
            let traction = skin.iter().map(|p| -p).collect();
            (traction, force, both.map(|f| 0.5 * passed * f))
        } else {
            return Ok([0.0; 3]);
        };
        let pull = std::mem::replace(&mut liquid.pull[0], traction);
        let held = std::mem::replace(&mut liquid.force[0], force);
        let rate = |now: f64, before: f64| {
            if passed > 0.0 {
                (now - before) / passed
            } else {
                0.0
            }
        };
        let both = liquid.pull[0].iter().enumerate();
        liquid.pull[1] = both
            .map(|(i, now)| rate(*now, pull.get(i).copied().unwrap_or(0.0)))
            .collect();
        let both = liquid.force[0].iter().enumerate();
        liquid.force[1] = both
            .map(|(i, now)| {
                let before = held.get(i).copied().unwrap_or([0.0; 3]);
                std::array::from_fn(|k| rate(now[k], before[k]))
            })
            .collect();
        Ok(impulse)
    }

    /// Force of an alternating field on the liquid \[N\].
    pub(crate) fn force(&self) -> [f64; 3] {
        let magnetic = self.magnetic.as_ref();
        magnetic.map_or([0.0; 3], Magnetic::force)
    }

    /// Heat of the currents \[W\].
    pub(crate) fn power(&self) -> f64 {
        let magnetic = self.magnetic.as_ref();
        magnetic.map_or(0.0, |m| m.totals.heat_volume)
    }

    /// Adds what fields do to a row.
    pub(crate) fn row(&self, record: Record) -> Record {
        let Some(magnetic) = &self.magnetic else {
            return record;
        };
        let totals = &magnetic.totals;
        let mut record = record;
        for (k, axis) in ["x", "y", "z"].iter().enumerate() {
            record = record.with(&format!("force_{axis}"), "N", totals.force_coil[k]);
        }
        record
            .with("lift_volume", "N", totals.force_volume[2])
            .with("lift_maxwell", "N", totals.force_stress[2])
            .with("power", "W", totals.heat_volume)
            .with("power_poynting", "W", totals.heat_surface)
            .with("current_out", "1", magnetic.out)
    }

    pub(crate) fn save(&self, liquid: &Liquid<3>, effort: &Effort, checkpoint: &mut Checkpoint) {
        if let Some(electric) = &self.electric {
            electric.save(checkpoint);
            checkpoint.put_vectors("drag", &liquid.drag);
            checkpoint.put_f64("surface_charge", &liquid.charge);
        } else if let Some(magnetic) = &self.magnetic {
            magnetic.save(checkpoint);
            checkpoint.put_vectors("force", &liquid.force[0]);
            checkpoint.put_vectors("force_rate", &liquid.force[1]);
            checkpoint.put_f64("magnetic_pressure", &self.pressure);
            checkpoint.put_f64("magnetic_heat", &self.heat);
            checkpoint.put_f64("currents", &[self.factor, self.through]);
        } else {
            return;
        }
        checkpoint.put_f64("pull", &liquid.pull[0]);
        checkpoint.put_f64("pull_rate", &liquid.pull[1]);
        checkpoint.put_u64(
            "field_counts",
            &[effort.field_products, effort.field_unsolved],
        );
        checkpoint.put_f64("field_residual", &[effort.field_residual]);
    }

    pub(crate) fn restore(
        &mut self,
        liquid: &mut Liquid<3>,
        effort: &mut Effort,
        spacing: f64,
        checkpoint: &mut Checkpoint,
    ) -> Result<(), Failure> {
        if let Some(electric) = &mut self.electric {
            electric.restore(checkpoint, spacing)?;
            liquid.drag = checkpoint.vectors("drag")?;
            liquid.charge = checkpoint.f64("surface_charge")?;
        } else if let Some(magnetic) = &mut self.magnetic {
            if let [factor, through] = checkpoint.f64("currents")?[..] {
                (self.factor, self.through) = (factor, through);
                magnetic.strengthen(factor);
            }
            magnetic.restore(checkpoint, spacing)?;
            self.pressure = checkpoint.f64("magnetic_pressure")?;
            self.heat = checkpoint.f64("magnetic_heat")?;
            liquid.force = [
                checkpoint.vectors("force")?,
                checkpoint.vectors("force_rate")?,
            ];
        } else {
            return Ok(());
        }
        if let [products, unsolved] = checkpoint.u64("field_counts")?[..] {
            (effort.field_products, effort.field_unsolved) = (products, unsolved);
        }
        let residual = checkpoint.f64("field_residual")?;
        effort.field_residual = residual.first().copied().unwrap_or(0.0);
        liquid.pull = [checkpoint.f64("pull")?, checkpoint.f64("pull_rate")?];
        Ok(())
    }

    pub(crate) fn close(&self, effort: &Effort, session: &mut Session) {
        let name = if let Some(electric) = &self.electric {
            session.closing("points_field", "1", electric.awake as f64);
            session.closing("air_renewed", "1", electric.renewed() as f64);
            "electric"
        } else if let Some(magnetic) = &self.magnetic {
            session.closing("points_field", "1", magnetic.count() as f64);
            session.closing("factors_renewed", "1", magnetic.renewed() as f64);
            session.closing("current_factor", "1", self.factor);
            session.closing("current_out", "1", self.through);
            if self.through > THROUGH {
                session.warn(format!(
                    "currents meet the surface: {:.3} of the greatest along it; the charges that they bring are left out, so that force and heat err by about as much",
                    self.through
                ));
            }
            "magnetic"
        } else {
            return;
        };
        session.closing("products_field", "1", effort.field_products as f64);
        session.closing("residual_field", "1", effort.field_residual);
        if effort.field_unsolved > 0 {
            session.warn(format!(
                "not converged: {} solves of the {name} field",
                effort.field_unsolved
            ));
        }
    }
}

/// The electric field of a scene.
pub(crate) fn electric(part: &Part) -> Option<Electric> {
    let given = part.electric.as_ref()?;
    let applied = Applied {
        field: std::array::from_fn(|k| given.field_v_m.get(k).copied().unwrap_or(0.0)),
        permittivity: given.relative_permittivity,
        leak: given.relative_conductivity,
        charge: given.charge_c.unwrap_or(0.0),
    };
    Some(Electric::new(applied, given.order))
}
