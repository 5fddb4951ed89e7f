//! `pool-similar`: the same drop at other lengths.

use std::f64::consts::PI;

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError, Subject};
use crate::particles::{Frames, number};

/// The case.
pub(super) struct PoolSimilar;

impl Case for PoolSimilar {
    fn name(&self) -> &'static str {
        "pool-similar"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "the drop itself: R, sqrt(rho R^3/gamma) and gamma/R are its only length, time and pressure at one Oh"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["twentieth", "hundredfold"]
    }

    fn targets(&self) -> Vec<Target> {
        let each = self.methods().iter().flat_map(|method| {
            ["place", "velocity", "pressure"]
                .into_iter()
                .flat_map(move |column| {
                    (1..=3)
                        .map(move |level| Target::error(column, 0.01).at_level(level).of(*method))
                })
        });
        each.collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let times = if method == "twentieth" { 0.05 } else { 100.0 };
        let label = format!("{method}-level{level}");
        let one = drop(lab, self.name(), level, 1.0, &format!("{label}-base"))?;
        let other = drop(lab, self.name(), level, times, &label)?;
        let [first, second] = [&one, &other].map(|run| Frames::read(&run.artefact, "pressure"));
        let (first, second) = (first?, second?);
        let errors = errors(&first, &second, times);
        let (points, spacing) = (first.liquid.len() as u64, number(&one, "/spacing_m")?);
        Ok(Measurement::over(vec![one, other], points, spacing, errors))
    }
}

/// A third of a swing of a drop `size` times that of 5 mm, at Oh 0.02.
fn drop(lab: &Lab, case: &str, level: u32, size: f64, label: &str) -> Result<Finished, LabError> {
    let (radius, density, tension) = (5e-3_f64 * size, 7850.0, 1.0);
    let period = 2.0 * PI / (8.0 * tension / (density * radius.powi(3))).sqrt();
    let patch = json!({
        // 7, 9 and 11 particles along the radius.
        "spacing_m": radius / (5.0 + 2.0 * f64::from(level)),
        "time": {"step_s": period / 600.0, "end_s": period / 3.0},
        "bodies": [{
            "shape": {"ellipsoid": {"centre_m": [0, 0, 0], "semi_axes_m": [0.95 * radius, 0.95 * radius, 1.1 * radius]}},
            "state": "liquid"
        }],
        "flow": {"viscosity_pa_s": 0.02 * (density * tension * radius).sqrt()},
        "output": {"particles_interval_s": period / 30.0}
    });
    let scene = std::path::Path::new("pipelines/verify/flow-drop/scene.json");
    lab.run_scene(Subject::new("poolsph", case, scene), label, &patch, &[])
}

/// Root mean squares of the differences of all columns in their own units over those of the columns, the worst of all times.
/// Places count from where they started.
fn errors(one: &Frames, other: &Frames, times: f64) -> Errors {
    let place = |frames: &Frames, k: usize, scale: f64| -> Vec<f64> {
        let pairs = frames.position[k].iter().zip(&frames.position[0]);
        pairs
            .flat_map(|(x, from)| (0..3).map(move |i| (x[i] - from[i]) / scale))
            .collect()
    };
    let velocity = |frames: &Frames, k: usize, scale: f64| -> Vec<f64> {
        frames.velocity[k]
            .iter()
            .flatten()
            .map(|u| u / scale)
            .collect()
    };
    let pressure = |frames: &Frames, k: usize, scale: f64| -> Vec<f64> {
        frames.scalar[k].iter().map(|p| p / scale).collect()
    };
    let mut worst: [f64; 3] = [0.0; 3];
    for k in 1..one.time.len().min(other.time.len()) {
        let columns = [
            (place(one, k, 1.0), place(other, k, times)),
            (velocity(one, k, 1.0), velocity(other, k, times.powf(-0.5))),
            (pressure(one, k, 1.0), pressure(other, k, 1.0 / times)),
        ];
        for (worst, (a, b)) in worst.iter_mut().zip(columns) {
            let square: f64 = a.iter().map(|x| x * x).sum();
            let apart: f64 = a.iter().zip(&b).map(|(x, y)| (x - y).powi(2)).sum();
            *worst = worst.max((apart / square).sqrt());
        }
    }
    let [place, velocity, pressure] = worst;
    let errors = [
        ("place", place),
        ("velocity", velocity),
        ("pressure", pressure),
    ];
    errors.map(|(name, error)| (name.to_owned(), error)).into()
}
