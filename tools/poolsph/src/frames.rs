//! What is written of the particles: frames with a column for each physics that is active.

use artefact::Frame;
use columns::Form;
use particles::{ID, POSITION, Set};
use run::scene::FloatWidth;
use run::{Failure, Session};
use serde::Serialize;

use crate::memory;
use crate::scene::{PoolOutput, Scene};
use crate::state::State;

/// JSON Schema of `/source`.
const SOURCE_SCHEMA: &str = r#"{"type":"object","title":"Place of the heat source and phase of the droplet period","properties":{"time_s":{"type":"number"},"x_m":{"type":"number"},"y_m":{"type":"number"},"z_m":{"type":"number"},"phase":{"type":"number","minimum":0,"maximum":1},"droplet":{"type":"integer"}}}"#;

/// JSON Schema of `/plate`.
const PLATE_SCHEMA: &str = r#"{"type":"object","title":"The base metal and its particles","properties":{"min_m":{"type":"array","items":{"type":"number"}},"max_m":{"type":"array","items":{"type":"number"}},"spacing_m":{"type":"number"},"particle_volume_m3":{"type":"number"},"melting_point_k":{"type":"number"},"direction":{"type":"array","items":{"type":"number"}},"mirror_x_m":{"type":"number"}}}"#;

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
    /// Direction in which the source moves, or else the first torch that does; +y where none does.
    pub direction: [f64; 3],
    /// x of the mirror beside which half of a weld is computed \[m\]; none of the whole.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mirror_x_m: Option<f64>,
}

/// Columns of the metal in the order of old; others stand behind them, the number last.
const ORDER: [&str; 9] = [
    "position",
    "velocity",
    "temperature",
    "pressure",
    "molten",
    "fused",
    "droplet",
    "wall",
    "surface",
];

/// The `rows` of the metal as a frame.
#[must_use]
pub fn metal(state: &State, rows: &[usize], width: FloatWidth) -> Frame {
    let mut shown: Vec<_> = columns::shown(&state.metal).collect();
    shown.sort_by_key(|column| {
        let place = ORDER.iter().position(|name| *name == column.name);
        (column.name == ID.name, place.unwrap_or(ORDER.len()))
    });
    columns::frame(shown, rows.iter().copied(), form(width))
}

/// Writes all particles to `/particles`.
///
/// # Errors
/// When the disk refuses or a value is not finite.
pub fn particles(state: &State, width: FloatWidth, session: &mut Session) -> Result<(), Failure> {
    let rows: Vec<usize> = (0..state.len()).collect();
    session.frame("/particles", state.time, &metal(state, &rows, width))
}

/// Writes the particles around the source at `centre` \[m\] to `/pool`.
///
/// # Errors
/// As [`particles()`].
pub fn pool(
    state: &State,
    pool: &PoolOutput,
    width: FloatWidth,
    centre: [f64; 3],
    session: &mut Session,
) -> Result<(), Failure> {
    let inside = |[x, y, _]: [f64; 3]| {
        let ahead = y - centre[1];
        (x - centre[0]).abs() <= pool.beside_m && ahead <= pool.ahead_m && ahead >= -pool.behind_m
    };
    let places = state.metal.column(&POSITION);
    let rows: Vec<usize> = (0..places.len()).filter(|a| inside(places[*a])).collect();
    session.frame("/pool", state.time, &metal(state, &rows, width))
}

fn form(width: FloatWidth) -> Form {
    Form {
        precision: width.into(),
        dimensions: 3,
    }
}

/// Grains as a frame, by their numbers, in whatever order they are kept.
#[must_use]
pub fn grains(set: &Set, width: FloatWidth) -> Frame {
    let rows = columns::by_number(set);
    columns::frame(columns::shown(set), rows.into_iter(), form(width))
}

/// Frames that are written every `interval` \[s\], at the start and at the end.
#[must_use]
pub fn count(scene: &Scene, interval: f64) -> u64 {
    let due = steps::instants::due(scene.steps(), scene.step(), interval);
    let turns = (scene.time.end_s / interval.max(scene.step())).floor() as u64;
    // The last state is written whether its turn has come or not.
    turns + 1 + u64::from(!due)
}

/// Channels of frames with the number of their messages, and at most their bytes before they are compressed.
#[must_use]
pub fn volume(scene: &Scene, state: &State, plate: &PlateNote) -> Vec<(&'static str, u64, u64)> {
    let (end, d) = (scene.time.end_s, state.metal.matter.spacing);
    // All droplets are born at the last frame.
    let born = memory::fed(scene);
    let row = metal(state, &[], scene.output.precision).row_bytes() as f64;
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
