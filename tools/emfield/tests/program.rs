//! The program: fields of small scenes, and no column of what is absent.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::path::Path;

use artefact::Reader;
use serde_json::{Value, json};

/// Runs a scene as the program does and gives its artefact.
fn run(folder: &Path, scene: &Value) -> Reader {
    let out = folder.join("fields.mcap");
    let file = folder.join("scene.json");
    std::fs::write(&file, scene.to_string()).unwrap();
    let status = std::process::Command::new(env!("CARGO_BIN_EXE_emfield"))
        .args([
            "run",
            file.to_str().unwrap(),
            "--out",
            out.to_str().unwrap(),
        ])
        .args(["--threads", "2", "-q"])
        .status()
        .unwrap();
    assert!(status.success(), "{status}");
    Reader::open_kind(&out, "point-fields", 1).unwrap()
}

fn scene() -> Value {
    json!({"kind": "emfield.scene", "version": 1, "geometry": "space",
        "domain": {"box": {"min_m": [-4, -4, -4], "max_m": [4, 4, 4]}},
        "bodies": [{"name": "ball", "shape": {"sphere": {"centre_m": [0, 0, 0], "radius_m": 1}},
            "relative_permittivity": 1, "conductivity_s_m": 1}],
        "points": {"spacing_m": 0.25}, "output": {"precision": "f64"}})
}

#[test]
fn a_uniform_field_is_exact() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = scene();
    scene["electrostatics"] = json!({"applied_field_v_m": [1, 2, 3]});
    scene["output"]["probes"] = json!([{"name": "p", "place_m": [0.5, 0.3, 1.1]}]);
    scene["output"]["lines"] =
        json!([{"name": "l", "from_m": [0, 0, 0], "to_m": [0, 0, 4], "points": 5}]);
    let reader = run(folder.path(), &scene);
    let frame = reader.frame("/points", 0).unwrap();
    let places = frame.position_vectors().unwrap();
    let v = frame.f64("potential").unwrap();
    for (x, v) in places.iter().zip(v) {
        assert!((v + x[0] + 2.0 * x[1] + 3.0 * x[2]).abs() < 1e-6);
    }
    for e in frame.vectors("electric_field").unwrap() {
        assert!((e[0] - 1.0).abs() + (e[1] - 2.0).abs() + (e[2] - 3.0).abs() < 1e-5);
    }
    for absent in ["volume", "magnetic_flux_density_real_x", "joule_heat"] {
        assert!(!frame.has(absent), "{absent}");
    }
    assert!(reader.frame("/surface", 0).unwrap().has("traction_x"));
    let probes = reader.record("/probes").unwrap();
    assert!((probes.get("p.potential").unwrap() + 0.5 + 0.6 + 3.3).abs() < 1e-6);
    assert!(reader.has("/line/l"));
}

#[test]
fn a_body_that_differs_in_nothing_is_not_there() {
    let folder = tempfile::tempdir().unwrap();
    let methods = [1, 2, 3, 4].map(|order| json!({"order": order}));
    let smeared = json!({"order": 2, "interfaces": {"smeared": {}}});
    for method in methods.into_iter().chain([smeared]) {
        let mut scene = scene();
        scene["points"] = json!({"spacing_m": 0.4});
        scene["method"] = method.clone();
        scene["electrostatics"] = json!({"applied_field_v_m": [1, 2, 3]});
        let reader = run(folder.path(), &scene);
        let frame = reader.frame("/points", 0).unwrap();
        let surface = reader.frame("/surface", 0).unwrap();
        let fields = [
            frame.vectors("electric_field").unwrap(),
            surface.vectors("electric_field_inner").unwrap(),
            surface.vectors("electric_field_outer").unwrap(),
        ];
        for e in fields.concat() {
            let far = (e[0] - 1.0).abs() + (e[1] - 2.0).abs() + (e[2] - 3.0).abs();
            assert!(far < 1e-5, "{method}: {e:?}");
        }
        for pull in surface.vectors("traction").unwrap() {
            assert!(pull.iter().all(|p| p.abs() < 1e-30), "{method}: {pull:?}");
        }
        for axis in ["x", "y", "z"] {
            let force = reader.record("/totals").unwrap();
            let force = force.get(&format!("electric_force_ball_{axis}")).unwrap();
            assert!(force.abs() < 1e-20, "{method}: {force}");
        }
    }
}

#[test]
fn points_on_top_of_each_other_are_refused_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = scene();
    scene["points"] = json!({"spacing_m": 0.5, "extra_m": [[0, 0, 0]]});
    scene["electrostatics"] = json!({"applied_field_v_m": [1, 2, 3]});
    let file = folder.path().join("scene.json");
    std::fs::write(&file, scene.to_string()).unwrap();
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_emfield"))
        .args(["run", file.to_str().unwrap(), "--out"])
        .arg(folder.path().join("fields.mcap"))
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("coincide at [0.0, 0.0, 0.0]"), "{said}");
}

