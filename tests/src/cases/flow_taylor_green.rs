//! `flow-taylor-green`: rows of vortices that die out by viscosity alone.

use std::f64::consts::PI;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::particles::{Frames, measurement, number};

/// The case.
pub(super) struct FlowTaylorGreen;

impl Case for FlowTaylorGreen {
    fn name(&self) -> &'static str {
        "flow-taylor-green"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "Taylor and Green (1937) in the plane: u = U sin(kx) cos(ky) e^(-2 nu k^2 t)"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["re-100", "re-10", "re-1000"]
    }

    fn targets(&self) -> Vec<Target> {
        let each = self.methods().iter().flat_map(|method| {
            [
                Target::error("decay", 0.02).of(*method),
                Target::order("velocity", 1.0).of(*method),
            ]
        });
        each.collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        // 20, 30 and 50 particles along a period.
        let cells = [20.0, 30.0, 50.0][level.clamp(1, 3) as usize - 1];
        let reynolds: f64 = method.trim_start_matches("re-").parse().unwrap_or(100.0);
        let patch = serde_json::json!({
            "spacing_m": 0.01 / cells,
            "flow": {"viscosity_pa_s": 1000.0 * 0.1 * 0.01 / reynolds}
        });
        let run = lab.run(
            "poolsph",
            self.name(),
            &format!("{method}-level{level}"),
            &patch,
        )?;
        let frames = Frames::read(&run.artefact, "pressure")?;
        let errors = errors(&run, &frames)?;
        measurement(run, frames.liquid.len(), errors)
    }
}

/// The rate of decay until the motion is a tenth of what it was, or to the end; speeds over U, in the mean of squares.
fn errors(run: &Finished, frames: &Frames) -> Result<Errors, LabError> {
    let wave = 2.0 * PI / number(run, "/faces/max_m/0")?;
    let nu = number(run, "/flow/viscosity_pa_s")? / number(run, "/density_kg_m3")?;
    let rate = 2.0 * nu * wave * wave;
    let mode = |x: &[f64; 3]| {
        let (x, y) = (wave * x[0], wave * x[1]);
        [x.sin() * y.cos(), -x.cos() * y.sin(), 0.0]
    };
    let amplitude = |k: usize| {
        let (mut along, mut square) = (0.0, 0.0);
        for (x, u) in frames.position[k].iter().zip(&frames.velocity[k]) {
            let m = mode(x);
            along += m[0] * u[0] + m[1] * u[1];
            square += m[0] * m[0] + m[1] * m[1];
        }
        along / square
    };
    let first = amplitude(0);
    let mut decay = f64::NAN;
    let mut worst: f64 = 0.0;
    for k in 1..frames.time.len() {
        let time = frames.time[k];
        let (fallen, exact) = (amplitude(k) / first, (-rate * time).exp());
        if exact > 0.1 || decay.is_nan() {
            decay = (-fallen.max(1e-300).ln() / (rate * time) - 1.0).abs();
        }
        let points = frames.position[k].iter().zip(&frames.velocity[k]);
        let squares = points.map(|(x, u)| {
            let m = mode(x);
            (0..3)
                .map(|i| (u[i] / first - exact * m[i]).powi(2))
                .sum::<f64>()
        });
        worst = worst.max((squares.sum::<f64>() / frames.position[k].len() as f64).sqrt());
    }
    let errors = [("decay", decay), ("velocity", worst)];
    Ok(errors.map(|(name, error)| (name.to_owned(), error)).into())
}
