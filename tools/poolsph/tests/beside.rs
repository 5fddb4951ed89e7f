//! Grains beside metal as a user meets them: what one loses the other gets, threads and interruptions do not show.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use artefact::{Reader, Record};
use serde_json::{Value, json};

fn command(scene: &Path, out: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_poolsph"));
    command.arg("run").arg(scene).arg("--out").arg(out);
    command.args(["--progress", "none"]).args(more);
    command
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn finished(scene: &Value, out: &Path, more: &[&str]) -> Vec<u8> {
    ended(scene, out, more, 0)
}

/// Runs a scene that ends with an exit code.
fn ended(scene: &Value, out: &Path, more: &[&str], code: i32) -> Vec<u8> {
    let path = out.with_extension("scene.json");
    std::fs::write(&path, scene.to_string()).unwrap();
    let output = command(&path, out, more).output().unwrap();
    assert_eq!(output.status.code(), Some(code), "{}", said(&output));
    assert_eq!(code == 3, said(&output).contains("have left the bounds"));
    std::fs::read(out).unwrap()
}

/// First and last record of a channel.
fn ends(artefact: &Path, channel: &str) -> [Record; 2] {
    let records = Reader::open(artefact).unwrap().records(channel).unwrap();
    [&records[0], &records[records.len() - 1]].map(|(_, record)| record.clone())
}

fn last_of(artefact: &Path, history: &str) -> f64 {
    let text = std::fs::read_to_string(artefact.with_extension("run.json")).unwrap();
    let record: Value = serde_json::from_str(&text).unwrap();
    let series = record["history"].as_array().unwrap().iter();
    let series: Vec<_> = series.filter(|h| h["name"] == history).collect();
    assert_eq!(series.len(), 1, "{history}: {}", record["history"]);
    let values = series[0]["values"].as_array().unwrap();
    values[values.len() - 1].as_f64().unwrap()
}

/// Grains that lie on a plate.
fn resting() -> Value {
    json!({
        "kind": "poolsph.scene", "version": 2, "title": "Grains on a plate",
        "spacing_m": 5e-4, "time": {"step_s": 1e-4, "end_s": 0.3}, "density_kg_m3": 7750,
        "bodies": [{"shape": {"box": {"min_m": [0, 0, -1e-3], "max_m": [4e-3, 4e-3, 0]}}, "state": "solid"}],
        "grains": {
            "density_kg_m3": 3230, "gravity_m_s2": [0, 0, -9.8],
            "contact": {"law": {"linear": {"stiffness_n_m": 75}}, "restitution": 0.3, "friction": 0.5},
            "bodies": [{"places_m": [[1.2e-3, 1.1e-3, 0.4e-3], [2.4e-3, 2.6e-3, 0.5e-3], [2.45e-3, 2.6e-3, 1.1e-3]], "radius_m": 2.5e-4}]
        },
        "output": {"particles_interval_s": 0.05, "precision": "f64"}
    })
}

/// Hot grains that fall into a pool.
fn falling() -> Value {
    let mut scene = resting();
    scene["bodies"] = json!([
        {"shape": {"container": {"min_m": [0, 0, 0], "max_m": [4e-3, 4e-3, 4e-3], "thickness_m": 1e-3, "open": ["z+"]}},
         "state": "wall", "temperature_k": 300},
        {"shape": {"box": {"min_m": [0, 0, 0], "max_m": [4e-3, 4e-3, 1.5e-3]}}, "state": "liquid", "temperature_k": 1900}
    ]);
    scene["flow"] =
        json!({"method": "projection", "viscosity_pa_s": 0.004, "gravity_m_s2": [0, 0, -9.8]});
    scene["heat"] = json!({"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": 700,
        "melting": {"point_k": 1750, "latent_heat_j_kg": 250e3}});
    scene["grains"]["bodies"] = json!([{"shape": {"box": {"min_m": [0.5e-3, 0.5e-3, 2e-3], "max_m": [3.5e-3, 3.5e-3, 3.5e-3]}},
        "radius_m": 2.5e-4, "jitter": 0.03, "spacing_m": 6e-4, "temperature_k": 2400}]);
    scene["grains"]["walls"] = json!([{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [4e-3, 4e-3, 9e-3]}}, "hollow": true}]);
    scene["grains"]["heat"] = json!({"thermal_conductivity_w_m_k": 20.2, "specific_heat_j_kg_k": 1000, "gas_conductivity_w_m_k": 0.1,
        "melting": {"point_k": 2572, "latent_heat_j_kg": 5e5}});
    scene["time"]["end_s"] = json!(0.03);
    scene["output"]["particles_interval_s"] = json!(2e-3);
    scene
}

