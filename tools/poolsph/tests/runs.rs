//! The program as a user meets it: same bytes, columns of the active physics, located faults.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

fn program() -> Command {
    Command::new(env!("CARGO_BIN_EXE_poolsph"))
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

/// A drop that falls into a small tank of liquid on a plate that conducts heat and melts.
fn scene() -> Value {
    json!({
        "kind": "poolsph.scene", "version": 2, "title": "Drop and tank",
        "spacing_m": 5e-4, "time": {"step_s": 1e-4, "end_s": 0.02}, "density_kg_m3": 7850,
        "bodies": [
            {"shape": {"container": {"min_m": [0, 0, 0], "max_m": [4e-3, 4e-3, 4e-3], "thickness_m": 1e-3, "open": ["z+"]}},
             "state": "wall", "temperature_k": 300, "held_temperature_k": {"expr": "300 + 1000*t"}},
            {"shape": {"box": {"min_m": [0, 0, 0], "max_m": [4e-3, 4e-3, 1e-3]}}, "state": "solid", "temperature_k": 1740},
            {"shape": {"box": {"min_m": [0, 0, 1e-3], "max_m": [4e-3, 4e-3, 2.5e-3]}}, "state": "liquid", "temperature_k": 2100},
            {"shape": {"sphere": {"centre_m": [2e-3, 2e-3, 4e-3], "radius_m": 1e-3}}, "state": "liquid",
             "velocity_m_s": [0, 0, -1], "temperature_k": 2300}
        ],
        "flow": {"method": "projection", "viscosity_pa_s": 0.004, "gravity_m_s2": [0, 0, -9.8]},
        "tension": {"surface_tension_n_m": 1.0},
        "heat": {
            "thermal_conductivity_w_m_k": {"t_k": [300, 1750, 3000], "value": [60, 30, 35]},
            "specific_heat_j_kg_k": 700,
            "melting": {"point_k": 1750, "latent_heat_j_kg": 250e3},
            "rest_interval_steps": 4
        },
        "output": {"particles_interval_s": 2e-3, "balance_interval_s": 1e-3, "precision": "f64"}
    })
}

fn write(folder: &Path, name: &str, value: &Value) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, value.to_string()).unwrap();
    path
}

fn run(scene: &Path, out: &Path, more: &[&str]) -> Output {
    program()
        .arg("run")
        .arg(scene)
        .arg("--out")
        .arg(out)
        .args(["--progress", "none"])
        .args(more)
        .output()
        .unwrap()
}

fn finished(scene: &Path, out: &Path, more: &[&str]) -> Vec<u8> {
    let output = run(scene, out, more);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{said}");
    std::fs::read(out).unwrap()
}