#[test]
fn where_nothing_conducts_there_is_no_current() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = scene();
    scene["bodies"][0]["conductivity_s_m"] = json!(0);
    scene["eddy_currents"] =
        json!({"harmonic": {"frequency_hz": 50}, "applied_flux_density_t": [0, 0, 1]});
    let reader = run(folder.path(), &scene);
    let frame = reader.frame("/points", 0).unwrap();
    for b in frame.vectors("magnetic_flux_density_real").unwrap() {
        assert!(b[0].abs() + b[1].abs() + (b[2] - 1.0).abs() < 1e-9);
    }
    for absent in [
        "current_density_real_x",
        "joule_heat",
        "force_density_x",
        "potential",
    ] {
        assert!(!frame.has(absent), "{absent}");
    }
}

/// A conducting bar of 1 m in a field of 1 T across it, in which `mu sigma w R^2` is 4 at 0.5066 Hz.
fn driven(wave: &Value) -> Value {
    let mut scene = scene();
    scene["geometry"] = json!("plane");
    scene["domain"] = json!({"box": {"min_m": [-3, -3], "max_m": [3, 3]}});
    scene["bodies"][0] = json!({"name": "bar", "conductivity_s_m": 1e6,
        "shape": {"disc": {"centre_m": [0, 0], "radius_m": 1}}});
    // Weights that are to be positive are those of polynomials in a steady state too.
    scene["method"] = json!({"positive": true});
    scene["eddy_currents"] = json!({"applied_flux_density_t": [0, 1, 0], "outer": "multipole"});
    let currents = scene["eddy_currents"].as_object_mut().unwrap();
    currents.extend(wave.as_object().unwrap().clone());
    scene
}

#[test]
fn a_march_comes_to_the_sinusoidal_state() {
    let folder = tempfile::tempdir().unwrap();
    let frequency = 0.5066;
    let steady = run(
        folder.path(),
        &driven(&json!({"harmonic": {"frequency_hz": frequency}})),
    );
    let steady = steady.frame("/points", 0).unwrap();
    // After two periods all that was switched on has died away: the lowest mode lasts 0.3 s.
    let end = 2.0 / frequency;
    let mut scene = driven(&json!({"transient": {"end_s": end, "step_s": end / 200.0,
        "wave": {"expr": format!("cos({} * t)", std::f64::consts::TAU * frequency)}}}));
    scene["output"]["every_s"] = json!(end / 2.0);
    let reader = run(folder.path(), &scene);
    assert_eq!(reader.count("/points"), 3);
    let frame = reader.frame("/points", 2).unwrap();
    assert!((frame.time_s / end - 1.0).abs() < 1e-9);
    for name in [
        "vector_potential",
        "magnetic_flux_density",
        "current_density",
    ] {
        let now = frame.vectors(name).unwrap();
        let then = steady.vectors(&format!("{name}_real")).unwrap();
        let most = then.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
        let far = now.iter().flatten().zip(then.iter().flatten());
        let far = far.fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(
            most > 0.0 && far < 2e-3 * most,
            "{name}: {far:e} of {most:e}"
        );
    }
}

#[test]
fn a_skin_thinner_than_the_spacing_is_told_and_the_field_stays_bounded() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = scene();
    scene["geometry"] = json!("plane");
    scene["domain"] = json!({"sphere": {"centre_m": [0, 0], "radius_m": 0.1}});
    scene["bodies"] = json!([]);
    scene["surroundings"] = json!({"conductivity_s_m": 7.7e6});
    scene["points"] = json!({"spacing_m": 0.01});
    // A skin of 5.7 um.
    scene["eddy_currents"] = json!({"harmonic": {"frequency_hz": 1e9},
        "applied_flux_density_t": [0, 0, 1.2566370614359173e-6]});
    let out = folder.path().join("fields.mcap");
    let file = folder.path().join("scene.json");
    std::fs::write(&file, scene.to_string()).unwrap();
    let status = std::process::Command::new(env!("CARGO_BIN_EXE_emfield"))
        .args(["run", file.to_str().unwrap(), "--out"])
        .args([out.to_str().unwrap(), "-q"])
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(3));
    let record = std::fs::read_to_string(out.with_extension("run.json")).unwrap();
    let record: Value = serde_json::from_str(&record).unwrap();
    assert_eq!(record["outcome"], "warned");
    let told = record["warnings"][0].as_str().unwrap();
    assert!(told.starts_with("unresolved: skin depth"), "{told}");
    let frame = Reader::open(&out).unwrap().frame("/points", 0).unwrap();
    for name in ["magnetic_field_real", "magnetic_field_imag"] {
        for h in frame.f64(name).unwrap() {
            assert!((-1e-3..=1.0 + 1e-9).contains(&h), "{name}: {h}");
        }
    }
}

#[test]
fn frames_of_a_march_come_at_the_very_instants() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = driven(&json!({"transient": {"end_s": 1, "step_s": 0.1}}));
    scene["output"]["at_s"] = json!([0.25, 0.7, 0.73]);
    let reader = run(folder.path(), &scene);
    assert_eq!(
        reader.times("/points").unwrap(),
        [0.0, 0.25, 0.7, 0.73, 1.0]
    );
    scene["output"]["at_s"] = json!([0.25, 2]);
    let file = folder.path().join("late.json");
    std::fs::write(&file, scene.to_string()).unwrap();
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_emfield"))
        .args(["check", file.to_str().unwrap()])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("/output/at_s/1"), "{said}");
}

