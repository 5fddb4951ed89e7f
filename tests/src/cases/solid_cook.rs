//! `solid-cook`: a cantilever and Cook's membrane of a nearly incompressible solid bend under a shear load at their end.

use artefact::Frame;
use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError};
use crate::solid::{changed, fault, frames};

/// Deflection of the middle of the loaded face by finite elements of order 8, over traction/E \[m\].
const BEAM: f64 = 7.7293;
/// The same for the membrane of 48 mm.
const MEMBRANE: f64 = 18.736 * 16e-3;

/// The case.
pub(super) struct SolidCook;

impl Case for SolidCook {
    fn name(&self) -> &'static str {
        "solid-cook"
    }

    fn tool(&self) -> &'static str {
        "jetsph"
    }

    fn reference(&self) -> &'static str {
        "finite elements of order 8, plane strain, nu 0.49; the membrane of Cook (1974)"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["beam", "membrane"]
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("deflection", 0.02).at_level(2).of("beam"),
            Target::error("deflection", 0.02).at_level(3).of("beam"),
            Target::error("deflection", 0.02).at_level(3).of("membrane"),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        // 4, 8 and 16 rows of the beam; 4, 8 and 16 rows at the loaded face of the membrane.
        let by = f64::from(1 << (level.clamp(1, 4) - 1));
        let patch = changed(lab, self.name(), |solid| {
            let mut spacing = solid["spacing_m"].as_f64().unwrap_or(f64::NAN);
            if method == "membrane" {
                spacing = 0.004;
                solid["body"] = json!({"intersection": [
                    {"box": {"min_m": [0, 0], "max_m": [0.048, 0.06]}},
                    {"half_space": {"name": "lower", "point_m": [0, 0], "normal": [44, -48]}},
                    {"half_space": {"name": "upper", "point_m": [0, 0.044], "normal": [-16, 48]}}
                ]});
            }
            solid["spacing_m"] = json!(spacing / by);
        })?;
        let run = lab.run("jetsph", self.name(), &format!("{method}-{level}"), &patch)?;
        let solid = &run.scene["solids"][0];
        let number = |value: &serde_json::Value| value.as_f64().unwrap_or(f64::NAN);
        let spacing = number(&solid["spacing_m"]);
        let all = frames(&run.artefact, "beam")?;
        let (Some(start), Some(last)) = (all.first(), all.last()) else {
            return Err(fault(&run, "has no frame"));
        };
        let (face, middle) = if method == "membrane" {
            (0.048, 0.052)
        } else {
            (0.1, 0.0)
        };
        let scale = number(&solid["loads"][0]["traction_pa"][1])
            / number(&solid["elastic"]["youngs_modulus_pa"]);
        let exact = scale * if method == "membrane" { MEMBRANE } else { BEAM };
        let found = deflection(start, last, face, middle, spacing)?;
        let errors = Errors::from([("deflection".to_owned(), (found / exact - 1.0).abs())]);
        Ok(Measurement::of(run, start.len() as u64, spacing, errors))
    }
}

/// Deflection at the middle of the loaded face: of the next two columns of particles, continued to the face.
fn deflection(
    start: &Frame,
    last: &Frame,
    face: f64,
    middle: f64,
    spacing: f64,
) -> Result<f64, LabError> {
    let (from, to) = (start.position_vectors()?, last.position_vectors()?);
    let column = |number: f64| {
        let at = face - (number + 0.5) * spacing;
        let near = from.iter().zip(&to).filter(|(x, _)| {
            (x[0] - at).abs() < 0.4 * spacing && (x[1] - middle).abs() < 0.9 * spacing
        });
        let (sum, count) = near.fold((0.0, 0.0), |(sum, count), (x, y)| {
            (sum + y[1] - x[1], count + 1.0)
        });
        sum / count
    };
    Ok(1.5 * column(0.0) - 0.5 * column(1.0))
}
