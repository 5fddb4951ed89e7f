//! The outline of a round drop at rest, as tables and pictures have it.

use artefact::{Frame, Table};
use run::{Failure, Session};

use crate::scene::Scene;

/// What places of an outline carry: name, unit and a value for each.
pub(crate) type Carried = (&'static str, &'static str, Vec<f64>);

/// Writes places `(r, z)` \[m\] from a `centre` \[m\] as a table, and as a frame with the places across a plane beside them,
/// to which `turned` takes r and z.
///
/// # Errors
/// When the disk refuses.
pub(crate) fn write(
    scene: &Scene,
    centre: &[f64],
    places: &[[f64; 2]],
    turned: [f64; 2],
    carried: &[Carried],
    session: &mut Session,
) -> Result<(), Failure> {
    let mut table = Table::new(places.len())
        .column("r_m", "m", places.iter().map(|p| p[0]))
        .column("z_m", "m", places.iter().map(|p| p[1]));
    for (name, unit, values) in carried {
        table = table.column(name, unit, values.iter().copied());
    }
    session.table("/outline", 0.0, &table)?;
    let both = places.iter().flat_map(|[r, z]| {
        let across = [turned[0] * r, 0.0, turned[1] * z];
        [[*r, 0.0, *z], across]
    });
    let position = both.map(|at| std::array::from_fn(|k| centre[k] + at[k]));
    let mut frame = Frame::new(scene.output.precision.into()).positions(position);
    for (name, unit, values) in carried {
        frame = frame.scalar(name, unit, values.iter().flat_map(|v| [*v, *v]));
    }
    session.frame("/surface", 0.0, &frame)
}
