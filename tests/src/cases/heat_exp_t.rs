//! `heat-exp-t`: a plate whose conductivity grows with temperature, steady.

use serde_json::json;

use super::heat_exp_x::{plate, square_spacing, steady_error};
use crate::case::{Case, Errors, Measurement, Target};
use crate::heat::frames::Frames;
use crate::heat::methods::{self, STEADY, over};
use crate::lab::{Lab, LabError};

/// a of the paper, and two harder ones \[1/K\], with the target of each.
pub(super) const RATES: [(f64, f64); 5] = [
    (1.0, 1e-3),
    (2.0, 1e-3),
    (4.0, 1e-3),
    (-3.0, 1e-3),
    (8.0, 3e-3),
];

/// The case.
pub(super) struct HeatExpT;

impl Case for HeatExpT {
    fn name(&self) -> &'static str {
        "heat-exp-t"
    }

    fn tool(&self) -> &'static str {
        "heatsph"
    }

    fn reference(&self) -> &'static str {
        "Closed form, Rong and Kisu (2010), eq. 7"
    }

    fn methods(&self) -> &'static [&'static str] {
        STEADY
    }

    fn targets(&self) -> Vec<Target> {
        let target = |(rate, max): &(f64, f64)| {
            Target::error(format!("temperature_linf_a{rate}"), *max).at_level(2)
        };
        methods::also_jittered(RATES.iter().map(target).collect(), STEADY)
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = square_spacing(level);
        let mut all = Vec::new();
        let mut errors = Errors::new();
        let mut points = 0;
        for (rate, _) in RATES {
            let patch = over(
                json!({"points": {"spacing_m": spacing}, "materials": [material(rate)]}),
                &methods::patch(method),
            );
            let label = format!("level{level}-{method}-a{rate}");
            let run = lab.run(self.tool(), self.name(), &label, &patch)?;
            let frames = Frames::read(&run)?;
            let error = steady_error(&plate(&run)?, &frames);
            errors.insert(format!("temperature_linf_a{rate}"), error);
            points = frames.points();
            all.push(run);
        }
        Ok(Measurement::over(all, points, spacing, errors))
    }
}

/// The material with `k = exp(a T)`.
pub(super) fn material(rate: f64) -> serde_json::Value {
    json!({"name": "plate", "density_kg_m3": 1, "specific_heat_j_kg_k": 1,
           "conductivity_w_m_k": {"expr": format!("exp({rate}*T)")}})
}
