//! Checkpoint of the columns and of the stages, bit for bit.

use artefact::{Checkpoint, Result};
use particles::Store;

use crate::balance::Balance;
use crate::march::March;
use crate::state::State;

/// Puts all that the rest of a run depends on into a checkpoint.
///
/// # Errors
/// When a value does not serialise.
pub fn save(
    checkpoint: &mut Checkpoint,
    state: &State,
    march: &March,
    start: &Balance,
) -> Result<()> {
    for (place, set) in state.sets.iter().enumerate() {
        for column in set.declared().filter(|column| column.saved) {
            let name = entry(place, column.name);
            match column.values {
                Store::Scalars(values) => checkpoint.put_f64(&name, values),
                Store::Vectors(values) => checkpoint.put_vectors(&name, values),
                Store::Matrices(values) => {
                    checkpoint.put_f64(&name, values.as_flattened().as_flattened())
                }
                Store::Flags(values) => checkpoint.put_u8(&name, values),
                Store::Ids(values) => {
                    let wide: Vec<u64> = values.iter().map(|id| u64::from(*id)).collect();
                    checkpoint.put_u64(&name, &wide);
                }
            }
        }
    }
    for (place, stage) in march.stages.iter().enumerate() {
        checkpoint.put_f64(&format!("stage.{place}.{}", stage.name()), &stage.save());
    }
    let counts = [state.step, u64::from(state.ids.next), state.exchanges];
    checkpoint.put_u64("step", &counts);
    checkpoint.put_f64("time", &[state.time]);
    checkpoint.put_f64("start", &start.save());
    Ok(())
}

/// Takes back what [`save`] put; gives the balance of the start.
///
/// # Errors
/// When the checkpoint lacks a part.
pub fn restore(
    checkpoint: &mut Checkpoint,
    state: &mut State,
    march: &mut March,
) -> Result<Balance> {
    for (place, set) in state.sets.iter_mut().enumerate() {
        set.restore(|name, kind| column(checkpoint, &entry(place, name), kind))?;
    }
    let counts = checkpoint.u64("step")?;
    state.step = counts.first().copied().unwrap_or(0);
    state.ids.next = counts.get(1).map_or(0, |next| *next as u32);
    state.exchanges = counts.get(2).copied().unwrap_or(0);
    state.time = checkpoint.f64("time")?.first().copied().unwrap_or(0.0);
    for (place, stage) in march.stages.iter_mut().enumerate() {
        let saved = checkpoint.f64(&format!("stage.{place}.{}", stage.name()))?;
        stage.restore(state, &saved);
    }
    Ok(Balance::restored(&checkpoint.f64("start")?))
}

fn column(checkpoint: &mut Checkpoint, name: &str, kind: &Store) -> Result<Store> {
    Ok(match kind {
        Store::Scalars(_) => Store::Scalars(checkpoint.f64(name)?),
        Store::Vectors(_) => Store::Vectors(checkpoint.vectors(name)?),
        Store::Matrices(_) => {
            let rows = checkpoint.vectors(name)?;
            Store::Matrices(rows.as_chunks::<3>().0.to_vec())
        }
        Store::Flags(_) => Store::Flags(checkpoint.u8(name)?),
        Store::Ids(_) => Store::Ids(checkpoint.u64(name)?.iter().map(|id| *id as u32).collect()),
    })
}

fn entry(place: usize, column: &str) -> String {
    format!("set.{place}.{column}")
}
