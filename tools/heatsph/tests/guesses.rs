//! First guesses of steady states, and temperatures that are none.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::process::Command;

use serde_json::{Value, json};

/// A bar, 0.1 m long, of 10 W/(m K), into which 1000 W/m2 flow on one side and radiate to 0 K on the other.
fn bar(guess: &Value) -> Value {
    json!({
        "kind": "heatsph.scene", "version": 1, "dimensions": 2,
        "body": {"box": {"min_m": [0, 0], "max_m": [0.1, 0.03]}},
        "points": {"spacing_m": 0.005},
        "materials": [{"name": "b", "density_kg_m3": 1000, "specific_heat_j_kg_k": 1000, "conductivity_w_m_k": 10}],
        "initial_temperature_k": guess,
        "boundaries": [
            {"on": ["x-"], "heat_flux_w_m2": 1000},
            {"on": ["x+"], "radiation": {"emissivity": 1.0, "surroundings_k": 0}}
        ],
        "steady": {},
        "output": {"monitors": [{"name": "hot", "place_m": [0, 0.015]}, {"name": "cold", "place_m": [0.1, 0.015]}]}
    })
}

fn run(command: &str, scene: &Value) -> (Option<i32>, Vec<f64>, String) {
    let folder = tempfile::tempdir().unwrap();
    let [path, out] = ["scene.json", "out.mcap"].map(|name| folder.path().join(name));
    std::fs::write(&path, scene.to_string()).unwrap();
    let mut program = Command::new(env!("CARGO_BIN_EXE_heatsph"));
    program.arg(command).arg(&path);
    if command == "run" {
        program
            .arg("--out")
            .arg(&out)
            .args(["--progress", "none", "--threads", "1"]);
    }
    let output = program.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let mut values = Vec::new();
    if output.status.code() == Some(0) && command == "run" {
        let file = artefact::Reader::open(&out).unwrap();
        let (_, record) = file.records("/monitors").unwrap().remove(0);
        values = ["hot", "cold"]
            .map(|name| record.get(name).unwrap())
            .to_vec();
    }
    (output.status.code(), values, said)
}

#[test]
fn a_steady_state_that_a_loose_tolerance_ends_is_told_as_not_converged() {
    let ended = |tolerance: f64| {
        let mut scene = bar(&json!(300.0));
        scene["steady"] = json!({"tolerance": tolerance});
        let (code, _, said) = run("run", &scene);
        (code, said.contains("not converged"))
    };
    assert_eq!(ended(1e-9), (Some(0), false));
    assert_eq!(ended(1e-2), (Some(3), true));
}

#[test]
fn a_radiating_bar_is_found_from_any_guess() {
    let cold = (1000.0 / 5.670_374_419e-8_f64).powf(0.25);
    for guess in [1e-6, 1e-3, 1.0, 2.7, 10.0, 300.0, 3e3, 1e6, 1e12] {
        let (code, values, said) = run("run", &bar(&json!(guess)));
        assert_eq!(code, Some(0), "{guess} K: {said}");
        for (value, exact) in values.iter().zip([cold + 10.0, cold]) {
            assert!(
                (value / exact - 1.0).abs() < 1e-9,
                "{guess} K: {value} of {exact}"
            );
        }
    }
}

#[test]
fn temperatures_below_zero_are_refused_with_their_place() {
    let patch = |at: &str, value: Value| {
        let mut scene = bar(&json!(300));
        *scene.pointer_mut(at).unwrap() = value;
        scene
    };
    let held = json!({"on": ["x-"], "temperature_k": -5});
    let robin = json!({"on": ["x-"], "convection": {"coefficient_w_m2_k": 10, "ambient_k": -5}});
    let field = json!({"expr": "20 - 1000*x"});
    for (at, value, place) in [
        (
            "/initial_temperature_k",
            json!(-40),
            "/initial_temperature_k",
        ),
        (
            "/initial_temperature_k",
            field.clone(),
            "/initial_temperature_k",
        ),
        ("/boundaries/0", held, "/boundaries/0/temperature_k"),
        (
            "/boundaries/0",
            json!({"on": ["y+"], "temperature_k": field}),
            "/boundaries/0",
        ),
        ("/boundaries/0", robin, "/boundaries/0/convection/ambient_k"),
        (
            "/boundaries/1/radiation/surroundings_k",
            json!(-270),
            "/boundaries/1/radiation/surroundings_k",
        ),
    ] {
        let (code, _, said) = run("check", &patch(at, value));
        assert_eq!(code, Some(2), "{place}: {said}");
        assert!(
            said.contains(place) && said.contains(" K"),
            "{place}: {said}"
        );
    }
}

