//! `solid-patch`: uniform strain of a shaken lattice.

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError};
use crate::solid::{finer, frames};

/// Rates of deformation of the scene in x, y by x, y \[1/s\], which act for one step of one second.
const RATE: [[f64; 2]; 2] = [[0.02, 0.01], [-0.005, 0.03]];

/// The case.
pub(super) struct SolidPatch;

impl Case for SolidPatch {
    fn name(&self) -> &'static str {
        "solid-patch"
    }

    fn tool(&self) -> &'static str {
        "jetsph"
    }

    fn reference(&self) -> &'static str {
        "neo-Hookean stress of a uniform deformation, plane strain"
    }

    fn targets(&self) -> Vec<Target> {
        vec![Target::error("stress_linf", 1e-10)]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let by = f64::from(1 << (level.clamp(1, 4) - 1));
        let mut patch = finer(lab, self.name(), by)?;
        // One step, which must be a stable one.
        patch["time"] = json!({"end_s": 1.0, "step_s": 1.0});
        let run = lab.run("jetsph", self.name(), &format!("level{level}"), &patch)?;
        let solid = &run.scene["solids"][0];
        let number = |key: &str| solid["elastic"][key].as_f64().unwrap_or(f64::NAN);
        let (bulk, shear) = (number("bulk_modulus_pa"), number("shear_modulus_pa"));
        let exact = stress(bulk - 2.0 / 3.0 * shear, shear);
        let frames = frames(&run.artefact, "patch")?;
        let (mut worst, mut points) = (f64::INFINITY, 0);
        if let Some(last) = frames.last() {
            worst = 0.0;
            points = last.len() as u64;
            for (name, exact) in ["stress_xx", "stress_yy", "stress_xy"].iter().zip(exact) {
                let found = last.f64(name)?;
                let miss = found.iter().map(|s| (s - exact).abs() / shear);
                worst = miss.fold(worst, f64::max);
            }
        }
        let spacing = solid["spacing_m"].as_f64().unwrap_or(f64::NAN);
        let errors = Errors::from([("stress_linf".to_owned(), worst)]);
        Ok(Measurement::of(run, points, spacing, errors))
    }
}

/// Cauchy stress xx, yy, xy: (mu (b - 1) + lambda ln J) / J, with b = F F^T.
fn stress(lame: f64, shear: f64) -> [f64; 3] {
    let f = [
        [1.0 + RATE[0][0], RATE[0][1]],
        [RATE[1][0], 1.0 + RATE[1][1]],
    ];
    let volume = f[0][0] * f[1][1] - f[0][1] * f[1][0];
    let left = |i: usize, j: usize| f[i][0] * f[j][0] + f[i][1] * f[j][1];
    let normal = |i: usize| (shear * (left(i, i) - 1.0) + lame * volume.ln()) / volume;
    [normal(0), normal(1), shear * left(0, 1) / volume]
}
