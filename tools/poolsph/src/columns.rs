//! Frames and checkpoints of sets of particles, read off the columns that were declared.

use artefact::{Checkpoint, Frame, Precision, Result};
use particles::{ID, Set, Store};

use crate::scene::FloatWidth;

/// Channel of a set.
#[must_use]
pub fn channel(set: &Set) -> String {
    format!("/{}", set.name())
}

/// A set as a frame: the columns that are shown, by the numbers of the particles, in whatever order they are kept.
#[must_use]
pub fn frame(set: &Set, width: FloatWidth) -> Frame {
    let ids = set.column(&ID);
    if !ids.is_sorted() {
        let mut order: Vec<u32> = (0..ids.len() as u32).collect();
        order.sort_unstable_by_key(|row| ids[*row as usize]);
        let mut sorted = set.clone();
        sorted.arrange(&order);
        return frame(&sorted, width);
    }
    let precision = match width {
        FloatWidth::F32 => Precision::F32,
        FloatWidth::F64 => Precision::F64,
    };
    let shown = set.declared().filter(|column| column.shown);
    shown.fold(Frame::new(precision), |frame, column| {
        let (name, unit) = (column.name, column.unit);
        match column.values {
            Store::Vectors(values) if name == "position" => frame.positions(values.iter().copied()),
            Store::Vectors(values) => frame.vector(name, unit, values.iter().copied()),
            Store::Scalars(values) => frame.scalar(name, unit, values.iter().copied()),
            Store::Flags(values) => frame.flag(name, values.iter().copied()),
            Store::Ids(values) => frame.id(name, values.iter().copied()),
            // No set of this tool shows matrices.
            Store::Matrices(_) => frame,
        }
    })
}

/// Puts the saved columns of a set into a checkpoint.
///
/// # Errors
/// When a value does not serialise.
pub fn save(checkpoint: &mut Checkpoint, set: &Set) -> Result<()> {
    for column in set.declared().filter(|column| column.saved) {
        let name = entry(set.name(), column.name);
        match column.values {
            Store::Scalars(values) => checkpoint.put_f64(&name, values),
            Store::Vectors(values) => checkpoint.put_vectors(&name, values),
            Store::Matrices(values) => {
                checkpoint.put_f64(&name, values.as_flattened().as_flattened());
            }
            Store::Flags(values) => checkpoint.put_u8(&name, values),
            Store::Ids(values) => {
                let wide: Vec<u64> = values.iter().map(|id| u64::from(*id)).collect();
                checkpoint.put_u64(&name, &wide);
            }
        }
    }
    Ok(())
}

/// Takes back what [`save`] put.
///
/// # Errors
/// When the checkpoint lacks a column.
pub fn restore(checkpoint: &mut Checkpoint, set: &mut Set) -> Result<()> {
    let of = set.name().to_owned();
    set.restore(|name, kind| {
        let name = entry(&of, name);
        Ok(match kind {
            Store::Scalars(_) => Store::Scalars(checkpoint.f64(&name)?),
            Store::Vectors(_) => Store::Vectors(checkpoint.vectors(&name)?),
            Store::Matrices(_) => {
                Store::Matrices(checkpoint.vectors(&name)?.as_chunks::<3>().0.to_vec())
            }
            Store::Flags(_) => Store::Flags(checkpoint.u8(&name)?),
            Store::Ids(_) => {
                let wide = checkpoint.u64(&name)?;
                Store::Ids(wide.iter().map(|id| *id as u32).collect())
            }
        })
    })
}

fn entry(set: &str, column: &str) -> String {
    format!("{set}.{column}")
}
