//! `jet-still`: water at rest in a tank stays so.

use artefact::Reader;
use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError};
use crate::solid::fault;

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
        "rest; the weight of the water on the floor"
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("speed", 1e-3).at_level(2),
            Target::error("floor_force", 0.01).at_level(2),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        // 10, 20 and 40 particles deep.
        let spacing = 5e-3 / f64::from(1 << (level.clamp(1, 4) - 1));
        let patch = json!({"water": {"spacing_m": spacing}});
        let run = lab.run("jetsph", self.name(), &format!("level{level}"), &patch)?;
        let reader = Reader::open_kind(&run.artefact, "jet-frames", 1)?;
        let frames: Vec<_> = reader.frames("/water")?.collect::<artefact::Result<_>>()?;
        let last = frames.last().ok_or_else(|| fault(&run, "has no frame"))?;
        let (depth, gravity) = (0.05_f64, 9.81);
        let wave = (gravity * depth).sqrt();
        let squares = last.vectors("velocity")?;
        let squares = squares.iter().map(|u| u.iter().map(|x| x * x).sum::<f64>());
        let speed = (squares.sum::<f64>() / last.len() as f64).sqrt() / wave;
        let records = reader.records("/balance")?;
        let (_, floor) = records
            .last()
            .ok_or_else(|| fault(&run, "has no balance"))?;
        let floor = floor.get("water_force_on_floor_y")?;
        let weight = 1000.0 * gravity * 0.1 * depth;
        let errors = Errors::from([
            ("speed".to_owned(), speed),
            ("floor_force".to_owned(), (-floor / weight - 1.0).abs()),
        ]);
        Ok(Measurement::of(run, last.len() as u64, spacing, errors))
    }
}
