//! What `make bench` writes: figures, sizes, and whether the aims are met.

use serde::Serialize;
use serde_json::Value;

use super::Aim;
use crate::speed::Row;

/// Stages of a run that are no part of its steps.
pub(super) const OUTSIDE: [&str; 5] = ["scene", "plan", "write", "checkpoint", "other"];

/// An aim with what was found; `None` where it was not measured on so many threads.
#[derive(Debug, Serialize)]
pub struct Verdict {
    #[serde(flatten)]
    aim: Aim,
    found: Option<f64>,
    holds: Option<bool>,
}

/// How many of what.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Count {
    pub(super) name: String,
    pub(super) number: u64,
}

/// The record that `make bench` writes.
#[derive(Debug, Serialize)]
pub struct Record {
    kind: &'static str,
    version: &'static str,
    name: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) tool: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) outcome: Option<String>,
    load_average: Option<f64>,
    pub(super) counts: Vec<Count>,
    pub(super) aims: Vec<Verdict>,
    pub(super) rows: Vec<Row>,
}

impl Record {
    /// A record of rows alone.
    #[must_use]
    pub fn of_rows(name: &str, rows: Vec<Row>) -> Self {
        Self {
            kind: "bench",
            version: "1.0",
            name: name.to_owned(),
            tool: None,
            outcome: None,
            load_average: load(),
            counts: Vec::new(),
            aims: Vec::new(),
            rows,
        }
    }

    /// The record as a table for people.
    #[must_use]
    pub fn table(&self) -> String {
        let mut text = format!("{}\n", self.name);
        for count in &self.counts {
            text += &format!("  {:24} {}\n", count.name, count.number);
        }
        for row in &self.rows {
            text += &format!(
                "  {:24} {:2} threads  median {:10.3} {}  least {:10.3}\n",
                row.name, row.threads, row.value, row.unit, row.least
            );
        }
        for Verdict { aim, found, holds } in &self.aims {
            let word = match holds {
                Some(true) => "holds ",
                Some(false) => "MISSED",
                None => "open  ",
            };
            let found = found.map_or_else(|| "not measured".to_owned(), |x| format!("{x:.3}"));
            text += &format!(
                "  {word} {} on {} threads: at most {} {}, found {found}\n",
                aim.name, aim.threads, aim.max, aim.unit
            );
        }
        text
    }
}

/// Times by name, unit and threads, in the order in which they came.
#[derive(Debug, Default)]
pub(super) struct Samples(Vec<(String, &'static str, usize, Vec<f64>)>);

impl Samples {
    pub(super) fn add(&mut self, threads: usize, record: &Value) {
        let steps = record["steps"].as_f64().unwrap_or(0.0).max(1.0);
        let spent: Vec<(&str, f64)> = record["stages"]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(|stage| Some((stage["name"].as_str()?, stage["wall_s"].as_f64()?)))
            .collect();
        let inside = spent.iter().filter(|(name, _)| !OUTSIDE.contains(name));
        let all: f64 = inside.map(|(_, wall)| wall).sum();
        self.put(
            "run",
            "s",
            threads,
            record["wall_s"].as_f64().unwrap_or(0.0),
        );
        self.put("step", "ms", threads, 1e3 * all / steps);
        for (name, wall) in spent {
            self.put(name, "ms", threads, 1e3 * wall / steps);
        }
    }

    fn put(&mut self, name: &str, unit: &'static str, threads: usize, value: f64) {
        let known = self
            .0
            .iter_mut()
            .find(|(n, _, t, _)| n == name && *t == threads);
        match known {
            Some((.., values)) => values.push(value),
            None => self.0.push((name.to_owned(), unit, threads, vec![value])),
        }
    }

    pub(super) fn rows(self) -> Vec<Row> {
        let rows = self.0.into_iter();
        rows.map(|(name, unit, threads, values)| Row::of(&name, unit, threads, values))
            .collect()
    }
}

pub(super) fn verdict(aim: &Aim, rows: &[Row]) -> Verdict {
    let row = rows
        .iter()
        .find(|row| row.name == aim.name && row.unit == aim.unit && row.threads == aim.threads);
    let found = row.map(|row| row.value);
    Verdict {
        aim: aim.clone(),
        found,
        holds: found.map(|found| found <= aim.max),
    }
}

/// Load of the machine over the last minute, where the system tells.
pub(super) fn load() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/loadavg").ok()?;
    text.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_step_is_what_the_stages_within_take() {
        let record = json!({"steps": 10, "wall_s": 9.0, "stages": [
            {"name": "plan", "wall_s": 5.0}, {"name": "heat", "wall_s": 1.0},
            {"name": "motion", "wall_s": 2.0}, {"name": "other", "wall_s": 1.0}]});
        let mut samples = Samples::default();
        samples.add(2, &record);
        let rows = samples.rows();
        let aim = |max: f64, threads: usize| Aim {
            name: "step".to_owned(),
            unit: "ms".to_owned(),
            threads,
            max,
        };
        let held = verdict(&aim(300.5, 2), &rows);
        assert!((held.found.unwrap() - 300.0).abs() < 1e-9);
        assert_eq!(held.holds, Some(true));
        assert_eq!(verdict(&aim(299.5, 2), &rows).holds, Some(false));
        assert_eq!(verdict(&aim(299.5, 1), &rows).holds, None);
    }
}
