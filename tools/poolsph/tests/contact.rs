//! Liquid that freezes on contact with cold metal: it rests, keeps its heat until that is conducted away, and a resumed or
//! threaded run has the same bits.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::Path;
use std::process::Command;

use artefact::{Frame, Reader};
use serde_json::{Value, json};

/// A liquid `layers` particles thick on the middle of a cold plate, one part of it beside an edge.
fn film(layers: f64, flow: &Value) -> Value {
    let d = 1e-3;
    let liquid = json!({"box": {"min_m": [3e-3, 3e-3, 0], "max_m": [9e-3, 12e-3, layers * d]}});
    let plate = json!({"box": {"min_m": [0, 0, -3e-3], "max_m": [12e-3, 12e-3, 0]}});
    let mut scene = json!({
        "kind": "poolsph.scene", "version": 2, "title": "A film on a cold plate", "spacing_m": d,
        "time": {"step_s": 1e-4, "end_s": 0.02}, "density_kg_m3": 7850,
        "bodies": [{"shape": plate, "state": "solid", "temperature_k": 300},
            {"shape": liquid, "state": "liquid", "temperature_k": 2100}],
        "heat": {"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": 700,
            "melting": {"point_k": 1750, "latent_heat_j_kg": 250e3}},
        "output": {"particles_interval_s": 0.01, "precision": "f64"}
    });
    if !flow.is_null() {
        scene["flow"] = flow.clone();
        scene["flow"]["viscosity_pa_s"] = json!(0.005);
        scene["flow"]["gravity_m_s2"] = json!([0.0, 0.0, -9.8]);
    }
    scene
}

/// Runs a scene; its last frame.
fn last(scene: &Value, out: &Path, options: &[&str]) -> Frame {
    let path = out.with_extension("json");
    std::fs::write(&path, scene.to_string()).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_poolsph"));
    command.arg("run").arg(&path).arg("--out").arg(out);
    let output = command
        .args(["--progress", "none"])
        .args(options)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let reader = Reader::open(out).unwrap();
    let frames = reader.count("/particles");
    reader.frame("/particles", frames - 1).unwrap()
}

fn numbers(frame: &Frame, name: &str) -> Vec<f64> {
    frame.f64(name).unwrap()
}

#[test]
fn held_metal_conducts_as_metal_at_rest_does() {
    let folder = tempfile::tempdir().unwrap();
    let run = |name: &str, flow: Value| last(&film(1.0, &flow), &folder.path().join(name), &[]);
    let held = run("held.mcap", json!({"on_cold_metal": "sticks"}));
    let resting = run("resting.mcap", Value::Null);
    let [a, b] = [&held, &resting].map(|frame| numbers(frame, "temperature"));
    let hottest = b.iter().fold(0.0_f64, |most, t| most.max(*t));
    assert!(hottest < 2000.0, "{hottest}");
    // Away from the edges: what rests from the start on conducts along free faces as inside, what has frozen does not. Pairs across
    // the rows of a face weigh a little more for that, so that what has come down differs by 0.3 %.
    let within = |x: f64, low: f64, high: f64| x > low && x < high;
    let places = [numbers(&resting, "x"), numbers(&resting, "y")];
    let mut compared = 0;
    for (k, (held, resting)) in a.iter().zip(&b).enumerate() {
        if within(places[0][k], 5e-3, 7e-3) && within(places[1][k], 5e-3, 10e-3) {
            let rise = resting - 300.0;
            assert!((held - resting).abs() < 5e-3 * rise, "{held} {resting}");
            compared += 1;
        }
    }
    assert!(compared >= 30, "{compared}");
    for axis in ["x", "y", "z"] {
        let [a, b] = [&held, &resting].map(|frame| numbers(frame, axis));
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-9));
    }
}

#[test]
fn what_lies_on_held_metal_flows_over_its_edge_and_sliding_liquid_goes_farther() {
    let folder = tempfile::tempdir().unwrap();
    let reach = |name: &str, sticks: &str| {
        let mut scene = film(4.0, &json!({"on_cold_metal": sticks}));
        scene["time"]["end_s"] = json!(0.05);
        let frame = last(&scene, &folder.path().join(name), &[]);
        let plate = 3 * 12 * 12;
        let far = numbers(&frame, "x").into_iter().skip(plate);
        far.fold(0.0_f64, f64::max)
    };
    let (sticks, slides) = (
        reach("sticks.mcap", "sticks"),
        reach("slides.mcap", "slides"),
    );
    assert!(sticks > 9e-3 && slides > sticks + 1e-3, "{sticks} {slides}");
}

/// A drop of five spacings of radius, set down on a cold plate without gravity.
fn drop(sticks: &str) -> Value {
    json!({
        "kind": "poolsph.scene", "version": 2, "title": "A drop on a cold plate", "spacing_m": 5e-4,
        "time": {"step_s": 1e-4, "end_s": 0.03}, "density_kg_m3": 7850,
        "bodies": [{"shape": {"box": {"min_m": [-6e-3, -6e-3, -1.5e-3], "max_m": [6e-3, 6e-3, 0]}},
            "state": "solid", "temperature_k": 300},
            {"shape": {"sphere": {"centre_m": [0, 0, 2.5e-3], "radius_m": 2.5e-3}},
            "state": "liquid", "velocity_m_s": [0, 0, -0.05], "temperature_k": 2600}],
        "flow": {"viscosity_pa_s": 0.004, "on_cold_metal": sticks},
        "tension": {"surface_tension_n_m": 1.0},
        "heat": {"thermal_conductivity_w_m_k": 34, "specific_heat_j_kg_k": 750,
            "melting": {"point_k": 1750, "latent_heat_j_kg": 250e3}},
        "output": {"particles_interval_s": 0.03}
    })
}

#[test]
fn the_edge_of_a_drop_is_arrested_on_a_cold_plate() {
    let folder = tempfile::tempdir().unwrap();
    let radius = |sticks: &str| {
        let frame = last(
            &drop(sticks),
            &folder.path().join(sticks).with_extension("mcap"),
            &[],
        );
        let [x, y, z] = ["x", "y", "z"].map(|name| numbers(&frame, name));
        let plate = 24 * 24 * 3;
        let lowest = (plate..x.len()).filter(|a| z[*a] < 5e-4);
        // Half a spacing more than the outermost middles.
        let far = lowest.map(|a| x[a].hypot(y[a])).fold(0.0_f64, f64::max);
        (far + 2.5e-4) / 2.5e-3
    };
    let (sticks, slides) = (radius("sticks"), radius("slides"));
    // Wider than it was, and no wider than half a ball, which meets the plate at a right angle.
    assert!(sticks > 0.5 && sticks < 2.0_f64.cbrt() + 0.1, "{sticks}");
    assert!(slides > 1.7, "{slides}");
}

#[test]
fn threads_change_no_bit() {
    let folder = tempfile::tempdir().unwrap();
    let run = |name: &str, threads: &str| {
        let scene = film(3.0, &json!({"on_cold_metal": "sticks"}));
        last(&scene, &folder.path().join(name), &["--threads", threads])
    };
    let (one, two) = (run("one.mcap", "1"), run("two.mcap", "2"));
    for column in one.columns() {
        let [a, b] = [&one, &two].map(|frame| frame.get(&column.name).unwrap().clone());
        assert!(a.values == b.values, "{} has changed", column.name);
    }
}
