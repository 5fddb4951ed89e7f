//! `solid-rings`: two rubber rings meet and bounce, after Gray, Monaghan and Swift (2001).

use std::collections::BTreeMap;

use artefact::Frame;
use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::solid::{changed, fault, frames};

/// Particles that are nearer than so many spacings are of one piece.
const JOINED: f64 = 1.6;
/// Methods: the speed of each ring over that of sound, and the artificial stress of the updated form.
const METHODS: [(&str, f64, Option<f64>); 5] = [
    ("0.03", 0.03, None),
    ("0.059", 0.059, None),
    ("0.1", 0.1, None),
    ("updated", 0.059, Some(0.3)),
    ("control", 0.059, Some(0.0)),
];

/// The case.
pub(super) struct SolidRings;

impl Case for SolidRings {
    fn name(&self) -> &'static str {
        "solid-rings"
    }

    fn tool(&self) -> &'static str {
        "jetsph"
    }

    fn reference(&self) -> &'static str {
        "rings of Gray, Monaghan and Swift (2001): whole, symmetric, the same on any spacing"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["0.03", "0.059", "0.1", "updated", "control"]
    }

    fn levels(&self, method: &str, asked: &[u32]) -> Vec<u32> {
        let most = if METHODS[..3].iter().any(|m| m.0 == method) {
            3
        } else {
            2
        };
        asked.iter().copied().filter(|l| *l <= most).collect()
    }

    fn targets(&self) -> Vec<Target> {
        let whole = METHODS[..3].iter().flat_map(|(method, ..)| {
            let at = |what, most, level| Target::error(what, most).at_level(level).of(*method);
            let each = (1..=3)
                .flat_map(move |level| [at("parted", 0.0, level), at("turned", 0.02, level)]);
            each.chain([at("change", 0.05, 2), at("change", 0.02, 3)])
        });
        let of_control = Target::error("whole", 0.0).at_level(2).of("control");
        whole.chain([of_control]).collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let chosen = METHODS.iter().find(|(name, ..)| *name == method);
        let (name, mach, artificial) = *chosen.unwrap_or(&METHODS[0]);
        let at = |level: u32| -> Result<(Finished, Bounce), LabError> {
            let mut speed = 0.0;
            let by = f64::from(1 << (level.clamp(1, 4) - 1));
            let mut sign = -1.0;
            let mut patch = changed(lab, self.name(), |ring| {
                let spacing = ring["spacing_m"].as_f64().unwrap_or(f64::NAN);
                let number = |value: &serde_json::Value| value.as_f64().unwrap_or(f64::NAN);
                let bulk = number(&ring["elastic"]["bulk_modulus_pa"]);
                speed = mach * (bulk / number(&ring["density_kg_m3"])).sqrt();
                sign = -sign;
                ring["spacing_m"] = json!(spacing / by);
                ring["velocity_m_s"] = json!([sign * speed, 0]);
                if let Some(artificial) = artificial {
                    ring["updated_form"] = json!({"artificial_stress": artificial});
                    ring["artificial_viscosity"] = json!({"linear": 1, "quadratic": 2});
                }
            })?;
            // Until a ring of that speed would have gone two of its radii, and half a swing.
            let end = 0.08 / speed + 1e-3;
            patch["time"] = json!({"end_s": end});
            patch["output"] = json!({"frames_interval_s": end / 20.0});
            let run = lab.run("jetsph", self.name(), &format!("{name}-{level}"), &patch)?;
            let found = bounce(&run, speed, 0.0025 / by)?;
            Ok((run, found))
        };
        let (run, found) = at(level)?;
        let mut errors = Errors::from([
            ("parted".to_owned(), 1.0 - found.largest),
            ("turned".to_owned(), found.turned),
            ("restitution".to_owned(), found.restitution),
        ]);
        if method == "control" {
            let whole = if found.largest >= 1.0 { 1.0 } else { 0.0 };
            errors.insert("whole".to_owned(), whole);
        } else if level > 1 {
            let (_, coarser) = at(level - 1)?;
            let change = (found.restitution - coarser.restitution).abs();
            errors.insert("change".to_owned(), change);
        }
        let all = frames(&run.artefact, "left")?;
        let start = all.first().ok_or_else(|| fault(&run, "has no frame"))?;
        let points = 2 * start.len() as u64;
        let spacing = 0.0025 / f64::from(1 << (level.clamp(1, 4) - 1));
        Ok(Measurement::of(run, points, spacing, errors))
    }
}

/// What became of the rings.
struct Bounce {
    /// Part of a ring that its largest piece is at the end.
    largest: f64,
    /// Speed of the rings apart, over that together before.
    restitution: f64,
    /// Speed across of the middle of a ring, over its own before.
    turned: f64,
}

fn bounce(run: &Finished, speed: f64, spacing: f64) -> Result<Bounce, LabError> {
    let mut middle = [[0.0; 2]; 2];
    let mut largest = 1.0_f64;
    for (middle, name) in middle.iter_mut().zip(["left", "right"]) {
        let all = frames(&run.artefact, name)?;
        let last = all.last().ok_or_else(|| fault(run, "has no frame"))?;
        let velocity = last.vectors("velocity")?;
        for u in &velocity {
            (0..2).for_each(|k| middle[k] += u[k] / velocity.len() as f64);
        }
        largest = largest.min(largest_piece(last, JOINED * spacing)?);
    }
    let [left, right] = middle;
    Ok(Bounce {
        largest,
        restitution: (right[0] - left[0]) / (2.0 * speed),
        turned: (right[1] - left[1]).abs() / (2.0 * speed),
    })
}

/// Part of the particles in the largest piece.
fn largest_piece(frame: &Frame, joined: f64) -> Result<f64, LabError> {
    let places = frame.position_vectors()?;
    let cell = |x: &[f64; 3]| [0, 1].map(|k| (x[k] / joined).floor() as i64);
    let mut cells: BTreeMap<[i64; 2], Vec<usize>> = BTreeMap::new();
    for (a, x) in places.iter().enumerate() {
        cells.entry(cell(x)).or_default().push(a);
    }
    let mut seen = vec![false; places.len()];
    let mut most = 0;
    for start in 0..places.len() {
        let (mut open, mut size) = (vec![start], 0);
        while let Some(a) = open.pop() {
            if std::mem::replace(&mut seen[a], true) {
                continue;
            }
            size += 1;
            let [i, j] = cell(&places[a]);
            let around = (-1..=1).flat_map(|di| (-1..=1).map(move |dj| [i + di, j + dj]));
            let near = around.filter_map(|at| cells.get(&at)).flatten();
            open.extend(near.filter(|b| {
                let [x, y] = [places[a], places[**b]];
                !seen[**b] && (x[0] - y[0]).hypot(x[1] - y[1]) < joined
            }));
        }
        most = most.max(size);
    }
    Ok(f64::from(most) / places.len() as f64)
}