fn record(out: &Path) -> Value {
    let text = std::fs::read_to_string(out.with_extension("run.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

fn closing(record: &Value, name: &str) -> f64 {
    let rows = record["closing"].as_array().unwrap();
    let row = rows.iter().find(|row| row["name"] == name);
    row.unwrap_or_else(|| panic!("no '{name}' in {rows:?}"))["value"]
        .as_f64()
        .unwrap()
}

#[test]
fn threads_do_not_show_and_totals_close() {
    let folder = folder();
    let scene = write(folder.path(), "scene.json", &scene());
    let (one, two) = (
        folder.path().join("one.mcap"),
        folder.path().join("two.mcap"),
    );
    let first = finished(&scene, &one, &["--threads", "1"]);
    let second = finished(&scene, &two, &["--threads", "2"]);
    assert!(first == second, "the bytes depend on the number of threads");
    let record = record(&one);
    assert!(closing(&record, "mass_error").abs() < 1e-12);
    assert!(closing(&record, "energy_balance").abs() < 5e-3);
    assert!(closing(&record, "energy_stored_j").abs() > 1.0);
}

/// A short weld with droplets on a small plate.
fn weld() -> Value {
    let mut weld = scene();
    let metal = json!({"min_m": [-4e-3, -4e-3, -2e-3], "max_m": [4e-3, 4e-3, 0]});
    weld["bodies"] = json!([{"shape": {"box": metal}, "state": "solid", "temperature_k": 1500}]);
    weld["source"] = json!({"start_m": [0, -2e-3, 0], "velocity_m_s": [0, 0.05, 0]});
    weld["arc"] = json!({"flux_w_m2": {"expr": "8e7*exp(-(r/1.7e-3)^2)"}});
    weld["flow_start"] = json!({"liquid_particles": 120});
    weld["droplets"] = json!({"feed_m3_s": 1.5e-7, "radius_m": 7.5e-4, "height_m": 4e-3, "speed_m_s": 1.0,
        "temperature_k": 2100});
    weld["time"] = json!({"step_s": 1e-4, "end_s": 0.08});
    weld["output"] = json!({"particles_interval_s": 0.02});
    weld
}

#[test]
fn a_weld_closes_its_energy_while_it_melts_and_flows() {
    let folder = folder();
    let out = folder.path().join("weld.mcap");
    finished(&write(folder.path(), "weld.json", &weld()), &out, &[]);
    let record = record(&out);
    assert_eq!(record["warnings"], json!([]));
    assert!(closing(&record, "energy_balance").abs() < 5e-3);
    assert!(closing(&record, "energy_in_j") > 10.0 && closing(&record, "mass_droplets_kg") > 0.0);
    let liquid = record["history"].as_array().unwrap().iter();
    let liquid = liquid
        .filter(|h| h["name"] == "phase_liquid_particles")
        .flat_map(|h| h["values"].as_array().unwrap())
        .filter_map(Value::as_f64)
        .fold(0.0, f64::max);
    assert!(liquid >= 120.0, "{liquid}");
}

#[test]
fn steps_that_grow_keep_all_times_and_close_the_totals() {
    let folder = folder();
    let mut weld = weld();
    weld["output"] = json!({"particles_interval_s": 3.3e-3, "balance_interval_s": 1e-3,
        "probes": [{"name": "beside", "place_m": [3e-3, 0, -1e-3]}], "probes_interval_s": 7e-4,
        "pool": {"from_s": 0.0503, "interval_s": 1.7e-3, "beside_m": 0.01, "behind_m": 0.01, "ahead_m": 0.01}});
    let run = |name: &str, scene: &Value| {
        let out = folder.path().join(format!("{name}.mcap"));
        let scene = write(folder.path(), &format!("{name}.json"), scene);
        let bytes = finished(&scene, &out, &["--threads", "1"]);
        let again = finished(
            &scene,
            &folder.path().join("again.mcap"),
            &["--threads", "2"],
        );
        assert!(
            bytes == again,
            "{name}: the bytes depend on the number of threads"
        );
        let reader = artefact::Reader::open_kind(&out, "particle-frames", 1).unwrap();
        let times =
            ["/particles", "/pool", "/balance", "/probes"].map(|name| reader.times(name).unwrap());
        (times, record(&out))
    };
    let (even, plain) = run("even", &weld);
    weld["time"]["adaptive"] = json!({"greatest_s": 8e-4});
    let (times, adaptive) = run("adaptive", &weld);
    assert_eq!(even, times);
    let taken = closing(&adaptive, "steps_taken");
    assert!(taken < 0.6 * 800.0 && taken > 100.0, "{taken}");
    assert!(closing(&adaptive, "energy_balance").abs() < 5e-3);
    let [mass, wanted] = [&adaptive, &plain].map(|r| closing(r, "mass_droplets_kg"));
    assert!((mass - wanted).abs() < 1e-12 * wanted, "{mass} {wanted}");
    let [heat, wanted] = [&adaptive, &plain].map(|r| closing(r, "energy_in_j"));
    assert!((heat / wanted - 1.0).abs() < 0.02, "{heat} {wanted}");
}

#[test]
fn an_interrupted_run_ends_in_the_same_bytes() {
    interrupted(&json!({"step_s": 1e-4, "end_s": 0.1}));
}

#[test]
fn an_interrupted_run_whose_steps_grow_ends_in_the_same_bytes() {
    interrupted(&json!({"step_s": 2.5e-5, "end_s": 0.1, "adaptive": {"greatest_s": 1e-4}}));
}

/// Starts a run, lets it take some steps, interrupts it and takes it up.
fn interrupted(time: &Value) {
    let folder = folder();
    let mut long = scene();
    long["time"] = time.clone();
    let scene = write(folder.path(), "scene.json", &long);
    let whole = finished(&scene, &folder.path().join("whole.mcap"), &[]);
    let out = folder.path().join("broken.mcap");
    let mut child = program()
        .arg("run")
        .arg(&scene)
        .arg("--out")
        .arg(&out)
        .args(["--progress", "none"])
        .spawn()
        .unwrap();
    // The first balance records are on their way once the file exists; then a little more.
    let part = folder.path().join("broken.mcap.part");
    let start = Instant::now();
    while !part.exists() && start.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(150));
    let pid = child.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-INT", &pid])
            .status()
            .unwrap()
            .success()
    );
    let code = child.wait().unwrap().code();
    assert_eq!(
        code,
        Some(130),
        "the run must be interrupted before its end"
    );
    let resumed = finished(&scene, &out, &["--resume"]);
    assert!(whole == resumed, "the resumed run differs");
}

#[test]
fn absent_physics_has_no_column() {
    let folder = folder();
    let mut cold = scene();
    let map = cold.as_object_mut().unwrap();
    map.remove("heat");
    map.remove("tension");
    cold["bodies"][0]
        .as_object_mut()
        .unwrap()
        .remove("held_temperature_k");
    cold["time"]["end_s"] = json!(1e-3);
    let scene = write(folder.path(), "scene.json", &cold);
    let out = folder.path().join("cold.mcap");
    finished(&scene, &out, &[]);
    let reader = artefact::Reader::open_kind(&out, "particle-frames", 1).unwrap();
    let frame = reader
        .frames("/particles")
        .unwrap()
        .next()
        .unwrap()
        .unwrap();
    let names: Vec<&str> = frame.columns().iter().map(|c| c.name.as_str()).collect();
    let expected = [
        "x",
        "y",
        "z",
        "velocity_x",
        "velocity_y",
        "velocity_z",
        "pressure",
        "molten",
        "wall",
        "id",
    ];
    assert_eq!(names, expected);
    let left_out = record(&out)["left_out"].to_string();
    assert!(
        left_out.contains("heat") && left_out.contains("tension"),
        "{left_out}"
    );
}

#[test]
fn faults_of_a_scene_are_told_together_and_located() {
    let folder = folder();
    let mut bad = scene();
    bad["bodies"][1]["temperature_k"] = json!(1900);
    let path = write(folder.path(), "warm.json", &bad);
    let output = run(&path, &folder.path().join("out.mcap"), &[]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2));
    assert!(
        said.contains("/bodies/1/temperature_k") && said.contains("1750"),
        "{said}"
    );

    let mut bad = scene();
    bad["bodies"][0]["state"] = json!("solid");
    bad["bodies"][2]["velocity_m_s"] = json!([0, 0]);
    bad["tensions"] = json!({});
    let path = write(folder.path(), "keys.json", &bad);
    let output = run(&path, &folder.path().join("out.mcap"), &[]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2));
    assert!(
        said.contains("tension") && said.contains("/bodies/2/velocity_m_s"),
        "{said}"
    );

    let mut bad = scene();
    bad["bodies"][0]["state"] = json!("solid");
    bad["time"]["end_s"] = json!(1e-9);
    bad["smoothing_length_m"] = json!(1e-4);
    let path = write(folder.path(), "sense.json", &bad);
    let output = run(&path, &folder.path().join("out.mcap"), &[]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2));
    for path in ["/bodies/0/state", "/time/end_s", "/smoothing_length_m"] {
        assert!(said.contains(path), "{said}");
    }

    // The scene has tension, which is calibrated for one ratio only.
    let mut wide = scene();
    wide["smoothing_length_m"] = json!(1.2 * wide["spacing_m"].as_f64().unwrap());
    let path = write(folder.path(), "wide.json", &wide);
    let output = run(&path, &folder.path().join("out.mcap"), &[]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("calibrated for 1 only"), "{said}");

    // Tension by curvature is calibrated for none.
    wide["flow"]["method"] = json!("divergence_free");
    wide["time"]["end_s"] = json!(2e-4);
    let path = write(folder.path(), "free.json", &wide);
    let output = run(&path, &folder.path().join("out.mcap"), &[]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{said}");
}

