//! `solid-plastic`: a thick cylinder of metal under inner pressure, and a bar that is pulled.

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError};
use crate::solid::{changed, fault, frames};

/// Displacements are compared beyond this part of the outer radius, where the metal is elastic.
const OUTSIDE: f64 = 0.9;
/// Nominal stress at the ends of the bar and its hardening \[Pa\].
const PULL: f64 = 1e9;
const HARDENING: f64 = 2.1e10;

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
        let cylinder = |level| {
            let target = Target::error("displacement", 0.03).at_level(level);
            target.of("cylinder")
        };
        let pulled = |quantity| Target::error(quantity, 0.01).at_level(1).of("uniaxial");
        vec![
            cylinder(1),
            cylinder(2),
            cylinder(3),
            pulled("plastic_strain"),
            pulled("stretch"),
        ]
    }

    fn methods(&self) -> &'static [&'static str] {
        &["cylinder", "uniaxial"]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        if method == "uniaxial" {
            return pulled(lab, level);
        }
        // 8, 16 and 32 rows through the wall.
        let by = f64::from(1 << (level.clamp(1, 4) - 1));
        let patch = changed(lab, self.name(), |solid| {
            let spacing = solid["spacing_m"].as_f64().unwrap_or(f64::NAN);
            solid["spacing_m"] = json!(spacing / by);
        })?;
        let run = lab.run("jetsph", self.name(), &format!("cylinder-{level}"), &patch)?;
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
        let front = front(pressure / shear, inner, outer);
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

/// A bar in space, pulled at both ends by a nominal stress P that rises slowly. With logarithmic strains
///
/// ```text
/// tau = P l,   ln l = tau/E + a,   tau = Y + H a
/// ```
fn pulled(lab: &Lab, level: u32) -> Result<Measurement, LabError> {
    // 2, 4 and 8 rows.
    let spacing = 0.02 / f64::from(1 << (level.clamp(1, 4) - 1));
    let mut patch = changed(lab, "solid-plastic", |solid| {
        solid["body"] = json!({"box": {"min_m": [0, 0, 0], "max_m": [0.1, 0.04, 0.04]}});
        solid["spacing_m"] = json!(spacing);
        solid["plasticity"]["hardening_pa"] = json!(HARDENING);
        solid["damping_1_s"] = json!(4e4);
        solid["loads"] = json!([
            {"on": ["x+"], "traction_pa": [PULL, 0, 0], "rise_s": 4e-3},
            {"on": ["x-"], "traction_pa": [-PULL, 0, 0], "rise_s": 4e-3}
        ]);
    })?;
    patch["dimensions"] = json!(3);
    patch["time"] = json!({"end_s": 4.5e-3});
    patch["output"] = json!({"frames_interval_s": 1.5e-3});
    let run = lab.run(
        "jetsph",
        "solid-plastic",
        &format!("uniaxial-{level}"),
        &patch,
    )?;
    let solid = &run.scene["solids"][0];
    let number = |value: &serde_json::Value| value.as_f64().unwrap_or(f64::NAN);
    let modulus = number(&solid["elastic"]["youngs_modulus_pa"]);
    let (yielding, hardening) = (
        number(&solid["plasticity"]["yield_stress_pa"]),
        number(&solid["plasticity"]["hardening_pa"]),
    );
    let pull = number(&solid["loads"][0]["traction_pa"][0]);
    let mut stress = pull;
    for _ in 0..200 {
        stress = pull * (stress / modulus + (stress - yielding) / hardening).exp();
    }
    let all = frames(&run.artefact, "cylinder")?;
    let (Some(start), Some(last)) = (all.first(), all.last()) else {
        return Err(fault(&run, "has no frame"));
    };
    let strains = last.f64("plastic_strain")?;
    let strain = strains.iter().sum::<f64>() / strains.len() as f64;
    let length = |frame: &artefact::Frame| -> Result<f64, LabError> {
        let along = frame.position_vectors()?;
        let ends = along
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| {
                [a.min(x[0]), b.max(x[0])]
            });
        Ok(ends[1] - ends[0])
    };
    let errors = Errors::from([
        (
            "plastic_strain".to_owned(),
            (strain * hardening / (stress - yielding) - 1.0).abs(),
        ),
        (
            "stretch".to_owned(),
            ((length(last)? / length(start)?).ln() / (stress / pull).ln() - 1.0).abs(),
        ),
    ]);
    Ok(Measurement::of(run, start.len() as u64, spacing, errors))
}

/// Radius c to which the metal flows at a pressure over the yield stress in shear.
fn front(pressure: f64, inner: f64, outer: f64) -> f64 {
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
        assert!((front(0.75, 1.0, 2.0) - 1.0).abs() < 1e-12);
        assert!((front(2.0 * 2.0_f64.ln(), 1.0, 2.0) - 2.0).abs() < 1e-6);
    }
}
