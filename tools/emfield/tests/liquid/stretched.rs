//! Drops that are let go far from the sphere.

use std::f64::consts::PI;
use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::{column, drop, run, said};

/// Energy that may come back, and volume that may be lost.
const ENERGY: f64 = 1e-3;
const VOLUME: f64 = 1e-4;

/// A spheroid of some ratio of axes and Ohnesorge number, five spacings in the radius of its sphere, let go at rest for some
/// periods of small swings.
fn spheroid(radius: f64, ratio: f64, ohnesorge: f64, periods: f64) -> Value {
    let (density, tension) = (1000.0_f64, 0.072_f64);
    let wide = radius / ratio.cbrt();
    let time = (density * radius.powi(3) / tension).sqrt();
    json!({"kind": "emfield.scene", "version": 1, "geometry": "space",
        "liquid": {"shape": {"ellipsoid": {"centre_m": [0, 0, 0], "semi_axes_m": [wide, wide, ratio * wide]}},
            "density_kg_m3": density, "surface_tension_n_m": tension,
            "viscosity_pa_s": ohnesorge * (density * tension * radius).sqrt(),
            "march": {"end_s": periods * 2.0 * PI / 8.0_f64.sqrt() * time}},
        "points": {"spacing_m": radius / 5.0}, "output": {"precision": "f64"}})
}

/// How many points came and merged in the run whose record is in a folder.
pub(super) fn renewed(folder: &Path, name: &str) -> [u64; 2] {
    let text = std::fs::read_to_string(folder.join(name)).unwrap();
    let record: Value = serde_json::from_str(&text).unwrap();
    ["points_added", "points_merged"].map(|name| {
        let all = record["closing"].as_array().unwrap().iter();
        let mut own = all.filter(|line| line["name"] == name);
        own.next().unwrap()["value"].as_f64().unwrap() as u64
    })
}

/// Lets one go: energy and volume are kept, and it becomes flat. What came and merged.
fn let_go(scene: &Value) -> [u64; 2] {
    let folder = tempfile::tempdir().unwrap();
    let reader = run(folder.path(), scene);
    let [kinetic, surface, volume, axes] =
        ["kinetic_energy", "surface_energy", "volume", "axis_ratio"]
            .map(|name| column(&reader, name));
    let energy = kinetic.iter().zip(&surface).map(|(k, s)| k.1 + s.1);
    let first = kinetic[0].1 + surface[0].1;
    let mut least = first;
    for e in energy {
        least = least.min(e);
        assert!(e - least < ENERGY * first, "{:e}", (e - least) / first);
    }
    for (_, v) in &volume {
        assert!((v / volume[0].1 - 1.0).abs() < VOLUME);
    }
    let shortest = axes.iter().map(|a| a.1).fold(f64::INFINITY, f64::min);
    assert!(shortest < 0.8, "{shortest}");
    let last = volume.last().unwrap().0;
    let end = scene["liquid"]["march"]["end_s"].as_f64().unwrap();
    assert!((last / end - 1.0).abs() < 1e-4, "told up to {last} s alone");
    renewed(folder.path(), "drop-2.run.json")
}

#[test]
fn a_slender_drop_loses_energy_and_holds() {
    let_go(&spheroid(1e-3, 2.5, 0.1, 0.75));
}

#[test]
fn a_stretched_drop_of_little_friction_loses_energy_and_holds() {
    let_go(&spheroid(1e-3, 1.5, 0.02, 0.55));
}

#[test]
fn a_small_drop_whose_points_crowd_holds_for_a_period() {
    let [added, merged] = let_go(&spheroid(3.5e-5, 2.0, 0.02, 1.05));
    assert!(added > 0 && merged > 0, "{added} {merged}");
}

#[test]
fn a_large_drop_whose_points_crowd_holds_in_half_steps() {
    let mut scene = spheroid(1e-3, 2.0, 0.02, 0.6);
    let time = (1000.0 * 1e-9 / 0.072_f64).sqrt();
    scene["liquid"]["march"]["step_s"] = json!(0.03 * time);
    let_go(&scene);
}

/// A drop of four spacings a radius that flattens at once, so that points come in few steps.
pub(super) fn pressed() -> Value {
    let mut scene = drop(1e-3, 1000.0, 0.072, 0.4);
    let time = (1000.0 * 1e-9 / 0.072_f64).sqrt();
    let speed = 1.2 / time;
    let along = [("x", speed), ("y", speed), ("z", -2.0 * speed)];
    scene["liquid"]["velocity_m_s"] = along
        .map(|(axis, v)| json!({"expr": format!("{v:e}*{axis}")}))
        .into();
    scene["liquid"]["viscosity_pa_s"] = json!(0.05 * (1000.0_f64 * 0.072 * 1e-3).sqrt());
    scene["points"]["spacing_m"] = json!(2.5e-4);
    scene
}

#[test]
fn points_come_and_merge_in_a_weak_field_as_without_one() {
    let mut scene = pressed();
    let ends = [
        Value::Null,
        json!({"relative_permittivity": 80, "field_v_m": [0, 0, 1e3]}),
    ]
    .map(|field| {
        let folder = tempfile::tempdir().unwrap();
        scene["liquid"]["electric"] = field;
        let reader = run(folder.path(), &scene);
        let [added, merged] = renewed(folder.path(), "drop-2.run.json");
        assert!(added > 0 && merged > 0, "{added} {merged}");
        column(&reader, "axis_ratio").last().unwrap().1
    });
    assert!((ends[1] / ends[0] - 1.0).abs() < 0.02, "{ends:?}");
}

#[test]
fn threads_and_a_stop_change_no_byte_while_points_come_and_merge() {
    let folder = tempfile::tempdir().unwrap();
    let scene = pressed();
    let files = ["1", "2"].map(|threads| {
        let (code, text, out) = said(folder.path(), &scene, threads);
        assert_eq!(code, 0, "{text}");
        std::fs::read(out).unwrap()
    });
    assert!(files[0] == files[1]);
    let straight = renewed(folder.path(), "drop-2.run.json");
    assert!(straight[0] > 0 && straight[1] > 0, "{straight:?}");
    let (file, out) = (
        folder.path().join("scene.json"),
        folder.path().join("broken.mcap"),
    );
    let command = |more: &[&str]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_emfield"));
        command.arg("run").arg(&file).arg("--out").arg(&out);
        command.args(["--threads", "2", "-q"]).args(more);
        command
    };
    let mut child = command(&["--checkpoint-s", "0.02"]).spawn().unwrap();
    let checkpoint = folder.path().join("broken.mcap.checkpoint");
    let (start, mut taken) = (Instant::now(), 0);
    let mut last = None;
    // Some checkpoints on, when points have begun to merge.
    while taken < 4 && start.elapsed() < Duration::from_secs(60) {
        let now = std::fs::metadata(&checkpoint)
            .and_then(|m| m.modified())
            .ok();
        taken += u32::from(now != last);
        last = now;
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    let code = child.wait().unwrap().code();
    assert_eq!(code, None, "the run must be killed before its end");
    assert!(command(&["--resume"]).status().unwrap().success());
    assert!(files[1] == std::fs::read(&out).unwrap());
    assert_eq!(renewed(folder.path(), "broken.run.json"), straight);
}
