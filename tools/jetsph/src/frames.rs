//! What is written of the particles: a channel for each set, a column for each that was declared to be shown.

use artefact::Frame;
use columns::{Form, channel};
use particles::Set;
use run::scene::FloatWidth;
use run::{Failure, Session};

use crate::state::State;

/// A set as a frame.
#[must_use]
pub fn frame(set: &Set, dimensions: usize, width: FloatWidth) -> Frame {
    let form = Form {
        precision: width.into(),
        dimensions,
    };
    columns::frame(columns::shown(set), 0..set.len(), form)
}

/// Writes all sets.
///
/// # Errors
/// When the disk refuses or a value is not finite.
pub fn write(state: &State, width: FloatWidth, session: &mut Session) -> Result<(), Failure> {
    for set in &state.sets {
        let frame = frame(set, state.dimensions, width);
        session.frame(&channel(set), state.time, &frame)?;
    }
    Ok(())
}
