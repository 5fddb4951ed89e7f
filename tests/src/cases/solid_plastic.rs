//! `solid-plastic`: a thick cylinder of metal under inner pressure.

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError};
use crate::solid::{changed, fault, frames};

/// Displacements are compared beyond this part of the outer radius, where the metal is elastic.
const OUTSIDE: f64 = 0.9;

/// The case.
pub(super) struct SolidPlastic;

impl Case for SolidPlastic {
    fn name(&self) -> &'static str {
        "solid-plastic"
    }

    fn tool(&self) -> &'static str {
        "jetsph"
    }

    fn reference(&self) -> &'static str {
        "Hill (1950, chapter 5): p = Y/sqrt(3) (2 ln(c/a) + 1 - c^2/b^2), perfectly plastic, plane strain"
    }

    fn targets(&self) -> Vec<Target> {
        vec![Target::error("displacement", 0.03).at_level(3)]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        // 8, 16 and 32 rows through the wall.
        let by = f64::from(1 << (level.clamp(1, 4) - 1));
        let patch = changed(lab, self.name(), |solid| {
            let spacing = solid["spacing_m"].as_f64().unwrap_or(f64::NAN);
            solid["spacing_m"] = json!(spacing / by);
        })?;
        let run = lab.run("jetsph", self.name(), &format!("level{level}"), &patch)?;
        let solid = &run.scene["solids"][0];
        let number = |value: &serde_json::Value| value.as_f64().unwrap_or(f64::NAN);
        let radius = |k: usize| number(&solid["body"]["difference"][k]["disc"]["radius_m"]);
        let (outer, inner) = (radius(0), radius(1));
        let (modulus, ratio) = (
            number(&solid["elastic"]["youngs_modulus_pa"]),
            number(&solid["elastic"]["poisson_ratio"]),
        );
        let shear = number(&solid["plasticity"]["yield_stress_pa"]) / 3.0_f64.sqrt();
        let pressure = number(&solid["loads"][0]["pressure_pa"]);
        let front = front(pressure / shear, (inner, outer));
        let all = frames(&run.artefact, "cylinder")?;
        let (Some(start), Some(last)) = (all.first(), all.last()) else {
            return Err(fault(&run, "has no frame"));
        };
        let (mut sum, mut count) = (0.0, 0.0);
        for (x, y) in start
            .position_vectors()?
            .iter()
            .zip(last.position_vectors()?)
        {
            let r = x[0].hypot(x[1]);
            if r > OUTSIDE * outer {
                let moved = ((y[0] - x[0]) * x[0] + (y[1] - x[1]) * x[1]) / r;
                let shape = (1.0 - 2.0 * ratio) * r / (outer * outer) + 1.0 / r;
                let exact = (1.0 + ratio) * shear * front * front / modulus * shape;
                sum += moved / exact;
                count += 1.0;
            }
        }
        let errors = Errors::from([("displacement".to_owned(), (sum / count - 1.0).abs())]);
        let spacing = number(&solid["spacing_m"]);
        Ok(Measurement::of(run, start.len() as u64, spacing, errors))
    }
}

/// Radius c to which the metal flows at a pressure over the yield stress in shear.
fn front(pressure: f64, (inner, outer): (f64, f64)) -> f64 {
    let (mut low, mut high) = (inner, outer);
    for _ in 0..200 {
        let c = 0.5 * (low + high);
        if 2.0 * (c / inner).ln() + 1.0 - (c / outer).powi(2) < pressure {
            low = c;
        } else {
            high = c;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flow_begins_inside_and_ends_outside() {
        // First yield at 1 - (a/b)^2, collapse at 2 ln(b/a).
        assert!((front(0.75, (1.0, 2.0)) - 1.0).abs() < 1e-12);
        assert!((front(2.0 * 2.0_f64.ln(), (1.0, 2.0)) - 2.0).abs() < 1e-6);
    }
}
