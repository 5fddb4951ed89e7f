//! What `emfield` wrote, and what its scene says.

use artefact::{Frame, Reader, Record};
use serde_json::Value;

use super::C;
use super::axes::Axes;
use crate::case::{Case, Errors, Measurement};
use crate::heat::methods::over;
use crate::heat::property::at;
use crate::lab::{Finished, Lab, LabError, read_json};

/// A resolution of a method of a case.
#[derive(Debug, Clone, Copy)]
pub struct Level<'a> {
    /// 1 is the coarsest.
    pub level: u32,
    /// Name of the method.
    pub method: &'a str,
    /// What the resolution is counted by.
    pub spacing: f64,
}

/// Runs a case on a scene with a patch, and finds its errors from the points at its end.
///
/// # Errors
/// When the run fails or lacks what is asked for.
pub fn measured(
    lab: &Lab,
    case: &dyn Case,
    of: Level<'_>,
    patch: &Value,
    errors: impl Fn(&Finished, &Points) -> Result<Errors, LabError>,
) -> Result<Measurement, LabError> {
    let label = format!("level{}-{}", of.level, of.method);
    let run = lab.run(case.tool(), case.name(), &label, patch)?;
    let points = Points::read(&run)?;
    let errors = errors(&run, &points)?;
    Ok(Measurement::of(run, points.count(), of.spacing, errors))
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
    /// In which axes places and vectors are told.
    axes: Axes,
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
            axes: Axes::default(),
        })
    }

    /// The same points with places and vectors in other axes.
    #[must_use]
    pub fn seen_from(&self, axes: Axes) -> Self {
        Self {
            position: self.position.iter().map(|p| axes.place(*p)).collect(),
            frame: self.frame.clone(),
            time: self.time,
            axes,
        }
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
        let real = self.vectors(&format!("{name}_real"))?;
        let imaginary = self.vectors(&format!("{name}_imag"))?;
        let pair = |(a, b): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|k| C::new(a[k], b[k]));
        Ok(real.iter().zip(&imaginary).map(pair).collect())
    }

    /// A vector.
    ///
    /// # Errors
    /// When its column is missing.
    pub fn vectors(&self, name: &str) -> Result<Vec<[f64; 3]>, LabError> {
        let found = self.frame.vectors(name)?;
        Ok(found.iter().map(|v| self.axes.components(*v)).collect())
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

/// The applied flux density \[T\] of a scene in a plane or about an axis, whose exact solution wants it along the last axis.
///
/// # Errors
/// When there is none, or it points elsewhere.
pub fn flux_along(run: &Finished) -> Result<f64, LabError> {
    let pointer = "/eddy_currents/applied_flux_density_t";
    let wrong = |what: &str| LabError::Content {
        path: run.artefact.clone(),
        what: format!("{pointer} of its scene {what}"),
    };
    let vector = at(run, pointer)?.as_array().into_iter().flatten();
    let vector: Option<Vec<f64>> = vector.map(Value::as_f64).collect();
    let vector = vector.ok_or_else(|| wrong("is no vector"))?;
    let (last, across) = vector.split_last().ok_or_else(|| wrong("is empty"))?;
    if across.iter().any(|b| *b != 0.0) {
        return Err(wrong(&format!(
            "is {vector:?}: the exact solution wants it along the last axis alone"
        )));
    }
    Ok(*last)
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
