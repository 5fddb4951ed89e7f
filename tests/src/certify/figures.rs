//! Headline figures, read from what a point wrote.

use std::path::Path;
use std::process::Command;

use artefact::Reader;
use serde_json::Value;

use super::course;
use super::plan::{Figure, From};
use crate::lab::{Lab, LabError, read_json};

/// What an artefact tells of a figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Its value.
    pub value: f64,
    /// Of a bead, whether it is the median of what has frozen; else it is the greatest value so far.
    pub frozen: Option<bool>,
}

/// The value of a figure in an artefact.
///
/// # Errors
/// When the artefact does not hold it, or what it holds is no number.
pub fn read(lab: &Lab, figure: &Figure, artefact: &Path) -> Result<Reading, LabError> {
    let reading = match &figure.from {
        From::Bead(measure) => bead(lab, measure, artefact)?,
        _ => Reading {
            value: of_file(figure, artefact)?,
            frozen: None,
        },
    };
    judged(figure, artefact, reading)
}

/// Refuses a value that is no number.
fn judged(figure: &Figure, artefact: &Path, reading: Reading) -> Result<Reading, LabError> {
    match reading.value.is_finite() {
        true => Ok(reading),
        false => {
            let what = format!(
                "'{}' is no number: there are no records, rows or values that it could be made from",
                figure.name
            );
            Err(missing(artefact, what))
        }
    }
}

/// The value of a figure that an artefact, or the record beside it, holds.
fn of_file(figure: &Figure, artefact: &Path) -> Result<f64, LabError> {
    let open = || Reader::open(artefact);
    match &figure.from {
        From::Record { channel, value } => {
            let reader = open()?;
            let last = reader.count(channel).saturating_sub(1);
            Ok(reader.record_at(channel, last)?.get(value)?)
        }
        From::Mean {
            channel,
            value,
            from_s,
            until_s,
        } => {
            let during = *from_s..=until_s.unwrap_or(f64::INFINITY);
            Ok(course::mean(
                &course::of(&open()?, channel, value)?,
                &during,
            ))
        }
        From::FallsBelow {
            channel,
            value,
            limit,
        } => {
            let course = course::of(&open()?, channel, value)?;
            let never = || missing(artefact, format!("'{value}' never falls below {limit}"));
            course::falls_below(&course, *limit).ok_or_else(never)
        }
        From::Period { channel, value } => {
            let course = course::of(&open()?, channel, value)?;
            let never = || missing(artefact, format!("'{value}' does not swing to and fro"));
            course::period(&course).ok_or_else(never)
        }
        From::Greatest { channel, column } => greatest(&open()?, channel, column),
        From::Closing(name) => closing(artefact, name),
        From::Bead(measure) => Err(missing(
            artefact,
            format!("'{measure}' is a measure of a bead"),
        )),
        From::Point {
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

/// The greatest value of a column of the last table; below all numbers where it is empty.
fn greatest(reader: &Reader, channel: &str, column: &str) -> Result<f64, LabError> {
    let table = reader.table_at(channel, reader.count(channel).saturating_sub(1))?;
    let values = table.values(column)?.iter().copied();
    Ok(values.fold(f64::NEG_INFINITY, f64::max))
}

/// A column of the last frame at the point that stands at a place.
fn at_point(artefact: &Path, wanted: &Column<'_>, at_m: &[f64; 3]) -> Result<f64, LabError> {
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
    let found = match frame.vectors(wanted.column) {
        Ok(vectors) => vectors[here].get(wanted.component).copied(),
        Err(_) => frame.f64(wanted.column)?.get(here).copied(),
    };
    found.ok_or_else(nowhere)
}

/// A component of a column of a channel.
struct Column<'a> {
    channel: &'a str,
    column: &'a str,
    component: usize,
}

/// A closing value of the run record beside an artefact.
fn closing(artefact: &Path, name: &str) -> Result<f64, LabError> {
    let record = artefact.with_extension("run.json");
    let told = read_json(&record)?;
    let values = told["closing"].as_array().into_iter().flatten();
    let own = values.filter(|value| value["name"] == name);
    let value = own.filter_map(|value| value["value"].as_f64()).next_back();
    value.ok_or_else(|| missing(&record, format!("it closes without '{name}'")))
}

fn missing(path: &Path, what: String) -> LabError {
    LabError::Content {
        path: path.to_owned(),
        what,
    }
}

/// A measure of the bead, by the program that measures beads.
fn bead(lab: &Lab, measure: &str, artefact: &Path) -> Result<Reading, LabError> {
    let mut command = Command::new(lab.programs.join("report"));
    command.arg("figures").arg("--pool").arg(artefact);
    let output = command.output().map_err(|source| LabError::Io {
        path: lab.programs.join("report"),
        source,
    })?;
    if !output.status.success() {
        return Err(LabError::Tool {
            command: format!("{command:?}"),
            code: output.status.code(),
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
        });
    }
    let told: Value = serde_json::from_slice(&output.stdout).unwrap_or_default();
    let value = told[measure]["value"].as_f64();
    let none = || missing(artefact, format!("its bead has no measure '{measure}'"));
    Ok(Reading {
        value: value.ok_or_else(none)?,
        frozen: told[measure]["frozen"].as_bool(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_that_is_no_number_is_told_as_that() {
        let figure: Figure = serde_json::from_value(
            serde_json::json!({"name": "mean_force", "unit": "N", "stage": "a",
            "from": {"closing": "force"}}),
        )
        .unwrap();
        let of = |value| {
            judged(
                &figure,
                Path::new("a.mcap"),
                Reading {
                    value,
                    frozen: None,
                },
            )
        };
        assert!(of(1.0).is_ok());
        for value in [f64::NAN, f64::NEG_INFINITY] {
            assert!(
                of(value)
                    .unwrap_err()
                    .to_string()
                    .contains("'mean_force' is no number")
            );
        }
    }
}
