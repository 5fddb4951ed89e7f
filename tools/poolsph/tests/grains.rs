//! Grains as a user meets them: what is kept is kept, threads and interruptions do not show, and what is not there costs nothing.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

fn command(scene: &Path, out: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_poolsph"));
    command.arg("run").arg(scene).arg("--out").arg(out);
    command.args(["--progress", "none"]).args(more);
    command
}

fn finished(scene: &Value, name: &str, folder: &Path, more: &[&str]) -> Vec<u8> {
    let path = folder.join("scene.json");
    std::fs::write(&path, scene.to_string()).unwrap();
    let out = folder.join(name);
    let output = command(&path, &out, more).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    std::fs::read(out).unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Two clouds of grains of two sizes that run into each other.
fn clouds() -> Value {
    let cloud = |x: f64, radius: f64, u: f64| {
        json!({"shape": {"sphere": {"centre_m": [x, 1e-3, 0.0], "radius_m": 4e-3}}, "radius_m": radius,
               "spacing_m": 2.3 * radius, "jitter": 0.05, "velocity_m_s": [u, 0.1, 0.0], "spin_rad_s": [0.0, 30.0, 200.0]})
    };
    json!({
        "kind": "poolsph.scene", "version": 2, "title": "Two clouds",
        "time": {"step_s": 1e-4, "end_s": 0.02},
        "grains": {
            "density_kg_m3": 2500,
            "contact": {
                "law": {"linear": {"stiffness_n_m": 200, "tangential_ratio": 0.8}},
                "restitution": 0.6, "friction": 0.4, "rolling": {"coefficient": 0.1}
            },
            "bodies": [cloud(-4e-3, 0.5e-3, 0.5), cloud(4.3e-3, 0.8e-3, -0.4)]
        },
        "output": {"particles_interval_s": 1e-3, "precision": "f64"}
    })
}

/// Grains that fall into a shaken box.
fn shaken() -> Value {
    let mut scene = clouds();
    scene["grains"]["gravity_m_s2"] = json!([0.0, 0.0, -9.81]);
    scene["grains"]["walls"] = json!([{
        "shape": {"box": {"min_m": [-9e-3, -4e-3, -5e-3], "max_m": [9e-3, 6e-3, 5e-3]}}, "hollow": true,
        "velocity_m_s": [{"expr": "0.05*sin(300*t)"}, 0, 0]
    }]);
    scene["time"]["end_s"] = json!(0.03);
    scene
}

#[test]
fn momentum_and_angular_momentum_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    for law in [
        json!({"linear": {"stiffness_n_m": 200, "tangential_ratio": 0.8}}),
        json!({"linear": null, "hertz": {"youngs_modulus_pa": 1e7, "poisson_ratio": 0.3}}),
    ] {
        let mut scene = clouds();
        let map = law
            .as_object()
            .unwrap()
            .iter()
            .filter(|(_, v)| !v.is_null());
        scene["grains"]["contact"]["law"] =
            Value::Object(map.map(|(k, v)| (k.clone(), v.clone())).collect());
        finished(&scene, "clouds.mcap", folder.path(), &[]);
        let reader = artefact::Reader::open(folder.path().join("clouds.mcap")).unwrap();
        let records = reader.records("/grains_balance").unwrap();
        let (first, last) = (&records[0].1, &records[records.len() - 1].1);
        let energy = |r: &artefact::Record| {
            r.get("kinetic_energy_j").unwrap() + r.get("rotational_energy_j").unwrap()
        };
        assert!(energy(last) < 0.7 * energy(first), "the clouds hardly met");
        let mass = first.get("mass_kg").unwrap();
        for axis in ["x", "y", "z"] {
            let change = |name: &str| {
                let name = format!("{name}_{axis}");
                (last.get(&name).unwrap() - first.get(&name).unwrap()).abs()
            };
            assert!(
                change("momentum") < 1e-10 * mass * 0.5,
                "{axis}: {:e}",
                change("momentum")
            );
            let turning = change("angular_momentum");
            assert!(turning < 1e-10 * mass * 0.5 * 4e-3, "{axis}: {turning:e}");
        }
        assert!((last.get("mass_kg").unwrap() / mass - 1.0).abs() < 1e-12);
    }
}

