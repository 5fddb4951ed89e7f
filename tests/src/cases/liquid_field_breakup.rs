//! `liquid-field-breakup`: a drop in a field in which it has no rest grows pointed ends that shed liquid.

use artefact::Reader;
use serde_json::json;

use super::liquid_stretched::back;
use crate::case::{Case, Errors, Measurement, Target};
use crate::drop::{Series, Sphere, drift, points};
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct LiquidFieldBreakup;

/// Spacings in the radius, by level.
const PARTS: [f64; 3] = [4.0, 5.0, 6.5];
const EPS0: f64 = 8.854_187_812_8e-12;
/// End and step over sqrt(rho R^3/gamma), and frames until the end.
const END: f64 = 0.8;
const STEP: f64 = 0.04;
const FRAMES: f64 = 20.0;
/// Points of the surface farther from the middle than so much of half the length are an end.
const TIP: f64 = 0.9;

/// Fields, as eps0 E^2 R/gamma: that of section 4.1 is 2.85 times the greatest at which the drop is at rest (0.240), the other
/// is below that.
const BEYOND: &str = "4.1";
const BELOW: &str = "below";
const METHODS: [(&str, f64); 2] = [(BEYOND, 0.684), (BELOW, 0.1)];

impl Case for LiquidFieldBreakup {
    fn name(&self) -> &'static str {
        "liquid-field-breakup"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Matsuzawa (2017), 4.1: beyond its limit a drop has pointed ends; the curvature at the ends of a spheroid as long and as wide"
    }

    fn methods(&self) -> &'static [&'static str] {
        &[BEYOND, BELOW]
    }

    fn targets(&self) -> Vec<Target> {
        let each = METHODS.iter().flat_map(|(method, _)| {
            [
                Target::error("mass", 1e-3).of(*method),
                Target::error("momentum", 1e-8).of(*method),
                Target::error("time_left", 1e-6).of(*method),
            ]
        });
        let own = [
            Target::error("blunt", 0.8).of(BEYOND),
            Target::error("pointed", 0.1).of(BELOW),
            Target::error("strewn", 0.0).of(BELOW),
            Target::error("energy_back", 1e-3).of(BELOW),
        ];
        each.chain(own).collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let parts = PARTS[level.clamp(1, 3) as usize - 1];
        let sphere = Sphere::planned(lab, self.name())?;
        let (radius, time) = (sphere.radius, sphere.time());
        let found = METHODS.iter().find(|m| m.0 == method);
        let (_, capillary) = found.copied().unwrap_or(METHODS[0]);
        let field = (capillary * sphere.tension / (EPS0 * radius)).sqrt();
        let end = END * time;
        let patch = json!({
            "points": {"spacing_m": radius / parts},
            "liquid": {
                "electric": {"field_v_m": [0.0, 0.0, field]},
                "march": {"end_s": end, "step_s": STEP * time}
            },
            "output": {"every_s": end / FRAMES}
        });
        let label = format!("level{level}-{method}");
        let run = lab.run(self.tool(), self.name(), &label, &patch)?;
        let column = |name: &str| Series::read(&run, name);
        let [kinetic, surface, work] = [
            column("kinetic_energy")?,
            column("surface_energy")?,
            column("field_work")?,
        ];
        let both = kinetic.value.iter().zip(&surface.value);
        let energy: Vec<f64> = both.zip(&work.value).map(|((k, s), w)| k + s - w).collect();
        let speed = (sphere.tension / (sphere.density * radius)).sqrt();
        let mut moved = 0.0_f64;
        for axis in ["x", "y", "z"] {
            let speeds = column(&format!("velocity_{axis}"))?.value;
            moved = speeds
                .iter()
                .fold(moved, |most, u| most.max(u.abs() / speed));
        }
        let [volume, strewn] = ["volume", "volume_parcels"].map(column);
        let strewn = strewn?.value.last().copied().unwrap_or(f64::NAN) / volume?.value[0];
        let pointed = pointed(&run)?;
        let last = kinetic.time.last().copied().unwrap_or(f64::NAN);
        let errors = Errors::from([
            ("mass".to_owned(), drift(&run)?),
            ("momentum".to_owned(), moved),
            ("time_left".to_owned(), 1.0 - last / end),
            ("blunt".to_owned(), pointed.recip()),
            ("pointed".to_owned(), pointed - 1.0),
            ("strewn".to_owned(), strewn),
            ("energy_back".to_owned(), back(&energy)),
        ]);
        let count = points(&run)?;
        Ok(Measurement::of(run, count, radius / parts, errors))
    }
}

/// Greatest curvature of an end over that of a spheroid as long and as wide, `2 a/b^2`, at any frame.
fn pointed(run: &Finished) -> Result<f64, LabError> {
    let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
    let column = |name: &str| Series::read(run, name);
    let [x, y, z] = [
        column("extent_x")?,
        column("extent_y")?,
        column("extent_z")?,
    ];
    let middle = column("centre_z")?.value;
    let mut most = 0.0_f64;
    for k in 0..reader.count("/surface") {
        let time = reader.time("/surface", k)?;
        let Some(row) = z.time.iter().position(|t| (t - time).abs() < 1e-9) else {
            continue;
        };
        let (long, wide) = (0.5 * z.value[row], 0.25 * (x.value[row] + y.value[row]));
        let frame = reader.frame("/surface", k)?;
        let bent = frame.f64("curvature")?;
        for (place, bent) in frame.f64("z")?.iter().zip(bent) {
            if (place - middle[row]).abs() > TIP * long {
                most = most.max(bent * wide * wide / (2.0 * long));
            }
        }
    }
    Ok(most)
}
