//! `jet-threshold`: a slow jet leaves a block whole, a faster one parts it.

use artefact::Reader;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError};
use crate::solid::fault;

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
        &["3", "8"]
    }

    fn levels(&self, _: &str, asked: &[u32]) -> Vec<u32> {
        asked.iter().copied().filter(|l| *l <= 2).collect()
    }

    fn targets(&self) -> Vec<Target> {
        let each = ["3", "8"].into_iter().flat_map(|method| {
            [1, 2].map(|level| Target::error("wrong", 0.0).at_level(level).of(method))
        });
        each.collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = 0.002 / f64::from(1 << (level.clamp(1, 4) - 1));
        let speed: f64 = method.parse().unwrap_or(f64::NAN);
        // Until the jet has gone 150 mm; it rises over 20 ms of a jet of 5 m/s, so that no blow decides.
        let (end, rise) = (0.2 / speed, 0.1 / speed);
        let mut patch = crate::solid::changed(lab, self.name(), |solid| {
            solid["spacing_m"] = serde_json::json!(spacing);
        })?;
        patch["time"] = serde_json::json!({"end_s": end});
        patch["output"] = serde_json::json!({"frames_interval_s": end / 20.0});
        patch["water"] = serde_json::json!({
            "spacing_m": 0.5 * spacing,
            "nozzles": [{"name": "jet", "exit_m": [0, 0.042], "direction": [0, -1], "width_m": 0.004,
                "speed_m_s": {"expr": format!("{speed}*min(1, 0.1 + 0.9*t/{rise})")}}]
        });
        let run = lab.run("jetsph", self.name(), &format!("{method}-{level}"), &patch)?;
        let reader = Reader::open_kind(&run.artefact, "jet-frames", 1)?;
        let records = reader.records("/balance")?;
        let (_, last) = records
            .last()
            .ok_or_else(|| fault(&run, "has no balance"))?;
        let largest = last.get("tofu_largest_piece")?;
        let parted = largest < 0.6;
        let wrong = if parted == (speed > 6.3) { 0.0 } else { 1.0 };
        let points = reader.frame("/tofu", 0)?.len() as u64;
        let errors = Errors::from([
            ("wrong".to_owned(), wrong),
            ("largest_piece".to_owned(), largest),
        ]);
        Ok(Measurement::of(run, points, spacing, errors))
    }
}
