//! What is written of the particles: frames with a column for each physics that is active.

use artefact::Frame;
use columns::Form;
use particles::Set;
use run::{Failure, Session};
use serde::Serialize;

use crate::scene::{FloatWidth, PoolOutput, Scene};
use crate::state::{Column, Phase, State};

/// A particle that owns this part of d^2 of the surface counts as surface.
const EXPOSED: f64 = 0.1;

/// JSON Schema of `/source`.
const SOURCE_SCHEMA: &str = r#"{"type":"object","title":"Place of the heat source and phase of the droplet period","properties":{"time_s":{"type":"number"},"x_m":{"type":"number"},"y_m":{"type":"number"},"z_m":{"type":"number"},"phase":{"type":"number","minimum":0,"maximum":1},"droplet":{"type":"integer"}}}"#;

/// JSON Schema of `/plate`.
const PLATE_SCHEMA: &str = r#"{"type":"object","title":"The base metal and its particles","properties":{"min_m":{"type":"array","items":{"type":"number"}},"max_m":{"type":"array","items":{"type":"number"}},"spacing_m":{"type":"number"},"particle_volume_m3":{"type":"number"},"melting_point_k":{"type":"number"},"direction":{"type":"array","items":{"type":"number"}}}}"#;

/// Place of the heat source at the time of a frame, as `/source` tells it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SourceNote {
    /// Simulated time \[s\].
    pub time_s: f64,
    /// x of the axis \[m\].
    pub x_m: f64,
    /// y of the axis \[m\].
    pub y_m: f64,
    /// z of the surface that the arc stands on \[m\].
    pub z_m: f64,
    /// Phase of the droplet period, 0 at the birth of a droplet.
    pub phase: f64,
    /// Number of droplets born.
    pub droplet: u64,
}

/// The base metal, as `/plate` tells it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlateNote {
    /// Lower corner of the first solid body \[m\].
    pub min_m: [f64; 3],
    /// Upper corner \[m\].
    pub max_m: [f64; 3],
    /// d \[m\].
    pub spacing_m: f64,
    /// d^3 \[m3\].
    pub particle_volume_m3: f64,
    /// T_m \[K\], if the metal melts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub melting_point_k: Option<f64>,
    /// Direction in which the source moves.
    pub direction: [f64; 3],
}

/// Which columns the frames of a run have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Width of the floats.
    pub width: FloatWidth,
    /// Frames have a column `wall`.
    pub walls: bool,
    /// Frames have a column `surface`.
    pub surface: bool,
    /// Pressures of single particles differ like the contacts of grains: frames show their kernel mean.
    pub uneven: bool,
}

impl Layout {
    /// The particles `ids` as a frame.
    #[must_use]
    pub fn frame(&self, state: &State, ids: &[usize]) -> Frame {
        let moving = |a: &usize| match state.phase[*a] {
            Phase::Liquid | Phase::Flying => state.velocity[*a],
            Phase::Solid => [0.0; 3],
        };
        let mut frame = Frame::new(self.width.into())
            .positions(ids.iter().map(|a| state.position[*a]))
            .vector("velocity", "m/s", ids.iter().map(moving));
        if state.has(Column::Temperature) {
            let temperature = ids.iter().map(|a| state.temperature[*a]);
            frame = frame.scalar("temperature", "K", temperature);
        }
        if state.has(Column::Pressure) {
            frame = frame.scalar("pressure", "Pa", self.pressure(state, ids));
        }
        let liquid = |a: &usize| u8::from(state.phase[*a] != Phase::Solid);
        frame = frame
            .flag("molten", ids.iter().map(liquid))
            .scalar("fused", "1", ids.iter().map(|a| state.fused[*a]))
            .flag("droplet", ids.iter().map(|a| u8::from(state.droplet[*a])));
        if self.walls {
            frame = frame.flag("wall", ids.iter().map(|a| u8::from(state.wall[*a])));
        }
        if self.surface {
            let least = EXPOSED * state.metal.spacing * state.metal.spacing;
            let exposed = |a: &usize| u8::from(state.surface[*a].area > least);
            frame = frame.flag("surface", ids.iter().map(exposed));
        }
        frame.id("id", ids.iter().map(|a| *a as u32))
    }

    /// Pressure of the particles `ids` \[Pa\].
    fn pressure(&self, state: &State, ids: &[usize]) -> impl Iterator<Item = f64> {
        let means = self.uneven.then(|| state.near.liquid_mean(&state.pressure));
        let pressure = means.as_ref().unwrap_or(&state.pressure);
        let shown: Vec<f64> = ids.iter().map(|a| pressure[*a]).collect();
        shown.into_iter()
    }

