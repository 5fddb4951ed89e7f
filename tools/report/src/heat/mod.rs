//! Points of a body that conducts heat, as one frame shows them.

pub(crate) mod field;
pub(crate) mod fit;
pub(crate) mod shape;

use artefact::Reader;
use serde_json::Value;

use shape::Body;

/// Channel of all points.
pub(crate) const POINTS: &str = "/points";

/// The points of one frame with what is known of them.
#[derive(Debug, Clone)]
pub(crate) struct Points {
    /// Simulated time \[s\].
    pub(crate) time: f64,
    /// Places \[m\].
    pub(crate) position: Vec<[f64; 3]>,
    /// Temperatures \[K\].
    pub(crate) temperature: Vec<f64>,
    /// What each point stands for \[m3\], in a plane body \[m2\].
    pub(crate) volume: Vec<f64>,
    /// Number of its material, where there is more than one.
    pub(crate) material: Option<Vec<usize>>,
    /// Whether the body lies in a plane.
    pub(crate) plane: bool,
    /// Body and materials as the scene tells them.
    pub(crate) body: Body,
}

/// Least, mean (by volume) and greatest temperature \[K\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Range {
    pub(crate) least: f64,
    pub(crate) mean: f64,
    pub(crate) greatest: f64,
}

impl Points {
    /// The last frame of the artefact; `None` when it has none, or no point in it.
    ///
    /// # Errors
    /// When a message cannot be read or a column is absent.
    pub(crate) fn last(reader: &Reader) -> artefact::Result<Option<Self>> {
        match reader.count(POINTS) {
            0 => Ok(None),
            n => Ok(Some(Self::read(reader, n - 1)?).filter(|p| !p.position.is_empty())),
        }
    }

    fn read(reader: &Reader, index: usize) -> artefact::Result<Self> {
        let frame = reader.frame(POINTS, index)?;
        let position = frame.position_vectors()?;
        let scene = &reader.header().scene;
        let flat = scene.get("dimensions").and_then(Value::as_u64) == Some(2);
        let level = position.first().map_or(0.0, |p| p[2]);
        let even = position.iter().all(|p| (p[2] - level).abs() <= 0.0);
        Ok(Self {
            time: frame.time_s,
            temperature: frame.f64("temperature")?,
            volume: frame.f64("volume")?,
            material: match frame.has("material") {
                true => Some(frame.u8("material")?.iter().map(|m| (*m).into()).collect()),
                false => None,
            },
            plane: flat || even,
            body: Body::of_scene(scene),
            position,
        })
    }

    /// Least, mean and greatest temperature.
    pub(crate) fn range(&self) -> Range {
        let t = &self.temperature;
        let whole: f64 = self.volume.iter().sum();
        let sum: f64 = t.iter().zip(&self.volume).map(|(t, v)| t * v).sum();
        Range {
            least: t.iter().copied().fold(f64::INFINITY, f64::min),
            mean: sum / whole,
            greatest: t.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// Mean distance of neighbours \[m\].
    pub(crate) fn spacing(&self) -> f64 {
        let mean = self.volume.iter().sum::<f64>() / self.volume.len() as f64;
        if self.plane { mean.sqrt() } else { mean.cbrt() }
    }

    /// The centre of volume \[m\].
    pub(crate) fn centre(&self) -> [f64; 3] {
        let whole: f64 = self.volume.iter().sum();
        let mut centre = [0.0; 3];
        for (p, v) in self.position.iter().zip(&self.volume) {
            for k in 0..3 {
                centre[k] += p[k] * v / whole;
            }
        }
        centre
    }
}
