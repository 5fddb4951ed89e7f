//! What a schema cannot tell of a scene.

use std::collections::BTreeSet;

use run::Fault;
use shapes::check::{self, Misfit};

use super::currents::{RegionCoil, Transient};
use super::method::{Interfaces, Way};
use super::output::Closed;
use super::{BodyScene, Coil, Domain, EddyCurrents, Geometry, Scene};
use crate::geometry::BALL;

/// What a potential may depend on.
pub(crate) const PLACE: [&str; 4] = ["x", "y", "z", "r"];

impl Scene {
    /// Everything that is wrong with the scene as far as it can be told without points.
    #[must_use]
    pub fn faults(&self) -> Vec<Fault> {
        let mut misfits = Vec::new();
        let dimensions = self.geometry.dimensions();
        let fields = self.electrostatics.is_some() || self.eddy_currents.is_some();
        if self.domain != Domain::default() {
            self.domain
                .check(self.geometry, self.points.spacing_m, &mut misfits);
        } else if fields {
            misfits.push(Misfit::at(
                "",
                "\"domain\" is wanted: fields are sought there",
            ));
            return faulty(misfits);
        }
        for (number, refinement) in self.points.refinements.iter().enumerate() {
            let at = format!("/points/refinements/{number}/shape");
            check::check(&refinement.shape, &at, dimensions, &mut misfits);
        }
        for (number, place) in self.points.extra_m.iter().enumerate() {
            let at = format!("/points/extra_m/{number}");
            check::coordinates(place, &at, dimensions, &mut misfits);
        }
        for (number, probe) in self.output.probes.iter().enumerate() {
            let at = format!("/output/probes/{number}/place_m");
            check::coordinates(&probe.place_m, &at, dimensions, &mut misfits);
        }
        for (number, line) in self.output.lines.iter().enumerate() {
            for (key, place) in [("from_m", &line.from_m), ("to_m", &line.to_m)] {
                let at = format!("/output/lines/{number}/{key}");
                check::coordinates(place, &at, dimensions, &mut misfits);
            }
        }
        check_bodies(&self.bodies, dimensions, &mut misfits);
        self.ways(&mut misfits);
        self.enclosures(&mut misfits);
        self.times(&mut misfits);
        if !fields && self.liquid.is_none() {
            misfits.push(Misfit::at(
                "",
                "at least one of \"electrostatics\", \"eddy_currents\" and \"liquid\" is wanted",
            ));
        }
        if let Some(liquid) = &self.liquid {
            liquid.check(self, &mut misfits);
        }
        if let Some(electrostatics) = &self.electrostatics {
            electrostatics.check(self, &mut misfits);
        }
        if let Some(currents) = &self.eddy_currents {
            currents.check(self, &mut misfits);
        }
        let mut faults = faulty(misfits);
        faults.extend(self.formulas());
        faults
    }

    /// Ways of forming derivatives that the equations asked for do not have.
    fn ways(&self, misfits: &mut Vec<Misfit>) {
        let smeared = matches!(self.method.interfaces, Interfaces::Smeared(_));
        if smeared && self.eddy_currents.is_some() {
            misfits.push(Misfit::at(
                "/method/interfaces/smeared",
                "is a way of electrostatics: eddy currents have one-sided slopes; leave \"interfaces\" away",
            ));
        }
        let incomplete = matches!(self.solver.way, Way::Ilu0 | Way::Ilut);
        let magnetic = (1..=self.bodies.len()).any(|m| self.magnetic(m));
        let currents = self.eddy_currents.as_ref();
        let together = currents.is_some_and(|c| c.charged(self.geometry) || magnetic);
        if incomplete && together && self.geometry == Geometry::Space {
            misfits.push(Misfit::at(
                "/solver/way",
                "incomplete factors serve one operator: potentials of charges and bodies of another permeability in space are solved for part by part; take \"auto\", or \"potential\": \"none\" of \"eddy_currents\" without such bodies",
            ));
        }
        let compared = self.electrostatics.is_some()
            && !smeared
            && self.geometry != Geometry::Axisymmetric
            && self.method.order > 2
            && self.eddy_currents.is_none();
        let what = if compared {
            "compares values with harmonic polynomials and has no weights of a Laplacian to make positive"
        } else {
            "has no positive weights of a Laplacian: exact for quartics, those times the fourth powers of the distances add up to zero"
        };
        if self.method.positive && (compared || self.method.order > 3) {
            let what = format!("order {} {what}: take order 2", self.method.order);
            misfits.push(Misfit::at("/method/positive", what));
        }
    }