#[test]
fn a_plate_carries_the_weight_of_grains_that_rest_on_it() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("rest.mcap");
    finished(&resting(), &out, &[]);
    let weight = 3.0 * 3230.0 * 4.0 / 3.0 * std::f64::consts::PI * 2.5e-4_f64.powi(3) * 9.8;
    let [_, last] = ends(&out, "/grains_balance");
    assert!(last.get("kinetic_energy_j").unwrap() < 1e-6 * weight * 5e-4);
    let borne = last_of(&out, "grains_grain_force_on_solid");
    assert!((borne / weight + 1.0).abs() < 1e-6, "{borne} {weight}");
}

/// A grain that meets metal which nothing holds; the drop is one particle, or many.
fn met(liquid: &Value, u: f64) -> Value {
    let mut scene = resting();
    scene["bodies"] = json!([{"shape": liquid, "state": "liquid"}]);
    scene["flow"] = json!({"method": "projection", "viscosity_pa_s": 0.004});
    scene["grains"]
        .as_object_mut()
        .unwrap()
        .remove("gravity_m_s2");
    scene["grains"]["contact"]["restitution"] = json!(1.0);
    scene["grains"]["bodies"] = json!([{"places_m": [[0.3e-3, 0.25e-3, 2.3e-3]], "radius_m": 2.5e-4, "velocity_m_s": [0.01, 0, -u]}]);
    scene["time"] = json!({"step_s": 1e-4, "end_s": 0.03});
    scene
}

#[test]
fn momentum_that_a_grain_loses_metal_gets() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("met.mcap");
    for (box_, speed) in [
        (
            json!({"box": {"min_m": [0, 0, 0], "max_m": [1e-3, 1e-3, 1e-3]}}),
            0.4,
        ),
        (
            json!({"box": {"min_m": [0, 0, 1.5e-3], "max_m": [0.5e-3, 0.5e-3, 2e-3]}}),
            0.05,
        ),
    ] {
        finished(&met(&box_, speed), &out, &[]);
        let (metal, grains) = (ends(&out, "/balance"), ends(&out, "/grains_balance"));
        let scale = grains[0].get("momentum_z").unwrap().abs();
        let lost =
            (grains[1].get("momentum_z").unwrap() - grains[0].get("momentum_z").unwrap()).abs();
        assert!(lost > 0.5 * scale, "they hardly met: {lost} of {scale}");
        for axis in ["x", "y", "z"] {
            let name = format!("momentum_{axis}");
            let [before, after] =
                [0, 1].map(|k| metal[k].get(&name).unwrap() + grains[k].get(&name).unwrap());
            assert!(
                (after - before).abs() < 1e-12 * scale,
                "{axis}: {before:e} {after:e}"
            );
        }
    }
}

