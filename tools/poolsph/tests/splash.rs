//! Drops of few particles that strike, merge and fall apart stay within what their speed and tension give.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::PathBuf;
use std::process::Command;

use artefact::Reader;
use serde_json::{Value, json};

/// Speed of a drop \[m/s\].
const SPEED: f64 = 1.56;

/// Liquid of half a millimetre a particle without divergence for 20 ms.
fn scene(bodies: &[Value], gravity: f64, viscosity: f64) -> Value {
    json!({
        "kind": "poolsph.scene", "version": 2, "spacing_m": 5e-4, "time": {"step_s": 1e-4, "end_s": 0.02},
        "density_kg_m3": 7850, "bodies": bodies,
        "flow": {"viscosity_pa_s": viscosity, "gravity_m_s2": [0, 0, -gravity], "method": "divergence_free"},
        "tension": {"surface_tension_n_m": 1.0},
        "output": {"particles_interval_s": 0.02, "balance_interval_s": 1e-4}
    })
}

fn block(state: &str, min: [f64; 3], max: [f64; 3]) -> Value {
    json!({"shape": {"box": {"min_m": min, "max_m": max}}, "state": state})
}

fn drop(height: f64, speed: f64) -> Value {
    json!({"shape": {"sphere": {"centre_m": [0, 0, height], "radius_m": 7.6e-4}}, "state": "liquid",
        "velocity_m_s": [0, 0, -speed]})
}

fn plate(top: f64) -> Value {
    block("solid", [-4e-3, -4e-3, top - 2e-3], [4e-3, 4e-3, top])
}

/// Runs a scene; the folder holds the artefact.
fn run(scene: &Value) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let [path, out] = ["scene.json", "out.mcap"].map(|name| folder.path().join(name));
    std::fs::write(&path, scene.to_string()).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_poolsph"))
        .arg("run")
        .arg(&path)
        .arg("--out")
        .arg(&out)
        .args(["--progress", "none", "--threads", "1"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{said}");
    (folder, out)
}

/// Greatest speed of any particle at any time \[m/s\].
fn fastest(scene: &Value) -> f64 {
    let (_folder, out) = run(scene);
    let record = std::fs::read_to_string(out.with_extension("run.json")).unwrap();
    let record: Value = serde_json::from_str(&record).unwrap();
    let histories = record["history"].as_array().unwrap();
    let speeds = histories.iter().find(|h| h["name"] == "motion_speed_max");
    let speeds = speeds.unwrap()["values"].as_array().unwrap();
    speeds.iter().filter_map(Value::as_f64).fold(0.0, f64::max)
}

#[test]
fn a_drop_that_falls_into_a_shallow_pool_does_not_burst() {
    let pool = block("liquid", [-2e-3, -2e-3, -1e-3], [2e-3, 2e-3, 0.0]);
    let mut scene = scene(&[pool, plate(0.0), drop(1.5e-3, SPEED)], 9.8, 0.004);
    for tension in [true, false] {
        if !tension {
            scene.as_object_mut().unwrap().remove("tension");
        }
        let fastest = fastest(&scene);
        assert!(fastest < 3.0 * SPEED, "tension {tension}: {fastest}");
    }
}

/// Places of the particles that were liquid at first, 20 ms later \[m\].
fn places(scene: &Value) -> Vec<[f64; 3]> {
    let (_folder, out) = run(scene);
    let reader = Reader::open(&out).unwrap();
    let last = reader.count("/particles") - 1;
    let phase = reader.frame("/particles", 0).unwrap();
    let phase = phase.u8("molten").unwrap();
    let places = reader.frame("/particles", last).unwrap();
    let places = places.position_vectors().unwrap();
    let liquid = places
        .into_iter()
        .zip(phase)
        .filter(|(_, molten)| **molten > 0);
    liquid.map(|(place, _)| place).collect()
}

#[test]
fn drops_of_few_particles_hold_together_where_they_strike() {
    // Half of the 19 slid away on bare metal, and a film threw single ones up to 6 mm.
    let bare = [plate(-5e-4), drop(1.5e-3, SPEED)];
    let film = block("liquid", [-2e-3, -2e-3, -5e-4], [2e-3, 2e-3, 0.0]);
    let wet = [film, plate(-5e-4), drop(1.5e-3, SPEED)];
    for viscosity in [0.0, 0.004] {
        let on_metal = places(&scene(&bare, 9.8, viscosity));
        let far = on_metal.iter().filter(|[x, y, _]| x.hypot(*y) > 5e-3);
        assert!(far.count() <= 4, "{viscosity}: {on_metal:?}");
        let on_film = places(&scene(&wet, 9.8, viscosity));
        let top = on_film.iter().fold(0.0_f64, |top, [_, _, z]| top.max(*z));
        assert!(top < 2e-3, "{viscosity}: {top} m");
    }
}

#[test]
fn drops_that_meet_do_not_burst() {
    for viscosity in [0.004, 0.04] {
        let fastest = fastest(&scene(
            &[drop(0.0, 0.0), drop(2.2e-3, SPEED)],
            0.0,
            viscosity,
        ));
        assert!(fastest < 2.0 * SPEED, "{viscosity}: {fastest}");
    }
}

#[test]
fn a_column_that_falls_together_does_not_burst() {
    // Four particles across: tension draws it together at sqrt(gamma/(rho a)), 0.36 m/s for half of its width.
    let column = block("liquid", [-1e-3, -1e-3, 0.0], [1e-3, 1e-3, 5e-3]);
    for viscosity in [0.004, 0.04] {
        let fastest = fastest(&scene(&[column.clone(), plate(0.0)], 9.8, viscosity));
        assert!(fastest < 4.0 * 0.36, "{viscosity}: {fastest}");
    }
}
