//! Run records: how long each stage took, what it held in memory, what it left out.
//!
//! Every key may be absent: a record of another version or of a run that failed is shown as far
//! as it goes.

use std::path::Path;

use serde::{Deserialize, Deserializer};
use serde_json::Value;

/// Wall time of a stage.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Spent {
    pub(crate) name: String,
    pub(crate) wall_s: f64,
    pub(crate) share: f64,
}

/// Memory of a part.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Memory {
    pub(crate) name: String,
    pub(crate) bytes: u64,
}

/// What was not computed, and why.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(crate) struct LeftOut {
    pub(crate) name: String,
    pub(crate) why: String,
}

/// A limit or a conserved total.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Total {
    pub(crate) name: String,
    /// A value that is not finite is null in JSON: a limit that does not bind.
    #[serde(deserialize_with = "finite_or_not")]
    pub(crate) value: f64,
    pub(crate) unit: String,
}

fn finite_or_not<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::<f64>::deserialize(from)?.unwrap_or(f64::INFINITY))
}

fn totals<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Total>, D::Error> {
    let mut totals = Vec::<Total>::deserialize(from)?;
    for total in totals.iter_mut().filter(|total| total.value.is_infinite()) {
        total.value = f64::NAN;
    }
    Ok(totals)
}

/// A quantity over steps, sweeps or time.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(crate) struct History {
    pub(crate) name: String,
    pub(crate) unit: String,
    pub(crate) at: Vec<f64>,
    pub(crate) values: Vec<f64>,
}

/// A run record.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(crate) struct RunRecord {
    pub(crate) tool: String,
    pub(crate) tool_version: String,
    pub(crate) outcome: String,
    pub(crate) start: String,
    pub(crate) wall_s: f64,
    pub(crate) steps: u64,
    pub(crate) threads: u64,
    pub(crate) resumed: u64,
    pub(crate) stages: Vec<Spent>,
    pub(crate) memory: Vec<Memory>,
    pub(crate) peak_memory_bytes: Option<u64>,
    pub(crate) warnings: Vec<String>,
    pub(crate) notes: Vec<String>,
    pub(crate) left_out: Vec<LeftOut>,
    pub(crate) limits: Vec<Total>,
    /// A total that is not finite is null in JSON: it is no number, as nothing limits it.
    #[serde(deserialize_with = "totals")]
    pub(crate) closing: Vec<Total>,
    pub(crate) history: Vec<History>,
    pub(crate) scene: Value,
    pub(crate) scene_hash: String,
}

impl RunRecord {
    /// The record beside an artefact; `None` when there is none that can be read.
    pub(crate) fn beside(artefact: &Path) -> Option<Self> {
        let path = artefact.with_extension("run.json");
        // What is no file may never end.
        let text = path
            .is_file()
            .then(|| std::fs::read_to_string(&path).ok())??;
        serde_json::from_str(&text).ok()
    }

    /// Title of the scene.
    pub(crate) fn title(&self) -> Option<&str> {
        self.scene.get("title").and_then(Value::as_str)
    }
}

/// A number of bytes for people.
pub(crate) fn bytes(count: u64) -> String {
    let count = count as f64;
    match count {
        c if c < 1e3 => format!("{c:.0} B"),
        c if c < 1e6 => format!("{:.1} kB", c / 1e3),
        c if c < 1e9 => format!("{:.1} MB", c / 1e6),
        c => format!("{:.2} GB", c / 1e9),
    }
}

/// A value with a sensible number of digits.
pub(crate) fn figure(value: f64) -> String {
    let size = value.abs();
    let text = if size <= 0.0 {
        "0".to_owned()
    } else if value.is_infinite() {
        "unbounded".to_owned()
    } else if value.is_nan() {
        "not a number".to_owned()
    } else if !(1e-3..1e5).contains(&size) {
        format!("{value:.2e}")
    } else {
        let digits = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
        format!("{value:.digits$}")
    };
    text.replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_four_digits() {
        let text: Vec<String> = [1234.56, 0.012345, -2.0, 0.0, 1.5e-7, 98765.4]
            .into_iter()
            .map(figure)
            .collect();
        assert_eq!(
            text,
            [
                "1235",
                "0.01235",
                "\u{2212}2.000",
                "0",
                "1.50e\u{2212}7",
                "98765"
            ]
        );
    }

    #[test]
    fn a_limit_that_does_not_bind_is_unbounded() {
        let total: Total =
            serde_json::from_str(r#"{"name": "step", "value": null, "unit": "s"}"#).unwrap();
        assert_eq!(figure(total.value), "unbounded");
        assert_eq!(figure(f64::NAN), "not a number");
    }

    #[test]
    fn a_closing_total_that_is_no_number_is_no_limit() {
        let text = r#"{"limits": [{"name": "dt", "value": null, "unit": "s"}],
            "closing": [{"name": "error", "value": null, "unit": "1"}, {"name": "mass", "value": 2.0, "unit": "kg"}]}"#;
        let record: RunRecord = serde_json::from_str(text).unwrap();
        assert_eq!(figure(record.limits[0].value), "unbounded");
        assert_eq!(figure(record.closing[0].value), "not a number");
        assert_eq!(figure(record.closing[1].value), "2.000");
    }

    #[test]
    fn a_record_with_unknown_and_missing_keys_is_read() {
        let record: RunRecord =
            serde_json::from_str(r#"{"tool": "avg", "news": 1, "scene": {"title": "T"}}"#).unwrap();
        assert_eq!((record.tool.as_str(), record.title()), ("avg", Some("T")));
    }
}
