//! `dem-shear-loop`: a grain pressed on a plane and sheared to and fro.

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::grains::{fault, frames};
use crate::lab::{Finished, Lab, LabError};
use crate::norms::Worst;
use crate::particles::number;

/// The case.
pub(super) struct DemShearLoop;

impl Case for DemShearLoop {
    fn name(&self) -> &'static str {
        "dem-shear-loop"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "a spring with a slider: a loop of 4 mu N (A - mu N / k_t) each time round"
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("closure", 0.02),
            Target::error("loss", 0.02),
            Target::error("force", 0.02),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let steps = 100.0 * f64::from(1 << (level.clamp(1, 6) - 1));
        let scene = lab.run("poolsph", self.name(), &format!("scene{level}"), &json!({}))?;
        let end = number(&scene, "/time/end_s")?;
        let step = end / 3.0 / steps;
        let patch = json!({"time": {"step_s": step}, "output": {"particles_interval_s": step}});
        let run = lab.varied(&scene, &format!("level{level}"), &patch)?;
        let errors = errors(&run)?;
        let spacing = number(&run, "/grains/bodies/0/radius_m")? / steps;
        Ok(Measurement::of(run, steps as u64, spacing, errors))
    }
}

/// The run lasts three times round.
fn errors(run: &Finished) -> Result<Errors, LabError> {
    let at = |key: &str| number(run, &format!("/grains/{key}"));
    let (r, z) = (at("bodies/0/radius_m")?, at("bodies/0/places_m/0/2")?);
    let k = at("contact/law/linear/stiffness_n_m")?;
    let k_t = k * at("contact/law/linear/tangential_ratio").unwrap_or(1.0);
    let most = at("contact/friction")? * k * (r - z);
    let mut course = Vec::new();
    for frame in frames(&run.artefact)? {
        let (x, force) = (
            frame.position_vectors()?[0][0],
            frame.vectors("force")?[0][0],
        );
        course.push((x, force));
    }
    let round = (course.len() - 1) / 3;
    if round < 8 {
        return Err(fault(run, "has too few frames"));
    }
    let (second, third) = (&course[round..=2 * round], &course[2 * round..]);
    let gap = second.iter().zip(third).map(|(a, b)| (a.1 - b.1).abs());
    let loss: f64 = third
        .windows(2)
        .map(|w| -0.5 * (w[0].1 + w[1].1) * (w[1].0 - w[0].0))
        .sum();
    let reach = |pick: fn(f64, f64) -> f64| third.iter().map(|(x, _)| *x).reduce(pick);
    let (low, high) = (
        reach(f64::min).unwrap_or(0.0),
        reach(f64::max).unwrap_or(0.0),
    );
    let amplitude = 0.5 * (high - low);
    let exact = 4.0 * most * (amplitude - most / k_t);
    let largest = third.iter().map(|(_, f)| f.abs()).fold(0.0, f64::max);
    Ok(Errors::from([
        ("closure".to_owned(), gap.worst() / most),
        ("loss".to_owned(), (loss / exact - 1.0).abs()),
        ("force".to_owned(), (largest / most - 1.0).abs()),
    ]))
}
