//! What the types of a scene cannot tell.

use run::Fault;
use shapes::Shape;
use shapes::check::{Misfit, check, filled};

use super::{Method, Scene, Solid};
use crate::matter::solid::fracture::Criterion;
use crate::matter::solid::law::Plane;
use crate::matter::water::tait::Tension;

/// Most frames and balances of a run.
const EVENTS_MOST: f64 = 1e7;
/// Most particles side by side in a nozzle.
const LANES_MOST: f64 = 1e6;
/// Most spacings in the length over which a solid breaks, in the plane and in space: 4096 cells.
const LENGTHS_MOST: [f64; 2] = [64.0, 16.0];
/// Most nozzles of a scene: a particle knows its own by a byte.
const NOZZLES_MOST: usize = 255;

impl Scene {
    /// Every fault that the types cannot tell.
    #[must_use]
    pub fn faults(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        if self.solids.is_empty() && self.water.is_none() {
            faults.push(Fault::at(
                "",
                "there is nothing in the scene: it wants 'solids' or 'water'",
            ));
        }
        if self.dimensions == 3 && self.plane.is_some() {
            faults.push(Fault::at("/plane", "a scene of 3 dimensions has no plane"));
        }
        let end = self.time.end_s;
        for (key, interval) in [
            ("frames_interval_s", Some(self.output.frames_interval_s)),
            ("balance_interval_s", self.output.balance_interval_s),
        ] {
            if let Some(interval) = interval.filter(|interval| end / interval > EVENTS_MOST) {
                let what = format!(
                    "{interval} s is too short: {:.1e} times until {end} s, at most {EVENTS_MOST:.0e}",
                    end / interval
                );
                faults.push(Fault::at(&format!("/output/{key}"), what));
            }
        }
        for (i, solid) in self.solids.iter().enumerate() {
            if solid.name == "water" {
                let what = "\"water\" is the channel of the water";
                faults.push(Fault::at(&format!("/solids/{i}/name"), what));
            }
            let (dimensions, plane) = (self.dimensions, self.plane);
            solid.faults(&format!("/solids/{i}"), dimensions, plane, &mut faults);
            if let Some(k) = self.solids[..i]
                .iter()
                .position(|other| other.name == solid.name)
            {
                let what = format!("\"{}\" is the name of /solids/{k} too", solid.name);
                faults.push(Fault::at(&format!("/solids/{i}/name"), what));
            }
        }
        self.flow_faults(&mut faults);
        faults
    }

    /// Faults of water, walls and gravity.
    fn flow_faults(&self, faults: &mut Vec<Fault>) {
        let mut misfits = Vec::new();
        let mut vectors = vec![("/gravity_m_s2".to_owned(), self.gravity_m_s2.as_deref())];
        for (k, wall) in self.walls.iter().enumerate() {
            let at = format!("/walls/{k}");
            check(
                &wall.body,
                &format!("{at}/body"),
                self.dimensions,
                &mut misfits,
            );
            let named = |other: &super::WallScene| other.name == wall.name;
            if let Some(other) = self.walls[..k].iter().position(named) {
                let what = format!("\"{}\" is the name of /walls/{other} too", wall.name);
                faults.push(Fault::at(&format!("{at}/name"), what));
            }
            if let Some(of) = wall
                .repulsion
                .filter(|of| of.exponent_far >= of.exponent_near)
            {
                let (far, near) = (of.exponent_far, of.exponent_near);
                let what =
                    format!("{far} is not less than 'exponent_near', {near}: the wall would pull");
                faults.push(Fault::at(&format!("{at}/repulsion/exponent_far"), what));
            }
        }
        if let Some(water) = &self.water {
            if water.method == Method::DivergenceFree {
                let updated = self.solids.iter().any(|s| s.updated_form.is_some());
                water.soundless_faults(updated, faults);
                if self.solids.is_empty() && water.tension == Tension::Full {
                    let what = "means nothing to water without sound where it meets no solid: leave it out";
                    faults.push(Fault::at("/water/tension", what));
                }
            }
            water.faults(self.dimensions, &mut vectors, &mut misfits, faults);
        }
        for (at, vector) in vectors {
            if let Some(found) = vector.filter(|found| found.len() != self.dimensions) {
                faults.push(Fault::at(&at, wrong_length(found.len(), self.dimensions)));
            }
        }
        let misfits = misfits.into_iter();
        faults.extend(misfits.map(|Misfit { path, what }| Fault::at(&path, what)));
    }
}

/// Vectors of a scene with their paths.
type Vectors<'a> = Vec<(String, Option<&'a [f64]>)>;