#[test]
fn divergence_names_step_place_and_quantity() {
    let folder = folder();
    let mut wild = scene();
    wild["bodies"][3]["velocity_m_s"] = json!([0, 0, -1e4]);
    let scene = write(folder.path(), "wild.json", &wild);
    let out = folder.path().join("wild.mcap");
    let output = run(&scene, &out, &[]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("speed") && said.contains("particle"),
        "{said}"
    );
    let record = record(&out);
    assert_eq!(record["outcome"], "diverged");
    assert!(!out.exists(), "a diverged run must not look finished");
}

#[test]
fn the_schema_on_disk_is_that_of_the_program() {
    let output = program().arg("schema").output().unwrap();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../schemas/poolsph.scene.v2.json");
    let kept = std::fs::read_to_string(path).unwrap();
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(kept == printed, "run `make schemas`");
}

#[test]
fn the_last_state_is_written_whatever_the_intervals_and_the_step() {
    let folder = folder();
    let mut short = scene();
    short["output"] = json!({"particles_interval_s": 3.5e-4, "balance_interval_s": 4e-4});
    for (name, step, end) in [("even", 1e-4, 1e-3), ("uneven", 3e-4, 1e-3)] {
        short["time"] = json!({"step_s": step, "end_s": end});
        let path = write(folder.path(), &format!("{name}.json"), &short);
        let out = folder.path().join(format!("{name}.mcap"));
        finished(&path, &out, &[]);
        let reader = artefact::Reader::open_kind(&out, "particle-frames", 1).unwrap();
        for channel in ["/particles", "/balance"] {
            let last = reader.times(channel).unwrap().last().copied().unwrap();
            assert!((last / end - 1.0).abs() < 1e-6, "{name} {channel}: {last}");
        }
    }
}