    /// Names and shapes of enclosing surfaces.
    fn enclosures(&self, misfits: &mut Vec<Misfit>) {
        let mut names = BTreeSet::new();
        for (number, enclosure) in self.output.enclosures.iter().enumerate() {
            let at = format!("/output/enclosures/{number}");
            if !names.insert(&enclosure.name) {
                let what = format!("the name \"{}\" is taken", enclosure.name);
                misfits.push(Misfit::at(&format!("{at}/name"), what));
            }
            match &enclosure.surface {
                Closed::Shape(shape) => {
                    let at = format!("{at}/surface/shape");
                    check::check(shape, &at, self.geometry.dimensions(), misfits);
                }
                Closed::Around(around) if !self.bodies.iter().any(|b| b.name == around.body) => {
                    let names: Vec<&str> = self.bodies.iter().map(|b| b.name.as_str()).collect();
                    let what = format!(
                        "\"{}\" is no body; bodies are {}",
                        around.body,
                        names.join(", ")
                    );
                    misfits.push(Misfit::at(&format!("{at}/surface/around/body"), what));
                }
                Closed::Around(_) => {}
            }
        }
    }

    /// Times of frames lie in a march and rise.
    fn times(&self, misfits: &mut Vec<Misfit>) {
        let march = self.eddy_currents.as_ref();
        let flow = self.liquid.as_ref().and_then(|l| l.march);
        let flow = flow.map(|m| m.end_s);
        let end = march
            .and_then(|e| e.transient.as_ref())
            .map_or(flow.unwrap_or(0.0), |t| t.end_s);
        for (number, at) in self.output.at_s.iter().enumerate() {
            let path = format!("/output/at_s/{number}");
            if !(*at >= 0.0 && *at <= end) {
                let what = format!("{at} s is out of range: from 0 s to the end at {end} s");
                misfits.push(Misfit::at(&path, what));
            } else if number > 0 && *at <= self.output.at_s[number - 1] {
                let what = format!("{at} s does not rise above the time before it");
                misfits.push(Misfit::at(&path, what));
            }
        }
        if let Some(every) = self.output.every_s
            && end / every > 1e6
        {
            let what = format!("{} outputs are too many: at most 1e6", end / every);
            misfits.push(Misfit::at("/output/every_s", what));
        }
    }

    /// Faults of formulas and tables.
    fn formulas(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        for (number, body) in self.bodies.iter().enumerate() {
            let at = format!("/bodies/{number}/relative_permeability");
            faults.extend(body.relative_permeability.rows(&at).err());
        }
        if let Some(electrostatics) = &self.electrostatics {
            electrostatics.formulas(&mut faults);
        }
        if let Some(liquid) = &self.liquid {
            liquid.formulas(&mut faults);
        }
        let transient = self
            .eddy_currents
            .as_ref()
            .and_then(|e| e.transient.as_ref());
        if let Some(wave) = transient.and_then(|t| t.wave.as_ref()) {
            faults.extend(wave.compile("/eddy_currents/transient/wave", &["t"]).err());
        }
        faults
    }
}

fn faulty(misfits: Vec<Misfit>) -> Vec<Fault> {
    let located = misfits.into_iter().map(|m| Fault::at(&m.path, m.what));
    located.collect()
}

