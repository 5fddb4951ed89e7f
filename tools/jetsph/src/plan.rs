//! What a run would do, as `check` tells it.

use run::{Failure, Fault, Plan};
use steps::instants;

use crate::assemble::Assembled;
use crate::frames;
use crate::memory;
use crate::scene::{Method, Scene};
use crate::simulate::endless;

/// Spacings in the length over which a solid breaks from which on a crack takes the same energy within 12 % (`fracture-energy`).
const RESOLVED: f64 = 4.0;

/// What is done before a run, and told by `check`.
///
/// # Errors
/// A run without end.
pub(crate) fn plan(scene: &Scene, run: &Assembled) -> Result<Plan, Failure> {
    let Assembled {
        state,
        march,
        left_out,
        notes,
    } = run;
    let mut plan = Plan::new().count("particles", state.len() as u64);
    let frames = instants::count(scene.time.end_s, scene.output.frames_interval_s);
    for set in &state.sets {
        let n = set.len() as u64;
        plan = plan.count(&format!("particles of {}", set.name()), n);
        let frame = frames::frame(set, state.dimensions, scene.output.precision);
        for column in frame.columns() {
            plan = plan.column(&format!("{}.{}", set.name(), column.name), &column.unit);
        }
        plan = plan.output(
            &columns::channel(set),
            frames,
            frames * n * frame.row_bytes() as u64,
        );
    }
    for stage in &march.stages {
        plan = plan.stage(stage.name());
        if stage.bytes() > 0 {
            plan = plan.memory(stage.name(), stage.bytes() as u64);
        }
        if let Some(limit) = stage.limit(state) {
            if let Some(what) = endless(scene, limit) {
                return Err(Fault::at("/time/end_s", what).into());
            }
            plan = plan.limit(&format!("step_{}", limit.name), limit.seconds, "s");
        }
    }
    for (name, bytes) in state.memory() {
        plan = plan.memory(&name, bytes as u64);
    }
    for (name, bytes) in memory::beyond(scene, state) {
        plan = plan.memory(name, bytes);
    }
    for (name, why) in left_out {
        plan = plan.left_out(name, why);
    }
    for note in notes {
        plan = plan.note(note);
    }
    Ok(noted(plan, scene))
}

/// What is told of a scene beside its numbers.
fn noted(mut plan: Plan, scene: &Scene) -> Plan {
    for solid in &scene.solids {
        let cells = solid
            .fracture_length_m
            .map_or(f64::INFINITY, |length| length / solid.spacing_m);
        if cells < RESOLVED {
            plan = plan.note(format!(
                "'fracture_length_m' of \"{}\" is {cells:.2} spacings: strength is the same on any spacing, the energy of a crack within 12 % from {RESOLVED} on",
                solid.name
            ));
        }
    }
    let soundless = scene.water.as_ref().map(|water| water.method) == Some(Method::DivergenceFree);
    if soundless && scene.gravity_m_s2.is_some() {
        plan = plan.note(
            "water without sound is for jets: a tank does not rest under gravity, take sound there",
        );
    }
    if scene.dimensions == 2 {
        plan = plan.note("a plane scene: masses, forces and energies are per metre of depth");
    }
    plan
}
