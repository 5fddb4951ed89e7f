//! Figures read from an artefact, or from the run record beside it.

use std::path::{Path, PathBuf};

use artefact::Reader;
use serde_json::Value;
use thiserror::Error;

use crate::course::Course;
use crate::from::From;

/// A figure as the artefact has it.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// Its value; no number where there are no records, rows or values that it could be made from.
    pub value: f64,
    /// Its unit.
    pub unit: String,
}

/// Why a figure cannot be read.
#[derive(Debug, Error)]
pub enum Error {
    /// The artefact cannot be read, or has no such channel, value or column.
    #[error(transparent)]
    Artefact(#[from] artefact::Error),
    /// The figure is not there: a value that never falls below its limit, a point that stands nowhere.
    #[error("{}: {what}", .path.display())]
    Missing {
        /// What was read.
        path: PathBuf,
        /// What is missing.
        what: String,
    },
}

impl From {
    /// The figure of a run whose artefact this is. A measure of a bead is missing: no channel has it.
    ///
    /// # Errors
    /// When what the run wrote does not hold it.
    pub fn read(&self, artefact: &Path) -> Result<Reading, Error> {
        let missing = |what: String| missing(artefact, what);
        match self {
            Self::Record { channel, value } => last(&Reader::open(artefact)?, channel, value),
            Self::Mean {
                channel,
                value,
                from_s,
                until_s,
            } => {
                let during = *from_s..=until_s.unwrap_or(f64::INFINITY);
                let course = Course::of(&Reader::open(artefact)?, channel, value)?;
                Ok(reading(course.mean(&during), &course.unit))
            }
            Self::FallsBelow {
                channel,
                value,
                limit,
            } => {
                let course = Course::of(&Reader::open(artefact)?, channel, value)?;
                let never = || missing(format!("'{value}' never falls below {limit}"));
                Ok(reading(course.falls_below(*limit).ok_or_else(never)?, "s"))
            }
            Self::Period { channel, value } => {
                let course = Course::of(&Reader::open(artefact)?, channel, value)?;
                let never = || missing(format!("'{value}' does not swing to and fro"));
                Ok(reading(course.period().ok_or_else(never)?, "s"))
            }
            Self::Greatest { channel, column } => {
                greatest(&Reader::open(artefact)?, channel, column)
            }
            Self::Closing(name) => closing(artefact, name),
            Self::Bead(measure) => Err(missing(format!("'{measure}' is a measure of a bead"))),
            Self::Point {
                channel,
                column,
                component,
                at_m,
            } => {
                let wanted = Column {
                    channel,
                    column,
                    component: *component,
                };
                at_point(artefact, &wanted, at_m)
            }
        }
    }
}

fn reading(value: f64, unit: &str) -> Reading {
    Reading {
        value,
        unit: unit.to_owned(),
    }
}

fn missing(path: &Path, what: String) -> Error {
    Error::Missing {
        path: path.to_owned(),
        what,
    }
}

/// A value of the last record.
fn last(reader: &Reader, channel: &str, value: &str) -> Result<Reading, Error> {
    let record = reader.record_at(channel, reader.count(channel).saturating_sub(1))?;
    let found = record.get(value)?;
    let entry = record.values.iter().find(|entry| entry.name == value);
    Ok(reading(found, entry.map_or("", |entry| &entry.unit)))
}

/// The greatest value of a column of the last table; below all numbers where it is empty.
fn greatest(reader: &Reader, channel: &str, column: &str) -> Result<Reading, Error> {
    let table = reader.table_at(channel, reader.count(channel).saturating_sub(1))?;
    let values = table.values(column)?.iter().copied();
    let unit = table.columns.iter().find(|series| series.name == column);
    let unit = unit.map_or("", |series| &series.unit);
    Ok(reading(values.fold(f64::NEG_INFINITY, f64::max), unit))
}

/// A component of a column of a channel.
struct Column<'a> {
    channel: &'a str,
    column: &'a str,
    component: usize,
}

/// A column of the last frame at the point that stands at a place.
fn at_point(artefact: &Path, wanted: &Column<'_>, at_m: &[f64; 3]) -> Result<Reading, Error> {
    let channel = wanted.channel;
    let reader = Reader::open(artefact)?;
    let frame = reader.frame(channel, reader.count(channel).saturating_sub(1))?;
    let places = frame.position_vectors()?;
    let apart = |p: &[f64; 3]| (0..3).map(|k| (p[k] - at_m[k]).powi(2)).sum::<f64>().sqrt();
    let nearest =
        (0..places.len()).min_by(|a, b| apart(&places[*a]).total_cmp(&apart(&places[*b])));
    let size = places.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
    let here = nearest.filter(|i| apart(&places[*i]) <= 1e-6 * size);
    let nowhere = || {
        missing(
            artefact,
            format!("no point of {channel} stands at {at_m:?} m"),
        )
    };
    let here = here.ok_or_else(nowhere)?;
    let (found, first) = match frame.vectors(wanted.column) {
        Ok(vectors) => (
            vectors[here].get(wanted.component).copied(),
            format!("{}_x", wanted.column),
        ),
        Err(_) => (
            frame.f64(wanted.column)?.get(here).copied(),
            wanted.column.to_owned(),
        ),
    };
    let unit = &frame.get(&first)?.unit;
    Ok(reading(found.ok_or_else(nowhere)?, unit))
}