#[test]
fn threads_do_not_show() {
    let folder = tempfile::tempdir().unwrap();
    let one = finished(&shaken(), "one.mcap", folder.path(), &["--threads", "1"]);
    for threads in ["2", "3"] {
        let more = finished(
            &shaken(),
            "more.mcap",
            folder.path(),
            &["--threads", threads],
        );
        assert!(one == more, "the bytes depend on the number of threads");
    }
}

#[test]
fn an_interrupted_run_ends_in_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = shaken();
    scene["time"]["end_s"] = json!(0.1);
    scene["grains"]["bounds"] =
        json!({"min_m": [-1e-1, -1e-1, -1e-1], "max_m": [1e-1, 1e-1, 3e-3]});
    let whole = finished(&scene, "whole.mcap", folder.path(), &[]);
    let (path, out) = (
        folder.path().join("scene.json"),
        folder.path().join("broken.mcap"),
    );
    let mut child = command(&path, &out, &["--checkpoint-s", "0.02"])
        .spawn()
        .unwrap();
    let checkpoint = folder.path().join("broken.mcap.checkpoint");
    let start = Instant::now();
    while !checkpoint.exists() && start.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    let code = child.wait().unwrap().code();
    assert_eq!(code, None, "the run must be killed before its end");
    let resumed = finished(&scene, "broken.mcap", folder.path(), &["--resume"]);
    assert!(whole == resumed, "the resumed run differs");
}

#[test]
fn a_scene_of_nothing_is_refused_and_so_is_metal_without_its_lattice() {
    let folder = tempfile::tempdir().unwrap();
    let told = |scene: &Value| {
        let path = folder.path().join("scene.json");
        std::fs::write(&path, scene.to_string()).unwrap();
        let output = command(&path, &folder.path().join("out.mcap"), &[])
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2));
        said(&output)
    };
    let mut nothing = clouds();
    nothing.as_object_mut().unwrap().remove("grains");
    assert!(told(&nothing).contains("nothing is there"));
    let mut metal = clouds();
    metal["bodies"] =
        json!([{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [1, 1, 1]}}, "state": "solid"}]);
    let said = told(&metal);
    assert!(
        said.contains("'spacing_m'") && said.contains("'density_kg_m3'"),
        "{said}"
    );
    let mut tight = clouds();
    tight["grains"]["bodies"][0]["spacing_m"] = json!(0.9e-3);
    assert!(told(&tight).contains("within each other"));
    // A wall throws out what begins inside it, and a step of the run never ends.
    let mut buried = clouds();
    buried["grains"]["walls"] = json!([
        {"shape": {"box": {"min_m": [9, 9, 9], "max_m": [9.1, 9.1, 9.1]}}, "hollow": true}
    ]);
    let said = told(&buried);
    assert!(
        said.contains("/grains/walls/0") && said.contains("wholly inside this wall"),
        "{said}"
    );
}

#[test]
fn a_bed_settles_and_a_later_scene_takes_it() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = shaken();
    let walls = scene["grains"]["walls"][0].as_object_mut().unwrap();
    walls.remove("velocity_m_s");
    scene["grains"]["bodies"] = json!([{"shape": {"box": {"min_m": [-4e-3, -4e-3, -5e-3], "max_m": [4e-3, 4e-3, 0]}},
        "radius_m": 0.6e-3, "jitter": 0.02, "spacing_m": 1.3e-3}]);
    scene["grains"]["until"] = json!({"speed_m_s": 3e-3, "held_s": 2e-3});
    scene["time"]["end_s"] = json!(1.0);
    finished(&scene, "bed.mcap", folder.path(), &[]);
    let last = |name: &str| {
        let reader = artefact::Reader::open(folder.path().join(name)).unwrap();
        let frames = reader.count("/grains");
        reader.frame("/grains", frames - 1).unwrap()
    };
    let bed = last("bed.mcap");
    assert!(bed.time_s < 0.9, "the grains never rest");
    scene["grains"]["bodies"] = json!([{"bed": true}]);
    scene["grains"].as_object_mut().unwrap().remove("until");
    scene["time"]["end_s"] = json!(1e-2);
    let input = format!("bed={}", folder.path().join("bed.mcap").display());
    finished(&scene, "later.mcap", folder.path(), &["--input", &input]);
    let later = last("later.mcap");
    assert_eq!(later.len(), bed.len());
    let (then, now) = (
        bed.position_vectors().unwrap(),
        later.position_vectors().unwrap(),
    );
    for (x, y) in then.iter().zip(&now) {
        assert!((0..3).all(|k| (x[k] - y[k]).abs() < 0.6e-4), "{x:?} {y:?}");
    }
}

