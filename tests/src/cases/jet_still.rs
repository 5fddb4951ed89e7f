//! `jet-still`: water at rest in a tank stays so, alone and beside a solid.

use artefact::{Frame, Reader};
use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError};
use crate::norms::Worst;
use crate::solid::fault;

/// Depth of the water and size of the block \[m\].
const DEPTH: f64 = 0.05;
const BLOCK: [f64; 3] = [0.04, 0.06, 0.03];
/// How long it stays beside the block, and from when on it must rest \[s\].
const BESIDE: [f64; 2] = [10.0, 5.0];

/// The case.
pub(super) struct JetStill;

impl Case for JetStill {
    fn name(&self) -> &'static str {
        "jet-still"
    }

    fn tool(&self) -> &'static str {
        "jetsph"
    }

    fn reference(&self) -> &'static str {
        "rest; the weight of the water on the floor; no water in the block or beneath it"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["alone", "beside"]
    }

    fn levels(&self, method: &str, asked: &[u32]) -> Vec<u32> {
        let most = if method == "beside" { 2 } else { 3 };
        asked.iter().copied().filter(|l| *l <= most).collect()
    }

    fn targets(&self) -> Vec<Target> {
        let beside = [1, 2].into_iter().flat_map(|level| {
            [("speed", 1e-3), ("within", 0.0)]
                .map(|(what, most)| Target::error(what, most).at_level(level).of("beside"))
        });
        let alone = [("speed", 1e-3), ("floor_force", 0.01)]
            .map(|(what, most)| Target::error(what, most).at_level(2).of("alone"));
        alone.into_iter().chain(beside).collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        // 10, 20 and 40 particles deep.
        let spacing = 5e-3 / f64::from(1 << (level.clamp(1, 4) - 1));
        let mut patch = json!({"water": {"spacing_m": spacing}});
        let is_beside = method == "beside";
        if is_beside {
            patch["time"] = json!({"end_s": BESIDE[0]});
            patch["solids"] = json!([block(2.0 * spacing)]);
        }
        let run = lab.run("jetsph", self.name(), &format!("{method}-{level}"), &patch)?;
        let reader = Reader::open_kind(&run.artefact, "jet-frames", 1)?;
        let frames: Vec<Frame> = reader.frames("/water")?.collect::<artefact::Result<_>>()?;
        let last = frames.last().ok_or_else(|| fault(&run, "has no frame"))?;
        let mut errors = Errors::new();
        if is_beside {
            let late = frames.iter().filter(|frame| frame.time_s >= BESIDE[1]);
            let speeds: Vec<f64> = late.map(speed).collect::<Result<_, _>>()?;
            errors.insert("speed".to_owned(), speeds.into_iter().worst());
            errors.insert("within".to_owned(), within(&frames, spacing)?);
        } else {
            errors.insert("speed".to_owned(), speed(last)?);
            let records = reader.records("/balance")?;
            let (_, floor) = records
                .last()
                .ok_or_else(|| fault(&run, "has no balance"))?;
            let floor = floor.get("water_force_on_floor_y")?;
            let weight = 1000.0 * GRAVITY * 0.1 * DEPTH;
            errors.insert("floor_force".to_owned(), (-floor / weight - 1.0).abs());
        }
        Ok(Measurement::of(run, last.len() as u64, spacing, errors))
    }
}

/// g \[m/s2\].
const GRAVITY: f64 = 9.81;

/// A block that is held below and stands on the floor.
fn block(spacing: f64) -> Value {
    let [left, right, top] = BLOCK;
    json!({"name": "block", "body": {"box": {"min_m": [left, 0], "max_m": [right, top]}}, "spacing_m": spacing,
        "density_kg_m3": 1000, "elastic": {"youngs_modulus_pa": 1e5, "poisson_ratio": 0.3},
        "damping_1_s": 20, "clamps": [{"on": ["y-"]}]})
}

/// Root mean square of the speeds over sqrt(g H).
fn speed(frame: &Frame) -> Result<f64, LabError> {
    let all = frame.vectors("velocity")?;
    let squares = all.iter().flatten().map(|u| u * u).sum::<f64>();
    Ok((squares / all.len() as f64 / (GRAVITY * DEPTH)).sqrt())
}

/// Most particles that were deeper in the block than a spacing of the water, which is half of that of the block.
fn within(frames: &[Frame], spacing: f64) -> Result<f64, LabError> {
    let [left, right, top] = BLOCK;
    let mut most = 0;
    for frame in frames {
        let places = frame.position_vectors()?;
        let deep = places
            .iter()
            .filter(|x| x[0] > left + spacing && x[0] < right - spacing && x[1] < top - spacing);
        most = most.max(deep.count());
    }
    Ok(most as f64)
}
