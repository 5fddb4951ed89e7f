//! Reads the frames of `poolsph` for exact cases.

use std::path::Path;

use artefact::Reader;
use serde_json::Value;

use crate::case::{Errors, Measurement};
use crate::lab::{Finished, LabError};

/// All frames of `/particles`.
pub(crate) struct Frames {
    /// Times \[s\].
    pub(crate) time: Vec<f64>,
    /// Places by frame and particle \[m\].
    pub(crate) position: Vec<Vec<[f64; 3]>>,
    /// Velocities by frame and particle \[m/s\].
    pub(crate) velocity: Vec<Vec<[f64; 3]>>,
    /// Named scalar by frame and particle.
    pub(crate) scalar: Vec<Vec<f64>>,
    /// Which particles are liquid at the end.
    pub(crate) liquid: Vec<bool>,
    /// Volume of a particle, of the lattice that was fitted to the bodies \[m3\].
    pub(crate) volume: f64,
}

/// What is read of `/plate`.
#[derive(serde::Deserialize)]
struct Plate {
    particle_volume_m3: f64,
}

impl Frames {
    /// Reads places, velocities and the column `scalar`.
    pub(crate) fn read(artefact: &Path, scalar: &str) -> Result<Self, LabError> {
        let reader = Reader::open_kind(artefact, "particle-frames", 1)?;
        let mut all = Self {
            time: Vec::new(),
            position: Vec::new(),
            velocity: Vec::new(),
            scalar: Vec::new(),
            liquid: Vec::new(),
            volume: f64::NAN,
        };
        if let Some((_, plate)) = reader.json::<Plate>("/plate")?.first() {
            all.volume = plate.particle_volume_m3;
        }
        for frame in reader.frames("/particles")? {
            let frame = frame?;
            all.time.push(frame.time_s);
            all.position.push(frame.position_vectors()?);
            all.velocity.push(frame.vectors("velocity")?);
            all.scalar.push(frame.f64(scalar)?);
            all.liquid = frame.u8("molten")?.iter().map(|m| *m == 1).collect();
        }
        Ok(all)
    }

    /// Frames of the second half of the run.
    pub(crate) fn second_half(&self) -> std::ops::Range<usize> {
        let end = self.time.last().copied().unwrap_or(0.0);
        let first = self.time.partition_point(|t| *t < 0.5 * end);
        first..self.time.len()
    }

    /// Indices of the liquid particles.
    pub(crate) fn liquid(&self) -> Vec<usize> {
        (0..self.liquid.len()).filter(|a| self.liquid[*a]).collect()
    }
}

/// Mean of numbers; NaN of none.
pub(crate) fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, n) = values.fold((0.0, 0_u64), |(sum, n), x| (sum + x, n + 1));
    sum / n as f64
}

/// A number of the scene by its JSON pointer.
pub(crate) fn number(run: &Finished, pointer: &str) -> Result<f64, LabError> {
    run.scene
        .pointer(pointer)
        .and_then(Value::as_f64)
        .ok_or_else(|| LabError::Content {
            path: run.artefact.clone(),
            what: format!("its scene has no number at {pointer}"),
        })
}

/// The measurement of a run with these errors.
pub(crate) fn measurement(
    run: Finished,
    points: usize,
    errors: Errors,
) -> Result<Measurement, LabError> {
    let spacing_m = number(&run, "/spacing_m")?;
    Ok(Measurement::of(run, points as u64, spacing_m, errors))
}