/// A closing value of the run record beside an artefact.
fn closing(artefact: &Path, name: &str) -> Result<Reading, Error> {
    let record = artefact.with_extension("run.json");
    let text = std::fs::read_to_string(&record);
    let text = text.map_err(|error| missing(&record, error.to_string()))?;
    let told: Value =
        serde_json::from_str(&text).map_err(|error| missing(&record, error.to_string()))?;
    let values = told["closing"].as_array().into_iter().flatten();
    let own = values.filter(|value| value["name"] == name);
    let mut found =
        own.filter_map(|value| Some((value["value"].as_f64()?, value["unit"].as_str())));
    let (value, unit) = found
        .next_back()
        .ok_or_else(|| missing(&record, format!("it closes without '{name}'")))?;
    Ok(reading(value, unit.unwrap_or_default()))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use artefact::{Frame, Header, Precision, Record, Table, Version, Writer};
    use serde_json::json;

    use super::*;

    /// A swing of a period of 0.4 s that decays, a table, two points, and a run record.
    fn written(folder: &Path) -> PathBuf {
        let path = folder.join("run.mcap");
        let header = Header {
            kind: "point-fields".to_owned(),
            version: Version::new(1, 0),
            tool: "emfield".to_owned(),
            tool_version: "0.1.0".to_owned(),
            scene: json!({}),
            inputs: BTreeMap::new(),
        };
        let mut writer = Writer::create(&path, &header).unwrap();
        for k in 0..=100 {
            let time = 0.01 * f64::from(k);
            let swing = (2.0 * std::f64::consts::PI * time / 0.4).cos();
            let record = Record::new()
                .with("swing", "m", swing)
                .with("left", "J", 1.0 - time);
            writer.record("/course", time, &record).unwrap();
        }
        let table = Table::new(3).column("pressure", "Pa", [1.0, 7.0, -2.0]);
        writer.table("/surface", 1.0, &table).unwrap();
        let frame = Frame::new(Precision::F64)
            .positions([[0.0; 3], [1.0, 0.0, 0.0]])
            .scalar("temperature", "K", [300.0, 400.0]);
        writer.frame("/points", 1.0, &frame).unwrap();
        writer.finish().unwrap();
        let record = json!({"closing": [{"name": "lost", "unit": "kg", "value": 0.25}]});
        std::fs::write(path.with_extension("run.json"), record.to_string()).unwrap();
        path
    }

    #[test]
    fn every_kind_of_figure_is_read_with_its_unit() {
        let folder = tempfile::tempdir().unwrap();
        let path = written(folder.path());
        for (from, value, unit) in [
            (
                json!({"record": {"channel": "/course", "value": "left"}}),
                0.0,
                "J",
            ),
            (
                json!({"mean": {"channel": "/course", "value": "left", "from_s": 0.495, "until_s": 0.705}}),
                0.4,
                "J",
            ),
            (
                json!({"falls_below": {"channel": "/course", "value": "left", "limit": 0.755}}),
                0.245,
                "s",
            ),
            (
                json!({"period": {"channel": "/course", "value": "swing"}}),
                0.4,
                "s",
            ),
            (
                json!({"greatest": {"channel": "/surface", "column": "pressure"}}),
                7.0,
                "Pa",
            ),
            (json!({"closing": "lost"}), 0.25, "kg"),
            (
                json!({"point": {"channel": "/points", "column": "temperature", "at_m": [1, 0, 0]}}),
                400.0,
                "K",
            ),
        ] {
            let own: From = serde_json::from_value(from.clone()).unwrap();
            let found = own.read(&path).unwrap();
            assert!((found.value - value).abs() < 1e-9, "{from} {found:?}");
            assert_eq!(found.unit, unit);
            assert_eq!(
                serde_json::to_value(&own).unwrap()["point"]["component"].as_u64(),
                from.get("point").map(|_| 0)
            );
        }
    }

    #[test]
    fn what_is_not_there_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = written(folder.path());
        for (from, words) in [
            (
                json!({"record": {"channel": "/course", "value": "lift"}}),
                "lift",
            ),
            (
                json!({"falls_below": {"channel": "/course", "value": "left", "limit": -1}}),
                "never falls below -1",
            ),
            (
                json!({"period": {"channel": "/course", "value": "left"}}),
                "does not swing",
            ),
            (json!({"closing": "gained"}), "closes without 'gained'"),
            (json!({"bead": "penetration"}), "measure of a bead"),
            (
                json!({"point": {"channel": "/points", "column": "temperature", "at_m": [2, 0, 0]}}),
                "no point of /points",
            ),
        ] {
            let own: From = serde_json::from_value(from).unwrap();
            let told = own.read(&path).unwrap_err().to_string();
            assert!(told.contains(words), "{told}");
        }
        assert!(
            serde_json::from_value::<From>(
                json!({"record": {"channel": "/a", "value": "b"}, "bead": "c"})
            )
            .is_err()
        );
    }
}
