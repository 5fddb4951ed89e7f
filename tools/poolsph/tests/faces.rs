//! What falls on a liquid between walls, mirrors and periodic faces is taken once, and whole.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::process::Command;

use artefact::Reader;
use serde_json::{Value, json};

/// A tank of liquid that sways under an even flux; heat that it has taken over heat that has fallen on it.
fn taken(faces: &Value, method: &str) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let mut scene = json!({
        "kind": "poolsph.scene", "version": 2, "title": "A tank under an even flux",
        "spacing_m": 5e-4, "time": {"step_s": 2e-4, "end_s": 0.04}, "density_kg_m3": 7000,
        "bodies": [{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [8e-3, 6e-3, 3e-3]}}, "state": "liquid", "temperature_k": 1900}],
        "faces": {"min_m": [0, 0, 0], "max_m": [8e-3, 6e-3, 2e-2]},
        "flow": {"method": method, "viscosity_pa_s": 0.004, "gravity_m_s2": [2, 1, -9.8]},
        "heat": {"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": 700},
        "arc": {"flux_w_m2": 1e5},
        "output": {"particles_interval_s": 0.04}
    });
    for (key, value) in faces.as_object().unwrap() {
        scene["faces"][key] = value.clone();
    }
    std::fs::write(at("tank.json"), scene.to_string()).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_poolsph"));
    command.arg("run").arg(at("tank.json")).arg("--out");
    let output = command.arg(at("tank.mcap")).arg("-q").output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let records = Reader::open(at("tank.mcap")).unwrap();
    let records = records.records("/balance").unwrap();
    let heat = records.last().unwrap().1.get("energy_in_arc_j").unwrap();
    heat / (1e5 * 8e-3 * 6e-3 * 0.04)
}

#[test]
fn what_falls_on_a_liquid_between_faces_is_taken_whole() {
    let wall = |face: &str| json!({"face": face});
    let all = ["x-", "x+", "y-", "y+", "z-"].map(wall);
    let some = ["x+", "y+", "z-"].map(wall);
    for faces in [
        json!({"wall": all}),
        json!({"mirror": ["x-", "y-"], "wall": some}),
        json!({"periodic": ["x", "y"], "wall": [wall("z-")]}),
    ] {
        for method in ["projection", "divergence_free"] {
            let part = taken(&faces, method);
            assert!((part - 1.0).abs() < 0.015, "{method}, {faces}: {part}");
        }
    }
}
