//! Grains glued into a body: it moves as a rigid one, and who has none pays nothing.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use artefact::{Frame, Reader, Record};
use serde_json::{Value, json};

fn command(scene: &Value, folder: &Path, name: &str, more: &[&str]) -> Command {
    let path = folder.join("scene.json");
    std::fs::write(&path, scene.to_string()).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_poolsph"));
    command
        .arg("run")
        .arg(path)
        .arg("--out")
        .arg(folder.join(name));
    command.args(["--progress", "none"]).args(more);
    command
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn finished(scene: &Value, folder: &Path, name: &str, more: &[&str]) -> Vec<u8> {
    let output = command(scene, folder, name, more).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    std::fs::read(folder.join(name)).unwrap()
}

fn records(folder: &Path, name: &str) -> Vec<Record> {
    let reader = Reader::open(folder.join(name)).unwrap();
    let records = reader.records("/grains_balance").unwrap();
    records.into_iter().map(|(_, record)| record).collect()
}

/// First and last frame.
fn ends(folder: &Path, name: &str) -> [Frame; 2] {
    let reader = Reader::open(folder.join(name)).unwrap();
    [0, reader.count("/grains") - 1].map(|k| reader.frame("/grains", k).unwrap())
}

/// A slab of 4 x 3 x 1 grains that no symmetry helps: it flies and tumbles.
fn tumbling() -> Value {
    json!({
        "kind": "poolsph.scene", "version": 2, "title": "A slab that tumbles",
        "time": {"step_s": 1e-4, "end_s": 0.05},
        "grains": {
            "density_kg_m3": 2500,
            "contact": {"law": {"linear": {"stiffness_n_m": 200}}, "restitution": 0.6, "friction": 0.4},
            "bodies": [{
                "shape": {"box": {"min_m": [0, 0, 0], "max_m": [8e-3, 6e-3, 2e-3]}}, "radius_m": 1e-3, "glued": true,
                "velocity_m_s": [0.1, -0.2, 0.3], "spin_rad_s": [20, 60, 10]
            }]
        },
        "output": {"particles_interval_s": 1e-2, "balance_interval_s": 1e-2, "precision": "f64"}
    })
}

/// The slab is hit by single grains, in a box.
fn hit() -> Value {
    let mut scene = tumbling();
    let more = json!({
        "shape": {"box": {"min_m": [-6e-3, -2e-3, 4e-3], "max_m": [8e-3, 8e-3, 1e-2]}}, "radius_m": 0.6e-3,
        "spacing_m": 1.5e-3, "jitter": 0.1, "velocity_m_s": [0.2, 0, -0.9]
    });
    scene["grains"]["bodies"].as_array_mut().unwrap().push(more);
    scene
}

fn vector(record: &Record, name: &str) -> [f64; 3] {
    ["x", "y", "z"].map(|axis| record.get(&format!("{name}_{axis}")).unwrap())
}

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

fn energy(record: &Record) -> f64 {
    record.get("kinetic_energy_j").unwrap() + record.get("rotational_energy_j").unwrap()
}

#[test]
fn a_slab_keeps_its_shape_and_its_momenta_and_its_energy_in_second_order() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut lost = Vec::new();
    for (name, steps) in [("long.mcap", 20), ("short.mcap", 40)] {
        let mut scene = tumbling();
        scene["grains"]["steps_per_contact"] = json!(steps);
        finished(&scene, folder, name, &[]);
        let records = records(folder, name);
        let (first, last) = (&records[0], &records[records.len() - 1]);
        for quantity in ["momentum", "angular_momentum"] {
            let [before, after] = [first, last].map(|record| vector(record, quantity));
            let gone = apart(before, after) / apart(before, [0.0; 3]);
            assert!(gone < 1e-12, "{quantity}: {gone}");
        }
        lost.push((energy(last) / energy(first) - 1.0).abs());
        let [before, after] = ends(folder, name).map(|frame| frame.position_vectors().unwrap());
        for a in 0..before.len() {
            for b in 0..a {
                let wider = apart(after[a], after[b]) / apart(before[a], before[b]) - 1.0;
                assert!(wider.abs() < 1e-12, "{wider}");
            }
        }
    }
    assert!(lost[0] < 1e-4 && lost[1] < 0.4 * lost[0], "{lost:?}");
}

#[test]
fn what_hits_a_slab_keeps_the_momenta_of_both() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    finished(&hit(), folder, "hit.mcap", &[]);
    let records = records(folder, "hit.mcap");
    let (first, last) = (&records[0], &records[records.len() - 1]);
    for quantity in ["momentum", "angular_momentum"] {
        let [before, after] = [first, last].map(|record| vector(record, quantity));
        let gone = apart(before, after) / apart(before, [0.0; 3]);
        assert!(gone < 1e-10, "{quantity}: {gone}");
    }
    assert!(energy(last) < 0.9 * energy(first), "nothing was hit");
}

#[test]
fn threads_and_interruptions_do_not_show() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut scene = hit();
    scene["time"]["end_s"] = json!(0.5);
    let straight = finished(&scene, folder, "straight.mcap", &["--threads", "1"]);
    assert!(straight == finished(&scene, folder, "two.mcap", &["--threads", "2"]));
    let mut child = command(&scene, folder, "cut.mcap", &["--checkpoint-s", "0.01"])
        .spawn()
        .unwrap();
    let (begin, checkpoint) = (Instant::now(), folder.join("cut.mcap.checkpoint"));
    while !checkpoint.exists() && begin.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(checkpoint.exists(), "the run ended before it was cut");
    assert!(straight == finished(&scene, folder, "cut.mcap", &["--resume"]));
}

#[test]
fn what_is_glued_cannot_be_driven() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut scene = tumbling();
    scene["grains"]["bodies"][0]["driven_m_s"] = json!([0, 0, 0]);
    let output = command(&scene, folder, "driven.mcap", &[])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(
        said(&output).contains("/grains/bodies/0/glued"),
        "{}",
        said(&output)
    );
}
