//! `liquid-field-march`: a drop that settles in a uniform electric field, at every step pulled by the field about its shape.

use serde_json::json;

use artefact::Reader;

use crate::case::{Case, Errors, Measurement, Target};
use crate::drop::{Series, Sphere, drift, points};
use crate::lab::{Lab, LabError};

/// The case.
pub(super) struct LiquidFieldMarch;

/// Spacings per radius, by level.
const PARTS: [f64; 3] = [5.0, 6.5, 8.0];
const EPS0: f64 = 8.854_187_812_8e-12;
/// mu/sqrt(rho gamma R): the drop settles without swinging.
const OHNESORGE: f64 = 0.5;
/// End of the march over sqrt(rho R^3/gamma).
const END: f64 = 4.0;
/// A step over the same.
const STEP: f64 = 0.1;

/// Permittivities and eps0 E^2 R/gamma: some 0.2 to 0.7 of the greatest at which a drop is at rest, and a little one.
const METHODS: [(&str, Option<f64>, f64); 4] = [
    ("s-80", Some(80.0), 0.05),
    ("conductor", None, 0.05),
    ("s-2", Some(2.0), 0.5),
    (TAYLOR, Some(20.0), 5e-3),
];
/// The one that is judged by Taylor's formula.
const TAYLOR: &str = "taylor";

impl Case for LiquidFieldMarch {
    fn name(&self) -> &'static str {
        "liquid-field-march"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "The drop at rest by the balance of normal stress, found without a march; Taylor: D = 9/16 Ca ((S-1)/(S+2))^2"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["s-80", "conductor", "s-2", TAYLOR]
    }

    fn targets(&self) -> Vec<Target> {
        let mut targets = Vec::new();
        for (method, ..) in METHODS {
            targets.push(Target::error("deformation", 2e-2).of(method));
            targets.push(Target::error("volume", 1e-6).of(method));
        }
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let parts = PARTS[level.clamp(1, 3) as usize - 1];
        let sphere = Sphere::planned(lab, self.name())?;
        let (radius, tension, time) = (sphere.radius, sphere.tension, sphere.time());
        let found = METHODS.iter().find(|m| m.0 == method);
        let (_, permittivity, capillary) = found.copied().unwrap_or(METHODS[0]);
        let field = (capillary * tension / (EPS0 * radius)).sqrt();
        let wanted = match permittivity {
            Some(s) if method == TAYLOR => 9.0 / 16.0 * capillary * ((s - 1.0) / (s + 2.0)).powi(2),
            _ => self.rest(lab, method, radius, field, permittivity)?,
        };
        let viscosity = OHNESORGE * (sphere.density * tension * radius).sqrt();
        let patch = json!({
            "points": {"spacing_m": radius / parts},
            "liquid": {
                "viscosity_pa_s": viscosity,
                "electric": {"field_v_m": [0.0, 0.0, field], "relative_permittivity": permittivity},
                "march": {"end_s": END * time, "step_s": STEP * time}
            }
        });
        let label = format!("level{level}-{method}");
        let run = lab.run(self.tool(), self.name(), &label, &patch)?;
        let [x, z] = ["radius_x", "radius_z"].map(|name| Series::read(&run, name));
        let last = |series: &Series| series.value.last().copied().unwrap_or(f64::NAN);
        let (x, z) = (last(&x?), last(&z?));
        let errors = Errors::from([
            (
                "deformation".to_owned(),
                ((z - x) / (z + x) / wanted - 1.0).abs(),
            ),
            ("volume".to_owned(), drift(&run)?),
        ]);
        let count = points(&run)?;
        Ok(Measurement::of(run, count, radius / parts, errors))
    }
}

impl LiquidFieldMarch {
    /// D of the drop at rest.
    fn rest(
        &self,
        lab: &Lab,
        method: &str,
        radius: f64,
        field: f64,
        permittivity: Option<f64>,
    ) -> Result<f64, LabError> {
        let patch = json!({
            "points": {"spacing_m": radius / 8.0},
            "liquid": {
                "viscosity_pa_s": null, "electric": null, "march": null,
                "equilibrium": {"field_v_m": field, "relative_permittivity": permittivity}
            }
        });
        let rest = lab.run(self.tool(), self.name(), &format!("rest-{method}"), &patch)?;
        let reader = Reader::open_kind(&rest.artefact, "point-fields", 1)?;
        Ok(reader.record("/liquid")?.get("deformation")?)
    }
}
