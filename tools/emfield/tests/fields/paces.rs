//! Marches whose steps or points do not follow what drives them.

use serde_json::{Value, json};

use super::said;

/// A bar of copper in a field across it that follows a wave.
fn bar(radius: f64, frequency: f64, step: f64, steps: f64) -> Value {
    let wave = format!("sin({} * t)", std::f64::consts::TAU * frequency);
    json!({"kind": "emfield.scene", "version": 1, "geometry": "plane",
        "domain": {"sphere": {"centre_m": [0, 0], "radius_m": 0.02}},
        "bodies": [{"name": "bar", "shape": {"disc": {"centre_m": [0, 0], "radius_m": radius}},
            "conductivity_s_m": 1e7}],
        "eddy_currents": {"transient": {"end_s": steps * step, "step_s": step, "wave": {"expr": wave}},
            "applied_flux_density_t": [0, 0.1, 0], "outer": "multipole"},
        "points": {"spacing_m": 0.001}})
}

/// Exit code and warnings of a run.
fn warned(scene: &Value) -> (i32, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let (code, _, out) = said(folder.path(), scene);
    let record = std::fs::read_to_string(out.with_extension("run.json")).unwrap();
    let record: Value = serde_json::from_str(&record).unwrap();
    let warnings = record["warnings"].as_array().cloned().unwrap_or_default();
    let words = warnings.iter().filter_map(Value::as_str);
    (code, words.map(str::to_owned).collect())
}

#[test]
fn a_wave_that_steps_do_not_follow_is_told() {
    let (code, told) = warned(&bar(0.01, 50.0, 0.02, 5.0));
    assert_eq!(code, 3);
    assert!(
        told[0].starts_with("unresolved: within 5 of 5 steps"),
        "{told:?}"
    );
    assert_eq!(warned(&bar(0.01, 50.0, 1e-3, 20.0)), (0, vec![]));
}

#[test]
fn a_skin_that_points_do_not_resolve_and_a_bar_that_meets_the_wall_are_told_in_a_march() {
    // 1/omega is 1.6 us, the skin 0.5 mm.
    let (code, told) = warned(&bar(0.01, 1e5, 2.5e-7, 20.0));
    assert_eq!(code, 3);
    assert!(
        told[0].starts_with("unresolved: skin depth 5.") && told[0].contains("in bar"),
        "{told:?}"
    );
    let (code, told) = warned(&bar(0.03, 50.0, 1e-3, 20.0));
    assert_eq!(code, 3);
    assert!(told[0].contains("bar touches the wall"), "{told:?}");
}

#[test]
fn fields_that_are_written_too_few_steps_after_a_switch_are_told() {
    // mu sigma D^2 is 5 ms; a field that is switched on at once.
    let scene = |steps: f64, every: f64| {
        let mut scene = bar(0.01, 50.0, 0.002 / steps, steps);
        scene["eddy_currents"]["transient"]
            .as_object_mut()
            .unwrap()
            .remove("wave");
        scene["output"] = json!({"every_s": 0.002 * every});
        scene
    };
    let (code, told) = warned(&scene(1.0, 1.0));
    assert_eq!(code, 3);
    assert!(
        told[0].starts_with("unresolved: at 1 instants that are written"),
        "{told:?}"
    );
    // Where the step is long for all of the bar there is nothing to follow.
    let mut poor = scene(1.0, 1.0);
    poor["bodies"][0]["conductivity_s_m"] = json!(1e2);
    assert_eq!(warned(&poor), (0, vec![]));
    // Eight steps, written at the end and after the first.
    assert_eq!(warned(&scene(8.0, 1.0)), (0, vec![]));
    assert_eq!(warned(&scene(8.0, 0.125)).0, 3);
}
