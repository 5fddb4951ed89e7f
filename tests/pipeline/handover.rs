//! A weld that a known torch has melted gives that torch back.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::{Value, json};

/// Half of the width, depth, lengths ahead and behind \[m\].
const HALF_AXES: [(&str, f64); 4] = [
    ("half_width_m", 4e-3),
    ("depth_m", 3e-3),
    ("front_m", 3e-3),
    ("rear_m", 7e-3),
];
const POWER: f64 = 3500.0;

fn program(name: &str) -> Command {
    Command::new(Path::new(env!("CARGO_BIN_EXE_verify")).with_file_name(name))
}

fn done(output: &Output) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
}

#[test]
fn the_torch_of_a_conducted_weld_is_fitted_again() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let axes: serde_json::Map<String, Value> = HALF_AXES
        .iter()
        .map(|(name, axis)| ((*name).to_owned(), json!(axis)))
        .collect();
    // Metal that melts with next to no heat and does not flow.
    let scene = json!({
        "kind": "poolsph.scene", "version": 2, "spacing_m": 1e-3,
        "time": {"step_s": 5e-3, "end_s": 3.0},
        "density_kg_m3": 7800,
        "bodies": [{"shape": {"box": {"min_m": [-0.016, 0, -0.008], "max_m": [0.016, 0.04, 0]}},
            "state": "solid", "temperature_k": 300}],
        "heat": {"thermal_conductivity_w_m_k": 35, "specific_heat_j_kg_k": 640,
            "melting": {"point_k": 1750, "latent_heat_j_kg": 1000},
            "faces": {"min_m": [-0.016, 0, -0.008], "max_m": [0.016, 0.04, 0],
                "mirror": ["x-", "x+", "y-", "y+", "z-", "z+"]}},
        "torches": [{"power_w": POWER,
            "path": {"points_m": [[0, 0.01, 0], [0, 0.03, 0]], "speed_m_s": 5e-3},
            "shape": {"double_ellipsoid": axes}}],
        "output": {"particles_interval_s": 0.1, "balance_interval_s": 0.1},
    });
    std::fs::write(at("weld.json"), scene.to_string()).unwrap();
    let weld = at("weld.mcap");
    done(
        &program("poolsph")
            .arg("run")
            .arg(at("weld.json"))
            .arg("--out")
            .arg(&weld)
            .args(["--threads", "1", "--progress", "none"])
            .output()
            .unwrap(),
    );
    let fitted = program("report").arg("goldak").arg(&weld).output().unwrap();
    done(&fitted);
    let torch: Value = serde_json::from_slice(&fitted.stdout).unwrap();
    let power = torch["power_w"].as_f64().unwrap();
    assert!((power / POWER - 1.0).abs() < 0.01, "{torch}");
    for (name, axis) in HALF_AXES {
        let found = torch["shape"]["double_ellipsoid"][name].as_f64().unwrap();
        assert!((found - axis).abs() < 0.03 * axis, "{name} {torch}");
    }
}
