//! `flow-dam-break`: a column of water that is let go.

use serde_json::Value;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError, read_json};
use crate::norms::Worst;
use crate::particles::{Frames, measurement, number};

/// The case.
pub(super) struct FlowDamBreak;

/// Greatest shift of time that the gate may have taken, in sqrt(a/g)/n.
const SHIFT: f64 = 0.1;

impl Case for FlowDamBreak {
    fn name(&self) -> &'static str {
        "flow-dam-break"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "Martin and Moyce (1952), tables 2 and 6, measured; potential flow by boundary elements, potential_flow.json"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["high-2", "high-1"]
    }

    fn targets(&self) -> Vec<Target> {
        let each = self.methods().iter().flat_map(|method| {
            [2, 3].map(|level| {
                ["front", "front_potential"]
                    .map(|error| Target::error(error, 0.05).at_level(level).of(*method))
            })
        });
        each.flatten().collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        // 12, 18 and 24 particles across the column.
        let wide = 0.05715;
        let spacing = wide / f64::from(6 + 6 * level);
        let high = if method == "high-1" { wide } else { 2.0 * wide };
        // Six particles between the mirrors at the sides.
        let deep = 6.0 * spacing;
        let patch = serde_json::json!({
            "spacing_m": spacing,
            "bodies": [{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [wide, deep, high]}}, "state": "liquid"}],
            "faces": {"max_m": [1.0, deep, 1.0]}
        });
        let run = lab.run(
            "poolsph",
            self.name(),
            &format!("{method}-level{level}"),
            &patch,
        )?;
        let frames = Frames::read(&run.artefact, "pressure")?;
        let errors = errors(lab, &run, &frames)?;
        measurement(run, frames.liquid.len(), errors)
    }
}

/// The place of the front beside the measured one, over it, after the best shift of time, and beside that of potential flow,
/// which starts when it starts; the worst of all points that the run reaches.
fn errors(lab: &Lab, run: &Finished, frames: &Frames) -> Result<Errors, LabError> {
    let wide = number(run, "/bodies/0/shape/box/max_m/0")?;
    let ratio = number(run, "/bodies/0/shape/box/max_m/2")? / wide;
    let gravity = -number(run, "/flow/gravity_m_s2/2")?;
    let spacing = number(run, "/spacing_m")?;
    let name = if (ratio - 2.0).abs() < 1e-9 {
        "front_2"
    } else if (ratio - 1.0).abs() < 1e-9 {
        "front_1"
    } else {
        let path = run.artefact.clone();
        let what = format!("is {ratio} times as high as wide; fronts of 1 and 2 are known");
        return Err(LabError::Content { path, what });
    };
    let unit = (wide / gravity).sqrt() / ratio.sqrt();
    let front = frames.position.iter().map(|places| {
        let farthest = places.iter().map(|x| x[0]).fold(0.0, f64::max);
        (farthest + 0.5 * spacing) / wide
    });
    let found: Vec<(f64, f64)> = frames.time.iter().map(|t| t / unit).zip(front).collect();
    let measured = known(lab, "martin_moyce_1952.json", name)?;
    let shifts = (-20..=20).map(|k| SHIFT / 20.0 * f64::from(k));
    let best = shifts.map(|shift| apart(&found, &measured, shift));
    let potential = known(lab, "potential_flow.json", name)?;
    Ok(Errors::from([
        ("front".to_owned(), best.fold(f64::INFINITY, f64::min)),
        ("front_potential".to_owned(), apart(&found, &potential, 0.0)),
    ]))
}

/// Times and places of a front that a file beside the scene knows.
fn known(lab: &Lab, file: &str, name: &str) -> Result<Vec<(f64, f64)>, LabError> {
    let path = lab.root.join("pipelines/verify/flow-dam-break").join(file);
    let data: Value = read_json(&path)?;
    let rows = data[name]["rows"].as_array().into_iter().flatten();
    let row = |row: &Value| Some((row[0].as_f64()?, row[1].as_f64()?));
    let known: Vec<(f64, f64)> = rows.filter_map(row).collect();
    let none = || LabError::Content {
        path: path.clone(),
        what: format!("has no rows of '{name}'"),
    };
    if known.is_empty() {
        return Err(none());
    }
    Ok(known)
}

/// The greatest difference of a front that starts later by a shift from the one that is known, over it.
fn apart(found: &[(f64, f64)], known: &[(f64, f64)], shift: f64) -> f64 {
    let points = known.iter().filter_map(|(time, place)| {
        let at = along(found, time - shift)?;
        Some((at / place - 1.0).abs())
    });
    points.worst()
}

/// The value at a time, between the rows on a line; none beyond them.
fn along(rows: &[(f64, f64)], time: f64) -> Option<f64> {
    let pair = rows
        .windows(2)
        .find(|pair| pair[0].0 <= time && time <= pair[1].0)?;
    let part = (time - pair[0].0) / (pair[1].0 - pair[0].0);
    Some(pair[0].1 + part * (pair[1].1 - pair[0].1))
}
