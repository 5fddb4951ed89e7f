//! Heat that varies in time, through every march.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::process::Command;

use serde_json::{Value, json};

/// A uniform plate of steel, 0.2 m by 0.1 m, with `more` in its scene.
fn plate(more: &Value) -> Value {
    let mut scene = json!({
        "kind": "heatsph.scene", "version": 1, "dimensions": 2,
        "body": {"box": {"min_m": [0, 0], "max_m": [0.2, 0.1]}},
        "points": {"spacing_m": 0.01},
        "materials": [{"name": "steel", "density_kg_m3": 7800, "specific_heat_j_kg_k": 500, "conductivity_w_m_k": 40}],
        "initial_temperature_k": 300
    });
    let (scene_keys, keys) = (scene.as_object_mut().unwrap(), more.as_object().unwrap());
    scene_keys.extend(keys.clone());
    scene
}

/// Runs a scene; its exit code, its record and what it said.
fn run(scene: &Value) -> (Option<i32>, Value, String) {
    let folder = tempfile::tempdir().unwrap();
    let [path, out] = ["scene.json", "out.mcap"].map(|name| folder.path().join(name));
    std::fs::write(&path, scene.to_string()).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_heatsph"))
        .arg("run")
        .arg(&path)
        .arg("--out")
        .arg(&out)
        .args(["--progress", "none", "--threads", "1"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let record = std::fs::read_to_string(out.with_extension("run.json"));
    let record = record.map_or(Value::Null, |text| serde_json::from_str(&text).unwrap());
    (output.status.code(), record, said)
}

/// A number of the closing block.
fn closing(record: &Value, name: &str) -> f64 {
    let rows = record["closing"].as_array().unwrap();
    let row = rows.iter().find(|row| row["name"] == name);
    row.unwrap_or_else(|| panic!("no '{name}' in {rows:?}"))["value"]
        .as_f64()
        .unwrap()
}

/// Every march to `end` \[s\], by error and in steps.
fn marches(end: f64) -> [Value; 5] {
    [
        json!({"end_s": end, "implicit": {}}),
        json!({"end_s": end, "implicit": {"step_s": 0.01 * end}}),
        json!({"end_s": end, "stabilised": {}}),
        json!({"end_s": end, "stabilised": {"step_s": 0.01 * end}}),
        json!({"end_s": end, "explicit": {}}),
    ]
}

/// Heat that `more` stores in the plate until `end` in every march \[J/m\].
fn stored(more: &Value, end: f64) -> Vec<f64> {
    let one = |time: Value| {
        let mut scene = plate(more);
        scene["time"] = time.clone();
        let (code, record, said) = run(&scene);
        assert_eq!(code, Some(0), "{time}: {said}");
        closing(&record, "heat_stored")
    };
    marches(end).map(one).to_vec()
}

#[test]
fn given_steps_that_err_by_more_than_a_hundredth_where_they_are_written_are_told() {
    let ended = |time: Value| {
        let cools = json!({"coefficient_w_m2_k": 1000, "ambient_k": 0});
        let mut scene = plate(&json!({"boundaries": [{"on": ["x+", "y+"], "convection": cools}]}));
        scene["time"] = time;
        let (code, _, said) = run(&scene);
        (code, said)
    };
    let (code, said) = ended(json!({"end_s": 600, "implicit": {"step_s": 600}}));
    assert_eq!(code, Some(3), "{said}");
    assert!(
        said.contains("at 1 instants follows") && said.contains("step_s"),
        "{said}"
    );
    // The first steps err as much, and nothing is written there.
    for time in [
        json!({"end_s": 600, "implicit": {"step_s": 20}}),
        json!({"end_s": 600, "stabilised": {"step_s": 20}}),
        json!({"end_s": 600, "implicit": {}}),
    ] {
        let (code, said) = ended(time);
        assert_eq!(code, Some(0), "{said}");
    }
}

#[test]
fn every_instant_is_written_once() {
    let folder = tempfile::tempdir().unwrap();
    let [path, out] = ["scene.json", "out.mcap"].map(|name| folder.path().join(name));
    let scene = plate(&json!({
        "time": {"end_s": 0.01, "implicit": {}}, "output": {"every_s": 0.002, "at_s": [0.004_000_000_3]},
        "boundaries": [{"on": ["x-"], "heat_flux_w_m2": 1e5}]
    }));
    std::fs::write(&path, scene.to_string()).unwrap();
    let mut run = Command::new(env!("CARGO_BIN_EXE_heatsph"));
    run.arg("run").arg(&path).arg("--out").arg(&out).arg("-q");
    assert!(run.status().unwrap().success());
    let reader = artefact::Reader::open_kind(&out, "point-fields", 1).unwrap();
    let expected = [0.0, 0.002, 0.004, 0.006, 0.008, 0.01];
    for channel in ["/points", "/boundaries", "/balance"] {
        assert_eq!(reader.times(channel).unwrap(), expected, "{channel}");
    }
}

#[test]
fn a_torch_comes_from_outside_a_plate_of_one_temperature() {
    let torch = "5e8*exp(-((x+0.1-0.01*t)^2+(y-0.05)^2)/0.01^2)";
    let source = json!({"source_w_m3": {"expr": torch}});
    // The line of the torch enters at 10 s: erfc over the way that it has come.
    for heat in stored(&source, 20.0) {
        let power = 5e8 * std::f64::consts::PI * 1e-4;
        assert!((heat / (10.0 * power) - 1.0).abs() < 2e-3, "{heat}");
    }
}

#[test]
fn surroundings_that_jump_start_the_march() {
    let ambient = json!({"expr": "300 + if(t - 1, 700, 0)"});
    let robin = json!({"coefficient_w_m2_k": 50, "ambient_k": ambient});
    let more = json!({"boundaries": [{"on": ["y+"], "convection": robin}]});
    for heat in stored(&more, 5.0) {
        let most = 0.2 * 50.0 * 700.0 * 4.0;
        assert!(heat > 0.9 * most && heat < 1.01 * most, "{heat} of {most}");
    }
}

/// Heat prescribed through a face and delivered \[J/m\], in every march.
fn delivered(more: &Value, end: f64, name: &str, exact: f64) {
    for time in marches(end) {
        let mut scene = plate(more);
        scene["time"] = time.clone();
        let (code, record, said) = run(&scene);
        assert_eq!(code, Some(0), "{time}: {said}");
        for kind in ["prescribed", "delivered"] {
            let heat = closing(&record, &format!("heat_{kind} {name}"));
            assert!(
                (heat / exact - 1.0).abs() < 1e-3,
                "{time} {kind}: {heat} of {exact}"
            );
        }
        let stored = closing(&record, "heat_stored");
        assert!(
            (stored / exact - 1.0).abs() < 1e-3,
            "{time}: {stored} of {exact}"
        );
    }
}

#[test]
fn a_pulse_is_neither_missed_nor_cut() {
    for (flux, heat) in [
        ("if(t - 1, if(1.1 - t, 1e7, 0), 0)", 1e6),
        ("1e7*step(t - 1)*step(1.0001 - t)", 1e3),
        (
            "1e9*exp(-((t - 1.2345)/1e-4)^2)",
            1e5 * std::f64::consts::PI.sqrt(),
        ),
        ("1e5 + 1e7*max(0, 1 - abs(t - 3)/0.01)", 5e5 + 1e5),
    ] {
        let entry = json!({"on": ["y+"], "heat_flux_w_m2": {"expr": flux}});
        delivered(&json!({"boundaries": [entry]}), 5.0, "y+", 0.2 * heat);
    }
}

#[test]
fn a_source_is_delivered_however_short() {
    let source = json!({"source_w_m3": {"expr": "2e12*exp(-((t - 3.1)/1e-5)^2)*(1 + x)"}});
    let heat = 2e12 * 1e-5 * std::f64::consts::PI.sqrt() * 0.1 * (0.2 + 0.02);
    delivered(&source, 5.0, "source", heat);
}

#[test]
fn a_face_that_is_hot_for_a_moment_heats_the_plate() {
    let hot = json!({"expr": "300 + 500*step(t - 100) - 500*step(t - 300)"});
    let more = json!({"boundaries": [{"on": ["y+"], "temperature_k": hot}]});
    // What a half space has taken up until the face is cold again, less what has come back since then.
    for heat in stored(&more, 400.0) {
        let root = |t: f64| 2.0 * (40.0 * 7800.0 * 500.0 * t / std::f64::consts::PI).sqrt();
        let exact = 0.2 * 500.0 * (root(300.0) - root(100.0));
        assert!((heat / exact - 1.0).abs() < 0.05, "{heat} of {exact}");
    }
}
