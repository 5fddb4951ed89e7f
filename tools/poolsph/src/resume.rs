//! Checkpoint of the state and of the stages, bit for bit.

use artefact::{Checkpoint, Result};

use crate::balance::Start;
use crate::march::March;
use crate::patch::Patch;
use crate::state::{Phase, State};

/// Puts all that the rest of a run depends on into a checkpoint.
///
/// # Errors
/// When a value does not serialise.
pub fn save(checkpoint: &mut Checkpoint, state: &State, march: &March, start: Start) -> Result<()> {
    let flags = |flags: &[bool]| -> Vec<u8> { flags.iter().map(|f| u8::from(*f)).collect() };
    let phases: Vec<u8> = state.phase.iter().map(|phase| *phase as u8).collect();
    checkpoint.put_vectors("position", &state.position);
    checkpoint.put_vectors("velocity", &state.velocity);
    checkpoint.put_u8("phase", &phases);
    checkpoint.put_f64("fused", &state.fused);
    checkpoint.put_u8("droplet", &flags(&state.droplet));
    checkpoint.put_u8("wall", &flags(&state.wall));
    checkpoint.put_f64("temperature", &state.temperature);
    checkpoint.put_f64("enthalpy", &state.enthalpy);
    checkpoint.put_f64("pressure", &state.pressure);
    let patches: Vec<f64> = state.surface.iter().flat_map(Patch::save).collect();
    checkpoint.put_f64("surface", &patches);
    if let Some(grains) = &state.grains {
        columns::save(checkpoint, grains);
    }
    checkpoint.put_u8("flowing", &[u8::from(state.flowing)]);
    checkpoint.put_u64("step", &[state.step]);
    checkpoint.put_u64("pace", &[march.pace().stride, march.pace().taken]);
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
    let flags = |bytes: Vec<u8>| -> Vec<bool> { bytes.into_iter().map(|b| b != 0).collect() };
    state.position = checkpoint.vectors("position")?;
    state.velocity = checkpoint.vectors("velocity")?;
    state.phase = checkpoint.u8("phase")?.into_iter().map(phase).collect();
    state.fused = checkpoint.f64("fused")?;
    state.droplet = flags(checkpoint.u8("droplet")?);
    state.wall = flags(checkpoint.u8("wall")?);
    state.temperature = checkpoint.f64("temperature")?;
    state.enthalpy = checkpoint.f64("enthalpy")?;
    state.pressure = checkpoint.f64("pressure")?;
    let patches = checkpoint.f64("surface")?;
    let (patches, _) = patches.as_chunks();
    state.surface = patches
        .iter()
        .map(|saved| Patch::restored(*saved))
        .collect();
    if let Some(grains) = &mut state.grains {
        columns::restore(checkpoint, grains)?;
    }
    state.flowing = checkpoint.u8("flowing")?.first().is_some_and(|f| *f != 0);
    state.step = checkpoint.u64("step")?.first().copied().unwrap_or(0);
    state.time = state.step as f64 * dt;
    if let [stride, taken] = checkpoint.u64("pace")?[..] {
        let pace = march.pace_mut();
        (pace.stride, pace.taken) = (stride, taken);
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

fn phase(byte: u8) -> Phase {
    match byte {
        1 => Phase::Liquid,
        2 => Phase::Flying,
        _ => Phase::Solid,
    }
}