#[test]
fn two_bodies_without_friction_keep_their_energy_the_better_the_shorter_the_steps() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("met.mcap");
    let lone = json!({"box": {"min_m": [0, 0, 1.5e-3], "max_m": [0.5e-3, 0.5e-3, 2e-3]}});
    let lost = |step: f64| {
        let mut scene = met(&lone, 0.05);
        let contact = scene["grains"]["contact"].as_object_mut().unwrap();
        contact.remove("friction");
        scene["time"] = json!({"step_s": step, "end_s": 2e-3});
        finished(&scene, &out, &[]);
        let (metal, grains) = (ends(&out, "/balance"), ends(&out, "/grains_balance"));
        let energy = |k: usize| {
            let of = |record: &Record| record.get("kinetic_energy_j").unwrap();
            of(&metal[k]) + of(&grains[k])
        };
        (energy(1) / energy(0) - 1.0).abs()
    };
    let (long, short) = (lost(5e-6), lost(1.25e-6));
    assert!(short < 0.01 && short < 0.4 * long, "{long} {short}");
}

#[test]
fn heat_that_a_grain_loses_metal_gets() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("falling.mcap");
    finished(&falling(), &out, &[]);
    let (metal, grains) = (ends(&out, "/balance"), ends(&out, "/grains_balance"));
    let given = grains[0].get("enthalpy_j").unwrap() - grains[1].get("enthalpy_j").unwrap();
    let stored = metal[1].get("energy_stored_j").unwrap();
    assert!(given > 1e-3, "{given}");
    assert!((stored / given - 1.0).abs() < 1e-10, "{given} {stored}");
    assert!(metal[1].get("closure").unwrap().abs() < 1e-10);
}

/// Slag that lies on metal which hardly warms, wherever its particles stand, cools by H = 4 k_a k_b/(k_a + k_b) r.
#[test]
fn slag_that_wets_metal_cools_through_its_whole_width() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("slag.mcap");
    // On one particle, and between four.
    let over = 2.5e-4 - 3e-8;
    let between = -2.5e-4 + (0.125e-6_f64).sqrt() - 3e-8;
    for (place, contact) in [
        ([2.25e-3, 2.25e-3, over], json!({})),
        ([2.5e-3, 2.5e-3, between], json!({"contact": "overlap"})),
    ] {
        let mut scene = resting();
        scene["bodies"][0]["temperature_k"] = json!(1000);
        scene["heat"] = json!({"thermal_conductivity_w_m_k": 3e3, "specific_heat_j_kg_k": 1e5});
        let grain = scene["grains"].as_object_mut().unwrap();
        grain["bodies"] = json!([{"places_m": [place], "radius_m": 2.5e-4, "temperature_k": 2000}]);
        grain.insert("heat".to_owned(), contact);
        let heat = grain["heat"].as_object_mut().unwrap();
        heat.insert("thermal_conductivity_w_m_k".to_owned(), json!(20));
        heat.insert("specific_heat_j_kg_k".to_owned(), json!(1000));
        heat.insert("gas_conductivity_w_m_k".to_owned(), json!(0.1));
        heat.insert(
            "melting".to_owned(),
            json!({"point_k": 500, "latent_heat_j_kg": 0}),
        );
        heat.insert("slag_wets".to_owned(), json!(true));
        scene["time"] = json!({"step_s": 1e-5, "end_s": 3e-3});
        finished(&scene, &out, &[]);
        let [first, last] = ends(&out, "/grains_balance");
        let mass = 3230.0 * 4.0 / 3.0 * std::f64::consts::PI * 2.5e-4_f64.powi(3);
        let lost =
            (first.get("enthalpy_j").unwrap() - last.get("enthalpy_j").unwrap()) / (mass * 1e3);
        let (k_a, k_b) = (60.0, 3e3);
        let conductance = 4.0 * k_a * k_b / (k_a + k_b) * 2.5e-4;
        let exact = 1e3 * (1.0 - (-conductance * 3e-3 / (mass * 1e3)).exp());
        assert!((lost / exact - 1.0).abs() < 3e-3, "{lost} {exact}");
    }
}

#[test]
fn threads_do_not_show() {
    let folder = tempfile::tempdir().unwrap();
    let out = |name: &str| -> PathBuf { folder.path().join(name) };
    let one = finished(&falling(), &out("one.mcap"), &["--threads", "1"]);
    let two = finished(&falling(), &out("two.mcap"), &["--threads", "2"]);
    assert!(one == two, "the bytes depend on the number of threads");
}

