//! What `heatsph` wrote: temperatures at its points, and heat through its boundaries.

use artefact::Reader;

use crate::lab::{Finished, LabError};

/// All frames of `/points`; the points stand still.
#[derive(Debug, Clone)]
pub struct Frames {
    /// Times \[s\].
    pub time: Vec<f64>,
    /// Places \[m\].
    pub position: Vec<[f64; 3]>,
    /// Volume of each point \[m3\], \[m2\] in a plane scene.
    pub volume: Vec<f64>,
    /// Temperatures by frame and point \[K\].
    pub temperature: Vec<Vec<f64>>,
}

impl Frames {
    /// Reads the artefact of a run.
    ///
    /// # Errors
    /// When it cannot be read or has no frames.
    pub fn read(run: &Finished) -> Result<Self, LabError> {
        let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
        let mut found = Self {
            time: Vec::new(),
            position: Vec::new(),
            volume: Vec::new(),
            temperature: Vec::new(),
        };
        for frame in reader.frames("/points")? {
            let frame = frame?;
            if found.time.is_empty() {
                found.position = frame.position_vectors()?;
                found.volume = frame.f64("volume")?;
            }
            found.time.push(frame.time_s);
            found.temperature.push(frame.f64("temperature")?);
        }
        if found.time.is_empty() {
            return Err(LabError::Content {
                path: run.artefact.clone(),
                what: "it has no frames of /points".to_owned(),
            });
        }
        Ok(found)
    }

    /// Number of points.
    #[must_use]
    pub fn points(&self) -> u64 {
        self.position.len() as u64
    }

    /// The last temperatures \[K\].
    #[must_use]
    pub fn last(&self) -> &[f64] {
        &self.temperature[self.temperature.len() - 1]
    }

    /// Times after the start \[s\].
    #[must_use]
    pub fn later(&self) -> Vec<f64> {
        self.time.iter().copied().filter(|t| *t > 0.0).collect()
    }

    /// Frames after the start, with their times \[s\].
    pub fn after_start(&self) -> impl Iterator<Item = (f64, &Vec<f64>)> {
        let frames = self.time.iter().copied().zip(&self.temperature);
        frames.filter(|(t, _)| *t > 0.0)
    }
}

/// Heat that enters the body through the boundary with this index at the end \[W\], \[W/m\] in a
/// plane scene.
///
/// # Errors
/// When the artefact does not tell.
pub fn heat_rate(run: &Finished, boundary: usize) -> Result<f64, LabError> {
    let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
    let entry = |key: &str| run.scene.pointer(&format!("/boundaries/{boundary}/{key}"));
    let name = entry("name").or_else(|| entry("on/0"));
    let content = |what: &str| LabError::Content {
        path: run.artefact.clone(),
        what: what.to_owned(),
    };
    let name = name.and_then(serde_json::Value::as_str);
    let name = name.ok_or_else(|| content("its scene has no such boundary"))?;
    let records = reader.records("/boundaries")?;
    let (_, last) = records.last().ok_or_else(|| content("no /boundaries"))?;
    Ok(last.get(&format!("{name}.heat_rate"))?)
}

/// Largest difference of `found` and what `wanted` says at each place, over `scale`.
pub fn worst(
    position: &[[f64; 3]],
    found: &[f64],
    scale: f64,
    mut wanted: impl FnMut(&[f64; 3]) -> f64,
) -> f64 {
    let mut worst = 0.0_f64;
    for (place, value) in position.iter().zip(found) {
        worst = greater(worst, (value - wanted(place)).abs() / scale);
    }
    worst
}

/// The greater of two errors; one that is not a number stays.
#[must_use]
pub fn greater(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        a.max(b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_point_counts_and_no_number_stays() {
        let places = [[0.0; 3], [1.0, 0.0, 0.0]];
        let found = worst(&places, &[0.0, 3.0], 2.0, |p| p[0]);
        assert!((found - 1.0).abs() < 1e-15);
        assert!(worst(&places, &[f64::NAN, 1.0], 1.0, |p| p[0]).is_nan());
    }
}
