//! `fracture-pull`: time and place where a bar breaks that is pulled at one end.

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError};
use crate::solid::{changed, fault, frames};

/// The case.
pub(super) struct FracturePull;

impl Case for FracturePull {
    fn name(&self) -> &'static str {
        "fracture-pull"
    }

    fn tool(&self) -> &'static str {
        "jetsph"
    }

    fn reference(&self) -> &'static str {
        "d'Alembert: 2 v/c at the clamp at L/c, 3 v/c at the pulled end at 2 L/c"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["clamp", "end", "near"]
    }

    fn targets(&self) -> Vec<Target> {
        let each = ["clamp", "end", "near"].into_iter().flat_map(|method| {
            ["time", "place"].map(|what| Target::error(what, 0.03).at_level(3).of(method))
        });
        each.collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let by = f64::from(1 << (level.clamp(1, 4) - 1));
        let (length, modulus, density, speed) = (0.1, 1e5_f64, 1000.0, 0.06);
        let sound = (modulus / density).sqrt();
        let (times, place, passes) = match method {
            "end" => (2.5, length, 2.0),
            "near" => (2.1, length, 2.0),
            _ => (1.5, 0.0, 1.0),
        };
        let patch = changed(lab, self.name(), |solid| {
            let spacing = solid["spacing_m"].as_f64().unwrap_or(f64::NAN);
            solid["spacing_m"] = json!(spacing / by);
            solid["fracture"] = json!({"principal_stress_pa": times * modulus * speed / sound});
        })?;
        let run = lab.run("jetsph", self.name(), &format!("{method}-{level}"), &patch)?;
        let frames = frames(&run.artefact, "bar")?;
        let first = frames.first().ok_or_else(|| fault(&run, "has no frame"))?;
        let points = first.len() as u64;
        let [time, x] = ["bar_first_break_s", "bar_first_break_x_m"].map(|what| run.closing(what));
        if time.is_nan() {
            return Err(fault(&run, "does not break"));
        }
        let exact = passes * length / sound;
        let errors = Errors::from([
            ("time".to_owned(), (time / exact - 1.0).abs()),
            // The pulled end has moved on.
            (
                "place".to_owned(),
                (x - place - speed * time * place / length).abs() / length,
            ),
        ]);
        Ok(Measurement::of(run, points, 0.002 / by, errors))
    }
}
