//! `flow-marangoni`: a layer that its surface is pulled along, and that returns below.

use crate::case::{Case, Errors, Measurement, Target};
use crate::flow::{Driven, layers, zeros};
use crate::lab::{Finished, Lab, LabError, Subject};
use crate::norms::Worst as _;
use crate::particles::{Frames, measurement, number};

/// The case.
pub(super) struct FlowMarangoni;

/// Stress \[Pa\] and viscosity \[Pa s\] of each method: Re = u h/nu is 10 in layers of 2.5 mm.
const STRESSES: [(&str, f64, f64); 5] = [
    ("0.01-pa", 0.01, 1.25e-3),
    ("0.1-pa", 0.1, 3.953e-3),
    ("1-pa", 1.0, 1.25e-2),
    ("10-pa", 10.0, 3.953e-2),
    ("1-pa-back", -1.0, 1.25e-2),
];

impl Case for FlowMarangoni {
    fn name(&self) -> &'static str {
        "flow-marangoni"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "return flow u = tau h/(4 mu) (3 c^2 - 2 c), and from rest on by sines"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["0.01-pa", "0.1-pa", "1-pa", "10-pa", "1-pa-back", "closed"]
    }

    fn targets(&self) -> Vec<Target> {
        let each = self.methods().iter().flat_map(|method| {
            [
                Target::error("surface", 0.05).at_level(1).of(*method),
                Target::error("surface", 0.03).at_level(3).of(*method),
                Target::error("turn", 0.02).at_level(1).of(*method),
                Target::error("turn", 0.02).at_level(3).of(*method),
            ]
        });
        each.collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        // 10, 15 and 20 layers.
        let spacing = 2.5e-3 / f64::from(5 + 5 * level);
        let label = format!("{method}-level{level}");
        let run = match STRESSES.iter().find(|(name, ..)| *name == method) {
            Some((_, stress, viscosity)) => {
                // The force that returns what the stress pulls: 3/2 tau/(rho h).
                let along = -1.5 * stress / (1000.0 * 2.5e-3);
                let time = 1000.0 * 2.5e-3_f64.powi(2) / viscosity;
                let patch = serde_json::json!({
                    "spacing_m": spacing,
                    "time": {"step_s": (time / 1000.0).min(5e-4), "end_s": time},
                    "flow": {"viscosity_pa_s": viscosity, "gravity_m_s2": [along, 0, -9.81]},
                    "surface_stress": {"stress_pa": [stress, 0, 0]},
                    "output": {"particles_interval_s": time / 20.0}
                });
                lab.run("poolsph", self.name(), &label, &patch)?
            }
            None => {
                let scene = std::path::Path::new("pipelines/verify/flow-marangoni/closed.json");
                let patch = serde_json::json!({"spacing_m": spacing});
                lab.run_scene(
                    Subject::new("poolsph", self.name(), scene),
                    &label,
                    &patch,
                    &[],
                )?
            }
        };
        let frames = Frames::read(&run.artefact, "pressure")?;
        let errors = errors(&run, &frames)?;
        measurement(run, frames.liquid.len(), errors)
    }
}

/// What drives the layer, as its scene says.
fn driven(run: &Finished) -> Result<Driven, LabError> {
    let high = number(run, "/bodies/0/shape/box/max_m/2")?;
    let viscosity = number(run, "/flow/viscosity_pa_s")?;
    let density = number(run, "/density_kg_m3")?;
    if let Ok(stress) = number(run, "/surface_stress/stress_pa/0") {
        let along = number(run, "/flow/gravity_m_s2/0")?;
        return Ok(Driven {
            stress: stress * high / viscosity,
            force: along * density * high * high / viscosity,
        });
    }
    // Between closed ends the surface tilts until nothing flows through a section.
    let long = number(run, "/faces/max_m/0")?;
    let slope = number(run, "/marangoni/slope_n_m_k")?;
    let kelvin =
        number(run, "/faces/wall/1/temperature_k")? - number(run, "/faces/wall/0/temperature_k")?;
    let stress = slope * kelvin / long * high / viscosity;
    Ok(Driven {
        stress,
        force: -1.5 * stress,
    })
}

/// Means over the last quarter: the speed of the upper layer, the height at which the flow turns, the profile; and the
/// profile at all times, as parts of the speed of the surface and of the height.
fn errors(run: &Finished, frames: &Frames) -> Result<Errors, LabError> {
    let high = number(run, "/bodies/0/shape/box/max_m/2")?;
    let nu = number(run, "/flow/viscosity_pa_s")? / number(run, "/density_kg_m3")?;
    let n = (high / number(run, "/spacing_m")?).round() as usize;
    let flow = driven(run)?;
    let scale = flow.speed(1.0, f64::INFINITY).abs();
    let end = frames.time.last().copied().unwrap_or(0.0);
    // Between closed ends the middle two fifths are parallel flow, and it starts as it likes.
    let closed = number(run, "/surface_stress/stress_pa/0").is_err();
    let long = number(run, "/faces/max_m/0")?;
    let middle = |x: f64| !closed || (x / long - 0.5).abs() < 0.2;
    let (mut late, mut started): (Vec<(f64, f64)>, f64) = (Vec::new(), 0.0);
    let all = frames
        .time
        .iter()
        .zip(&frames.position)
        .zip(&frames.velocity);
    for ((time, places), speeds) in all.skip(1) {
        let points = places.iter().zip(speeds).filter(|(x, _)| middle(x[0]));
        let points = points.map(|(x, u)| (x[2], u[0]));
        if *time > 0.75 * end {
            late.extend(points.clone());
        }
        for [z, u] in layers(points, high, n) {
            let exact = flow.speed((z / high).min(1.0), nu * time / (high * high));
            started = started.max((u - exact).abs() / scale);
        }
    }
    let seen = layers(late.into_iter(), high, n);
    let tau = if closed {
        f64::INFINITY
    } else {
        nu * 0.875 * end / (high * high)
    };
    let exact = |z: f64| flow.speed((z / high).min(1.0), tau);
    let error = |[z, u]: &[f64; 2]| (u - exact(*z)).abs() / scale;
    let profile = seen.iter().map(error).worst();
    let surface = seen.last().map_or(f64::NAN, error);
    let (heights, speeds): (Vec<f64>, Vec<f64>) = seen.iter().map(|[z, u]| (z / high, *u)).unzip();
    let heights_of = |heights: &[f64], speeds: &[f64]| zeros(heights, speeds).last().copied();
    let fine: Vec<f64> = (1..=1000).map(|k| 1e-3 * f64::from(k)).collect();
    let there: Vec<f64> = fine.iter().map(|c| flow.speed(*c, tau)).collect();
    // The uppermost turn; none is as wrong as can be.
    let turn = match (heights_of(&heights, &speeds), heights_of(&fine, &there)) {
        (Some(found), Some(exact)) => (found - exact).abs(),
        _ => 1.0,
    };
    let mut errors = vec![("surface", surface), ("turn", turn), ("profile", profile)];
    if !closed {
        errors.push(("start", started));
    }
    Ok(errors
        .into_iter()
        .map(|(name, error)| (name.to_owned(), error))
        .collect())
}
