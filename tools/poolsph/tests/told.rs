//! What is lost, missed or not resolved is told, exit 3, and what fast sources do is followed.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::Path;
use std::process::Command;

use artefact::Reader;
use serde_json::{Value, json};

/// A plate of 8 x 8 x 4 mm with more keys.
fn plate(more: &Value) -> Value {
    let mut scene = json!({
        "kind": "poolsph.scene", "version": 2, "title": "A plate",
        "spacing_m": 1e-3, "time": {"step_s": 1e-3, "end_s": 0.02}, "density_kg_m3": 7850,
        "bodies": [{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [8e-3, 8e-3, 4e-3]}}, "state": "solid", "temperature_k": 300}],
        "heat": {"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": 700,
            "melting": {"point_k": 1750, "latent_heat_j_kg": 250e3}},
        "source": {"start_m": [4e-3, 4e-3, 4e-3], "velocity_m_s": [0, 0, 0]},
        "output": {"particles_interval_s": 0.02, "precision": "f64"}
    });
    let more = more.as_object().unwrap().clone();
    scene.as_object_mut().unwrap().extend(more);
    scene
}

/// Runs a scene; its exit code, and what it said.
fn run(folder: &Path, scene: &Value) -> (Option<i32>, String) {
    let path = folder.join("scene.json");
    std::fs::write(&path, scene.to_string()).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_poolsph"))
        .arg("run")
        .arg(&path)
        .arg("--out")
        .arg(folder.join("out.mcap"))
        .args(["--progress", "none"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), said)
}

fn drops(more: &Value) -> Value {
    let mut drops = json!({"radius_m": 1.5e-3, "height_m": 3e-3, "speed_m_s": 1, "temperature_k": 2100,
        "feed_m3_s": 1e-6});
    for (key, value) in more.as_object().unwrap() {
        drops[key] = value.clone();
    }
    json!({"flow": {"viscosity_pa_s": 0.005}, "droplets": drops})
}

#[test]
fn droplets_that_miss_the_metal_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = plate(&drops(&json!({})));
    let (code, said) = run(folder.path(), &scene);
    assert_eq!(code, Some(0), "{said}");
    scene["source"]["start_m"] = json!([0.1, 4e-3, 4e-3]);
    scene["time"]["end_s"] = json!(0.04);
    let (code, said) = run(folder.path(), &scene);
    assert_eq!(code, Some(3), "{said}");
    assert!(said.contains("fallen past the metal"), "{said}");
}

#[test]
fn droplets_that_come_by_a_period_and_hold_more_than_their_balls_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let lumpy = json!({"feed_m3_s": null, "period_s": 0.02});
    let (code, said) = run(folder.path(), &plate(&drops(&lumpy)));
    assert_eq!(code, Some(3), "{said}");
    assert!(
        said.contains("feed_m3_s") && said.contains("19 particles"),
        "{said}"
    );
}

#[test]
fn droplets_that_would_be_born_in_the_metal_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (code, said) = run(folder.path(), &plate(&drops(&json!({"height_m": 1e-3}))));
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("/droplets/height_m"), "{said}");
}

#[test]
fn a_pressure_that_is_not_found_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let told = |sweeps: u32| {
        let column = json!({"box": {"min_m": [0, 0, 4e-3], "max_m": [8e-3, 8e-3, 16e-3]}});
        let plate = plate(&json!({}))["bodies"][0].clone();
        let scene = plate_with(
            &json!([plate, {"shape": column, "state": "liquid", "temperature_k": 2100}]),
            sweeps,
        );
        run(folder.path(), &scene)
    };
    let (code, said) = told(1);
    assert_eq!(code, Some(3), "{said}");
    assert!(said.contains("density_tolerance"), "{said}");
    let (code, said) = told(500);
    assert_eq!(code, Some(0), "{said}");
}

fn plate_with(bodies: &Value, sweeps: u32) -> Value {
    plate(
        &json!({"bodies": bodies, "source": null, "flow": {"viscosity_pa_s": 0.005, "method": "projection",
        "gravity_m_s2": [0, 0, -9.8], "sweeps_min": 1, "sweeps_max": sweeps}}),
    )
}

#[test]
fn heat_faces_without_metal_beside_them_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let faces = |max: f64| {
        let mut scene = plate(&json!({}));
        scene["heat"]["faces"] =
            json!({"min_m": [0, 0, 0], "max_m": [max, 8e-3, 4e-3], "open": ["x+"]});
        run(folder.path(), &scene)
    };
    let (code, said) = faces(8e-3);
    assert_eq!(code, Some(0), "{said}");
    let (code, said) = faces(9.5e-3);
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("/heat/faces/max_m/0") && said.contains("0.008"),
        "{said}"
    );
}

