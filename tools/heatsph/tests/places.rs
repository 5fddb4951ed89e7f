//! Where a fault is told: in the patch that made it.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::process::Command;

use serde_json::{Value, json};

/// What `check` says of a good scene with a patch.
fn said(patch: &Value) -> String {
    let scene = json!({
        "kind": "heatsph.scene", "version": 1, "dimensions": 2,
        "body": {"box": {"min_m": [0, 0], "max_m": [1, 1]}}, "points": {"spacing_m": 0.1},
        "materials": [{"name": "m", "density_kg_m3": 1, "specific_heat_j_kg_k": 1, "conductivity_w_m_k": 1}],
        "initial_temperature_k": 300, "steady": {}
    });
    let folder = tempfile::tempdir().unwrap();
    let [path, over] = ["scene.json", "patch.json"].map(|name| folder.path().join(name));
    std::fs::write(&path, scene.to_string()).unwrap();
    std::fs::write(&over, patch.to_string()).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_heatsph"))
        .arg("check")
        .arg(&path)
        .arg("--patch")
        .arg(&over)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    said
}

#[test]
fn factors_beyond_their_range_are_refused_with_their_place() {
    let robin = |h: &str| json!({"on": ["x-", "y-"], "convection": {"coefficient_w_m2_k": {"expr": h}, "ambient_k": 300}});
    let bright = |e: &str| json!({"on": ["x-", "y-"], "radiation": {"emissivity": {"expr": e}, "surroundings_k": 300}});
    let march = json!({"end_s": 20});
    for (entry, key, value) in [
        (
            robin("100*(x - 0.5)"),
            "convection/coefficient_w_m2_k",
            "gives -50 W/(m2 K) at x = 0,",
        ),
        (
            robin("10 - t"),
            "convection/coefficient_w_m2_k",
            "gives -10 W/(m2 K)",
        ),
        (
            bright("0.3 + 0.1*t"),
            "radiation/emissivity",
            "gives 2.3 at",
        ),
        (bright("0.3 - x"), "radiation/emissivity", "gives -0.67"),
    ] {
        let said = said(&json!({"boundaries": [entry], "steady": null, "time": march}));
        assert!(
            said.contains(&format!("/boundaries/0/{key}/expr: ")),
            "{said}"
        );
        assert!(
            said.contains(value) && said.contains("out of range"),
            "{said}"
        );
    }
}

#[test]
fn monitors_outside_of_the_body_are_refused() {
    let at = |x: f64| json!({"output": {"monitors": [{"name": "in", "place_m": [1, 1]}, {"name": "a", "place_m": [x, 0.5]}]}});
    let said = said(&at(1.01));
    assert!(
        said.contains(
            "/output/monitors/1/place_m: (1.01, 0.5, 0) m is outside of the body, 1.0000e-2 m"
        ),
        "{said}"
    );
}

#[test]
fn a_boundary_has_a_name_of_its_own() {
    let flux = |name: &str| json!({"name": name, "on": ["x-"], "heat_flux_w_m2": 1});
    let twice = said(&json!({"boundaries": [flux("a"), flux("a")]}));
    assert!(
        twice.contains("/boundaries/1/name: 'a' is the name of /boundaries/0 too"),
        "{twice}"
    );
    let source = said(&json!({"boundaries": [flux("source")]}));
    assert!(
        source.contains("/boundaries/0/name: 'source' is the name"),
        "{source}"
    );
}