/// Four layers of grains along a trough, and a stone that falls on one end of them at 0.03 s.
fn layers_and_stone() -> Value {
    let mut scene = shaken();
    scene["grains"]["walls"] = json!([
        {"shape": {"box": {"min_m": [0, 0, 0], "max_m": [4e-2, 1e-2, 0.1]}}, "hollow": true}
    ]);
    scene["grains"]["bodies"] = json!([
        {"shape": {"box": {"min_m": [0, 0, 0], "max_m": [4e-2, 1e-2, 4e-3]}}, "radius_m": 0.5e-3},
        {"places_m": [[3.1e-3, 4.8e-3, 1.5e-2]], "radius_m": 0.7e-3, "velocity_m_s": [0, 0, -0.3]}
    ]);
    scene["time"]["end_s"] = json!(0.06);
    scene["output"] = json!({"particles_interval_s": 1e-2, "precision": "f64"});
    scene
}

fn asleep(mut scene: Value) -> Value {
    scene["grains"]["sleep"] = json!({"speed_m_s": 2.5e-4, "held_s": 2e-3});
    scene
}

fn closing(folder: &Path, name: &str, figure: &str) -> f64 {
    let text = std::fs::read_to_string(folder.join(name).with_extension("run.json")).unwrap();
    let record: Value = serde_json::from_str(&text).unwrap();
    let figures = record["closing"].as_array().unwrap();
    let found = figures.iter().find(|f| f["name"] == figure);
    found.unwrap()["value"].as_f64().unwrap()
}

fn places(folder: &Path, name: &str, frame: usize) -> Vec<[f64; 3]> {
    let reader = artefact::Reader::open(folder.join(name)).unwrap();
    reader
        .frame("/grains", frame)
        .unwrap()
        .position_vectors()
        .unwrap()
}

#[test]
fn what_rests_sleeps_until_it_is_hit_and_lies_where_it_would_have_lain() {
    let folder = tempfile::tempdir().unwrap();
    finished(&layers_and_stone(), "awake.mcap", folder.path(), &[]);
    finished(
        &asleep(layers_and_stone()),
        "asleep.mcap",
        folder.path(),
        &[],
    );
    let share = closing(folder.path(), "asleep.mcap", "grain_moved_share");
    assert!(
        share < 0.4,
        "only {share} of the grains were moved, in the mean"
    );
    // Before the stone comes, and when it has come.
    let reader = artefact::Reader::open(folder.path().join("awake.mcap")).unwrap();
    let (then, last) = (2, reader.count("/grains") - 1);
    let apart = |frame: usize| {
        let awake = places(folder.path(), "awake.mcap", frame);
        let asleep = places(folder.path(), "asleep.mcap", frame);
        let far = awake
            .iter()
            .zip(&asleep)
            .map(|(x, y)| (0..3).map(|k| (x[k] - y[k]).powi(2)).sum::<f64>().sqrt());
        far.fold(0.0, f64::max)
    };
    assert!(apart(then) < 1e-6, "{:e} m", apart(then));
    assert!(apart(last) < 1e-4, "{:e} m", apart(last));
    let (before, after) = (
        places(folder.path(), "asleep.mcap", then),
        places(folder.path(), "asleep.mcap", last),
    );
    let moved = before.iter().zip(&after).take(1600);
    let moved = moved.filter(|(x, y)| (x[2] - y[2]).abs() > 1e-6).count();
    assert!(moved > 3, "the stone moved {moved} grains");
    assert!(after[1600][2] < 8e-3, "the stone still flies");
}