#[test]
fn an_interrupted_run_ends_in_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = falling();
    scene["time"]["end_s"] = json!(0.06);
    scene["grains"]["bounds"] = json!({"min_m": [-1, -1, -1], "max_m": [1, 1, 2.9e-3]});
    scene["output"]["heat_received"] = json!(true);
    // The upper grains leave, and their heat.
    let whole = ended(&scene, &folder.path().join("whole.mcap"), &[], 3);
    let (path, out) = (
        folder.path().join("broken.scene.json"),
        folder.path().join("broken.mcap"),
    );
    std::fs::write(&path, scene.to_string()).unwrap();
    let mut child = command(&path, &out, &["--checkpoint-s", "0.05"])
        .spawn()
        .unwrap();
    let checkpoint = folder.path().join("broken.mcap.checkpoint");
    let start = Instant::now();
    while !checkpoint.exists() && start.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    assert_eq!(
        child.wait().unwrap().code(),
        None,
        "the run must be killed before its end"
    );
    let resumed = ended(&scene, &out, &["--resume"], 3);
    assert!(whole == resumed, "the resumed run differs");
}

#[test]
fn steps_that_grow_lose_nothing_and_threads_do_not_show() {
    let folder = tempfile::tempdir().unwrap();
    let out = |name: &str| -> PathBuf { folder.path().join(name) };
    let mut scene = falling();
    scene["time"]["adaptive"] = json!({"greatest_s": 4e-4});
    scene["grains"]["sleep"] = json!({"speed_m_s": 1e-3, "held_s": 5e-3, "heat_interval_steps": 6});
    let one = finished(&scene, &out("one.mcap"), &["--threads", "1"]);
    let two = finished(&scene, &out("two.mcap"), &["--threads", "2"]);
    assert!(one == two, "the bytes depend on the number of threads");
    let (metal, grains) = (
        ends(&out("one.mcap"), "/balance"),
        ends(&out("one.mcap"), "/grains_balance"),
    );
    let given = grains[0].get("enthalpy_j").unwrap() - grains[1].get("enthalpy_j").unwrap();
    let stored = metal[1].get("energy_stored_j").unwrap();
    assert!((stored / given - 1.0).abs() < 1e-10, "{given} {stored}");
    let record = std::fs::read_to_string(out("one.run.json")).unwrap();
    let record: Value = serde_json::from_str(&record).unwrap();
    let told = record["closing"].as_array().unwrap().iter();
    let taken = told.clone().find(|c| c["name"] == "steps_taken").unwrap();
    let taken = taken["value"].as_f64().unwrap();
    assert!(taken < 300.0, "{taken} steps of 300: none has grown");
}

#[test]
fn what_metal_is_to_grains_means_nothing_without_metal() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = resting();
    scene["grains"]["metal"] = json!({"friction": 0.1});
    for key in ["bodies", "spacing_m", "density_kg_m3"] {
        scene.as_object_mut().unwrap().remove(key);
    }
    let path = folder.path().join("scene.json");
    std::fs::write(&path, scene.to_string()).unwrap();
    let output = command(&path, &folder.path().join("out.mcap"), &[])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("/grains/metal"), "{}", said(&output));
}

/// A grain of the weight m g sinks by m g/k into what it lies on.
#[test]
fn contacts_that_are_too_soft_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let told = |stiffness: f64| {
        let mut scene = resting();
        scene["grains"]["contact"]["law"]["linear"]["stiffness_n_m"] = json!(stiffness);
        let out = folder.path().join("soft.mcap");
        let path = out.with_extension("scene.json");
        std::fs::write(&path, scene.to_string()).unwrap();
        said(&command(&path, &out, &[]).output().unwrap())
    };
    // m g is 2.1e-6 N, a tenth of the radius 2.5e-5 m.
    assert!(!told(75.0).contains("overlap by"), "{}", told(75.0));
    assert!(told(0.02).contains("overlap by"), "{}", told(0.02));
}