#[test]
fn what_is_colder_than_nothing_ends_with_its_place() {
    // 1000 J/(kg K) of 1000 kg/m3, 0.1 m long: 1e6 W/m2 take 10 K in a second, and all by 30 s.
    let taken = json!({"on": ["x-"], "heat_flux_w_m2": -1e6});
    let held = json!({"on": ["x+"], "temperature_k": 300});
    for (way, march) in [
        ("steady", json!({})),
        ("time", json!({"end_s": 100, "implicit": {"step_s": 1}})),
        ("time", json!({"end_s": 100, "implicit": {}})),
        ("time", json!({"end_s": 100, "stabilised": {}})),
        ("time", json!({"end_s": 100, "explicit": {}})),
    ] {
        let mut scene = bar(&json!(300));
        scene["boundaries"] = json!([taken, held]);
        scene.as_object_mut().unwrap().remove("steady");
        scene[way] = march.clone();
        let (code, _, said) = run("run", &scene);
        assert_eq!(code, Some(1), "{march}: {said}");
        assert!(
            said.contains("K is below 0 K") && said.contains(" at (0.0000e0, "),
            "{march}: {said}"
        );
        // A hundredth of it leaves the bar warm: 300 K less 1e4 W/m2 over 0.1 m of 10 W/(m K).
        scene["boundaries"][0]["heat_flux_w_m2"] = json!(-1e4);
        let (code, values, said) = run("run", &scene);
        assert_eq!(code, Some(0), "{march}: {said}");
        assert!(
            values[0] > 199.0 && values[0] < 301.0,
            "{march}: {values:?}"
        );
    }
}

#[test]
fn what_cools_to_nothing_ends_near_it_and_is_not_blamed_on_a_flux() {
    for coefficient in [1e3, 1e6] {
        for march in [
            json!({"implicit": {}}),
            json!({"implicit": {"tolerance": 1e-2}}),
            json!({"stabilised": {"step_s": 20}}),
        ] {
            let mut scene = bar(&json!(300));
            let cooled = json!({"coefficient_w_m2_k": coefficient, "ambient_k": 0});
            scene["boundaries"] = json!([{"on": ["x-", "x+"], "convection": cooled}]);
            scene.as_object_mut().unwrap().remove("steady");
            scene["time"] = march.clone();
            scene["time"]["end_s"] = json!(5000);
            let (code, _, said) = run("run", &scene);
            assert_eq!(code, Some(0), "{march}: {said}");
        }
    }
    // What no step resolves is told for what it is.
    let told = heatsph::march::too_cold(-20.0, false);
    assert!(told.contains("step_s") && !told.contains("flux"), "{told}");
}

#[test]
fn held_points_that_stand_for_another_area_are_told() {
    for (high, code) in [(0.015, 0), (0.0045, 3)] {
        let mut scene = bar(&json!(300));
        let within = json!({"box": {"min_m": [-1, 0], "max_m": [1, high]}});
        scene["boundaries"][1] = json!({"on": ["x+"], "temperature_k": 300, "within": within});
        let (found, _, said) = run("run", &scene);
        assert_eq!(found, Some(code), "{high}: {said}");
        assert_eq!(
            said.contains("boundaries/1: the temperature holds on"),
            code == 3,
            "{said}"
        );
    }
}

#[test]
fn materials_and_contacts_that_nothing_meets_are_told() {
    let layer = |low: f64, high: f64| {
        let mut scene = bar(&json!(300));
        let mut film = scene["materials"][0].clone();
        film["name"] = json!("film");
        film["region"] = json!({"box": {"min_m": [low, -1], "max_m": [high, 1]}});
        let rest = scene["materials"][0].clone();
        scene["materials"] = json!([film, rest]);
        scene["contacts"] = json!([{"between": ["film", "b"], "resistance_m2_k_w": 1e-3}]);
        scene
    };
    // 1 um between points has its resistances: 1000 W/m2 over 2e-3 m2 K/W are 2 K.
    let (code, values, said) = run("run", &layer(0.0512, 0.051201));
    assert_eq!(code, Some(0), "{said}");
    assert!((values[0] - values[1] - 12.0).abs() < 1e-6, "{values:?}");
    let (code, _, said) = run("run", &layer(0.2, 0.3));
    assert_eq!(code, Some(3), "{said}");
    assert!(
        said.contains("materials/0: ") && said.contains("contacts/0: "),
        "{said}"
    );
}
