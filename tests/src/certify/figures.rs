//! Headline figures, read from what a point wrote.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::plan::Figure;
use crate::lab::{Lab, LabError};

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
        figures::From::Bead(measure) => bead(lab, measure, artefact)?,
        from => Reading {
            value: from.read(artefact)?.value,
            frozen: None,
        },
    };
    judged(figure, artefact, reading)
}

impl From<figures::Error> for LabError {
    fn from(error: figures::Error) -> Self {
        match error {
            figures::Error::Artefact(error) => Self::Artefact(error),
            figures::Error::Missing { path, what } => Self::Content { path, what },
        }
    }
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
