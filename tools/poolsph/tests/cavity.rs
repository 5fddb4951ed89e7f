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

/// What is said of a scene that cannot be.
fn refused(scene: &Value, folder: &Path) -> String {
    let path = folder.join("scene.json");
    std::fs::write(&path, scene.to_string()).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_poolsph"));
    command.arg("run").arg(&path);
    let output = command.arg("--out").arg(folder.join("out.mcap")).output();
    let output = output.unwrap();
    assert_eq!(output.status.code(), Some(2));
    String::from_utf8_lossy(&output.stderr).into_owned()
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

/// The places of the grains of [`cavity`], nearer by a hundredth: all touch, so that vapour finds a way from each.
fn pressed() -> Vec<[f64; 3]> {
    let lattice = |k: i32| 4.95e-4 * (f64::from(k) + 0.5);
    let grains = (0..4000).map(|k| [k % 20 - 10, k / 20 % 20 - 10, k / 400].map(lattice));
    let outside = |x: &[f64; 3]| x.iter().map(|x| x * x).sum::<f64>().sqrt() > 3.25e-3;
    grains.filter(outside).collect()
}

#[test]
fn vapour_that_condenses_leaves_its_heat_in_the_bed() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("condensed.mcap");
    let mut scene = cavity();
    scene["grains"]["bodies"][0] = json!({"places_m": pressed(), "radius_m": 2.5e-4,
        "driven_m_s": [0, 0, 0], "temperature_k": 600});
    scene["grains"]["walls"][0]["light"]["power_w"] = json!(6000);
    scene["time"]["end_s"] = json!(0.03);
    let slag = |scene: &Value| {
        finished(scene, &out);
        let reader = Reader::open(&out).unwrap();
        let frame = reader.frame("/grains", reader.count("/grains") - 1);
        let frame = frame.unwrap();
        let hottest = frame.f64("temperature").unwrap().into_iter();
        let hottest = hottest.fold(0.0, f64::max);
        assert!((hottest - 2850.0).abs() < 1e-6, "{hottest}");
        let states = frame.u8("state").unwrap();
        states.iter().filter(|s| **s == 1).count()
    };
    let lost = slag(&scene);
    scene["grains"]["heat"]["slag_vapour"] = json!("condenses");
    let kept = slag(&scene);
    let [first, last] = ends(&out, "/grains_balance");
    let get = |name: &str| last.get(name).unwrap();
    let (left, condensed) = (get("grain_vapour_j"), get("grain_vapour_condensed_j"));
    assert!(left.abs() < 1e-12 && condensed > 0.0, "{left} {condensed}");
    // All light that is taken up stays, but for what the wall gives off.
    let held = get("grain_light_taken_j") - get("grain_light_given_j");
    let stored = get("enthalpy_j") - first.get("enthalpy_j").unwrap();
    assert!((stored / held - 1.0).abs() < 1e-10, "{stored} {held}");
    assert!(kept as f64 > 1.2 * lost as f64, "{kept} {lost}");
    // Where it condenses does not hang on the step.
    scene["time"]["step_s"] = json!(5e-5);
    let finer = slag(&scene);
    assert!(
        finer.abs_diff(kept) as f64 <= 0.02 * kept as f64,
        "{finer} {kept}"
    );
}

#[test]
fn vapour_condenses_only_where_slag_boils() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = cavity();
    scene["grains"]["heat"]["slag_vapour"] = json!("condenses");
    let melting = scene["grains"]["heat"]["melting"].as_object_mut();
    melting.unwrap().remove("boiling_k");
    let said = refused(&scene, folder.path());
    assert!(
        said.contains("slag_vapour") && said.contains("boiling_k"),
        "{said}"
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
    let said = refused(&cold, folder.path());
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
