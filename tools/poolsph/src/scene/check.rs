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
    } else if scene.tension.is_some() && (ratio - 1.0).abs() > 1e-6 {
        let what = format!(
            "{} m is {ratio:.2} particle diameters; the surface tension is calibrated for 1 only",
            metal.smoothing_length
        );
        faults.push(Fault::at("/smoothing_length_m", what));
    }
    faults.extend(dependences(scene));
    faults.extend(super::size::faults(scene));
    faults
}

/// Keys that mean nothing without another.
fn dependences(scene: &Scene) -> Vec<Fault> {
    let flow = ("flow", scene.flow.is_some());
    let heat = ("heat", scene.heat.is_some());
    let source = ("source", scene.source.is_some());
    let needs = [
        ("flow_start", scene.flow_start.is_some(), vec![flow, heat]),
        ("arc", scene.arc.is_some(), vec![heat]),
        ("losses", scene.losses.is_some(), vec![heat]),
        ("tension", scene.tension.is_some(), vec![flow]),
        ("marangoni", scene.marangoni.is_some(), vec![flow, heat]),
        ("buoyancy", scene.buoyancy.is_some(), vec![flow, heat]),
        ("gas_shear", scene.gas_shear.is_some(), vec![flow, source]),
        ("lorentz", scene.lorentz.is_some(), vec![flow, source]),
        (
            "arc_pressure",
            scene.arc_pressure.is_some(),
            vec![flow, source],
        ),
        ("bounds", scene.bounds.is_some(), vec![flow]),
        ("droplets", scene.droplets.is_some(), vec![flow, source]),
    ];
    let missing = |(key, there, needs): (&'static str, bool, Vec<(&'static str, bool)>)| {
        let absent = needs
            .into_iter()
            .filter(move |(_, is_there)| there && !is_there);
        absent.map(move |(other, _)| {
            Fault::at(
                &format!("/{key}"),
                format!("means nothing without the key '{other}'"),
            )
        })
    };
    let mut faults: Vec<Fault> = needs.into_iter().flat_map(missing).collect();
    let weightless = scene
        .flow
        .as_ref()
        .is_some_and(|flow| flow.gravity_m_s2.is_none());
    if scene.buoyancy.is_some() && weightless {
        let what = "means nothing without the key 'gravity_m_s2' in 'flow'";
        faults.push(Fault::at("/buoyancy", what));
    }
    faults
}
