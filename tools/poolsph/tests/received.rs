//! Heat that metal is told to have got, way by way: it adds up to the balance, and costs nothing where nobody asks.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::Path;
use std::process::Command;

use artefact::{Frame, Reader};
use serde_json::{Value, json};

const WAYS: [&str; 5] = [
    "heat_from_arc",
    "heat_from_torches",
    "heat_from_powder",
    "heat_from_slag",
    "heat_lost",
];

/// A plate under an arc and a torch, with cold powder on one end and hot slag on the other.
fn plate(told: bool) -> Value {
    let grains = |x: f64, kelvin: f64| {
        json!({"shape": {"box": {"min_m": [x, 0.5e-3, 0.2e-3], "max_m": [x + 2e-3, 5.5e-3, 1.2e-3]}},
            "radius_m": 2.5e-4, "spacing_m": 5e-4, "temperature_k": kelvin})
    };
    json!({
        "kind": "poolsph.scene", "version": 2, "title": "A plate that is heated in every way",
        "spacing_m": 5e-4, "time": {"step_s": 1e-4, "end_s": 0.02}, "density_kg_m3": 7750,
        "bodies": [{"shape": {"box": {"min_m": [0, 0, -2e-3], "max_m": [10e-3, 6e-3, 0]}}, "state": "solid", "temperature_k": 1200}],
        "heat": {"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": 700},
        "source": {"start_m": [5e-3, 3e-3, 0], "velocity_m_s": [0, 0, 0]},
        "arc": {"flux_w_m2": {"expr": "5e6 * exp(-(r/1e-3)^2)"}},
        "torches": [{"power_w": 200, "path": {"points_m": [[5e-3, 1e-3, 0], [5e-3, 5e-3, 0]], "speed_m_s": 0.2},
            "shape": {"gaussian": {"radius_m": 1e-3}}}],
        "losses": {"surroundings_k": 300, "emissivity": 0.5},
        "grains": {
            "density_kg_m3": 3230, "gravity_m_s2": [0, 0, -9.8],
            "contact": {"law": {"linear": {"stiffness_n_m": 75}}, "restitution": 0.3, "friction": 0.5},
            "bodies": [grains(0.5e-3, 600.0), grains(7.5e-3, 2700.0)],
            "heat": {"thermal_conductivity_w_m_k": 20.2, "specific_heat_j_kg_k": 1000, "gas_conductivity_w_m_k": 0.1,
                "melting": {"point_k": 2572, "latent_heat_j_kg": 5e5}}
        },
        "output": {"particles_interval_s": 0.01, "precision": "f64", "heat_received": told}
    })
}

/// Runs a scene; its last frame.
fn last(scene: &Value, out: &Path) -> Frame {
    let path = out.with_extension("json");
    std::fs::write(&path, scene.to_string()).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_poolsph"));
    command.arg("run").arg(&path).arg("--out").arg(out);
    let output = command.args(["--progress", "none"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    // Without grains that take it, what falls beside the plate is told.
    let beside = said.contains("fall on the metal") && said.matches("warning: ").count() == 1;
    let wanted = if beside { 3 } else { 0 };
    assert_eq!(output.status.code(), Some(wanted), "{said}");
    let reader = Reader::open(out).unwrap();
    reader
        .frame("/particles", reader.count("/particles") - 1)
        .unwrap()
}

#[test]
fn heat_by_its_ways_adds_up_to_the_balance_and_other_columns_keep_their_bits() {
    let folder = tempfile::tempdir().unwrap();
    let out = |name: &str| folder.path().join(name);
    let told = last(&plate(true), &out("told.mcap"));
    let plain = last(&plate(false), &out("plain.mcap"));
    for column in plain.columns() {
        let [a, b] = [&plain, &told].map(|frame| frame.get(&column.name).unwrap().clone());
        assert!(a.values == b.values, "{} has changed", column.name);
    }
    assert!(WAYS.iter().all(|way| told.has(way) && !plain.has(way)));

    let [arc, torch, powder, slag, lost] =
        WAYS.map(|way| told.f64(way).unwrap().iter().sum::<f64>());
    assert!(powder < 0.0 && slag > 0.0, "{powder} {slag}");
    let records = Reader::open(out("told.mcap")).unwrap();
    let records = records.records("/balance").unwrap();
    let balance = &records.last().unwrap().1;
    let found = |name: &str| balance.get(name).unwrap();
    let alike = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-10;
    assert!(alike(torch, 4.0), "{torch}");
    for (got, told) in [
        (arc, "energy_in_arc_j"),
        (torch, "energy_in_torches_j"),
        (powder + slag, "energy_in_grains_j"),
        (lost, "energy_out_radiation_j"),
    ] {
        assert!(alike(got, found(told)), "{told}: {got} {}", found(told));
    }
}

#[test]
fn ways_that_a_scene_lacks_have_no_column_and_none_at_all_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = plate(true);
    for key in ["grains", "torches", "losses"] {
        scene.as_object_mut().unwrap().remove(key);
    }
    let frame = last(&scene, &folder.path().join("arc.mcap"));
    let there = WAYS.map(|way| frame.has(way));
    assert_eq!(there, [true, false, false, false, false]);

    let path = folder.path().join("none.json");
    let check = |scene: &Value| {
        std::fs::write(&path, scene.to_string()).unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_poolsph"));
        let output = command.arg("check").arg(&path).output().unwrap();
        let told = [output.stdout, output.stderr].concat();
        (
            output.status.code(),
            String::from_utf8_lossy(&told).into_owned(),
        )
    };
    scene.as_object_mut().unwrap().remove("arc");
    let (code, said) = check(&scene);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("heat_received: no column"), "{said}");
    scene.as_object_mut().unwrap().remove("heat");
    let (code, said) = check(&scene);
    assert_eq!(code, Some(2));
    assert!(said.contains("/output/heat_received"), "{said}");
}
