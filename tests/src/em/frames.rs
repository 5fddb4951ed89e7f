//! What `emfield` wrote, and what its scene says.

use artefact::{Frame, Reader, Record};
use serde_json::Value;

use super::C;
use crate::case::{Case, Errors, Measurement};
use crate::heat::methods::over;
use crate::heat::property::at;
use crate::lab::{Finished, Lab, LabError, read_json};

/// Runs a case on a scene with a patch, and finds its errors from the points at its end.
///
/// # Errors
/// When the run fails or lacks what is asked for.
pub fn measured(
    lab: &Lab,
    case: &dyn Case,
    (level, method): (u32, &str),
    (patch, spacing): (&Value, f64),
    errors: impl Fn(&Finished, &Points) -> Result<Errors, LabError>,
) -> Result<Measurement, LabError> {
    let label = format!("level{level}-{method}");
    let run = lab.run(case.tool(), case.name(), &label, patch)?;
    let points = Points::read(&run)?;
    let errors = errors(&run, &points)?;
    Ok(Measurement::of(run, points.count(), spacing, errors))
}

/// The points of a run at its end.
#[derive(Debug)]
pub struct Points {
    /// Places \[m\].
    pub position: Vec<[f64; 3]>,
    /// All columns.
    pub frame: Frame,
    /// Instant \[s\].
    pub time: f64,
}

impl Points {
    /// Reads the last frame of `/points`.
    ///
    /// # Errors
    /// When there is none.
    pub fn read(run: &Finished) -> Result<Self, LabError> {
        Self::channel(run, "/points")
    }

    /// Reads the last frame of a channel.
    ///
    /// # Errors
    /// When there is none.
    pub fn channel(run: &Finished, channel: &str) -> Result<Self, LabError> {
        let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
        let last = reader.count(channel).saturating_sub(1);
        let frame = reader.frame(channel, last)?;
        Ok(Self {
            position: frame.position_vectors()?,
            time: frame.time_s,
            frame,
        })
    }

    /// Number of points.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.position.len() as u64
    }

    /// Phasors of a vector.
    ///
    /// # Errors
    /// When a column is missing.
    pub fn phasors(&self, name: &str) -> Result<Vec<[C; 3]>, LabError> {
        let real = self.frame.vectors(&format!("{name}_real"))?;
        let imaginary = self.frame.vectors(&format!("{name}_imag"))?;
        let pair = |(a, b): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|k| C::new(a[k], b[k]));
        Ok(real.iter().zip(&imaginary).map(pair).collect())
    }
}

/// The totals of a run at its end.
///
/// # Errors
/// When there are none.
pub fn totals(run: &Finished) -> Result<Record, LabError> {
    let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
    let last = reader.count("/totals").saturating_sub(1);
    Ok(reader.record_at("/totals", last)?)
}

/// A number of the scene as it was run, or another where it is silent.
#[must_use]
pub fn number_or(run: &Finished, pointer: &str, other: f64) -> f64 {
    let value = run.scene.pointer(pointer).and_then(Value::as_f64);
    value.unwrap_or(other)
}

/// A number of the scene as it was run.
///
/// # Errors
/// When it has none.
pub fn number(run: &Finished, pointer: &str) -> Result<f64, LabError> {
    at(run, pointer)?.as_f64().ok_or_else(|| LabError::Content {
        path: run.artefact.clone(),
        what: format!("{pointer} of its scene is no number"),
    })
}

/// The applied flux density \[T\] of a scene whose exact solution wants it along the last axis.
///
/// # Errors
/// When it has none, or points elsewhere.
pub fn flux_along(run: &Finished) -> Result<f64, LabError> {
    let pointer = "/eddy_currents/applied_flux_density_t";
    let axes = at(run, pointer)?.as_array().map_or(0, Vec::len);
    along(run, pointer, axes.saturating_sub(1))
}

/// The component along `axis` of a vector of the scene, the others of which are zero.
///
/// # Errors
/// When there is none, or it points elsewhere.
pub fn along(run: &Finished, pointer: &str, axis: usize) -> Result<f64, LabError> {
    let vector = at(run, pointer)?.as_array().into_iter().flatten();
    let vector: Option<Vec<f64>> = vector.map(Value::as_f64).collect();
    let wrong = |what: &str| LabError::Content {
        path: run.artefact.clone(),
        what: format!("{pointer} of its scene {what}"),
    };
    let vector = vector.ok_or_else(|| wrong("is no vector"))?;
    if (0..vector.len()).any(|k| k != axis && vector[k] != 0.0) {
        return Err(wrong(&format!(
            "is {vector:?}: the exact solution wants it along axis {axis} alone"
        )));
    }
    let found = vector.get(axis).copied();
    found.ok_or_else(|| wrong("has too few numbers"))
}

/// The scene of a case with a patch of its own and then the user's, before it is run.
///
/// # Errors
/// When a file cannot be read.
pub fn planned(lab: &Lab, case: &str, patch: &Value) -> Result<Value, LabError> {
    let folder = lab.root.join("pipelines/verify").join(case);
    let mut scene = over(read_json(&folder.join("scene.json"))?, patch);
    if let Some(path) = &lab.patch {
        scene = over(scene, &read_json(path)?);
    }
    Ok(scene)
}
