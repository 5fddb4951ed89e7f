//! Checkpoint of the state and of the stages, bit for bit.

use artefact::{Checkpoint, Result};

use crate::balance::Start;
use crate::march::March;
use crate::state::State;

/// Puts all that the rest of a run depends on into a checkpoint.
///
/// # Errors
/// When a value does not serialise.
pub fn save(checkpoint: &mut Checkpoint, state: &State, march: &March, start: Start) -> Result<()> {
    columns::save(checkpoint, &state.metal);
    if let Some(grains) = &state.grains {
        columns::save(checkpoint, grains);
    }
    checkpoint.put_u8("flowing", &[u8::from(state.flowing)]);
    checkpoint.put_u64("step", &[state.step]);
    checkpoint.put_u64("pace", &[march.strides().stride, march.strides().taken]);
    checkpoint.put_f64("start", &[start.mass, start.stored]);
    for (place, stage) in march.stages().enumerate() {
        checkpoint.put_f64(&stage_name(place, stage.name()), &stage.save());
    }
    Ok(())
}

/// Takes back what [`save`] put; `dt` is the step \[s\].
///
/// # Errors
/// When the checkpoint lacks a part.
pub fn restore(
    checkpoint: &mut Checkpoint,
    state: &mut State,
    march: &mut March,
    dt: f64,
) -> Result<Start> {
    columns::restore(checkpoint, &mut state.metal)?;
    if let Some(grains) = &mut state.grains {
        columns::restore(checkpoint, grains)?;
    }
    state.flowing = checkpoint.u8("flowing")?.first().is_some_and(|f| *f != 0);
    state.step = checkpoint.u64("step")?.first().copied().unwrap_or(0);
    state.time = state.step as f64 * dt;
    if let [stride, taken] = checkpoint.u64("pace")?[..] {
        let strides = march.strides_mut();
        (strides.stride, strides.taken) = (stride, taken);
    }
    let start = checkpoint.f64("start")?;
    for (place, stage) in march.stages_mut().enumerate() {
        let saved = checkpoint.f64(&stage_name(place, stage.name()))?;
        stage.restore(&saved);
    }
    Ok(Start {
        mass: start.first().copied().unwrap_or(0.0),
        stored: start.get(1).copied().unwrap_or(0.0),
    })
}

fn stage_name(place: usize, name: &str) -> String {
    format!("stage.{place}.{name}")
}
