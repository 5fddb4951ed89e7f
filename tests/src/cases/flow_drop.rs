//! `flow-drop`: a drop that swings about the sphere, with and without viscosity, at any size.

use std::f64::consts::PI;

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::drop::Series;
use crate::drop::swing::{Fit, fit, rest};
use crate::flow::drop_mode;
use crate::lab::{Finished, Lab, LabError};
use crate::particles::{Frames, mean, measurement, number};

/// The case.
pub(super) struct FlowDrop;

/// Oh = mu / sqrt(rho gamma R) and times the size of each method.
const DROPS: [(&str, f64, f64); 5] = [
    ("inviscid", 0.0, 1.0),
    ("oh-0.02", 0.02, 1.0),
    ("oh-0.06", 0.06, 1.0),
    ("oh-0.02-twentieth", 0.02, 0.05),
    ("oh-0.02-hundredfold", 0.02, 100.0),
];

impl Case for FlowDrop {
    fn name(&self) -> &'static str {
        "flow-drop"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "Rayleigh (1879); with viscosity the second mode of Chandrasekhar (1961), section 98, solved for its complex rate"
    }

    fn methods(&self) -> &'static [&'static str] {
        &[
            "inviscid",
            "oh-0.02",
            "oh-0.06",
            "oh-0.02-twentieth",
            "oh-0.02-hundredfold",
        ]
    }

    fn targets(&self) -> Vec<Target> {
        let mut targets = Vec::new();
        for (name, ohnesorge, _) in DROPS {
            for level in [2, 3] {
                targets.push(Target::error("period", 0.01).at_level(level).of(name));
                if ohnesorge > 0.0 {
                    targets.push(Target::error("decay", 0.1).at_level(level).of(name));
                }
            }
        }
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let drop = DROPS.iter().find(|(name, ..)| *name == method);
        let Some(&(_, ohnesorge, size)) = drop else {
            unreachable!("methods are the drops");
        };
        let (radius, density, tension) = (5e-3_f64 * size, 7850.0, 1.0);
        let period = 2.0 * PI / (8.0 * tension / (density * radius.powi(3))).sqrt();
        // Volume is kept: a tenth longer along z.
        let long = 1.1_f64;
        let across = radius / long.sqrt();
        let patch = json!({
            // 7, 9 and 11 particles along the radius.
            "spacing_m": radius / (5.0 + 2.0 * f64::from(level)),
            "time": {"step_s": period / 600.0, "end_s": 4.0 * period},
            "bodies": [{
                "shape": {"ellipsoid": {"centre_m": [0, 0, 0], "semi_axes_m": [across, across, radius * long]}},
                "state": "liquid"
            }],
            "flow": {"viscosity_pa_s": ohnesorge * (density * tension * radius).sqrt()},
            "output": {"particles_interval_s": period / 50.0}
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

/// Period and decay of the elongation by a fit without the first quarter, and what it swings about.
fn errors(run: &Finished, frames: &Frames) -> Result<Errors, LabError> {
    let volume = frames.liquid.len() as f64 * frames.volume;
    let radius = (0.75 * volume / PI).cbrt();
    let density = number(run, "/density_kg_m3")?;
    let rayleigh =
        (8.0 * number(run, "/tension/surface_tension_n_m")? / (density * radius.powi(3))).sqrt();
    let diffusion = number(run, "/flow/viscosity_pa_s")? / density / (radius * radius);
    let (frequency, decay) = if diffusion > 0.0 {
        drop_mode(rayleigh, diffusion)
    } else {
        (rayleigh, 0.0)
    };
    let swing: Vec<f64> = frames
        .position
        .iter()
        .map(|places| elongation(places))
        .collect();
    // The lattice rings at first.
    let first = frames.time.partition_point(|t| *t < 0.5 * PI / frequency);
    let series = Series {
        time: frames.time[first..].to_vec(),
        value: swing[first..].to_vec(),
    };
    let found = fit(&series, Fit { frequency, decay });
    let mut errors = vec![("period", (frequency / found.frequency - 1.0).abs())];
    if decay > 0.0 {
        errors.push(("decay", (found.decay / decay - 1.0).abs()));
    } else {
        // Of the swing, in a period.
        errors.push(("lost", 1.0 - (-found.decay * found.period()).exp()));
    }
    errors.push(("rest", (rest(&series, found) / swing[0]).abs()));
    Ok(errors
        .into_iter()
        .map(|(name, error)| (name.to_owned(), error))
        .collect())
}

/// Second moment along z less the mean of those across, over the sum of all three.
fn elongation(places: &[[f64; 3]]) -> f64 {
    let moment = |i: usize| {
        let centre = mean(places.iter().map(|x| x[i]));
        mean(places.iter().map(|x| (x[i] - centre).powi(2)))
    };
    let [x, y, z] = [0, 1, 2].map(moment);
    (z - 0.5 * (x + y)) / (x + y + z)
}