#[test]
fn beside_faces_threads_do_not_show_and_totals_close() {
    let folder = folder();
    let hot = json!({"expr": "2100 + 1e5*x"});
    let layer = json!({
        "kind": "poolsph.scene", "version": 2, "title": "A layer between faces",
        "spacing_m": 5e-4, "time": {"step_s": 2e-4, "end_s": 0.02}, "density_kg_m3": 7850,
        "bodies": [{
            "shape": {"box": {"min_m": [0, 0, 0], "max_m": [4e-3, 3e-3, 2e-3]}}, "state": "liquid", "temperature_k": hot,
            "velocity_m_s": [0, 0, {"expr": "0.1*sin(2000*y)"}]
        }],
        "faces": {
            "min_m": [0, 0, 0], "max_m": [4e-3, 3e-3, 4e-3], "periodic": ["y"], "mirror": ["x-"],
            "wall": [{"face": "x+", "velocity_m_s": [0, 0.1, 0], "temperature_k": 2000}, {"face": "z-", "temperature_k": hot}]
        },
        "flow": {"method": "projection", "viscosity_pa_s": 0.02, "gravity_m_s2": [0, 0, -9.8]},
        "tension": {"surface_tension_n_m": 1.0},
        "marangoni": {"slope_n_m_k": -1e-4},
        "surface_stress": {"stress_pa": [0, 5, 0]},
        "heat": {"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": 700},
        "output": {"particles_interval_s": 5e-3, "precision": "f64"}
    });
    let scene = write(folder.path(), "layer.json", &layer);
    let (one, two) = (
        folder.path().join("one.mcap"),
        folder.path().join("two.mcap"),
    );
    let first = finished(&scene, &one, &["--threads", "1"]);
    assert_eq!(first, finished(&scene, &two, &["--threads", "2"]));
    let record = record(&one);
    assert!(closing(&record, "energy_balance").abs() < 1e-9);
    assert!(closing(&record, "energy_out_walls_j") > 0.0);
}