/// Heat by convection and by radiation through one face in a steady state, of which each has its own total.
#[test]
fn two_ways_through_one_face_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let [path, out] = ["scene.json", "out.mcap"].map(|name| folder.path().join(name));
    let scene = json!({
        "kind": "heatsph.scene", "version": 1, "dimensions": 2,
        "body": {"box": {"min_m": [0, 0], "max_m": [1, 1]}}, "points": {"spacing_m": 0.25},
        "materials": [{"name": "m", "density_kg_m3": 1, "specific_heat_j_kg_k": 1, "conductivity_w_m_k": 1}],
        "initial_temperature_k": 300, "steady": {},
        "boundaries": [
            {"on": ["x-"], "heat_flux_w_m2": 100},
            {"on": ["x+"], "convection": {"coefficient_w_m2_k": 10, "ambient_k": 300}},
            {"on": ["x+"], "radiation": {"emissivity": 0.5, "surroundings_k": 300}}
        ]
    });
    std::fs::write(&path, scene.to_string()).unwrap();
    let mut run = Command::new(env!("CARGO_BIN_EXE_heatsph"));
    run.arg("run").arg(&path).arg("--out").arg(&out).arg("-q");
    assert!(run.status().unwrap().success());
    let record = std::fs::read_to_string(out.with_extension("run.json")).unwrap();
    let record: Value = serde_json::from_str(&record).unwrap();
    let closing = record["closing"].as_array().unwrap();
    let heat = |name: &str| {
        let row = closing.iter().find(|row| row["name"] == name);
        row.unwrap()["value"].as_f64().unwrap()
    };
    let out = [heat("heat_rate x+"), heat("heat_rate x+ 2")];
    assert!(out.iter().all(|heat| *heat < -1.0), "{out:?}");
    assert!((out[0] + out[1] + 100.0).abs() < 1e-6, "{out:?}");
}

#[test]
fn mixtures_are_whole() {
    let mixture = |fractions: [Value; 2]| {
        let parts = fractions.map(|f| json!({"fraction": f, "conductivity_w_m_k": 5}));
        json!({"materials": [{"name": "m", "density_kg_m3": 1, "specific_heat_j_kg_k": 1, "conductivity_w_m_k": null, "mixture": parts}]})
    };
    let rising = json!({"expr": "x"});
    for (fractions, at, what) in [
        (
            [json!(1), json!(1)],
            "/materials/0/mixture:",
            "add up to 2,",
        ),
        (
            [json!(1.2), json!(-0.2)],
            "/materials/0/mixture/0/fraction:",
            "1.2 is out of range",
        ),
        (
            [rising, json!(0.5)],
            "/materials/0/mixture:",
            "add up to 0.5 at (0, 0, 0) m",
        ),
    ] {
        let said = said(&mixture(fractions));
        assert!(said.contains(at) && said.contains(what), "{said}");
    }
}

#[test]
fn a_formula_in_time_has_no_steady_state() {
    let ramp = json!({"expr": "300 + 1e5*t"});
    let robin = |h: &Value, t: &Value| json!({"on": ["x+"], "convection": {"coefficient_w_m2_k": h, "ambient_k": t}});
    let bright = |e: &Value, t: &Value| json!({"on": ["x+"], "radiation": {"emissivity": e, "surroundings_k": t}});
    let part = json!({"expr": "0.5 + 1e-9*t"});
    for (entry, key) in [
        (
            json!({"on": ["x+"], "heat_flux_w_m2": ramp}),
            "heat_flux_w_m2",
        ),
        (
            json!({"on": ["x+"], "temperature_k": ramp}),
            "temperature_k",
        ),
        (robin(&ramp, &json!(300)), "convection/coefficient_w_m2_k"),
        (robin(&json!(10), &ramp), "convection/ambient_k"),
        (bright(&part, &json!(300)), "radiation/emissivity"),
        (bright(&json!(1), &ramp), "radiation/surroundings_k"),
    ] {
        let said = said(&json!({"boundaries": [entry]}));
        assert!(
            said.contains(&format!("/boundaries/0/{key}/expr: ")),
            "{said}"
        );
        assert!(said.contains("no time"), "{said}");
    }
    assert!(said(&json!({"source_w_m3": ramp})).contains("/source_w_m3/expr: "));
}

#[test]
fn a_fault_of_two_keys_is_told_at_the_one_that_the_patch_set() {
    for (patch, key) in [
        (json!({"body": {"box": {"max_m": [1e6, 1e6]}}}), "/body:"),
        (json!({"points": {"spacing_m": 1e-7}}), "/points/spacing_m:"),
        (json!({"time": {"end_s": 1}}), "/time:"),
    ] {
        let said = said(&patch);
        assert!(
            said.contains("patch.json:1:") && said.contains(key),
            "{key} {said}"
        );
        assert!(!said.contains("scene.json:"), "{said}");
    }
}