fn check_bodies(bodies: &[BodyScene], dimensions: usize, misfits: &mut Vec<Misfit>) {
    let mut names = BTreeSet::from(["surroundings"]);
    for (number, body) in bodies.iter().enumerate() {
        let at = format!("/bodies/{number}");
        check::check(&body.shape, &format!("{at}/shape"), dimensions, misfits);
        if !names.insert(&body.name) {
            let what = format!("the name \"{}\" is taken", body.name);
            misfits.push(Misfit::at(&format!("{at}/name"), what));
        }
    }
}

impl Domain {
    fn check(&self, geometry: Geometry, spacing: f64, misfits: &mut Vec<Misfit>) {
        let axisymmetric = geometry == Geometry::Axisymmetric;
        let dimensions = geometry.dimensions();
        match self {
            Self::Box(b) => {
                let both = check::coordinates(&b.min_m, "/domain/box/min_m", dimensions, misfits)
                    & check::coordinates(&b.max_m, "/domain/box/max_m", dimensions, misfits);
                for k in (0..dimensions).filter(|_| both) {
                    let at = format!("/domain/box/min_m/{k}");
                    check::reach([b.min_m[k], b.max_m[k]], &at, spacing, misfits);
                    if b.max_m[k] <= b.min_m[k] {
                        let what = format!("{} m is not above min_m, {} m", b.max_m[k], b.min_m[k]);
                        misfits.push(Misfit::at(&format!("/domain/box/max_m/{k}"), what));
                    }
                }
                if axisymmetric && both && b.min_m[0] < 0.0 {
                    let what = format!("r = {} m is out of range: at least 0", b.min_m[0]);
                    misfits.push(Misfit::at("/domain/box/min_m/0", what));
                }
            }
            Self::Sphere(s) => {
                let at = "/domain/sphere/centre_m";
                let fits = check::coordinates(&s.centre_m, at, dimensions, misfits);
                for (k, c) in s.centre_m.iter().enumerate().filter(|_| fits) {
                    let ends = [c - s.radius_m, c + s.radius_m];
                    check::reach(ends, &format!("{at}/{k}"), spacing, misfits);
                }
                if fits && axisymmetric && s.centre_m[0] != 0.0 {
                    let what = format!("r = {} m: the centre lies on the axis", s.centre_m[0]);
                    misfits.push(Misfit::at("/domain/sphere/centre_m/0", what));
                }
            }
        }
    }

    /// Names of the walls, by number.
    #[must_use]
    pub fn walls(&self, geometry: Geometry) -> Vec<&'static str> {
        match self {
            Self::Sphere(_) => vec![BALL],
            Self::Box(_) => geometry.walls(),
        }
    }
}

impl EddyCurrents {
    fn check(&self, scene: &Scene, misfits: &mut Vec<Misfit>) {
        let at = "/eddy_currents";
        let kinds = [
            ("harmonic", self.harmonic.is_some()),
            ("transient", self.transient.is_some()),
            ("static", self.standing.is_some()),
        ];
        let had: Vec<&str> = kinds.iter().filter(|k| k.1).map(|k| k.0).collect();
        match (&had[..], &self.transient) {
            ([], _) => misfits.push(Misfit::at(
                at,
                "one of \"harmonic\", \"transient\" and \"static\" is wanted",
            )),
            ([first, other, ..], _) => misfits.push(Misfit::at(
                &format!("{at}/{other}"),
                format!("\"{first}\" and \"{other}\" exclude each other"),
            )),
            (_, Some(t)) if t.step_s > t.end_s => {
                let what = format!("{} s is beyond the end at {} s", t.step_s, t.end_s);
                misfits.push(Misfit::at(&format!("{at}/transient/step_s"), what));
            }
            _ => {}
        }
        misfits.extend(self.transient.as_ref().and_then(Transient::narrow));
        let net = scene.bodies.iter().any(|b| b.net_current_a.is_some());
        if self.coils.is_empty() && self.applied_flux_density_t.is_none() && !net {
            let what = "neither \"coils\" nor \"applied_flux_density_t\" drives currents";
            misfits.push(Misfit::at(at, what));
        }
        if let Some(field) = &self.applied_flux_density_t {
            let at = format!("{at}/applied_flux_density_t");
            let wanted = match scene.geometry {
                Geometry::Axisymmetric => 2,
                Geometry::Plane | Geometry::Space => 3,
            };
            if field.len() != wanted {
                let what = format!("{} numbers; {wanted} are wanted", field.len());
                misfits.push(Misfit::at(&at, what));
            } else if wanted == 2 && field[0] != 0.0 {
                let what = "a uniform field has no radial part in an axisymmetric scene";
                misfits.push(Misfit::at(&format!("{at}/0"), what));
            }
        }
        for (number, coil) in self.coils.iter().enumerate() {
            coil.check(&format!("{at}/coils/{number}"), scene, misfits);
        }
    }
}

