//! Particle frames as clouds, read one after another.

use artefact::{Frame, Reader};
use serde::Deserialize;

use crate::cloud::Cloud;
use crate::phase::Source;

/// What the frames say of the metal.
#[derive(Debug, Clone, Copy, Deserialize)]
pub struct Plate {
    /// Particle spacing \[m\].
    pub spacing_m: f64,
    /// Volume of a particle \[m3\]; the cube of the spacing when absent.
    #[serde(default)]
    pub particle_volume_m3: Option<f64>,
}

impl Plate {
    /// Reads the plate, where the file tells it.
    ///
    /// # Errors
    /// When the message cannot be read.
    pub fn read(reader: &Reader) -> artefact::Result<Option<Self>> {
        if !reader.has("/plate") {
            return Ok(None);
        }
        reader.json_at("/plate", 0).map(Some)
    }

    /// Volume of a particle \[m3\].
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.particle_volume_m3
            .unwrap_or_else(|| self.spacing_m.powi(3))
    }
}

#[derive(Deserialize)]
struct Place {
    x_m: f64,
    y_m: f64,
    z_m: f64,
    #[serde(default)]
    phase: f64,
    #[serde(default)]
    droplet: i64,
}

/// The source over time, one entry per moment, in the order of time.
///
/// # Errors
/// When the channel is absent or cannot be read.
pub fn track(reader: &Reader, channel: &str) -> artefact::Result<Vec<Source>> {
    let mut track: Vec<Source> = reader
        .json::<Place>(channel)?
        .into_iter()
        .map(|(time, place)| Source {
            time,
            position: [place.x_m, place.y_m, place.z_m],
            phase: place.phase,
            droplet: place.droplet,
        })
        .collect();
    track.sort_by(|a, b| a.time.total_cmp(&b.time));
    track.dedup_by(|b, a| same(a.time, b.time));
    Ok(track)
}

/// Index of the entry at `time`, if the track has one.
#[must_use]
pub fn entry(track: &[Source], time: f64) -> Option<usize> {
    let i = track.partition_point(|s| s.time < time && !same(s.time, time));
    (i < track.len() && same(track[i].time, time)).then_some(i)
}

/// Log times are whole nanoseconds.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

/// The particles of a frame. Walls and particles that are not metal are left out.
///
/// # Errors
/// When a column that averages need is absent.
pub fn cloud(frame: &Frame) -> artefact::Result<Cloud> {
    let mut cloud = Cloud {
        position: frame.position_vectors()?,
        velocity: frame.vectors("velocity")?,
        temperature: if frame.has("temperature") {
            Some(frame.f64("temperature")?)
        } else {
            None
        },
        liquid: frame.u8("molten")?.iter().map(|flag| *flag != 0).collect(),
    };
    if frame.has("wall") {
        let metal: Vec<bool> = frame.u8("wall")?.iter().map(|flag| *flag == 0).collect();
        cloud.retain(&metal);
    }
    Ok(cloud)
}

#[cfg(test)]
mod tests {
    use super::*;
    use artefact::Precision;

    fn frame() -> Frame {
        Frame::new(Precision::F64)
            .positions([[0.0; 3], [1.0; 3]])
            .vector("velocity", "m/s", [[1.0, 2.0, 3.0]; 2])
            .flag("molten", [1, 0])
    }

    #[test]
    fn a_frame_without_temperature_makes_a_cloud_without_temperature() {
        let c = cloud(&frame()).unwrap();
        assert!(c.temperature.is_none());
        assert_eq!(c.liquid, [true, false]);
        let hot = cloud(&frame().scalar("temperature", "K", [300.0, 400.0])).unwrap();
        assert_eq!(hot.temperature.unwrap(), [300.0, 400.0]);
    }

    #[test]
    fn walls_are_not_metal() {
        let c = cloud(&frame().flag("wall", [0, 1])).unwrap();
        assert_eq!((c.len(), c.velocity.len(), c.liquid.len()), (1, 1, 1));
    }

    #[test]
    fn a_missing_column_is_named() {
        let bare = Frame::new(Precision::F32).positions([[0.0; 3]]);
        let said = cloud(&bare).unwrap_err().to_string();
        assert!(said.contains("velocity_x"), "{said}");
    }

    #[test]
    fn a_moment_is_found_to_the_nanosecond() {
        let at = |time| Source {
            time,
            position: [0.0; 3],
            phase: 0.0,
            droplet: 0,
        };
        let track = [at(0.0), at(0.1), at(0.2)];
        assert_eq!(entry(&track, 0.1 + 4e-10), Some(1));
        assert_eq!(entry(&track, 0.1 - 4e-10), Some(1));
        assert_eq!(entry(&track, 0.15), None);
        assert_eq!(entry(&track, 0.3), None);
    }
}
