//! A bed as a user hands it on: grains lie on as they lay, on metal and under a weight that leans, for their springs come along.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::Path;
use std::process::{Command, Output};

use artefact::Reader;
use serde_json::{Value, json};

fn run(scene: &Value, out: &Path, more: &[&str]) -> Output {
    let path = out.with_extension("scene.json");
    std::fs::write(&path, scene.to_string()).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_poolsph"));
    command.arg("run").arg(path).arg("--out").arg(out);
    command.args(["--progress", "none"]);
    command.args(more).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Five layers of grains on a plate, in a box, that lean on one side of it.
fn bed() -> Value {
    json!({
        "kind": "poolsph.scene", "version": 2, "title": "A bed that leans", "spacing_m": 5e-4,
        "time": {"step_s": 1e-4, "end_s": 1.0}, "density_kg_m3": 7750,
        "bodies": [{"shape": {"box": {"min_m": [0, 0, -1e-3], "max_m": [6e-3, 4e-3, 0]}}, "state": "solid"}],
        "grains": {
            "density_kg_m3": 3230, "gravity_m_s2": [2, 0, -9.6],
            "contact": {"law": {"linear": {"stiffness_n_m": 75}}, "restitution": 0.4, "friction": 0.5},
            "bodies": [{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [6e-3, 4e-3, 2.7e-3]}}, "radius_m": 2.5e-4, "spacing_m": 5.3e-4,
                "jitter": 0.025}],
            "walls": [{"shape": {"box": {"min_m": [0, 0, -0.01], "max_m": [6e-3, 4e-3, 0.1]}}, "hollow": true}],
            "until": {"speed_m_s": 1e-3, "held_s": 1e-2}
        },
        "output": {"particles_interval_s": 0.02, "precision": "f64"}
    })
}

/// The same, from the bed on, for a while.
fn later() -> Value {
    let mut scene = bed();
    scene["grains"]["bodies"] = json!([{"bed": true}]);
    scene["grains"].as_object_mut().unwrap().remove("until");
    scene["time"]["end_s"] = json!(0.02);
    scene
}

/// How far the grains have gone, nineteen of twenty of them no farther \[m\].
fn gone(artefact: &Path) -> f64 {
    let reader = Reader::open(artefact).unwrap();
    let places = |frame: usize| {
        let frame = reader.frame("/grains", frame).unwrap();
        frame.position_vectors().unwrap()
    };
    let (then, now) = (places(0), places(reader.count("/grains") - 1));
    let ways = then.iter().zip(&now).map(|(x, y)| {
        let way = [0, 1, 2].map(|k| x[k] - y[k]);
        way.iter().map(|w| w * w).sum::<f64>().sqrt()
    });
    let mut ways: Vec<f64> = ways.collect();
    ways.sort_unstable_by(f64::total_cmp);
    ways[ways.len() * 19 / 20]
}

#[test]
fn grains_lie_on_as_they_lay() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(&bed(), &folder.path().join("bed.mcap"), &[]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let input = format!("bed={}", folder.path().join("bed.mcap").display());
    let input = ["--input", &input];
    let output = run(&later(), &folder.path().join("later.mcap"), &input);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    // On a plate whose particles stand elsewhere the springs of the lowest layer find nothing.
    let mut shifted = later();
    shifted["bodies"][0]["shape"]["box"] =
        json!({"min_m": [-2e-5, 0, -1e-3], "max_m": [5.98e-3, 4e-3, 0]});
    let output = run(&shifted, &folder.path().join("shifted.mcap"), &input);
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    assert!(said(&output).contains("metal or walls that are not there"));
    // Nor do those at the walls where these are farther off, or none.
    for walls in [
        json!([]),
        json!([{"shape": {"box": {"min_m": [-1e-3, -1e-3, -0.01], "max_m": [7e-3, 5e-3, 0.1]}}, "hollow": true}]),
    ] {
        let mut open = later();
        open["grains"]["walls"] = walls;
        let output = run(&open, &folder.path().join("open.mcap"), &input);
        assert_eq!(output.status.code(), Some(3), "{}", said(&output));
        assert!(said(&output).contains("metal or walls that are not there"));
    }
    // Single grains lie loose, and none of them bears the others.
    let still = gone(&folder.path().join("later.mcap"));
    let slipped = gone(&folder.path().join("shifted.mcap"));
    println!("gone {still:.2e}, {slipped:.2e} m");
    assert!(still < 1e-4 * 5e-4, "{still:e} m");
    assert!(slipped > 10.0 * still, "{slipped:e} m");
}

#[test]
fn a_bed_sleeps_from_the_start_where_nothing_stirs_it() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(&bed(), &folder.path().join("bed.mcap"), &[]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let input = format!("bed={}", folder.path().join("bed.mcap").display());
    let asleep = |scene: &Value, name: &str| {
        let output = run(scene, &folder.path().join(name), &["--input", &input]);
        assert!(
            matches!(output.status.code(), Some(0 | 3)),
            "{}",
            said(&output)
        );
        let record = folder.path().join(name).with_extension("run.json");
        let record: Value =
            serde_json::from_str(&std::fs::read_to_string(record).unwrap()).unwrap();
        let series = record["history"].as_array().unwrap().iter();
        let own = series.clone().find(|h| h["name"] == "grains_grain_asleep");
        let values = own.unwrap()["values"].as_array().unwrap().clone();
        values[1].as_f64().unwrap()
    };
    let mut scene = later();
    scene["output"]["balance_interval_s"] = json!(1e-4);
    scene["time"]["end_s"] = json!(1e-3);
    scene["grains"]["sleep"] = json!({"speed_m_s": 1e-3, "held_s": 5e-3});
    let grains = Reader::open(folder.path().join("bed.mcap"))
        .unwrap()
        .frame("/grains", 0)
        .unwrap()
        .len() as f64;
    assert!((asleep(&scene, "still.mcap") - grains).abs() < 0.5);
    // A wall that moves keeps those beside it awake, and all where contacts are lost.
    let mut stirred = scene.clone();
    stirred["grains"]["walls"] = json!([
        {"shape": {"box": {"min_m": [0, 0, -0.01], "max_m": [6e-3, 4e-3, 0.1]}}, "hollow": true},
        {"shape": {"half_space": {"point_m": [0, 0, 0], "normal": [1, 0, 0]}}, "velocity_m_s": [1e-3, 0, 0]}
    ]);
    let beside = asleep(&stirred, "stirred.mcap");
    assert!(beside > 0.0 && beside < grains, "{beside} of {grains}");
    scene["bodies"][0]["shape"]["box"] =
        json!({"min_m": [-2e-5, 0, -1e-3], "max_m": [5.98e-3, 4e-3, 0]});
    assert!(asleep(&scene, "lost.mcap") < 0.5);
}