#[test]
fn a_fault_names_file_line_and_place() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = scene();
    scene["electrostatics"] = json!({"applied_field_v_m": [1, 2, 3]});
    scene["output"]["probes"] = json!([{"name": "p", "place_m": [9, 0, 0]}]);
    let file = folder.path().join("scene.json");
    std::fs::write(&file, serde_json::to_string_pretty(&scene).unwrap()).unwrap();
    let out = folder.path().join("fields.mcap");
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_emfield"))
        .args([
            "run",
            file.to_str().unwrap(),
            "--out",
            out.to_str().unwrap(),
            "-q",
        ])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        said.contains("scene.json:") && said.contains("/output/probes/0/place_m"),
        "{said}"
    );
}

#[test]
fn a_box_less_permittive_than_its_surroundings_has_no_potential_beyond_the_walls() {
    for order in [2, 4] {
        let folder = tempfile::tempdir().unwrap();
        let mut scene = scene();
        scene["bodies"] = json!([{"name": "void", "relative_permittivity": 0.1,
            "shape": {"box": {"min_m": [-1.5, -1, -1], "max_m": [0.1, 1, 1]}}}]);
        scene["method"] = json!({"order": order});
        scene["electrostatics"] = json!({"outer": [{"potential_v": {"expr": "z"}}]});
        let reader = run(folder.path(), &scene);
        let v = reader
            .frame("/points", 0)
            .unwrap()
            .f64("potential")
            .unwrap();
        assert!(v.iter().all(|v| v.abs() <= 4.0 + 1e-9), "order {order}");
    }
}

#[test]
fn electrodes_at_other_potentials_than_what_they_touch_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let ball = |name: &str, z: f64, v: f64| {
        json!({"name": name, "potential_v": v,
        "shape": {"sphere": {"centre_m": [0, 0, z], "radius_m": 1}}})
    };
    for (bodies, said) in [
        (
            json!([ball("a", -3.0, 2.0)]),
            "/bodies/0/potential_v: 2 V touches the wall z- at 0 V at (",
        ),
        (
            json!([ball("a", -1.0, 2.0), ball("b", 1.0, 3.0)]),
            "/bodies/0/potential_v: 2 V touches the electrode b at 3 V at (",
        ),
    ] {
        let mut scene = scene();
        scene["bodies"] = bodies;
        scene["electrostatics"] = json!({"outer": [{"potential_v": 0}]});
        let file = folder.path().join("scene.json");
        std::fs::write(&file, scene.to_string()).unwrap();
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_emfield"))
            .arg("check")
            .arg(&file)
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stderr);
        assert!(
            output.status.code() == Some(2) && text.contains(said),
            "{text}"
        );
    }
}

/// A size of a plan \[byte\]: "460.3 MB".
fn bytes(text: &str) -> f64 {
    let mut words = text.split_whitespace();
    let number: f64 = words.next().unwrap().parse().unwrap();
    let unit = match words.next().unwrap() {
        "B" => 1.0,
        "kB" => 1e3,
        "MB" => 1e6,
        "GB" => 1e9,
        other => panic!("{other}"),
    };
    number * unit
}

#[test]
fn check_tells_the_memory_that_a_run_takes() {
    let folder = tempfile::tempdir().unwrap();
    let mut own = scene();
    own["electrostatics"] = json!({"applied_field_v_m": [1, 2, 3]});
    let march = driven(&json!({"transient": {"end_s": 0.2, "step_s": 0.01}}));
    for (name, scene, spacing) in [
        ("still", &own, 0.12),
        ("direct", &own, 0.3),
        ("march", &march, 0.05),
    ] {
        let mut scene = scene.clone();
        scene["points"]["spacing_m"] = json!(spacing);
        if name == "direct" {
            scene["solver"] = json!({"way": "direct"});
        }
        run(folder.path(), &scene);
        let record = std::fs::read_to_string(folder.path().join("fields.run.json")).unwrap();
        let record: Value = serde_json::from_str(&record).unwrap();
        let taken = record["peak_memory_bytes"].as_f64().unwrap();
        let checked = std::process::Command::new(env!("CARGO_BIN_EXE_emfield"))
            .arg("check")
            .arg(folder.path().join("scene.json"))
            .output()
            .unwrap();
        let said = String::from_utf8(checked.stdout).unwrap();
        let row = |start: &str| {
            said.lines()
                .find_map(|l| l.trim_start().strip_prefix(start))
        };
        let told = bytes(row("memory").unwrap_or_else(|| panic!("{said}")));
        let ratio = told / taken;
        assert!(
            (0.67..1.5).contains(&ratio),
            "{name}: {told} of {taken}: {said}"
        );
        if name == "still" {
            assert!(
                row("weights").is_some() && row("factors").is_some(),
                "{said}"
            );
        }
        assert!(
            row("time").is_some_and(|t| t.contains("about")),
            "{name}: {said}"
        );
    }
}
