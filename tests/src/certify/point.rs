//! A point of a plan: what was run, and what it tells.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::Value;

/// One point of a plan.
#[derive(Debug, Clone, Serialize)]
pub struct Point {
    /// `base`, or knob and number.
    pub name: String,
    /// Which knob is turned, none for the base.
    pub knob: Option<String>,
    /// Its size, where it is refined.
    pub size: Option<f64>,
    /// The patch.
    pub patch: Value,
    /// Figures by name; empty where it was not run.
    pub figures: BTreeMap<String, f64>,
    /// Wall time of its own stages \[s\], whenever they were run; of all stages for the base.
    pub run_time_s: Option<f64>,
    /// Processor time of the same; none where a record does not tell it.
    pub processor_s: Option<f64>,
    /// Greatest resident memory of its stages \[byte\].
    pub peak_memory_bytes: Option<u64>,
    /// Points, cells or particles of the stage that was turned, where its record tells.
    pub points: Option<u64>,
    /// Why it was not run, or what failed.
    pub missing: Option<String>,
    /// What its stages warned of: a figure of such a run may be worth less than its band says.
    pub warnings: Vec<String>,
    /// Hashes of the scenes of its stages.
    pub scenes: BTreeMap<String, String>,
    /// Whether a figure of a bead is the median of what has frozen; else it is the greatest value so far.
    #[serde(skip)]
    pub frozen: BTreeMap<String, bool>,
}

impl Point {
    /// Leaves out figures that are of another kind than those of the base: they are no points of one series.
    pub(super) fn keep_what_is_as_in(&mut self, base: &Self) {
        for (name, frozen) in &self.frozen {
            if base.frozen.get(name).is_some_and(|own| own != frozen) {
                let words = |frozen: bool| match frozen {
                    true => "the median of a frozen stretch",
                    false => "the greatest value so far of a weld of which nothing has frozen",
                };
                self.figures.remove(name);
                self.warnings.push(format!(
                    "no {name}: it is {}, and that of the base is {}. Let the weld run longer",
                    words(*frozen),
                    words(!*frozen)
                ));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(frozen: bool) -> Point {
        Point {
            name: "a".to_owned(),
            knob: None,
            size: None,
            patch: Value::Null,
            figures: [("depth".to_owned(), 3e-3), ("power".to_owned(), 5.0)].into(),
            run_time_s: Some(1.0),
            processor_s: None,
            peak_memory_bytes: None,
            points: None,
            missing: None,
            warnings: Vec::new(),
            scenes: BTreeMap::new(),
            frozen: [("depth".to_owned(), frozen)].into(),
        }
    }

    #[test]
    fn a_greatest_value_so_far_is_no_point_of_a_series_of_medians() {
        let mut other = point(false);
        other.keep_what_is_as_in(&point(true));
        assert!(!other.figures.contains_key("depth") && other.figures.contains_key("power"));
        assert!(other.warnings[0].contains("no depth") && other.warnings[0].contains("so far"));
        let mut same = point(false);
        same.keep_what_is_as_in(&point(false));
        assert!(same.figures.contains_key("depth") && same.warnings.is_empty());
    }
}