#[test]
fn faces_off_the_bodies_are_refused_by_name() {
    let folder = folder();
    let told = |faces: Value, more: Value| {
        let mut scene = scene();
        scene["bodies"] = json!([{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [4e-3, 4e-3, 4e-3]}}, "state": "liquid",
            "temperature_k": 2000}]);
        scene["faces"] = faces;
        for (key, value) in more.as_object().unwrap() {
            scene[key] = value.clone();
        }
        let path = write(folder.path(), "faces.json", &scene);
        let output = run(&path, &folder.path().join("out.mcap"), &[]);
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let off = json!({"min_m": [-1e-3, 0, 0], "max_m": [4e-3, 4e-3, 1], "mirror": ["x-"]});
    let said = told(off, json!({}));
    assert!(
        said.contains("/faces/min_m/0") && said.contains("the mirror 'x-'"),
        "{said}"
    );
    let high = json!({"min_m": [0, 0, 0], "max_m": [4e-3, 4e-3, 5e-3], "lid": ["z+"]});
    let said = told(high, json!({"tension": null}));
    assert!(
        said.contains("/faces/max_m/2") && said.contains("the lid 'z+'"),
        "{said}"
    );
    let held = json!({"min_m": [0, 0, 0], "max_m": [4e-3, 4e-3, 1], "wall": [{"face": "z-", "temperature_k": 300}]});
    let solid = json!({"shape": {"box": {"min_m": [5e-3, 0, 0], "max_m": [6e-3, 1e-3, 1e-3]}}, "state": "solid",
        "temperature_k": 300});
    let bodies = json!([{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [4e-3, 4e-3, 4e-3]}}, "state": "liquid",
        "temperature_k": 2000}, solid]);
    let said = told(held.clone(), json!({ "bodies": bodies }));
    assert!(said.contains("/faces/wall/0/temperature_k"), "{said}");
    let said = told(
        held,
        json!({"flow": {"viscosity_pa_s": 0.004, "method": "homogenising"}}),
    );
    assert!(said.contains("/flow/method"), "{said}");
}

#[test]
fn an_arc_and_a_torch_that_give_nothing_are_told() {
    let folder = folder();
    let told = |key: &str, value: Value| {
        let mut plate = json!({
            "kind": "poolsph.scene", "version": 2, "title": "A plate",
            "spacing_m": 1e-3, "time": {"step_s": 1e-3, "end_s": 0.01}, "density_kg_m3": 7850,
            "bodies": [{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [8e-3, 8e-3, 4e-3]}}, "state": "solid", "temperature_k": 300}],
            "heat": {"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": 700},
            "source": {"start_m": [4e-3, 4e-3, 4e-3], "velocity_m_s": [0, 0, 0]},
            "output": {"particles_interval_s": 0.01}
        });
        plate[key] = value;
        if key == "arcs" {
            plate["arc"] = json!({"flux_w_m2": {"expr": "1e6*exp(-(r/1e-3)^2)"}});
        }
        let path = write(folder.path(), "plate.json", &plate);
        let output = run(&path, &folder.path().join("plate.mcap"), &[]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code(), said)
    };
    let (code, said) = told("arcs", json!([{"offset_m": [1, 0, 0]}]));
    assert_eq!(code, Some(3), "{said}");
    assert!(said.contains("no heat at all"), "{said}");
    let late = json!([{"power_w": 100, "shape": {"gaussian": {"radius_m": 2e-3}},
        "path": {"points_m": [[4e-3, 4e-3, 4e-3]], "start_s": 1}}]);
    let (code, said) = told("torches", late);
    assert_eq!(code, Some(3), "{said}");
    assert!(
        said.contains("torches/0") && said.contains("from 1 s on"),
        "{said}"
    );
    let (code, said) = told("arcs", json!([{}]));
    assert_eq!(code, Some(0), "{said}");
}