impl super::WaterScene {
    /// Faults of water; vectors and shapes are added to those that are yet to be checked.
    fn faults<'a>(
        &'a self,
        dimensions: usize,
        vectors: &mut Vectors<'a>,
        misfits: &mut Vec<Misfit>,
        faults: &mut Vec<Fault>,
    ) {
        for (k, nozzle) in self.nozzles.iter().enumerate() {
            let at = format!("/water/nozzles/{k}");
            vectors.push((format!("{at}/exit_m"), Some(&nozzle.exit_m)));
            vectors.push((format!("{at}/direction"), Some(&nozzle.direction)));
            vectors.push((format!("{at}/traverse_m_s"), nozzle.traverse_m_s.as_deref()));
            let across = (nozzle.width_m / self.spacing_m).powi(dimensions as i32 - 1);
            if across > LANES_MOST {
                let what = format!(
                    "{:.3e} m wide: {across:.1e} particles of {:.3e} m side by side, at most {LANES_MOST:.0e}",
                    nozzle.width_m, self.spacing_m
                );
                faults.push(Fault::at(&format!("{at}/width_m"), what).or_at("/water/spacing_m"));
            }
            if let Some(end) = nozzle.end_s.filter(|end| *end <= nozzle.start_s) {
                let what = format!(
                    "{end} s is not after 'start_s', {} s: the nozzle would never run",
                    nozzle.start_s
                );
                faults.push(Fault::at(&format!("{at}/end_s"), what));
            }
            if k >= NOZZLES_MOST {
                let what = format!("at most {NOZZLES_MOST} nozzles");
                faults.push(Fault::at(&at, what));
            }
        }
        for (k, body) in self.bodies.iter().enumerate() {
            let at = format!("/water/bodies/{k}/body");
            filled(&body.body, &at, dimensions, self.spacing_m, misfits);
            let axes = body.velocity_m_s.as_ref().map(Vec::len);
            if let Some(length) = axes.filter(|length| *length != dimensions) {
                let at = format!("/water/bodies/{k}/velocity_m_s");
                faults.push(Fault::at(&at, wrong_length(length, dimensions)));
            }
        }
        for (k, outlet) in self.outlets.iter().enumerate() {
            let at = format!("/water/outlets/{k}");
            vectors.push((format!("{at}/moving_m_s"), outlet.moving_m_s.as_deref()));
            match (&outlet.within, &outlet.beyond) {
                (Some(shape), None) => {
                    check(shape, &format!("{at}/within"), dimensions, misfits);
                }
                (None, Some(shape)) => {
                    check(shape, &format!("{at}/beyond"), dimensions, misfits);
                }
                _ => faults.push(Fault::at(&at, "wants either 'within' or 'beyond'")),
            }
        }
    }
}

impl super::WaterScene {
    /// Faults of water without sound.
    fn soundless_faults(&self, meets_updated: bool, faults: &mut Vec<Fault>) {
        let with_pressure = self.bodies.iter().any(|body| body.pressure_pa.is_some());
        let told = [
            ("sound_speed_m_s", self.sound_speed_m_s.is_some()),
            ("reference_speed_m_s", self.reference_speed_m_s.is_some()),
            ("artificial_viscosity", self.artificial_viscosity.is_some()),
            ("density_diffusion", self.density_diffusion.is_some()),
            ("viscosity_pa_s", self.viscosity_pa_s.is_some()),
            ("bodies", with_pressure),
        ];
        for (key, _) in told.iter().filter(|(_, is_told)| *is_told) {
            let what = match *key {
                "bodies" => "water without sound finds its pressure: leave 'pressure_pa' out",
                "viscosity_pa_s" => {
                    "water without sound has no friction yet: leave this or 'method' out"
                }
                _ => "belongs to water with sound: leave this or 'method' out",
            };
            faults.push(Fault::at(&format!("/water/{key}"), what));
        }
        if meets_updated {
            let what = "water without sound presses on faces, which the updated form lacks: leave 'updated_form' out, or take \"weakly_compressible\"";
            faults.push(Fault::at("/water/method", what));
        }
    }
}

/// A vector of another length than the scene has axes.
fn wrong_length(length: usize, dimensions: usize) -> String {
    format!("{length} numbers; a scene of {dimensions} dimensions wants {dimensions}")
}

impl Solid {
    /// Faults of what flows.
    fn flow_faults(&self, at: &str, plane: Option<Plane>, faults: &mut Vec<Fault>) {
        if self.plasticity.is_none() {
            return;
        }
        if plane == Some(Plane::Stress) {
            let what =
                "a thin sheet does not flow yet: take \"plane\": \"strain\" or three dimensions";
            faults.push(Fault::at(&format!("{at}/plasticity"), what));
        }
        if matches!(
            self.fracture,
            Some(Criterion::Stress(_) | Criterion::Energy(_))
        ) {
            let what = "what flows breaks by 'equivalent_strain' alone";
            faults.push(Fault::at(&format!("{at}/fracture"), what));
        }
    }

