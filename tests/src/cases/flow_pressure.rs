//! `flow-pressure`: what a pressure on the surface, or a greater weight, may not change.

use std::path::Path;

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::flow::{apart, layers};
use crate::lab::{Finished, Lab, LabError, Subject};
use crate::particles::{Frames, number};

/// The case.
pub(super) struct FlowPressure;

/// Each method: the case that it is a variant of, what presses on the surface \[Pa\], and times the weight.
const VARIANTS: [(&str, &str, &str, f64); 9] = [
    ("layer-0.1-kpa", "flow-marangoni", "100", 1.0),
    ("layer-2-kpa", "flow-marangoni", "2000", 1.0),
    ("layer-20-kpa", "flow-marangoni", "20000", 1.0),
    (
        "layer-2-kpa-ramped",
        "flow-marangoni",
        "2000*min(1, t/0.1)",
        1.0,
    ),
    ("layer-10-g", "flow-marangoni", "", 10.0),
    ("layer-100-g", "flow-marangoni", "", 100.0),
    ("poiseuille-10-g", "flow-poiseuille", "", 10.0),
    ("poiseuille-100-g", "flow-poiseuille", "", 100.0),
    ("couette-100-g", "flow-couette", "", 100.0),
];

impl Case for FlowPressure {
    fn name(&self) -> &'static str {
        "flow-pressure"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "the same run without: a uniform pressure, and a weight that the floor bears, move no incompressible liquid"
    }

    fn methods(&self) -> &'static [&'static str] {
        &[
            "layer-0.1-kpa",
            "layer-2-kpa",
            "layer-20-kpa",
            "layer-2-kpa-ramped",
            "layer-10-g",
            "layer-100-g",
            "poiseuille-10-g",
            "poiseuille-100-g",
            "couette-100-g",
        ]
    }

    fn targets(&self) -> Vec<Target> {
        let each = self.methods().iter().flat_map(|method| {
            (1..=3).flat_map(move |level| {
                [("profile", 0.01), ("surface", 0.01)]
                    .map(|(name, max)| Target::error(name, max).at_level(level).of(*method))
            })
        });
        each.collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let variant = VARIANTS.iter().find(|(name, ..)| *name == method);
        let Some(&(_, case, pressure, weight)) = variant else {
            unreachable!("methods are the variants");
        };
        let layer = case == "flow-marangoni";
        let spacing = if layer {
            2.5e-3 / f64::from(5 + 5 * level)
        } else {
            1e-3 / f64::from(level)
        };
        // Plates bear no weight in their own cases.
        let mut base = json!({"spacing_m": spacing});
        if !layer {
            base["flow"] = json!({"gravity_m_s2": [if case == "flow-couette" { 0.0 } else { 0.008 }, 0, -9.81]});
        }
        let scene = Path::new("pipelines/verify").join(case).join("scene.json");
        let label = format!("{method}-level{level}-without");
        let of = Subject::new("poolsph", self.name(), &scene);
        let without = lab.run_scene(of, &label, &base, &[])?;
        let with = lab.varied(
            &without,
            &format!("{method}-level{level}"),
            &changed(&without, pressure, weight)?,
        );
        let with = match with {
            Ok(run) => run,
            // A run that bursts is one that changed.
            Err(LabError::Tool { code: Some(1), .. }) => {
                let errors = ["profile", "surface"].map(|name| (name.to_owned(), f64::INFINITY));
                let points = Frames::read(&without.artefact, "pressure")?.liquid.len() as u64;
                return Ok(Measurement::of(without, points, spacing, errors.into()));
            }
            Err(error) => return Err(error),
        };
        let points = Frames::read(&with.artefact, "pressure")?.liquid.len() as u64;
        let errors = errors(&without, &with)?;
        Ok(Measurement::over(
            vec![without, with],
            points,
            spacing,
            errors,
        ))
    }
}

/// What is pressed, or heavier.
fn changed(run: &Finished, pressure: &str, weight: f64) -> Result<Value, LabError> {
    let [x, y, z] = [0, 1, 2].map(|k| number(run, &format!("/flow/gravity_m_s2/{k}")));
    let mut patch = json!({"flow": {"gravity_m_s2": [x?, y?, weight * z?]}});
    if !pressure.is_empty() {
        patch["source"] = json!({"start_m": [0, 0, 0], "velocity_m_s": [0, 0, 0]});
        patch["arc_pressure"] = json!({"pressure_pa": {"expr": pressure}});
    }
    Ok(patch)
}

/// Greatest difference of the speeds of layers, over their range, and of the height of the surface, over the depth, at
/// all times.
fn errors(without: &Finished, with: &Finished) -> Result<Errors, LabError> {
    let high = number(without, "/bodies/0/shape/box/max_m/2")?;
    let spacing = number(without, "/spacing_m")?;
    let n = (high / spacing).round() as usize;
    let [one, other] = [without, with].map(|run| Frames::read(&run.artefact, "pressure"));
    let (one, other) = (one?, other?);
    let speeds = |frames: &Frames, k: usize| {
        let points = frames.position[k].iter().zip(&frames.velocity[k]);
        layers(points.map(|(x, u)| (x[2], u[0])), high, n)
    };
    let top = |frames: &Frames, k: usize| {
        let mut heights: Vec<f64> = frames.position[k].iter().map(|x| x[2]).collect();
        heights.sort_by(f64::total_cmp);
        // The upper layer's mean.
        let upper = heights.len() / n;
        heights.iter().rev().take(upper).sum::<f64>() / upper as f64
    };
    let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
    let (mut profile, mut surface): (f64, f64) = (0.0, 0.0);
    for k in 0..one.time.len().min(other.time.len()) {
        let (a, b) = (speeds(&one, k), speeds(&other, k));
        for [_, u] in &a {
            (least, greatest) = (least.min(*u), greatest.max(*u));
        }
        profile = profile.max(apart(&a, &b, high, n));
        surface = surface.max((top(&one, k) - top(&other, k)).abs() / high);
    }
    let errors = [
        ("profile", profile / (greatest - least)),
        ("surface", surface),
    ];
    Ok(errors.map(|(name, error)| (name.to_owned(), error)).into())
}
