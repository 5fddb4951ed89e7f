//! `jet-threshold`: a slow jet leaves a block whole, a faster one parts it.

use artefact::Reader;
use serde_json::json;

use super::jet_plate::soundless;
use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError};

/// Where the block of the source is parted \[s\], under a jet of full speed from the start.
const PARTED: f64 = 0.025;
/// A block is parted where its largest piece is less than this.
const PIECE: f64 = 0.6;

/// The case.
pub(super) struct JetThreshold;

impl Case for JetThreshold {
    fn name(&self) -> &'static str {
        "jet-threshold"
    }

    fn tool(&self) -> &'static str {
        "jetsph"
    }

    fn reference(&self) -> &'static str {
        "statics of a half plane under a strip: 0.1 E needs 6.3 m/s; 3 m/s parts nothing, 8 m/s the block"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["3", "8", "sudden", "soundless-3", "soundless-8"]
    }

    fn levels(&self, _: &str, asked: &[u32]) -> Vec<u32> {
        asked.iter().copied().filter(|l| *l <= 2).collect()
    }

    fn targets(&self) -> Vec<Target> {
        let each = ["3", "8", "soundless-3", "soundless-8"]
            .into_iter()
            .flat_map(|method| {
                [1, 2].map(|level| Target::error("wrong", 0.0).at_level(level).of(method))
            });
        // 26.3 ms of 25 ms.
        let late = Target::error("time_of_parting", 0.11).at_level(2);
        each.chain([late.of("sudden")]).collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = 0.002 / f64::from(1 << (level.clamp(1, 4) - 1));
        let mut patch = crate::solid::changed(lab, self.name(), |solid| {
            solid["spacing_m"] = json!(spacing);
        })?;
        patch["water"] = json!({"spacing_m": 0.5 * spacing});
        // The sudden jet is that of the study.
        let slow = method.trim_start_matches("soundless-").parse::<f64>().ok();
        if let Some(speed) = slow {
            // Until the jet has gone 150 mm; it rises over 20 ms of a jet of 5 m/s, so that no blow decides.
            let (end, rise) = (0.2 / speed, 0.1 / speed);
            patch["time"] = json!({"end_s": end});
            patch["output"] = json!({"frames_interval_s": end / 20.0});
            patch["water"]["nozzles"] = json!([{"name": "jet", "exit_m": [0, 0.042], "direction": [0, -1], "width_m": 0.004,
                "speed_m_s": {"expr": format!("{speed}*min(1, 0.1 + 0.9*t/{rise})")}}]);
        }
        if method.starts_with("soundless") {
            soundless(&mut patch);
        }
        let run = lab.run("jetsph", self.name(), &format!("{method}-{level}"), &patch)?;
        let reader = Reader::open_kind(&run.artefact, "jet-frames", 1)?;
        let records = reader.records("/balance")?;
        let mut largest = f64::NAN;
        let mut parted = None;
        for (time, record) in &records {
            largest = record.get("tofu_largest_piece")?;
            if largest < PIECE && parted.is_none() {
                parted = Some(*time);
            }
        }
        let mut errors = Errors::from([("largest_piece".to_owned(), largest)]);
        if let Some(speed) = slow {
            let is_wrong = parted.is_some() != (speed > 6.3);
            errors.insert("wrong".to_owned(), f64::from(u8::from(is_wrong)));
        } else {
            let late = parted.map_or(1.0, |time| (time / PARTED - 1.0).abs());
            errors.insert("time_of_parting".to_owned(), late);
        }
        let points = reader.frame("/tofu", 0)?.len() as u64;
        Ok(Measurement::of(run, points, spacing, errors))
    }
}
