//! `pool-drop-oscillation`: the period of a drop that swings about the sphere.

use std::f64::consts::PI;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::particles::{Frames, mean, measurement, number};

/// The case.
pub(super) struct PoolDropOscillation;

impl Case for PoolDropOscillation {
    fn name(&self) -> &'static str {
        "pool-drop-oscillation"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "Rayleigh (1879): omega^2 = 8 gamma / (rho R^3)"
    }

    fn targets(&self) -> Vec<Target> {
        vec![Target::error("period", 0.03)]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        // About 7, 9 and 11 particles along the radius.
        let spacing = 5.3e-3 / (5.0 + 2.0 * f64::from(level));
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
    let cube = 0.75 * volume / PI;
    let stiffness = 8.0 * number(run, "/tension/surface_tension_n_m")?;
    let exact = 2.0 * PI / (stiffness / (number(run, "/density_kg_m3")? * cube)).sqrt();
    let swing: Vec<f64> = frames
        .position
        .iter()
        .map(|places| elongation(places, liquid))
        .collect();
    let zeros = zeros(&frames.time, &swing);
    let (Some(first), Some(last), true) = (zeros.first(), zeros.last(), zeros.len() > 2) else {
        return Err(LabError::Content {
            path: run.artefact.clone(),
            what: format!("swings through the sphere {} times, not three", zeros.len()),
        });
    };
    let period = 2.0 * (last - first) / (zeros.len() - 1) as f64;
    Ok(Errors::from([(
        "period".to_owned(),
        (period / exact - 1.0).abs(),
    )]))
}

/// Second moment along z less the mean of those across, over the sum of all three.
fn elongation(places: &[[f64; 3]], liquid: &[usize]) -> f64 {
    let moment = |i: usize| {
        let centre = mean(liquid.iter().map(|a| places[*a][i]));
        mean(liquid.iter().map(|a| (places[*a][i] - centre).powi(2)))
    };
    let [x, y, z] = [0, 1, 2].map(moment);
    (z - 0.5 * (x + y)) / (x + y + z)
}

/// Times at which `y` changes its sign, between the rows on a line.
fn zeros(time: &[f64], y: &[f64]) -> Vec<f64> {
    let pairs = time.windows(2).zip(y.windows(2));
    let crossing = pairs.filter(|(_, y)| (y[0] > 0.0) != (y[1] > 0.0));
    crossing
        .map(|(t, y)| t[0] + (t[1] - t[0]) * y[0] / (y[0] - y[1]))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_of_a_damped_swing_tell_its_period() {
        let time: Vec<f64> = (0..400).map(|k| 0.01 * f64::from(k)).collect();
        let swing: Vec<f64> = time.iter().map(|t| (-t).exp() * (5.0 * t).cos()).collect();
        let zeros = zeros(&time, &swing);
        let half = (zeros[zeros.len() - 1] - zeros[0]) / (zeros.len() - 1) as f64;
        assert!((half / (PI / 5.0) - 1.0).abs() < 1e-3, "{half}");
    }

    #[test]
    fn a_rod_is_longer_than_a_ball() {
        let rod: Vec<[f64; 3]> = (0..5).map(|k| [0.0, 0.0, f64::from(k)]).collect();
        let all: Vec<usize> = (0..5).collect();
        assert!((elongation(&rod, &all) - 1.0).abs() < 1e-12);
    }
}
