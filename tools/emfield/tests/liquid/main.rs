//! Small drops that the program moves.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod between;
mod drawn;
mod field;
mod heat;
mod lifted;
mod meet;
mod stretched;

use std::f64::consts::PI;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use artefact::Reader;
use serde_json::{Value, json};

fn said(folder: &Path, scene: &Value, threads: &str) -> (i32, String, PathBuf) {
    let out = folder.join(format!("drop-{threads}.mcap"));
    let file = folder.join("scene.json");
    std::fs::write(&file, scene.to_string()).unwrap();
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_emfield"))
        .args(["run", file.to_str().unwrap(), "--out"])
        .arg(&out)
        .args(["--threads", threads, "-q"])
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code().unwrap(), text, out)
}

fn bytes(folder: &Path, scene: &Value, threads: &str) -> Vec<u8> {
    let (code, text, out) = said(folder, scene, threads);
    assert_eq!(code, 0, "{text}");
    std::fs::read(out).unwrap()
}

/// The bytes of a run that was killed after its first checkpoint and resumed.
fn resumed(folder: &Path, scene: &Value) -> Vec<u8> {
    let file = folder.join("scene.json");
    std::fs::write(&file, scene.to_string()).unwrap();
    let out = folder.join("broken.mcap");
    let command = |more: &[&str]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_emfield"));
        command.arg("run").arg(&file).arg("--out").arg(&out);
        command.args(["--threads", "2", "-q"]).args(more);
        command
    };
    let mut child = command(&["--checkpoint-s", "0.02"]).spawn().unwrap();
    let checkpoint = folder.join("broken.mcap.checkpoint");
    let start = Instant::now();
    while !checkpoint.exists() && start.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    let code = child.wait().unwrap().code();
    assert_eq!(code, None, "the run must be killed before its end");
    assert!(command(&["--resume"]).status().unwrap().success());
    std::fs::read(&out).unwrap()
}

fn run(folder: &Path, scene: &Value) -> Reader {
    let (code, text, out) = said(folder, scene, "2");
    assert_eq!(code, 0, "{text}");
    Reader::open_kind(&out, "point-fields", 1).unwrap()
}

/// A drop of radius, density and tension that leaves the sphere as its mode 2 does, 0.01 R high, for a part of the period.
fn drop(radius: f64, density: f64, tension: f64, part: f64) -> Value {
    let time = (density * radius.powi(3) / tension).sqrt();
    let speed = 0.01 * 8.0_f64.sqrt() / time / 2.0;
    let velocity = [-speed, -speed, 2.0 * speed];
    let velocity: Vec<Value> = ["x", "y", "z"]
        .iter()
        .zip(velocity)
        .map(|(axis, v)| json!({"expr": format!("{v:e}*{axis}")}))
        .collect();
    json!({"kind": "emfield.scene", "version": 1, "geometry": "space",
        "liquid": {"shape": {"sphere": {"centre_m": [0, 0, 0], "radius_m": radius}},
            "density_kg_m3": density, "surface_tension_n_m": tension, "velocity_m_s": velocity,
            "march": {"end_s": part * 2.0 * PI / 8.0_f64.sqrt() * time}},
        "points": {"spacing_m": radius / 4.5}, "output": {"precision": "f64"}})
}

fn column(reader: &Reader, name: &str) -> Vec<(f64, f64)> {
    let rows = reader.records("/liquid").unwrap();
    rows.iter()
        .map(|(t, r)| (*t, r.get(name).unwrap()))
        .collect()
}

#[test]
fn a_drop_swings_at_the_period_of_rayleigh_at_any_scale() {
    let folder = tempfile::tempdir().unwrap();
    let mut halves = Vec::new();
    for (radius, density, tension) in [(1e-3, 1000.0, 0.07196), (3.2e-2, 6500.0, 1.4)] {
        let reader = run(folder.path(), &drop(radius, density, tension, 0.55));
        let swing = column(&reader, "mode_2");
        let time = 2.0 * PI * (density * radius.powi(3) / tension / 8.0).sqrt();
        let zero = swing
            .windows(2)
            .find(|w| w[0].1 > 0.0 && w[1].1 <= 0.0)
            .map(|w| w[0].0 + (w[1].0 - w[0].0) * w[0].1 / (w[0].1 - w[1].1))
            .unwrap();
        halves.push(2.0 * zero / time);
        let most = swing.iter().map(|s| s.1).fold(0.0, f64::max);
        assert!((most / radius - 0.01).abs() < 3e-4, "{most:e}");
        let volume = column(&reader, "volume");
        let first = volume[0].1;
        for (_, v) in volume {
            assert!((v / first - 1.0).abs() < 1e-5);
        }
        let frame = reader.frame("/points", 0).unwrap();
        assert!(frame.has("velocity_x") && frame.has("pressure") && !frame.has("potential"));
    }
    assert!((halves[0] - 1.0).abs() < 0.02, "{halves:?}");
    // Times are written in whole nanoseconds.
    assert!((halves[0] - halves[1]).abs() < 2e-6, "{halves:?}");
}