    /// Writes all particles to `/particles`.
    ///
    /// # Errors
    /// When the disk refuses or a value is not finite.
    pub fn particles(&self, state: &State, session: &mut Session) -> Result<(), Failure> {
        let ids: Vec<usize> = (0..state.len()).collect();
        session.frame("/particles", state.time, &self.frame(state, &ids))
    }

    /// Writes the particles around the source at `centre` \[m\] to `/pool`.
    ///
    /// # Errors
    /// As [`Layout::particles`].
    pub fn pool(
        &self,
        state: &State,
        pool: &PoolOutput,
        centre: [f64; 3],
        session: &mut Session,
    ) -> Result<(), Failure> {
        let inside = |a: &usize| {
            let [x, y, _] = state.position[*a];
            let ahead = y - centre[1];
            (x - centre[0]).abs() <= pool.beside_m
                && ahead <= pool.ahead_m
                && ahead >= -pool.behind_m
        };
        let ids: Vec<usize> = (0..state.len()).filter(inside).collect();
        session.frame("/pool", state.time, &self.frame(state, &ids))
    }
}

/// Grains as a frame, by their numbers, in whatever order they are kept.
#[must_use]
pub fn grains(set: &Set, width: FloatWidth) -> Frame {
    let form = Form {
        precision: width.into(),
        dimensions: 3,
    };
    let rows = columns::by_number(set);
    columns::frame(columns::shown(set), rows.into_iter(), form)
}

/// Frames that are written every `interval` \[s\], at the start and at the end.
#[must_use]
pub fn count(scene: &Scene, interval: f64) -> u64 {
    let due = crate::scene::due(scene.steps(), scene.step(), interval);
    let turns = (scene.time.end_s / interval.max(scene.step())).floor() as u64;
    // The last state is written whether its turn has come or not.
    turns + 1 + u64::from(!due)
}

/// Channels of frames with the number of their messages, and at most their bytes before they are compressed.
#[must_use]
pub fn volume(
    scene: &Scene,
    state: &State,
    (layout, plate): (&Layout, &PlateNote),
) -> Vec<(&'static str, u64, u64)> {
    let (end, d) = (scene.time.end_s, scene.spacing_m);
    // All droplets are born at the last frame.
    let born = scene.droplets.map_or(0.0, |droplets| {
        let period = scene.droplet_period().unwrap_or(end).max(scene.step());
        let each = (2.0 * droplets.radius_m / d).powi(3) * std::f64::consts::FRAC_PI_6;
        each * (end / period)
    });
    let row = layout.frame(state, &[]).row_bytes() as f64;
    let bytes = |frames: f64, particles: f64| (frames * particles * row) as u64;
    let from_on = |from: f64, interval: f64| {
        let interval = interval.max(scene.step());
        ((end - from).max(0.0) / interval).floor() + 1.0
    };
    let all = state.len() as f64 + 0.5 * born;
    let frames = count(scene, scene.output.particles_interval_s);
    let mut channels = vec![("/particles", frames, bytes(frames as f64, all))];
    if let Some(pool) = scene.output.pool.filter(|pool| pool.from_s <= end) {
        // The part of the plate that the box covers; drops may all lie in it.
        let size = |axis: usize| (plate.max_m[axis] - plate.min_m[axis]).max(d);
        let part = |reach: f64, axis: usize| (reach / size(axis)).min(1.0);
        let share = part(2.0 * pool.beside_m, 0) * part(pool.behind_m + pool.ahead_m, 1);
        let frames = from_on(pool.from_s, pool.interval_s);
        let inside = share * state.len() as f64 + born;
        channels.push(("/pool", frames as u64, bytes(frames, inside)));
    }
    channels
}

/// Writes `/source`.
///
/// # Errors
/// When the disk refuses.
pub fn source(note: &SourceNote, session: &mut Session) -> Result<(), Failure> {
    let schema = ("poolsph.source.v1", SOURCE_SCHEMA);
    session.json("/source", note.time_s, schema, note)
}

/// Writes `/plate`.
///
/// # Errors
/// When the disk refuses.
pub fn plate(note: &PlateNote, session: &mut Session) -> Result<(), Failure> {
    session.json("/plate", 0.0, ("poolsph.plate.v1", PLATE_SCHEMA), note)
}
