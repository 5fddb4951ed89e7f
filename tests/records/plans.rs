//! What plans tell of memory and time is what runs take.

use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};

use super::programs;

/// What a program holds without particles \[byte\].
const EMPTY: f64 = 20e6;
/// A plan may tell this many times more or less.
const OFF: f64 = 1.5;

/// Memory that `check` tells, and the peak of the run \[byte\].
fn told_and_taken(tool: &str, scene: &Value, folder: &Path) -> [f64; 2] {
    let path = folder.join("scene.json");
    std::fs::write(&path, scene.to_string()).unwrap();
    let run = |words: &[&str]| {
        let mut command = Command::new(programs().join(tool));
        command.args(words).arg(&path).current_dir(folder);
        let output = command.output().unwrap();
        assert!(output.status.success(), "{output:?}");
        output.stdout
    };
    let plan: Value = serde_json::from_slice(&run(&["check", "--json"])).unwrap();
    run(&["run", "--out", "a.mcap"]);
    let record = std::fs::read(folder.join("a.run.json")).unwrap();
    let record: Value = serde_json::from_slice(&record).unwrap();
    [&plan["memory_bytes"], &record["peak_memory_bytes"]].map(|bytes| bytes.as_f64().unwrap())
}

fn metal(method: &str, smoothing: f64) -> Value {
    json!({"kind": "poolsph.scene", "version": 2, "spacing_m": 1e-3, "smoothing_length_m": smoothing * 1e-3,
        "density_kg_m3": 7850, "time": {"step_s": 1e-4, "end_s": 2e-4},
        "bodies": [{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [0.04, 0.04, 0.03]}}, "state": "liquid"}],
        "flow": {"method": method, "viscosity_pa_s": 0.005},
        "output": {"particles_interval_s": 1e-4}})
}

fn plate() -> Value {
    json!({"kind": "poolsph.scene", "version": 2, "spacing_m": 1e-3, "density_kg_m3": 7850,
        "time": {"step_s": 1e-3, "end_s": 2e-3},
        "bodies": [{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [0.05, 0.05, 0.03]}}, "state": "solid", "temperature_k": 300}],
        "heat": {"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": 700},
        "output": {"particles_interval_s": 1e-3}})
}

fn water(method: &str) -> Value {
    let velocity = ["1*(x - 0.02)", "-1*(y - 0.02)", "0"].map(|u| json!({"expr": u}));
    json!({"kind": "jetsph.scene", "version": 1, "dimensions": 3, "time": {"step_s": 1e-5, "end_s": 2e-5},
        "water": {"method": method, "density_kg_m3": 1000, "spacing_m": 1e-3,
            "bodies": [{"body": {"box": {"min_m": [0, 0, 0], "max_m": [0.04, 0.04, 0.03]}}, "velocity_m_s": velocity}]},
        "output": {"frames_interval_s": 1e-5, "balance_interval_s": 1e-5}})
}

#[test]
fn plans_tell_the_memory_that_runs_take() {
    let folder = tempfile::tempdir().unwrap();
    let scenes = [
        ("poolsph", metal("projection", 1.0)),
        ("poolsph", metal("divergence_free", 1.3)),
        ("poolsph", plate()),
        ("jetsph", water("weakly_compressible")),
        ("jetsph", water("divergence_free")),
    ];
    for (tool, scene) in scenes {
        let [told, taken] = told_and_taken(tool, &scene, folder.path());
        let ratio = told / (taken - EMPTY);
        assert!(
            ratio < OFF && ratio > 1.0 / OFF,
            "{tool}: {told:.3e} B told, {taken:.3e} B taken: {scene}"
        );
    }
}

#[test]
fn droplets_that_will_come_have_their_memory_in_the_plan() {
    let folder = tempfile::tempdir().unwrap();
    let told = |radius: f64| {
        let mut scene = metal("projection", 1.0);
        scene["source"] = json!({"start_m": [0.02, 0.02, 0.03], "velocity_m_s": [0, 0, 0]});
        scene["droplets"] =
            json!({"period_s": 1.0, "radius_m": radius, "height_m": 0.2, "speed_m_s": 1.0});
        let path = folder.path().join("scene.json");
        std::fs::write(&path, scene.to_string()).unwrap();
        let check = Command::new(programs().join("poolsph"))
            .args(["check", "--json"])
            .arg(&path)
            .output()
            .unwrap();
        let plan: Value = serde_json::from_slice(&check.stdout).unwrap();
        plan["memory_bytes"].as_f64().unwrap()
    };
    // A drop of 66 mm: 1.2e6 particles of more than a kilobyte each.
    assert!(told(0.066) > 1.2e9 + told(0.002), "{}", told(0.066));
}

#[test]
fn check_tells_how_long_a_run_will_last() {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("resume/drop.json");
    let output = Command::new(programs().join("poolsph"))
        .arg("check")
        .arg(scene)
        .output()
        .unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    let time = said.lines().find(|line| line.starts_with("  time "));
    let time = time.unwrap_or_else(|| panic!("{said}"));
    assert!(
        time.contains("about") && time.contains("ms a step"),
        "{time}"
    );
}