    /// Faults of the length over which it breaks.
    fn length_faults(&self, at: &str, dimensions: usize, faults: &mut Vec<Fault>) {
        let Some(length) = self.fracture_length_m else {
            return;
        };
        let most = LENGTHS_MOST[usize::from(dimensions == 3)];
        let (at, spacing) = (format!("{at}/fracture_length_m"), format!("{at}/spacing_m"));
        match self.fracture {
            None => faults.push(Fault::at(&at, "nothing breaks: it wants 'fracture', too")),
            Some(Criterion::Energy(_)) => {
                let what = "belongs to 'equivalent_strain' and 'principal_stress_pa': an energy has no length";
                faults.push(Fault::at(&at, what));
            }
            Some(_) if length < self.spacing_m => {
                let what = format!(
                    "{length} m is less than the spacing of {} m: no smaller part has a strain of its own",
                    self.spacing_m
                );
                faults.push(Fault::at(&at, what).or_at(&spacing));
            }
            Some(_) if length > most * self.spacing_m => {
                let what = format!(
                    "{length} m is {:.3e} spacings, at most {most}: each cell would look at too many others",
                    length / self.spacing_m
                );
                faults.push(Fault::at(&at, what).or_at(&spacing));
            }
            Some(_) => {}
        }
    }

    /// Faults of what only the form by the deformation since rest can.
    fn form_faults(&self, at: &str, plane: Option<Plane>, faults: &mut Vec<Fault>) {
        if self.updated_form.is_none() {
            return;
        }
        let told = [
            ("clamps", !self.clamps.is_empty()),
            ("loads", !self.loads.is_empty()),
            ("plasticity", self.plasticity.is_some()),
            ("fracture", self.fracture.is_some()),
            ("damping_1_s", self.damping_1_s.is_some()),
        ];
        for (key, _) in told.iter().filter(|(_, is_there)| *is_there) {
            let what =
                "the updated form is one of free, elastic bodies: leave this or 'updated_form' out";
            faults.push(Fault::at(&format!("{at}/{key}"), what));
        }
        if plane == Some(Plane::Stress) {
            let what = "the updated form has no thin sheets: take \"plane\": \"strain\" or three dimensions";
            faults.push(Fault::at(&format!("{at}/updated_form"), what));
        }
    }

    fn faults(&self, at: &str, dimensions: usize, plane: Option<Plane>, faults: &mut Vec<Fault>) {
        let mut misfits = Vec::new();
        let body_at = format!("{at}/body");
        filled(
            &self.body,
            &body_at,
            dimensions,
            self.spacing_m,
            &mut misfits,
        );
        for (k, load) in self.loads.iter().enumerate() {
            if load.traction_pa.is_some() == load.pressure_pa.is_some() {
                let what = "wants either 'traction_pa' or 'pressure_pa'";
                faults.push(Fault::at(&format!("{at}/loads/{k}"), what));
            }
        }
        self.flow_faults(at, plane, faults);
        self.length_faults(at, dimensions, faults);
        self.form_faults(at, plane, faults);
        let mut within = |shape: Option<&Shape>, at: &str| {
            if let Some(shape) = shape {
                check(shape, &format!("{at}/within"), dimensions, &mut misfits);
            }
        };
        for (k, clamp) in self.clamps.iter().enumerate() {
            within(clamp.within.as_ref(), &format!("{at}/clamps/{k}"));
        }
        for (k, load) in self.loads.iter().enumerate() {
            within(load.within.as_ref(), &format!("{at}/loads/{k}"));
        }
        faults.extend(
            misfits
                .into_iter()
                .map(|Misfit { path, what }| Fault::at(&path, what)),
        );
        let lengths = self.clamps.iter().enumerate().map(|(k, clamp)| {
            (
                format!("{at}/clamps/{k}/velocity_m_s"),
                clamp.velocity_m_s.as_ref().map(Vec::len),
            )
        });
        let lengths = lengths.chain(self.loads.iter().enumerate().map(|(k, load)| {
            (
                format!("{at}/loads/{k}/traction_pa"),
                load.traction_pa.as_ref().map(Vec::len),
            )
        }));
        let own = (
            format!("{at}/velocity_m_s"),
            self.velocity_m_s.as_ref().map(Vec::len),
        );
        for (at, length) in lengths.chain([own]) {
            if let Some(length) = length.filter(|length| *length != dimensions) {
                faults.push(Fault::at(&at, wrong_length(length, dimensions)));
            }
        }
    }
}