#[test]
fn a_held_temperature_below_nothing_ends_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = plate(&json!({}));
    scene["bodies"][0]["held_temperature_k"] = json!({"expr": "300 - 1e5*t"});
    let (code, said) = run(folder.path(), &scene);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("held temperature"), "{said}");
    scene["bodies"][0]["held_temperature_k"] = json!(-5);
    let (code, said) = run(folder.path(), &scene);
    assert_eq!(code, Some(2), "{said}");
}

#[test]
fn metal_that_freezes_upon_a_wall_of_held_temperature_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let slab = |kelvin: f64| {
        plate(&json!({
            "bodies": [{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [4e-3, 4e-3, 12e-3]}}, "state": "liquid", "temperature_k": 1760}],
            "heat": {"thermal_conductivity_w_m_k": 300, "specific_heat_j_kg_k": 700,
                "melting": {"point_k": 1750, "latent_heat_j_kg": 250e3}},
            "time": {"step_s": 2e-3, "end_s": 0.3},
            "flow": {"viscosity_pa_s": 0.005},
            "faces": {"min_m": [0, 0, 0], "max_m": [4e-3, 4e-3, 12e-3], "mirror": ["x-", "x+", "y-", "y+"],
                "wall": [{"face": "z-", "temperature_k": kelvin}, {"face": "z+"}]}
        }))
    };
    let (code, said) = run(folder.path(), &slab(300.0));
    assert_eq!(code, Some(3), "{said}");
    assert!(
        said.contains("froze beside a wall of held temperature takes no heat"),
        "{said}"
    );
    let (code, said) = run(folder.path(), &slab(1755.0));
    assert_eq!(code, Some(0), "{said}");
}

#[test]
fn an_arc_that_goes_several_spacings_in_a_step_leaves_a_line_and_no_spots() {
    let folder = tempfile::tempdir().unwrap();
    // Without conduction worth the name each particle keeps what fell on it.
    let line = |step: f64| {
        let bar = json!({"box": {"min_m": [0, 0, 0], "max_m": [4e-3, 40e-3, 2e-3]}});
        let scene = plate(&json!({
            "bodies": [{"shape": bar, "state": "solid", "temperature_k": 300}],
            "heat": {"thermal_conductivity_w_m_k": 1e-3, "specific_heat_j_kg_k": 700},
            "time": {"step_s": step, "end_s": 0.04},
            "source": {"start_m": [2e-3, 0, 2e-3], "velocity_m_s": [0, 1, 0]},
            "arc": {"flux_w_m2": {"expr": "1e8*exp(-(r/1.5e-3)^2)"}},
            "output": {"particles_interval_s": 0.04, "precision": "f64"}
        }));
        let (code, said) = run(folder.path(), &scene);
        // Some of it falls beside the bar.
        assert_eq!(code, Some(3), "{said}");
        assert!(
            said.contains("fall on the metal") && said.matches("warning: ").count() == 1,
            "{said}"
        );
        let reader = Reader::open(folder.path().join("out.mcap")).unwrap();
        let frame = reader
            .frame("/particles", reader.count("/particles") - 1)
            .unwrap();
        frame.f64("temperature").unwrap()
    };
    let (whole, divided) = (line(5e-3), line(2.5e-4));
    let rise = |t: &[f64]| t.iter().map(|t| t - 300.0).sum::<f64>();
    assert!((rise(&whole) / rise(&divided) - 1.0).abs() < 0.01);
    let most = divided.iter().fold(0.0_f64, |most, t| most.max(*t)) - 300.0;
    for (a, b) in whole.iter().zip(&divided) {
        assert!((a - b).abs() < 0.05 * most, "{a} K, {b} K, of {most} K");
    }
}

#[test]
fn the_plate_has_the_direction_of_its_torches() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = plate(
        &json!({"time": {"step_s": 1e-3, "end_s": 2e-3}, "torches": [{
        "power_w": 100, "efficiency": 0.8, "shape": {"gaussian": {"radius_m": 2e-3}},
        "path": {"points_m": [[2e-3, 4e-3, 4e-3], [6e-3, 4e-3, 4e-3]], "speed_m_s": 0.01}}]}),
    );
    for at_rest in [true, false] {
        if !at_rest {
            scene.as_object_mut().unwrap().remove("source");
        }
        let (code, said) = run(folder.path(), &scene);
        assert!(matches!(code, Some(0 | 3)), "{said}");
        let reader = Reader::open_kind(folder.path().join("out.mcap"), "particle-frames", 1);
        let plate: Value = reader.unwrap().json_at("/plate", 0).unwrap();
        assert_eq!(plate["direction"], json!([1.0, 0.0, 0.0]));
    }
}
