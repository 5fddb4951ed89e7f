//! `liquid-rest`: a drop at rest stays at rest, at the pressure of its tension.

use serde_json::json;

use artefact::Reader;

use crate::case::{Case, Errors, Measurement, Target};
use crate::drop::{Sphere, points};
use crate::lab::{Lab, LabError};
use crate::norms::Worst as _;

/// The case.
pub(super) struct LiquidRest;

/// Spacings per radius, by level.
const PARTS: [f64; 3] = [4.0, 5.0, 6.5];
/// Steps of a run.
const STEPS: f64 = 200.0;
/// A step over sqrt(rho R^3/gamma) times h/R.
const STEP: f64 = 0.3;

impl Case for LiquidRest {
    fn name(&self) -> &'static str {
        "liquid-rest"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Young and Laplace: p = p_gas + 2 gamma/R, and nothing moves"
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("pressure_mean", 5e-4),
            Target::error("pressure_spread", 5e-3),
            Target::error("capillary_number", 1e-5),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let parts = PARTS[level.clamp(1, 3) as usize - 1];
        let sphere = Sphere::planned(lab, self.name())?;
        let (radius, tension) = (sphere.radius, sphere.tension);
        let end = STEPS * STEP / parts * sphere.time();
        let patch = json!({
            "points": {"spacing_m": radius / parts},
            "liquid": {"march": {"end_s": end}}
        });
        let run = lab.run(self.tool(), self.name(), &format!("level{level}"), &patch)?;
        let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
        let frame = reader.frame("/points", reader.count("/points") - 1)?;
        let gas = run.scene["liquid"]["gas_pressure_pa"]
            .as_f64()
            .unwrap_or(0.0);
        let wanted = 2.0 * tension / radius;
        let pressure: Vec<f64> = frame.f64("pressure")?.iter().map(|p| p - gas).collect();
        let mean = pressure.iter().sum::<f64>() / pressure.len() as f64;
        let spread = pressure.iter().map(|p| (p - mean).abs()).worst();
        let fastest = frame
            .vectors("velocity")?
            .iter()
            .map(|u| u.iter().map(|c| c * c).sum::<f64>().sqrt())
            .worst();
        let errors = Errors::from([
            ("pressure_mean".to_owned(), (mean / wanted - 1.0).abs()),
            ("pressure_spread".to_owned(), spread / wanted),
            (
                "capillary_number".to_owned(),
                sphere.viscosity * fastest / tension,
            ),
        ]);
        let count = points(&run)?;
        Ok(Measurement::of(run, count, radius / parts, errors))
    }
}
