//! `pool-drop-pressure`: the pressure in a free drop.

use std::f64::consts::PI;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::particles::{Frames, mean, measurement, number};

/// The case.
pub(super) struct PoolDropPressure;

impl Case for PoolDropPressure {
    fn name(&self) -> &'static str {
        "pool-drop-pressure"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "Young (1805), Laplace (1806): p = 2 gamma / R"
    }

    fn targets(&self) -> Vec<Target> {
        vec![Target::error("pressure", 0.03)]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        // A cube of 14, 18, 22 particles along the edge, which rounds itself.
        let spacing = 7e-3 / f64::from(10 + 4 * level);
        let patch = serde_json::json!({"spacing_m": spacing});
        let run = lab.run("poolsph", self.name(), &format!("level{level}"), &patch)?;
        let frames = Frames::read(&run.artefact, "pressure")?;
        let liquid = frames.liquid();
        let errors = errors(&run, &frames, &liquid)?;
        measurement(run, liquid.len(), errors)
    }
}

fn errors(run: &Finished, frames: &Frames, liquid: &[usize]) -> Result<Errors, LabError> {
    let volume = liquid.len() as f64 * frames.volume;
    let radius = (0.75 * volume / PI).cbrt();
    let exact = 2.0 * number(run, "/tension/surface_tension_n_m")? / radius;
    let inside = |k: usize| {
        let places = &frames.position[k];
        let centre = [0, 1, 2].map(|i| mean(liquid.iter().map(|a| places[*a][i])));
        let near = liquid.iter().filter(|a| {
            let square: f64 = (0..3).map(|i| (places[**a][i] - centre[i]).powi(2)).sum();
            square < 0.25 * radius * radius
        });
        mean(near.map(|a| frames.scalar[k][*a]))
    };
    let pressure = mean(frames.second_half().map(inside));
    Ok(Errors::from([(
        "pressure".to_owned(),
        (pressure / exact - 1.0).abs(),
    )]))
}