#[test]
fn a_viscous_drop_at_rest_has_the_pressure_of_its_tension() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = drop(1e-3, 1000.0, 0.07, 0.1);
    scene["liquid"]["velocity_m_s"] = Value::Null;
    scene["liquid"]["viscosity_pa_s"] = json!(0.02 * (1000.0_f64 * 0.07 * 1e-3).sqrt());
    scene["liquid"]["gas_pressure_pa"] = json!(1e5);
    let reader = run(folder.path(), &scene);
    let last = reader.count("/points") - 1;
    for p in reader
        .frame("/points", last)
        .unwrap()
        .f64("pressure")
        .unwrap()
    {
        assert!((p - 1e5 - 140.0).abs() < 0.1, "{p}");
    }
    let swing = column(&reader, "mode_2");
    assert!(swing.iter().all(|s| s.1.abs() < 1e-8));
}

#[test]
fn a_drop_falls_as_gravity_says_and_threads_change_no_byte() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = drop(1e-3, 1000.0, 0.07, 0.03);
    scene["liquid"]["gravity_m_s2"] = json!([0, 0, -9.81]);
    let files = ["1", "2"].map(|threads| {
        let (code, text, out) = said(folder.path(), &scene, threads);
        assert_eq!(code, 0, "{text}");
        std::fs::read(out).unwrap()
    });
    assert!(files[0] == files[1]);
    let reader = Reader::open_kind(folder.path().join("drop-2.mcap"), "point-fields", 1).unwrap();
    for ((t, z), (_, v)) in column(&reader, "centre_z")
        .iter()
        .zip(column(&reader, "velocity_z"))
    {
        // Of the speed of the swing, 7.5 mm/s.
        assert!((v + 9.81 * t).abs() < 1e-6 * 7.5e-3, "{v} {t}");
        assert!((z + 0.5 * 9.81 * t * t).abs() < 1e-8, "{z} {t}");
    }
}

#[test]
fn what_a_liquid_cannot_be_is_told_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let good = drop(1e-3, 1000.0, 0.07, 0.1);
    for (pointer, value, path) in [
        ("/geometry", json!("plane"), "/geometry"),
        ("/points/spacing_m", json!(1e-2), "/points/spacing_m"),
        ("/liquid/density_kg_m3", json!(0.0), "/liquid/density_kg_m3"),
        (
            "/liquid/velocity_m_s/2",
            json!({"expr": "w"}),
            "/liquid/velocity_m_s/2",
        ),
        (
            "/liquid/march",
            json!({"end_s": 1.0, "step_s": 2.0}),
            "/liquid/march/step_s",
        ),
    ] {
        let mut scene = good.clone();
        *scene.pointer_mut(pointer).unwrap() = value;
        let (code, text, _) = said(folder.path(), &scene, "1");
        assert!(code == 2 && text.contains(path), "{path}: {text}");
    }
}

#[test]
fn a_drop_at_rest_in_a_field_is_drawn_out_as_taylor_says() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = drop(5e-5, 1000.0, 0.072, 0.1);
    let liquid = scene["liquid"].as_object_mut().unwrap();
    liquid.remove("march");
    liquid.remove("velocity_m_s");
    let field = (2e-3 * 0.072 / 5e-5 / 8.854_187_812_8e-12_f64).sqrt();
    liquid.insert(
        "equilibrium".to_owned(),
        json!({"field_v_m": field, "limit": true}),
    );
    let reader = run(folder.path(), &scene);
    let row = reader.record("/liquid").unwrap();
    assert!((row.get("deformation").unwrap() / (9.0 / 16.0 * 2e-3) - 1.0).abs() < 5e-3);
    assert!((row.get("capillary_limit").unwrap() - 0.20441).abs() < 1e-4);
    assert!(reader.has("/outline") && reader.has("/surface") && !reader.has("/points"));
    scene["liquid"]["equilibrium"] = json!({"field_v_m": 1.1e7, "relative_permittivity": 80});
    let (code, text, _) = said(folder.path(), &scene, "1");
    assert!(
        code == 1 && text.contains("the greatest field is 6.16"),
        "{text}"
    );
}
