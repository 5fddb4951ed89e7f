//! `liquid-leaky`: a drop whose surface holds the charge that currents bring to it, drawn out or flattened, and turning round inside.

use serde_json::json;

use artefact::Reader;

use crate::case::{Case, Errors, Measurement, Target};
use crate::drop::{Series, Sphere, drift, points};
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct LiquidLeaky;

/// Spacings per radius, by level.
const PARTS: [f64; 3] = [5.0, 6.5, 8.0];
const EPS0: f64 = 8.854_187_812_8e-12;
/// mu/sqrt(rho gamma R): the drop settles without swinging.
const OHNESORGE: f64 = 0.5;
/// End of the march over sqrt(rho R^3/gamma), and a step.
const END: f64 = 5.0;
const STEP: f64 = 0.1;
/// eps0 E^2 R/gamma.
const CAPILLARY: f64 = 5e-3;
/// Conductivity and permittivity over those of the gas, by method.
const METHODS: [(&str, f64, f64); 2] = [("prolate", 10.0, 2.0), ("oblate", 0.5, 4.0)];

impl Case for LiquidLeaky {
    fn name(&self) -> &'static str {
        "liquid-leaky"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Taylor (1966), Melcher and Taylor (1969): deformation and surface speed of first order in eps0 E^2 R/gamma, in a gas without friction"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["prolate", "oblate"]
    }

    fn targets(&self) -> Vec<Target> {
        let each = METHODS.iter().flat_map(|(method, ..)| {
            [("deformation", 3e-2), ("speed", 5e-2), ("volume", 1e-6)]
                .map(|(name, most)| Target::error(name, most).of(*method))
        });
        each.collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let parts = PARTS[level.clamp(1, 3) as usize - 1];
        let sphere = Sphere::planned(lab, self.name())?;
        let (radius, tension, time) = (sphere.radius, sphere.tension, sphere.time());
        let found = METHODS.iter().find(|m| m.0 == method);
        let (_, ratio, permittivity) = found.copied().unwrap_or(METHODS[0]);
        let field = (CAPILLARY * tension / (EPS0 * radius)).sqrt();
        let viscosity = OHNESORGE * (sphere.density * tension * radius).sqrt();
        let patch = json!({
            "points": {"spacing_m": radius / parts},
            "liquid": {
                "viscosity_pa_s": viscosity,
                "electric": {
                    "field_v_m": [0.0, 0.0, field],
                    "relative_permittivity": permittivity, "relative_conductivity": ratio
                },
                "march": {"end_s": END * time, "step_s": STEP * time}
            }
        });
        let label = format!("level{level}-{method}");
        let run = lab.run(self.tool(), self.name(), &label, &patch)?;
        let last = |name: &str| -> Result<f64, LabError> {
            let series = Series::read(&run, name)?;
            Ok(series.value.last().copied().unwrap_or(f64::NAN))
        };
        let (x, z) = (last("radius_x")?, last("radius_z")?);
        let share = CAPILLARY / (2.0 + ratio).powi(2);
        let bent = 1.0 + ratio * ratio - 2.0 * permittivity + 1.8 * (ratio - permittivity);
        let speed = -1.8 * share * (ratio - permittivity) * tension / viscosity;
        let deformation = (z - x) / (z + x) / (9.0 / 16.0 * share * bent);
        let errors = Errors::from([
            ("deformation".to_owned(), (deformation - 1.0).abs()),
            ("speed".to_owned(), (circulation(&run)? / speed - 1.0).abs()),
            ("volume".to_owned(), drift(&run)?),
        ]);
        let count = points(&run)?;
        Ok(Measurement::of(run, count, radius / parts, errors))
    }
}

/// The factor of sin cos in the velocity along the surface from the pole to the equator, by least squares \[m/s\].
fn circulation(run: &Finished) -> Result<f64, LabError> {
    let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
    let frame = reader.frame("/points", reader.count("/points") - 1)?;
    let (place, u) = (frame.position_vectors()?, frame.vectors("velocity")?);
    let kind = frame.f64("kind")?;
    let (mut sum, mut squares) = (0.0, 0.0);
    for k in (0..place.len()).filter(|k| kind[*k] > 0.5) {
        let [x, y, z] = place[k];
        let (ring, r) = (x.hypot(y), (x * x + y * y + z * z).sqrt());
        let (sine, cosine) = (ring / r, z / r);
        let outward = if ring > 0.0 {
            (u[k][0] * x + u[k][1] * y) / ring
        } else {
            0.0
        };
        let along = outward * cosine - u[k][2] * sine;
        sum += along * sine * cosine;
        squares += (sine * cosine).powi(2);
    }
    Ok(sum / squares)
}
