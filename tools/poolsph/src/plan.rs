//! What a run would do, as `check` tells it.

use run::{Failure, Fault, Plan};

use crate::assemble::Assembled;
use crate::frames;
use crate::memory;
use crate::probes;
use crate::scene::Scene;
use crate::state::State;
use crate::watch::{endless, undivided};

/// What is done before a run, and told by `check`.
///
/// # Errors
/// A step without end, and bodies without particles.
pub(crate) fn plan(scene: &Scene, assembled: &Assembled) -> Result<Plan, Failure> {
    let state = &assembled.state;
    let mut plan = Plan::new();
    if scene.has_metal() {
        plan = plan
            .count("particles", state.len() as u64)
            .count("liquid at the start", state.liquid() as u64);
    }
    let steps = if assembled.march.strides().grows() {
        "steps at most"
    } else {
        "steps"
    };
    plan = plan.count(steps, scene.steps());
    plan = with_grains(plan, scene, assembled)?;
    plan = with_bodies(plan, scene, assembled)?;
    for stage in assembled.march.stages() {
        plan = plan.stage(stage.name());
        if let Some(limit) = stage.limit(state) {
            let step = scene.step();
            if let Some(what) = endless(step, limit).or_else(|| undivided(step, limit)) {
                let fault = Fault::at("/time/step_s", what).or_at("/spacing_m");
                return Err(fault.or_at(&format!("/{}", stage.name())).into());
            }
            plan = plan.limit(&format!("step_{}", limit.name), limit.seconds, "s");
        }
    }
    if scene.has_metal() {
        for column in frames::metal(state, &[], scene.output.precision).columns() {
            plan = plan.column(&column.name, &column.unit);
        }
    }
    plan = with_probes(plan, scene, state);
    for (name, bytes) in state.memory() {
        plan = plan.memory(name, bytes as u64);
    }
    for (name, bytes) in memory::beyond(scene, state) {
        plan = plan.memory(name, bytes);
    }
    if scene.has_metal() {
        for (channel, messages, bytes) in frames::volume(scene, state, &assembled.plate) {
            plan = plan.output(channel, messages, bytes);
        }
    }
    for (name, why) in &assembled.left_out {
        plan = plan.left_out(name, why);
    }
    for note in (crate::scene::notes(scene).into_iter()).chain(crate::scene::doubts(scene)) {
        plan = plan.note(note);
    }
    Ok(plan)
}

/// What is told of bodies: their particles, and boxes that these do not fill as they are.
fn with_bodies(mut plan: Plan, scene: &Scene, assembled: &Assembled) -> Result<Plan, Failure> {
    for (i, filled) in assembled.filled.iter().enumerate() {
        plan = plan.count(&format!("particles of body {i}"), filled.placed as u64);
        if filled.left_out > 0 {
            let left_out = filled.left_out as u64;
            plan = plan.count(&format!("left out of body {i}"), left_out);
        }
        if filled.placed == 0 {
            let what = "holds no particle: too thin for the spacing, cut away, or in another body";
            return Err(Fault::at(&format!("/bodies/{i}"), what).into());
        }
        if let Some(note) = scene.bodies[i].rounded(filled, scene.metal().spacing) {
            plan = plan.note(format!("bodies/{i}: {note}"));
        }
    }
    Ok(plan)
}

/// What is told of probes that stand off the metal.
fn with_probes(plan: Plan, scene: &Scene, state: &State) -> Plan {
    let probes = scene.output.probes.iter().enumerate();
    let off = probes.filter_map(|(i, probe)| {
        let away = probes::read(state, probe.place_m).away;
        (away > state.metal.matter.spacing).then(|| {
            let name = &probe.name;
            format!("output/probes/{i}: '{name}' stands {away:.3e} m from the nearest particle at the start")
        })
    });
    off.fold(plan, Plan::note)
}

/// What is told of grains, if there are any.
fn with_grains(mut plan: Plan, scene: &Scene, assembled: &Assembled) -> Result<Plan, Failure> {
    for (i, grains) in assembled.grain_counts.iter().enumerate() {
        plan = plan.count(&format!("grains of body {i}"), *grains as u64);
        if *grains == 0 {
            let what = "holds no grain: too thin for their diameter";
            return Err(Fault::at(&format!("/grains/bodies/{i}"), what).into());
        }
    }
    for doubt in &assembled.grain_doubts {
        plan = plan.note(doubt.clone());
    }
    if let Some(grains) = &assembled.state.grains {
        let frame = frames::grains(grains, scene.output.precision);
        for column in frame.columns() {
            plan = plan.column(&format!("{}.{}", grains.name(), column.name), &column.unit);
        }
        let frames = frames::count(scene, scene.output.grains_interval());
        let bytes = frames * (grains.len() * frame.row_bytes()) as u64;
        plan = plan.output("/grains", frames, bytes);
    }
    Ok(plan)
}
