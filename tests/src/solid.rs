//! Solids of `jetsph` for exact cases: finer scenes, frames, and how a body swings.

use std::path::Path;

use artefact::{Frame, Reader};
use serde_json::{Value, json};

use crate::lab::{Finished, Lab, LabError};

/// The solids of a case's scene with their spacings divided by `by`, as a patch.
pub(crate) fn finer(lab: &Lab, case: &str, by: f64) -> Result<Value, LabError> {
    changed(lab, case, |solid| {
        let spacing = solid["spacing_m"].as_f64().unwrap_or(f64::NAN);
        solid["spacing_m"] = json!(spacing / by);
    })
}

/// The solids of a case's scene, each changed, as a patch.
pub(crate) fn changed(
    lab: &Lab,
    case: &str,
    mut change: impl FnMut(&mut Value),
) -> Result<Value, LabError> {
    let path = lab
        .root
        .join("pipelines/verify")
        .join(case)
        .join("scene.json");
    let text = std::fs::read_to_string(&path).map_err(|source| LabError::Io {
        path: path.clone(),
        source,
    })?;
    let mut scene: Value = serde_json::from_str(&text).map_err(|e| LabError::Content {
        path: path.clone(),
        what: e.to_string(),
    })?;
    let solids = scene["solids"].as_array_mut();
    solids.into_iter().flatten().for_each(&mut change);
    Ok(json!({ "solids": scene["solids"].take() }))
}

/// All frames of a solid.
pub(crate) fn frames(artefact: &Path, name: &str) -> Result<Vec<Frame>, LabError> {
    let reader = Reader::open_kind(artefact, "jet-frames", 1)?;
    let channel = format!("/{name}");
    let frames = reader.frames(&channel)?;
    Ok(frames.collect::<artefact::Result<_>>()?)
}

/// What is wrong with a run.
pub(crate) fn fault(run: &Finished, what: &str) -> LabError {
    LabError::Content {
        path: run.artefact.clone(),
        what: what.to_owned(),
    }
}

/// How a body swings that is pushed from rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Swing {
    /// From the push to where it comes by in the same direction \[s\].
    pub(crate) period: f64,
    /// Second excursion over the first.
    pub(crate) kept: f64,
}

/// The swing of displacements in the shape of the first velocities.
pub(crate) fn swing(frames: &[Frame]) -> Result<Option<Swing>, LabError> {
    let Some(first) = frames.first() else {
        return Ok(None);
    };
    let (start, shape) = (first.position_vectors()?, first.vectors("velocity")?);
    let mut course = Vec::new();
    for frame in frames {
        let places = frame.position_vectors()?;
        let each = places.iter().zip(&start).zip(&shape);
        let moved: f64 = each
            .map(|((x, x0), u)| (0..3).map(|k| (x[k] - x0[k]) * u[k]).sum::<f64>())
            .sum();
        course.push((frame.time_s, moved));
    }
    Ok(swing_of(&course))
}

/// The swing of a course in time that begins at 0 and rises.
fn swing_of(course: &[(f64, f64)]) -> Option<Swing> {
    let crossing = |falling: bool| {
        let sign = if falling { 1.0 } else { -1.0 };
        let pairs = course.windows(2).skip(1);
        let found = pairs
            .clone()
            .find(|pair| sign * pair[0].1 > 0.0 && sign * pair[1].1 <= 0.0);
        found.map(|pair| {
            let [(t, q), (later, r)] = [pair[0], pair[1]];
            t + (later - t) * q / (q - r)
        })
    };
    let (half, period) = (crossing(true)?, crossing(false)?);
    let furthest = |from: f64, to: f64| {
        let at = (1..course.len().saturating_sub(1))
            .filter(|k| course[*k].0 > from && course[*k].0 < to)
            .max_by(|a, b| course[*a].1.abs().total_cmp(&course[*b].1.abs()))?;
        // The top of the parabola through three of them.
        let [a, b, c] = [at - 1, at, at + 1].map(|k| course[k].1.abs());
        Some(b + (a - c).powi(2) / (8.0 * (2.0 * b - a - c)).max(f64::MIN_POSITIVE))
    };
    Some(Swing {
        period,
        kept: furthest(half, period)? / furthest(0.0, half)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_damped_sine_is_seen_as_it_is() {
        let at = |k: i32| {
            let t = 0.02 * f64::from(k);
            (t, (-0.1 * t).exp() * (2.0 * t).sin())
        };
        let course: Vec<_> = (0..200).map(at).collect();
        let swing = swing_of(&course).unwrap();
        assert!((swing.period - std::f64::consts::PI).abs() < 1e-4);
        let kept = (-0.05 * std::f64::consts::PI).exp();
        assert!((swing.kept - kept).abs() < 1e-4);
    }
}
