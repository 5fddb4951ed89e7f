//! Headline figures, read from what a point wrote.

use std::path::Path;
use std::process::Command;

use artefact::Reader;
use serde_json::Value;

use super::plan::{Figure, From};
use crate::lab::{Lab, LabError};

/// The value of a figure in an artefact.
///
/// # Errors
/// When the artefact does not hold it.
pub fn read(lab: &Lab, figure: &Figure, artefact: &Path) -> Result<f64, LabError> {
    match &figure.from {
        From::Record { channel, value } => {
            let reader = Reader::open(artefact)?;
            let last = reader.count(channel).saturating_sub(1);
            Ok(reader.record_at(channel, last)?.get(value)?)
        }
        From::Bead(measure) => bead(lab, measure, artefact),
        From::Point {
            channel,
            column,
            component,
            at_m,
        } => {
            let reader = Reader::open(artefact)?;
            let frame = reader.frame(channel, reader.count(channel).saturating_sub(1))?;
            let places = frame.position_vectors()?;
            let apart = |p: &[f64; 3]| (0..3).map(|k| (p[k] - at_m[k]).powi(2)).sum::<f64>().sqrt();
            let nearest =
                (0..places.len()).min_by(|a, b| apart(&places[*a]).total_cmp(&apart(&places[*b])));
            let size = places.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
            let here = nearest.filter(|i| apart(&places[*i]) <= 1e-6 * size);
            let missing = || LabError::Content {
                path: artefact.to_owned(),
                what: format!("no point of {channel} stands at {at_m:?} m"),
            };
            let here = here.ok_or_else(missing)?;
            let found = match frame.vectors(column) {
                Ok(vectors) => vectors[here].get(*component).copied(),
                Err(_) => frame.f64(column)?.get(here).copied(),
            };
            found.ok_or_else(missing)
        }
    }
}

/// A measure of the bead, by the program that measures beads.
fn bead(lab: &Lab, measure: &str, artefact: &Path) -> Result<f64, LabError> {
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
    told[measure]["value"]
        .as_f64()
        .ok_or_else(|| LabError::Content {
            path: artefact.to_owned(),
            what: format!("its bead has no measure '{measure}'"),
        })
}
