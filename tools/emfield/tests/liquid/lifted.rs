//! Drops that move in the alternating field of a loop.

use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::{column, drop, run, said};

/// A drop above a loop, its skin a third of its radius, for some steps; currents are the same at any radius, and so are forces.
fn lifted(radius: f64, steps: u32) -> Value {
    let tension = 1.0 * 2.5e-3 / radius;
    let mut scene = drop(radius, 7000.0, tension, 0.1);
    scene["points"]["spacing_m"] = json!(radius / 3.5);
    let liquid = scene["liquid"].as_object_mut().unwrap();
    liquid.remove("velocity_m_s");
    let step = 0.1 * (7000.0 * radius.powi(3) / tension).sqrt();
    liquid["march"] = json!({"step_s": step, "end_s": f64::from(steps) * step});
    let skin = radius / 3.0;
    let rate = 2.0 / (4e-7 * std::f64::consts::PI * 1e7 * skin * skin);
    liquid.insert(
        "magnetic".to_owned(),
        json!({"conductivity_s_m": 1e7, "frequency_hz": rate / std::f64::consts::TAU, "order": 2,
            "spacing_m": radius / 2.8, "coils": [{"loop": {"centre_m": [0, 0, -1.5 * radius], "radius_m": 1.5 * radius, "current_a": 200}}]}),
    );
    scene
}

fn bytes(folder: &Path, scene: &Value, threads: &str) -> Vec<u8> {
    let (code, text, out) = said(folder, scene, threads);
    assert_eq!(code, 0, "{text}");
    std::fs::read(out).unwrap()
}

/// Where two fits of the field are as good, rounding chooses between them: it is as coarse here as can be.
#[test]
fn a_drop_above_a_loop_knows_neither_scale_nor_threads() {
    let folder = tempfile::tempdir().unwrap();
    let of = |radius: f64| {
        let reader = run(folder.path(), &lifted(radius, 1));
        let last = |name: &str| column(&reader, name).last().unwrap().1;
        let of = [last("mode_3") / radius, last("centre_z") / radius];
        [of[0], of[1], last("force_z")]
    };
    let (one, small) = (of(2.5e-3), of(2.5e-3 / 20.0));
    assert!(one[1] > 0.0 && one[2] > 1e-3, "{one:?}");
    for (a, b) in small.iter().zip(one) {
        assert!((a / b - 1.0).abs() < 1e-3, "{small:?} {one:?}");
    }
    let scene = lifted(2.5e-3, 1);
    assert!(bytes(folder.path(), &scene, "1") == bytes(folder.path(), &scene, "2"));
}

#[test]
fn a_resumed_drop_above_a_loop_is_a_straight_one() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = lifted(2.5e-3, 3);
    scene["liquid"]["gravity_m_s2"] = json!([0, 0, -9.81]);
    scene["liquid"]["magnetic"]["balanced"] = json!(true);
    let straight = bytes(folder.path(), &scene, "2");
    let file = folder.path().join("scene.json");
    let out = folder.path().join("broken.mcap");
    let command = |more: &[&str]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_emfield"));
        command.arg("run").arg(&file).arg("--out").arg(&out);
        command.args(["--threads", "2", "-q"]).args(more);
        command
    };
    let mut child = command(&["--checkpoint-s", "0.02"]).spawn().unwrap();
    let checkpoint = folder.path().join("broken.mcap.checkpoint");
    let start = Instant::now();
    while !checkpoint.exists() && start.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    let code = child.wait().unwrap().code();
    assert_eq!(code, None, "the run must be killed before its end");
    assert!(command(&["--resume"]).status().unwrap().success());
    assert!(straight == std::fs::read(&out).unwrap());
}

#[test]
fn fields_that_cannot_lift_are_told_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let good = lifted(2.5e-3, 1);
    let wire = json!([{"wire": {"place_m": [0, 0], "current_a": 1}}]);
    for (key, value, path) in [
        ("balanced", json!(true), "/liquid/magnetic/balanced"),
        ("coils", wire, "/liquid/magnetic/coils/0"),
        ("order", json!(5), "/liquid/magnetic/order"),
    ] {
        let mut scene = good.clone();
        scene["liquid"]["magnetic"][key] = value;
        let (code, text, _) = said(folder.path(), &scene, "1");
        assert!(code == 2 && text.contains(path), "{path}: {text}");
    }
    let mut scene = good;
    scene["liquid"]["gravity_m_s2"] = json!([0, 0, 9.81]);
    scene["liquid"]["magnetic"]["balanced"] = json!(true);
    let (code, text, _) = said(folder.path(), &scene, "1");
    assert!(code == 1 && text.contains("does not lift"), "{text}");
    scene["liquid"]["magnetic"]["coils"][0]["loop"]["centre_m"] = json!([0, 0, -1e-3]);
    scene["liquid"]["magnetic"]["coils"][0]["loop"]["radius_m"] = json!(2.2e-3);
    let (code, text, _) = said(folder.path(), &scene, "1");
    assert!(code == 1 && text.contains("touches a coil"), "{text}");
}

#[test]
fn a_search_for_a_shape_at_rest_ends_when_it_is_interrupted() {
    let folder = tempfile::tempdir().unwrap();
    let scene = json!({
        "kind": "emfield.scene", "version": 1, "geometry": "space",
        "liquid": {"shape": {"sphere": {"centre_m": [0, 0, 0], "radius_m": 5e-5}}, "density_kg_m3": 1000,
            "surface_tension_n_m": 0.072, "equilibrium": {"field_v_m": 1e6, "relative_permittivity": 80}},
        // As many harmonics as there may be: some ten seconds.
        "points": {"spacing_m": 1e-9}
    });
    let file = folder.path().join("scene.json");
    std::fs::write(&file, scene.to_string()).unwrap();
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_emfield"))
        .args(["run", file.to_str().unwrap(), "--out"])
        .arg(folder.path().join("rest.mcap"))
        .args(["--threads", "1", "-q"])
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(1500));
    let interrupt = format!("kill -INT {}", child.id());
    let sent = std::process::Command::new("sh")
        .args(["-c", &interrupt])
        .status();
    assert!(sent.unwrap().success());
    let status = child.wait().unwrap();
    assert_eq!(status.code(), Some(130), "{status}");
    assert!(!folder.path().join("rest.mcap").exists());
}
