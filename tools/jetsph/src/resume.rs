//! Checkpoint of the columns and of the stages, bit for bit.

use artefact::{Checkpoint, Result};

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
    for set in &state.sets {
        columns::save(checkpoint, set);
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
    for set in &mut state.sets {
        columns::restore(checkpoint, set)?;
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
