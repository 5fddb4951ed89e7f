//! What is written of the particles: a channel for each set, a column for each that was declared to be shown.

use artefact::{Frame, Precision};
use particles::{Set, Store};
use run::{Failure, Session};

use crate::scene::FloatWidth;
use crate::state::State;

/// Components of a symmetric matrix that frames show.
const COMPONENTS: [(&str, usize, usize); 6] = [
    ("xx", 0, 0),
    ("yy", 1, 1),
    ("zz", 2, 2),
    ("xy", 0, 1),
    ("xz", 0, 2),
    ("yz", 1, 2),
];

/// The channel of a set.
#[must_use]
pub fn channel(set: &Set) -> String {
    format!("/{}", set.name())
}

/// A set as a frame.
#[must_use]
pub fn frame(set: &Set, dimensions: usize, width: FloatWidth) -> Frame {
    let precision = match width {
        FloatWidth::F32 => Precision::F32,
        FloatWidth::F64 => Precision::F64,
    };
    let mut frame = Frame::new(precision);
    for column in set.declared().filter(|column| column.shown) {
        let (name, unit) = (column.name, column.unit);
        frame = match column.values {
            Store::Vectors(values) if name == "position" => frame.positions(values.iter().copied()),
            Store::Vectors(values) => frame.vector(name, unit, values.iter().copied()),
            Store::Scalars(values) => frame.scalar(name, unit, values.iter().copied()),
            Store::Flags(values) => frame.flag(name, values.iter().copied()),
            Store::Ids(values) => frame.id(name, values.iter().copied()),
            Store::Matrices(values) => {
                // Nothing shears across the plane.
                let shown = COMPONENTS
                    .iter()
                    .filter(|(_, i, j)| dimensions == 3 || i == j || i + j == 1);
                shown.fold(frame, |frame, (axes, i, j)| {
                    frame.scalar(
                        &format!("{name}_{axes}"),
                        unit,
                        values.iter().map(|m| m[*i][*j]),
                    )
                })
            }
        };
    }
    frame
}

/// Writes all sets.
///
/// # Errors
/// When the disk refuses or a value is not finite.
pub fn write(state: &State, width: FloatWidth, session: &mut Session) -> Result<(), Failure> {
    for set in &state.sets {
        session.frame(
            &channel(set),
            state.time,
            &frame(set, state.dimensions, width),
        )?;
    }
    Ok(())
}
