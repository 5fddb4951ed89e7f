//! `flow-sloshing`: the first mode of water in a tank with smooth walls.

use std::f64::consts::PI;

use crate::case::{Case, Errors, Measurement, Target};
use crate::flow::{METHODS, period};
use crate::lab::{Finished, Lab, LabError};
use crate::particles::{Frames, mean, measurement, number};

/// The case.
pub(super) struct FlowSloshing;

impl Case for FlowSloshing {
    fn name(&self) -> &'static str {
        "flow-sloshing"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "potential theory: omega^2 = g k tanh(k h); Lamb (1932), section 228"
    }

    fn methods(&self) -> &'static [&'static str] {
        METHODS
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("period", 0.005),
            Target::error("energy_gained", 1e-3),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        // 10, 15 and 20 layers.
        let spacing = 0.5 / f64::from(5 + 5 * level);
        let patch = serde_json::json!({"spacing_m": spacing, "flow": {"method": method}});
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

/// Twice the mean time between the moments at which the mode stands still; what energy has gained at most on what it was before,
/// over that of the start: that of motion whenever the surface passes its level, and that of motion and height at all times.
fn errors(run: &Finished, frames: &Frames) -> Result<Errors, LabError> {
    let (long, high) = (
        number(run, "/faces/max_m/0")?,
        number(run, "/bodies/0/shape/box/max_m/2")?,
    );
    let gravity = -number(run, "/flow/gravity_m_s2/2")?;
    let wave = PI / long;
    let exact = 2.0 * PI / (gravity * wave * (wave * high).tanh()).sqrt();
    let frame = |k: usize| frames.position[k].iter().zip(&frames.velocity[k]);
    let along = |k: usize| {
        let mode = |x: &[f64; 3]| (wave * x[0]).sin() * (wave * x[2]).cosh();
        mean(frame(k).map(|(x, u)| u[0] * mode(x)))
    };
    let energy = |k: usize| {
        mean(frame(k).map(|(x, u)| 0.5 * u.iter().map(|u| u * u).sum::<f64>() + gravity * x[2]))
    };
    let count = frames.time.len();
    let swing: Vec<f64> = (0..count).map(along).collect();
    let period = period(run, &frames.time, &swing)?;
    let moving = |k: usize| mean(frame(k).map(|(_, u)| 0.5 * u.iter().map(|u| u * u).sum::<f64>()));
    let moving: Vec<f64> = (0..count).map(moving).collect();
    let all = (0..count).map(|k| energy(k) / moving[0]);
    let errors = [
        ("period", (period / exact - 1.0).abs()),
        ("energy_gained", rise(passing(&moving)) / moving[0]),
        ("energy_by_heights", rise(all)),
    ];
    Ok(errors.map(|(name, error)| (name.to_owned(), error)).into())
}

/// The energy of motion at the start and at each of its later greatest values, by the parabola through three frames.
fn passing(moving: &[f64]) -> impl Iterator<Item = f64> {
    let peaks = moving.windows(3).filter(|w| w[1] > w[0] && w[1] >= w[2]);
    let peaks = peaks.map(|w| {
        let (slope, bend) = (0.5 * (w[2] - w[0]), w[2] - 2.0 * w[1] + w[0]);
        w[1] - 0.5 * slope * slope / bend
    });
    moving.first().copied().into_iter().chain(peaks)
}

/// The greatest rise above an earlier value.
fn rise(values: impl Iterator<Item = f64>) -> f64 {
    let (mut least, mut rise): (f64, f64) = (f64::INFINITY, 0.0);
    for value in values {
        least = least.min(value);
        rise = rise.max(value - least);
    }
    rise
}
