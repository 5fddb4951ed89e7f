//! Marches that were killed go on to the same bytes.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// A plate whose density, specific heat and conductivity depend on temperature.
fn plate(march: &Value) -> Value {
    let mut time = json!({"end_s": 8});
    let keys = time.as_object_mut().unwrap();
    keys.extend(march.as_object().unwrap().clone());
    json!({
        "kind": "heatsph.scene", "version": 1, "dimensions": 2,
        "body": {"box": {"min_m": [0, 0], "max_m": [0.2, 0.1]}}, "points": {"spacing_m": 0.005},
        "materials": [{"name": "steel", "density_kg_m3": {"t_k": [300, 1800], "value": [7850, 7300]},
            "specific_heat_j_kg_k": {"expr": "450 + 0.28*T + 2e3*exp(-((T - 500)/5)^2)"},
            "conductivity_w_m_k": {"t_k": [300, 1500], "value": [50, 28]}}],
        "boundaries": [{"on": ["x-"], "heat_flux_w_m2": 2e6}],
        "initial_temperature_k": 300, "time": time
    })
}

fn run(folder: &Path, out: &str, more: &[&str]) -> Command {
    let mut program = Command::new(env!("CARGO_BIN_EXE_heatsph"));
    program
        .current_dir(folder)
        .args(["run", "scene.json", "--out", out, "--threads", "1", "-q"])
        .args(more);
    program
}

#[test]
fn a_killed_march_with_heat_of_temperature_goes_on_to_the_same_bytes() {
    for march in [
        json!({"implicit": {"step_s": 0.1}}),
        json!({"stabilised": {"step_s": 0.1}}),
        json!({"explicit": {}}),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("scene.json"), plate(&march).to_string()).unwrap();
        assert!(
            run(folder.path(), "whole.mcap", &[])
                .status()
                .unwrap()
                .success(),
            "{march}"
        );
        let cut = ["--checkpoint-s", "0"];
        let mut child = run(folder.path(), "cut.mcap", &cut).spawn().unwrap();
        let start = Instant::now();
        while !at("cut.mcap.checkpoint").exists() {
            assert!(start.elapsed() < Duration::from_secs(30), "{march}");
            std::thread::sleep(Duration::from_millis(1));
        }
        child.kill().unwrap();
        assert!(!child.wait().unwrap().success(), "{march}: it ended before");
        let status = run(folder.path(), "cut.mcap", &["--resume"]).status();
        assert!(status.unwrap().success(), "{march}");
        let [whole, cut] = ["whole.mcap", "cut.mcap"].map(|name| std::fs::read(at(name)).unwrap());
        assert!(whole == cut, "{march}: other bytes");
    }
}
