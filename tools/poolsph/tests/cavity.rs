//! Light on the wall of a cavity, slag that boils, and metal that grains cover.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::Path;
use std::process::Command;

use artefact::{Reader, Record};
use serde_json::{Value, json};

fn finished(scene: &Value, out: &Path) {
    let path = out.with_extension("scene.json");
    std::fs::write(&path, scene.to_string()).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_poolsph"));
    command.arg("run").arg(&path).arg("--out").arg(out);
    let output = command.args(["--progress", "none"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
}

fn ends(artefact: &Path, channel: &str) -> [Record; 2] {
    let records = Reader::open(artefact).unwrap().records(channel).unwrap();
    [&records[0], &records[records.len() - 1]].map(|(_, record)| record.clone())
}

/// Grains around half a ball that is in the light.
fn cavity() -> Value {
    let ball = json!({"sphere": {"centre_m": [0, 0, 0], "radius_m": 3e-3}});
    json!({
        "kind": "poolsph.scene", "version": 2, "title": "Light in a cavity",
        "time": {"step_s": 1e-4, "end_s": 0.05},
        "grains": {
            "density_kg_m3": 3230,
            "contact": {"law": {"linear": {"stiffness_n_m": 75}}, "restitution": 0.75},
            "bodies": [{"shape": {"difference": [{"box": {"min_m": [-5e-3, -5e-3, 0], "max_m": [5e-3, 5e-3, 5e-3]}}, ball]},
                "radius_m": 2.5e-4, "driven_m_s": [0, 0, 0], "temperature_k": 600}],
            "walls": [{"shape": {"intersection": [ball, {"half_space": {"point_m": [0, 0, 0], "normal": [0, 0, -1]}}]},
                "light": {"power_w": 2000, "from_m": [0, 0, 1e-3], "emissivity": 0.8, "surroundings_k": 300}}],
            "heat": {"thermal_conductivity_w_m_k": 20.2, "specific_heat_j_kg_k": 1000, "gas_conductivity_w_m_k": 0.1,
                "melting": {"point_k": 2572, "latent_heat_j_kg": 5e5, "boiling_k": 2850}}
        },
        "output": {"particles_interval_s": 0.01, "precision": "f64"}
    })
}

#[test]
fn light_is_taken_up_and_slag_that_boils_is_no_hotter() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("cavity.mcap");
    finished(&cavity(), &out);
    let [first, last] = ends(&out, "/grains_balance");
    let get = |name: &str| last.get(name).unwrap();
    let taken = get("grain_light_taken_j");
    assert!(
        (taken / (0.8 * 2000.0 * 0.05) - 1.0).abs() < 1e-9,
        "{taken}"
    );
    assert!((get("grain_light_not_taken_j") / (0.2 * 2000.0 * 0.05) - 1.0).abs() < 1e-9);
    assert!(get("grain_light_lost_j").abs() < 1e-12);
    let (given, vapour) = (get("grain_light_given_j"), get("grain_vapour_j"));
    assert!(given > 0.0 && vapour > 0.0, "{given} {vapour}");
    let stored = get("enthalpy_j") - first.get("enthalpy_j").unwrap();
    assert!(
        (stored - (taken - given - vapour)).abs() < 1e-10 * taken,
        "{stored}"
    );
    let reader = Reader::open(&out).unwrap();
    let frame = reader
        .frame("/grains", reader.count("/grains") - 1)
        .unwrap();
    let hottest = frame
        .f64("temperature")
        .unwrap()
        .into_iter()
        .fold(0.0, f64::max);
    assert!((hottest - 2850.0).abs() < 1e-6, "{hottest}");
    // Only what faces the light melts: a shell.
    let slag = frame
        .u8("state")
        .unwrap()
        .iter()
        .filter(|s| **s == 1)
        .count();
    assert!(
        slag > 50 && slag < frame.len() / 4,
        "{slag} of {}",
        frame.len()
    );
}

#[test]
fn without_light_nothing_is_told_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("dark.mcap");
    let mut dark = cavity();
    dark["grains"]["walls"][0]
        .as_object_mut()
        .unwrap()
        .remove("light");
    dark["time"]["end_s"] = json!(1e-3);
    finished(&dark, &out);
    let [first, last] = ends(&out, "/grains_balance");
    assert!(last.get("grain_light_taken_j").is_err());
    let enthalpy = |record: &Record| record.get("enthalpy_j").unwrap();
    assert!((enthalpy(&last) / enthalpy(&first) - 1.0).abs() < 1e-12);
}

#[test]
fn slag_boils_above_its_melting_point() {
    let folder = tempfile::tempdir().unwrap();
    let mut cold = cavity();
    cold["grains"]["heat"]["melting"]["boiling_k"] = json!(2500);
    let path = folder.path().join("scene.json");
    std::fs::write(&path, cold.to_string()).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_poolsph"));
    let output = command
        .arg("run")
        .arg(&path)
        .arg("--out")
        .arg(folder.path().join("out.mcap"))
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        said.contains("boiling_k") && said.contains("2572"),
        "{said}"
    );
}

#[test]
fn metal_under_grains_gets_nothing_of_the_arc() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("cover.mcap");
    let taken = |covered: f64| {
        let mut scene = json!({
            "kind": "poolsph.scene", "version": 2, "title": "A plate half under grains",
            "spacing_m": 5e-4, "time": {"step_s": 1e-4, "end_s": 2e-3}, "density_kg_m3": 7750,
            "bodies": [{"shape": {"box": {"min_m": [0, 0, -1e-3], "max_m": [8e-3, 4e-3, 0]}}, "state": "solid", "temperature_k": 600}],
            "heat": {"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": 700},
            "arc": {"flux_w_m2": 1e6},
            "output": {"particles_interval_s": 1e-3}
        });
        if covered > 0.0 {
            scene["grains"] = json!({
                "density_kg_m3": 3230,
                "contact": {"law": {"linear": {"stiffness_n_m": 75}}, "restitution": 0.75},
                "bodies": [{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [covered, 4e-3, 5e-4]}}, "radius_m": 2.5e-4, "driven_m_s": [0, 0, 0]}]
            });
        }
        finished(&scene, &out);
        ends(&out, "/balance")[1].get("energy_in_arc_j").unwrap()
    };
    let bare = taken(0.0);
    let all = 1e6 * 8e-3 * 4e-3 * 2e-3;
    assert!((bare / all - 1.0).abs() < 1e-9, "{bare}");
    // A grain covers the metal beside it too, half a millimetre off.
    let half = taken(4e-3) / bare;
    assert!((half - 7.0 / 16.0).abs() < 0.01, "{half}");
    assert!(taken(8e-3).abs() < 1e-12 * bare);
}
