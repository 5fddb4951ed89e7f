//! What a schema cannot say of a scene.

use run::Fault;

use super::Scene;

/// Most steps of a run: more is a slip of the pen.
const STEPS_MAX: f64 = 1e9;

/// Every fault of the scene as a whole; bodies are checked on their own.
#[must_use]
pub fn faults(scene: &Scene) -> Vec<Fault> {
    let mut faults = Vec::new();
    let time = scene.time;
    let steps = time.end_s / time.step_s;
    if steps < 0.5 {
        let what = format!(
            "{} s is shorter than a step of {} s",
            time.end_s, time.step_s
        );
        faults.push(Fault::at("/time/end_s", what));
    } else if steps > STEPS_MAX {
        let what = format!(
            "{} s is too short: {steps:.1e} steps to {} s, at most {STEPS_MAX:.0e}",
            time.step_s, time.end_s
        );
        faults.push(Fault::at("/time/step_s", what));
    }
    let metal = scene.metal();
    let ratio = metal.smoothing_length / metal.spacing;
    if !(0.8..=3.0).contains(&ratio) {
        let what = format!(
            "{} m is {ratio:.2} particle diameters; from 0.8 to 3 keep enough neighbours",
            metal.smoothing_length
        );
        faults.push(Fault::at("/smoothing_length_m", what));
    }
    if scene.flow_start.is_some() && scene.flow.is_none() {
        faults.push(Fault::at(
            "/flow_start",
            "nothing flows without the key 'flow'",
        ));
    }
    if scene.flow_start.is_some() && scene.heat.is_none() {
        faults.push(Fault::at(
            "/flow_start",
            "nothing melts without the key 'heat'",
        ));
    }
    faults
}