impl Coil {
    pub(super) fn check(&self, at: &str, scene: &Scene, misfits: &mut Vec<Misfit>) {
        let geometry = scene.geometry;
        match (self, geometry) {
            (Self::Region(region), _) => region.check(&format!("{at}/region"), scene, misfits),
            (Self::Loop(l), Geometry::Space | Geometry::Axisymmetric) => {
                let at = format!("{at}/loop");
                let dimensions = geometry.dimensions();
                let place = format!("{at}/centre_m");
                let fits = check::coordinates(&l.centre_m, &place, dimensions, misfits);
                let axisymmetric = geometry == Geometry::Axisymmetric;
                if fits && axisymmetric && l.centre_m[0] != 0.0 {
                    let what = format!("r = {} m: the centre lies on the axis", l.centre_m[0]);
                    misfits.push(Misfit::at(&format!("{place}/0"), what));
                }
                if let Some(n) = l.normal {
                    let zero = n.iter().all(|c| *c == 0.0);
                    if zero || axisymmetric && (n[0] != 0.0 || n[1] != 0.0) {
                        let what = "not zero, and along z in an axisymmetric scene";
                        misfits.push(Misfit::at(&format!("{at}/normal"), what));
                    }
                }
            }
            (Self::Segments(_), Geometry::Space) | (Self::Wire(_), Geometry::Plane) => {}
            (Self::Loop(_), Geometry::Plane) => {
                misfits.push(Misfit::at(
                    at,
                    "a loop has no place in a plane scene; wires have",
                ));
            }
            (Self::Segments(_), _) => {
                misfits.push(Misfit::at(at, "segments have a place in space alone"))
            }
            (Self::Wire(_), _) => misfits.push(Misfit::at(
                at,
                "a wire along z has a place in a plane scene alone",
            )),
        }
    }
}

impl RegionCoil {
    fn check(&self, at: &str, scene: &Scene, misfits: &mut Vec<Misfit>) {
        match scene.bodies.iter().find(|b| b.name == self.body) {
            None => {
                let names: Vec<&str> = scene.bodies.iter().map(|b| b.name.as_str()).collect();
                let what = format!(
                    "\"{}\" is no body; bodies are {}",
                    self.body,
                    names.join(", ")
                );
                misfits.push(Misfit::at(&format!("{at}/body"), what));
            }
            Some(body) if body.conductivity_s_m > 0.0 => {
                let what = format!(
                    "{} conducts: a current that is given is spread evenly, as over thin strands; leave its conductivity away",
                    self.body
                );
                misfits.push(Misfit::at(&format!("{at}/body"), what));
            }
            Some(_) => {}
        }
        let path = format!("{at}/axis");
        match (&self.axis, scene.geometry) {
            (None, Geometry::Space) => {
                misfits.push(Misfit::at(&path, "in space an axis is wanted"));
            }
            (Some(axis), Geometry::Space) if axis.normal.iter().all(|n| *n == 0.0) => {
                misfits.push(Misfit::at(&format!("{path}/normal"), "not zero"));
            }
            (Some(_), Geometry::Plane | Geometry::Axisymmetric) => {
                let what = "an axis has a place in space alone: here the current flows along z, or around the axis of the scene";
                misfits.push(Misfit::at(&path, what));
            }
            _ => {}
        }
    }
}