#[test]
fn sleep_hangs_on_no_thread_and_is_kept_where_a_run_is_interrupted() {
    let folder = tempfile::tempdir().unwrap();
    let scene = asleep(layers_and_stone());
    let whole = finished(&scene, "whole.mcap", folder.path(), &["--threads", "1"]);
    let more = finished(&scene, "more.mcap", folder.path(), &["--threads", "3"]);
    assert!(whole == more, "the bytes depend on the number of threads");
    let (path, out) = (
        folder.path().join("scene.json"),
        folder.path().join("broken.mcap"),
    );
    let mut child = command(&path, &out, &["--checkpoint-s", "0.3"])
        .spawn()
        .unwrap();
    // Some have gone to sleep by then.
    let checkpoint = folder.path().join("broken.mcap.checkpoint");
    let start = Instant::now();
    while !checkpoint.exists() && start.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let resumed = finished(&scene, "broken.mcap", folder.path(), &["--resume"]);
    assert!(whole == resumed, "the resumed run differs");
}

/// Layers that conduct, hot at one end; heat of what sleeps goes once in `interval` steps.
fn conducting_layers(interval: u32) -> Value {
    let mut scene = asleep(layers_and_stone());
    scene["grains"]["bodies"][0]["temperature_k"] = json!({"expr": "600 + 1e4*x"});
    scene["grains"]["bodies"][1]["temperature_k"] = json!(600);
    scene["grains"]["heat"] = json!({"thermal_conductivity_w_m_k": 20.2, "specific_heat_j_kg_k": 1000,
        "gas_conductivity_w_m_k": 1.0});
    scene["grains"]["sleep"]["heat_interval_steps"] = json!(interval);
    scene
}

#[test]
fn heat_of_what_sleeps_goes_in_longer_steps_and_none_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    let mut found = Vec::new();
    for interval in [1, 20] {
        let name = format!("{interval}.mcap");
        finished(&conducting_layers(interval), &name, folder.path(), &[]);
        let reader = artefact::Reader::open(folder.path().join(&name)).unwrap();
        let asleep = closing(folder.path(), &name, "grain_asleep");
        assert!(asleep > 100.0, "{asleep} grains sleep at the end");
        let temperature = |frame: usize| -> Vec<f64> {
            let frame = reader.frame("/grains", frame).unwrap();
            frame.f64("temperature").unwrap()
        };
        let (first, last) = (temperature(0), temperature(reader.count("/grains") - 1));
        // The stone has the other mass, and the temperature that most of its heat is counted from.
        let heat = |t: &[f64]| {
            let stone = 2.744 * (t[1600] - 600.0);
            t[..1600].iter().map(|t| t - 600.0).sum::<f64>() + stone
        };
        let lost = heat(&last) / heat(&first) - 1.0;
        assert!(lost.abs() < 1e-12, "{lost:e} of the heat is lost");
        found.push(last);
    }
    let apart = found[0].iter().zip(&found[1]).map(|(t, u)| (t - u).abs());
    let apart = apart.fold(0.0, f64::max);
    assert!((1e-9..2.0).contains(&apart), "{apart} K of 400");
}

#[test]
fn a_rest_so_short_that_falling_passes_for_it_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = layers_and_stone();
    scene["grains"]["until"] = json!({"speed_m_s": 0.06, "held_s": 2e-3});
    let path = folder.path().join("scene.json");
    std::fs::write(&path, scene.to_string()).unwrap();
    let run = command(&path, &folder.path().join("out.mcap"), &[])
        .output()
        .unwrap();
    let said = said(&run);
    assert_eq!(run.status.code(), Some(2), "{said}");
    assert!(
        said.contains("/grains/until/held_s") && said.contains("0.012"),
        "{said}"
    );
}
