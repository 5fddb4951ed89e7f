//! Particle frames as clouds, read one after another.

use artefact::{Frame, Reader};
use serde::Deserialize;

use crate::cloud::Cloud;
use crate::phase::Source;
use crate::scene::GrainState;

/// Share of the room that grains fill where they lie as they fell.
const PACKED: f64 = 0.6;

/// What the frames say of the metal.
#[derive(Debug, Clone, Copy, Deserialize)]
pub struct Plate {
    /// Particle spacing \[m\].
    pub spacing_m: f64,
    /// Volume of a particle \[m3\]; the cube of the spacing when absent.
    #[serde(default)]
    pub particle_volume_m3: Option<f64>,
    /// x of the mirror beside which half of a weld was computed \[m\].
    #[serde(default)]
    pub mirror_x_m: Option<f64>,
    /// Direction of welding.
    #[serde(default)]
    pub direction: Option<[f64; 3]>,
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

    /// The level direction of a weld that does not run along +y.
    #[must_use]
    pub fn turned(&self) -> Option<[f64; 2]> {
        let [x, y, _] = self.direction?;
        let size = x.hypot(y);
        let is_y = x.abs() <= 0.0 && y > 0.0;
        (size > 0.0 && !is_y).then(|| [x / size, y / size])
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

/// What grains say of themselves: their diameter in the mean, and the room that each takes; none where a frame is of metal.
///
/// # Errors
/// When the radii cannot be read.
pub fn grains(frame: &Frame) -> artefact::Result<Option<Plate>> {
    if !frame.has("radius") {
        return Ok(None);
    }
    let radii = frame.f64("radius")?;
    let count = radii.len().max(1) as f64;
    let mean = |of: fn(f64) -> f64| radii.iter().map(|r| of(2.0 * r)).sum::<f64>() / count;
    let ball = std::f64::consts::FRAC_PI_6 * mean(|d| d.powi(3));
    Ok(Some(Plate {
        spacing_m: mean(|d| d),
        particle_volume_m3: Some(ball / PACKED),
        mirror_x_m: None,
        direction: None,
    }))
}

/// The grains of a frame in the states that count. All of them flow.
fn grain_cloud(frame: &Frame, states: Option<&[GrainState]>) -> artefact::Result<Cloud> {
    let position = frame.position_vectors()?;
    let mut cloud = Cloud {
        liquid: vec![true; position.len()],
        position,
        velocity: frame.vectors("velocity")?,
        temperature: temperature(frame)?,
    };
    if let Some(states) = states {
        let own = frame.u8("state")?.iter();
        let counts: Vec<bool> = own
            .map(|own| states.iter().any(|state| *state as u8 == *own))
            .collect();
        cloud.retain(&counts);
    }
    Ok(cloud)
}

fn temperature(frame: &Frame) -> artefact::Result<Option<Vec<f64>>> {
    let told = frame.has("temperature");
    told.then(|| frame.f64("temperature")).transpose()
}

/// The particles of a frame. Walls and particles that are not metal are left out, and grains that are in none of the `states`.
///
/// # Errors
/// When a column that averages need is absent.
pub fn cloud(frame: &Frame, states: Option<&[GrainState]>) -> artefact::Result<Cloud> {
    if frame.has("radius") {
        return grain_cloud(frame, states);
    }
    let mut cloud = Cloud {
        position: frame.position_vectors()?,
        velocity: frame.vectors("velocity")?,
        temperature: temperature(frame)?,
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
    fn a_weld_along_y_is_told_by_nothing() {
        let of = |direction: Option<[f64; 3]>| {
            let plate = Plate {
                spacing_m: 1e-3,
                particle_volume_m3: None,
                mirror_x_m: None,
                direction,
            };
            plate.turned()
        };
        assert_eq!(of(None), None);
        assert_eq!(of(Some([0.0, 1.0, 0.0])), None);
        assert_eq!(of(Some([0.0, -1.0, 0.0])), Some([0.0, -1.0]));
        assert_eq!(of(Some([3.0, 4.0, 0.0])), Some([0.6, 0.8]));
    }

    #[test]
    fn a_frame_without_temperature_makes_a_cloud_without_temperature() {
        let c = cloud(&frame(), None).unwrap();
        assert!(c.temperature.is_none());
        assert_eq!(c.liquid, [true, false]);
        let hot = frame().scalar("temperature", "K", [300.0, 400.0]);
        let hot = cloud(&hot, None).unwrap();
        assert_eq!(hot.temperature.unwrap(), [300.0, 400.0]);
    }

    #[test]
    fn walls_are_not_metal() {
        let c = cloud(&frame().flag("wall", [0, 1]), None).unwrap();
        assert_eq!((c.len(), c.velocity.len(), c.liquid.len()), (1, 1, 1));
    }

    #[test]
    fn a_missing_column_is_named() {
        let bare = Frame::new(Precision::F32).positions([[0.0; 3]]);
        let said = cloud(&bare, None).unwrap_err().to_string();
        assert!(said.contains("velocity_x"), "{said}");
    }

    #[test]
    fn grains_count_by_their_state_and_all_of_them_flow() {
        let heap = Frame::new(Precision::F64)
            .positions([[0.0; 3], [1.0; 3], [2.0; 3]])
            .vector("velocity", "m/s", [[1.0, 2.0, 3.0]; 3])
            .scalar("radius", "m", [0.5, 0.5, 1.0])
            .flag("state", [0, 1, 2]);
        let found = |states: &[GrainState]| cloud(&heap, Some(states)).unwrap().position;
        assert_eq!(found(&[GrainState::Slag]), [[1.0; 3]]);
        assert_eq!(
            found(&[GrainState::Powder, GrainState::Frozen]),
            [[0.0; 3], [2.0; 3]]
        );
        assert_eq!(cloud(&heap, None).unwrap().liquid, [true; 3]);
        let own = grains(&heap).unwrap().unwrap();
        assert!((own.spacing_m - 4.0 / 3.0).abs() < 1e-15);
        let ball = std::f64::consts::FRAC_PI_6 * 10.0 / 3.0;
        assert!((own.volume() / (ball / 0.6) - 1.0).abs() < 1e-12);
        assert!(grains(&frame()).unwrap().is_none());
        let cold = Frame::new(Precision::F64)
            .positions([[0.0; 3]])
            .vector("velocity", "m/s", [[0.0; 3]])
            .scalar("radius", "m", [0.5]);
        let said = cloud(&cold, Some(&[GrainState::Slag])).unwrap_err();
        assert!(said.to_string().contains("state"), "{said}");
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
