//! `solid-turn`: ten turns of a body without a load.

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError};
use crate::solid::{changed, fault, frames};

/// Turns of the run.
const TURNS: f64 = 10.0;
/// Angular velocities by level \[rad/s\].
const RATES: [f64; 2] = [3.0, 300.0];
/// Shear modulus over what the rim's speed makes of the density: so stiff that turning itself strains it by less than
/// what is asked for.
const STIFF: f64 = 4e4;

/// The case.
pub(super) struct SolidTurn;

impl Case for SolidTurn {
    fn name(&self) -> &'static str {
        "solid-turn"
    }

    fn tool(&self) -> &'static str {
        "jetsph"
    }

    fn reference(&self) -> &'static str {
        "no stress but that of turning, rho omega^2 R^2, 2.5e-5 G"
    }

    fn levels(&self, _: &str, asked: &[u32]) -> Vec<u32> {
        asked.iter().copied().filter(|l| *l <= 2).collect()
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("stress_linf", 1e-3).at_level(1),
            Target::error("stress_linf", 1e-3).at_level(2),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let rate = RATES[level.clamp(1, 2) as usize - 1];
        let mut shear = f64::NAN;
        let mut patch = changed(lab, self.name(), |solid| {
            let density = solid["density_kg_m3"].as_f64().unwrap_or(f64::NAN);
            let half = solid["body"]["box"]["max_m"][0]
                .as_f64()
                .unwrap_or(f64::NAN);
            shear = STIFF * density * rate * rate * half * half;
            solid["elastic"] = json!({"shear_modulus_pa": shear, "bulk_modulus_pa": 2.0 * shear});
            solid["velocity_m_s"] =
                json!([{"expr": format!("-{rate}*y")}, {"expr": format!("{rate}*x")}]);
        })?;
        let end = TURNS * std::f64::consts::TAU / rate;
        patch["time"] = json!({"end_s": end});
        patch["output"] = json!({"frames_interval_s": 0.05 * end});
        let run = lab.run("jetsph", self.name(), &format!("level{level}"), &patch)?;
        let frames = frames(&run.artefact, "square")?;
        let mut worst = 0.0_f64;
        for frame in &frames {
            for name in ["stress_xx", "stress_yy", "stress_xy"] {
                worst = frame
                    .f64(name)?
                    .iter()
                    .fold(worst, |w, s| w.max(s.abs() / shear));
            }
        }
        let last = frames.last().ok_or_else(|| fault(&run, "has no frame"))?;
        let points = last.len() as u64;
        let spacing = run.scene["solids"][0]["spacing_m"]
            .as_f64()
            .unwrap_or(f64::NAN);
        let errors = Errors::from([("stress_linf".to_owned(), worst)]);
        Ok(Measurement::of(run, points, spacing, errors))
    }
}
