//! References for drops that swing, and what is read of them.

pub mod radial;
pub mod swing;
pub mod viscous;

use artefact::Reader;
use serde_json::json;

use crate::em::frames::planned;
use crate::lab::{Finished, Lab, LabError};
use crate::norms::Worst as _;

/// What the scene of a case says of its spherical drop.
#[derive(Debug, Clone, Copy)]
pub struct Sphere {
    /// Radius \[m\].
    pub radius: f64,
    /// Surface tension \[N/m\].
    pub tension: f64,
    /// Density \[kg/m3\].
    pub density: f64,
    /// Viscosity \[Pa s\]; NaN where the scene says none.
    pub viscosity: f64,
}

impl Sphere {
    /// Reads it.
    ///
    /// # Errors
    /// When the scene of the case cannot be read.
    pub fn planned(lab: &Lab, case: &str) -> Result<Self, LabError> {
        let scene = planned(lab, case, &json!({}))?;
        let number = |key: &str| scene["liquid"][key].as_f64().unwrap_or(f64::NAN);
        let radius = scene["liquid"]["shape"]["sphere"]["radius_m"].as_f64();
        Ok(Self {
            radius: radius.unwrap_or(f64::NAN),
            tension: number("surface_tension_n_m"),
            density: number("density_kg_m3"),
            viscosity: number("viscosity_pa_s"),
        })
    }

    /// `sqrt(rho R^3 / gamma)` \[s\].
    #[must_use]
    pub fn time(&self) -> f64 {
        (self.density * self.radius.powi(3) / self.tension).sqrt()
    }
}

/// Greatest change of the volume over the first one.
///
/// # Errors
/// When the artefact has no volumes.
pub fn drift(run: &Finished) -> Result<f64, LabError> {
    let volume = Series::read(run, "volume")?.value;
    let drift = volume.iter().map(|v| (v / volume[0] - 1.0).abs());
    Ok(drift.worst())
}

/// A column of the rows of a drop, with their times \[s\].
#[derive(Debug, Clone)]
pub struct Series {
    /// Times \[s\].
    pub time: Vec<f64>,
    /// Values.
    pub value: Vec<f64>,
}

impl Series {
    /// Reads it.
    ///
    /// # Errors
    /// When the artefact has none.
    pub fn read(run: &Finished, name: &str) -> Result<Self, LabError> {
        let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
        let (mut time, mut value) = (Vec::new(), Vec::new());
        for (at, record) in reader.records("/liquid")? {
            time.push(at);
            value.push(record.get(name)?);
        }
        Ok(Self { time, value })
    }
}

/// Points of the drop of a run.
///
/// # Errors
/// When it has no frame.
pub fn points(run: &Finished) -> Result<u64, LabError> {
    let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
    Ok(reader.frame("/points", 0)?.len() as u64)
}
