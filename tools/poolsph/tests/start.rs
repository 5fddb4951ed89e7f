//! Runs that begin with the metal of an earlier one: it goes on as it was, or has cooled meanwhile, and what does not fit is told.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use artefact::Reader;
use serde_json::{Value, json};

fn command(scene: &Value, out: &Path, more: &[&str]) -> Command {
    let path = out.with_extension("scene.json");
    std::fs::write(&path, scene.to_string()).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_poolsph"));
    command.arg("run").arg(path).arg("--out").arg(out);
    command.args(["--progress", "none"]).args(more);
    command
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn finished(scene: &Value, out: &Path, more: &[&str]) -> Vec<u8> {
    let output = command(scene, out, more).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    std::fs::read(out).unwrap()
}

fn input(file: &Path) -> String {
    format!("start={}", file.display())
}

/// A bar that is hot at one end.
fn bar(end: f64) -> Value {
    json!({
        "kind": "poolsph.scene", "version": 2, "title": "A bar",
        "spacing_m": 5e-4, "time": {"step_s": 1e-4, "end_s": end}, "density_kg_m3": 7750,
        "bodies": [{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [8e-3, 1e-3, 1e-3]}}, "state": "solid",
                    "temperature_k": {"expr": "300 + 850*exp(-x/2e-3)"}}],
        "heat": {"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": 700,
                 "melting": {"point_k": 1200, "latent_heat_j_kg": 250e3}},
        "output": {"particles_interval_s": 1.0, "precision": "f64"}
    })
}

/// The last frame.
fn last(file: &Path) -> artefact::Frame {
    let reader = Reader::open(file).unwrap();
    reader
        .frame("/particles", reader.count("/particles") - 1)
        .unwrap()
}

#[test]
fn what_goes_on_is_what_would_have_gone_on() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| -> PathBuf { folder.path().join(name) };
    finished(&bar(0.1), &at("straight.mcap"), &[]);
    finished(&bar(0.05), &at("first.mcap"), &[]);
    let mut second = bar(0.05);
    second["start"] = json!({});
    finished(
        &second,
        &at("second.mcap"),
        &["--input", &input(&at("first.mcap"))],
    );
    let [straight, second, begun] = ["straight", "second", "first"].map(|name| {
        let frame = last(&at(&format!("{name}.mcap")));
        frame.f64("temperature").unwrap()
    });
    assert!((begun[0] - straight[0]).abs() > 1.0, "nothing has gone on");
    for (a, b) in straight.iter().zip(&second) {
        assert!((a - b).abs() < 1e-8, "{a} {b}");
    }
}

#[test]
fn metal_that_melts_keeps_its_latent_heat_and_what_has_cooled_rests() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| -> PathBuf { folder.path().join(name) };
    let mut pool = bar(0.02);
    pool["bodies"] = json!([
        {"shape": {"container": {"min_m": [0, 0, 0], "max_m": [3e-3, 3e-3, 3e-3], "thickness_m": 1e-3, "open": ["z+"]}},
         "state": "wall", "temperature_k": 300},
        {"shape": {"box": {"min_m": [0, 0, 0], "max_m": [3e-3, 3e-3, 2e-3]}}, "state": "liquid", "temperature_k": 1250}
    ]);
    pool["flow"] =
        json!({"method": "projection", "viscosity_pa_s": 0.004, "gravity_m_s2": [0, 0, -9.8]});
    finished(&pool, &at("first.mcap"), &[]);
    let before = last(&at("first.mcap"));
    let mut more = pool.clone();
    more["time"]["end_s"] = json!(1e-4);
    more["start"] = json!({});
    finished(
        &more,
        &at("second.mcap"),
        &["--input", &input(&at("first.mcap"))],
    );
    let reader = Reader::open(at("second.mcap")).unwrap();
    let after = reader.frame("/particles", 0).unwrap();
    for column in ["molten", "wall"] {
        assert_eq!(before.u8(column).unwrap(), after.u8(column).unwrap());
    }
    assert!(before.u8("molten").unwrap().contains(&1));
    assert_eq!(before.f64("fused").unwrap(), after.f64("fused").unwrap());
    assert_eq!(
        before.vectors("velocity").unwrap(),
        after.vectors("velocity").unwrap()
    );
    more["start"] = json!({"cooled_to_k": 420});
    finished(
        &more,
        &at("third.mcap"),
        &["--input", &input(&at("first.mcap"))],
    );
    let reader = Reader::open(at("third.mcap")).unwrap();
    let after = reader.frame("/particles", 0).unwrap();
    assert!(
        after
            .f64("temperature")
            .unwrap()
            .iter()
            .all(|t| (t - 420.0).abs() < 1e-9)
    );
    assert!(
        after
            .u8("molten")
            .unwrap()
            .iter()
            .all(|molten| *molten == 0)
    );
    assert_eq!(before.f64("fused").unwrap(), after.f64("fused").unwrap());
}

#[test]
fn threads_and_interruptions_do_not_show() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| -> PathBuf { folder.path().join(name) };
    finished(&bar(0.02), &at("first.mcap"), &[]);
    let mut scene = bar(2.0);
    scene["start"] = json!({});
    let from = input(&at("first.mcap"));
    let one = finished(
        &scene,
        &at("one.mcap"),
        &["--input", &from, "--threads", "1"],
    );
    let two = finished(
        &scene,
        &at("two.mcap"),
        &["--input", &from, "--threads", "2"],
    );
    assert!(one == two, "the bytes depend on the number of threads");
    let out = at("broken.mcap");
    let mut child = command(&scene, &out, &["--input", &from, "--checkpoint-s", "0.02"])
        .spawn()
        .unwrap();
    let checkpoint = at("broken.mcap.checkpoint");
    let start = Instant::now();
    while !checkpoint.exists() && start.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    assert_eq!(child.wait().unwrap().code(), None, "it must be killed");
    let resumed = finished(&scene, &out, &["--input", &from, "--resume"]);
    assert!(one == resumed, "the resumed run differs");
}

#[test]
fn what_does_not_fit_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| -> PathBuf { folder.path().join(name) };
    finished(&bar(1e-3), &at("first.mcap"), &[]);
    let from = input(&at("first.mcap"));
    let told = |scene: &Value, more: &[&str]| {
        let output = command(scene, &at("out.mcap"), more).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        said(&output)
    };
    let given = ["--input", from.as_str()];
    let mut scene = bar(1e-3);
    assert!(told(&scene, &given).contains("no key 'start'"));
    scene["start"] = json!({});
    assert!(told(&scene, &[]).contains("--input start=FILE"));
    scene["spacing_m"] = json!(1e-3);
    assert!(told(&scene, &given).contains("0.0005 m"));
    scene["spacing_m"] = json!(5e-4);
    scene["start"] = json!({"cooled_to_k": 1300});
    assert!(told(&scene, &given).contains("melting point, 1200 K"));
    scene["start"] = json!({});
    scene["bodies"][0]["held_temperature_k"] = json!(300);
    assert!(told(&scene, &given).contains("held_temperature_k"));
}
