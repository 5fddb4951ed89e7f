//! The program as its users meet it: tables, their errors, what is absent, the same bytes on any number of threads.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use artefact::{Reader, Table};
use gasprop::properties::Gas;
use gasprop::scene::Scene;
use serde_json::{Value, json};

fn scene() -> Value {
    json!({
        "kind": "gasprop.scene",
        "version": 1,
        "gas": {"Ar": 1.0},
        "pressure_pa": 101_325.0,
        "temperatures": {"chosen": {"from_k": 300, "to_k": 30_000, "count": 24}},
        "iron_mole_fraction": [0, 0.1, 1],
        "radiation": {"absorption_length_m": 1e-3},
        "accuracy": {"temperature": 0.5, "iron": 1.0},
    })
}

/// Runs a scene; its artefact is `name.mcap`.
fn run(folder: &Path, name: &str, scene: &Value, words: &[&str]) -> (PathBuf, Output) {
    let file = folder.join(format!("{name}.json"));
    std::fs::write(&file, scene.to_string()).unwrap();
    let out = folder.join(format!("{name}.mcap"));
    let output = Command::new(env!("CARGO_BIN_EXE_gasprop"))
        .arg("run")
        .arg(file)
        .arg("--out")
        .arg(&out)
        .args(["--progress", "none"])
        .args(words)
        .output()
        .unwrap();
    (out, output)
}

fn table(artefact: &Path, channel: &str) -> Table {
    Reader::open_kind(artefact, "gas-table", 1)
        .unwrap()
        .table(channel)
        .unwrap()
}

fn gas(scene: &Value) -> Gas {
    let mut own = scene.clone();
    let keys = own.as_object_mut().unwrap();
    keys.remove("kind");
    keys.remove("version");
    let scene: Scene = serde_json::from_value(own).unwrap();
    Gas::new(&scene).unwrap()
}

#[test]
fn threads_change_no_byte() {
    let folder = tempfile::tempdir().unwrap();
    let (one, _) = run(folder.path(), "one", &scene(), &["--threads", "1"]);
    let (three, _) = run(folder.path(), "three", &scene(), &["--threads", "3"]);
    assert_eq!(std::fs::read(one).unwrap(), std::fs::read(three).unwrap());
}

#[test]
fn the_table_holds_the_gas_itself_and_tells_what_interpolation_costs() {
    let folder = tempfile::tempdir().unwrap();
    let (artefact, output) = run(folder.path(), "table", &scene(), &[]);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let table = table(&artefact, "/gas");
    let gas = gas(&scene());
    let (iron, t) = (
        table.axis("iron_mole_fraction").unwrap(),
        table.axis("temperature_k").unwrap(),
    );
    assert_eq!(
        (table.shape.as_slice(), iron, t[0]),
        (&[3, 24][..], &[0.0, 0.1, 1.0][..], 300.0)
    );
    assert!((t[23] - 30_000.0).abs() < 1e-9);
    for (c, column) in gas.columns().iter().enumerate() {
        let values = table.values(column.name).unwrap();
        let at = |x: usize, k: usize| values[x * t.len() + k];
        assert_eq!(
            at(1, 7).to_bits(),
            gas.at(t[7], 0.1).unwrap().values[c].to_bits(),
            "{}",
            column.name
        );
        let greatest = values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let mut worst = 0.0_f64;
        for k in 0..t.len() - 1 {
            for (x, fraction) in iron.iter().enumerate() {
                let middle = gas.at(0.5 * (t[k] + t[k + 1]), *fraction).unwrap().values[c];
                let error = (middle - 0.5 * (at(x, k) + at(x, k + 1))).abs();
                worst = worst.max(error / middle.abs().max(1e-3 * greatest));
            }
        }
        let told = table
            .scalar(&format!("interpolation_error_temperature_{}", column.name))
            .unwrap();
        assert!(
            (told - worst).abs() < 1e-9 * worst,
            "{}: {told} {worst}",
            column.name
        );
    }
}

#[test]
fn a_table_that_cannot_be_read_between_its_rows_is_told_without_a_limit_too() {
    let folder = tempfile::tempdir().unwrap();
    let few = json!({"kind": "gasprop.scene", "version": 1, "gas": {"Ar": 1.0}, "pressure_pa": 101_325.0,
        "temperatures": {"even": {"from_k": 300, "to_k": 30_000, "count": 2}}});
    let (_, output) = run(folder.path(), "few", &few, &[]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(said.contains("above the limit of 2.5e-1"), "{said}");
}

#[test]
fn a_table_that_is_too_coarse_is_told_with_the_number_that_would_do() {
    let folder = tempfile::tempdir().unwrap();
    let mut strict = scene();
    strict["accuracy"] = json!({"temperature": 0.01, "iron": 1.0});
    let (_, output) = run(folder.path(), "coarse", &strict, &[]);
    assert_eq!(output.status.code(), Some(3));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("above the limit of 1e-2"), "{said}");
    let words: Vec<&str> = said.split_whitespace().collect();
    let at = words.iter().position(|word| *word == "about").unwrap();
    let wanted: u32 = words[at + 1].parse().unwrap();
    strict["temperatures"]["chosen"]["count"] = json!(wanted + wanted / 4);
    let (_, output) = run(folder.path(), "fine", &strict, &[]);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
fn what_a_scene_does_not_name_has_no_column_and_no_species() {
    let folder = tempfile::tempdir().unwrap();
    let mut plain = scene();
    let keys = plain.as_object_mut().unwrap();
    keys.remove("radiation");
    keys.remove("iron_mole_fraction");
    let (artefact, _) = run(folder.path(), "plain", &plain, &[]);
    let gas = table(&artefact, "/gas");
    assert!(!gas.has("net_emission_w_m3") && !gas.has("iron_diffusion_m2_s"));
    assert!(gas.scalar("iron_molar_mass_kg_mol").is_err());
    assert!(gas.attributes.keys().all(|name| !name.contains("iron")));
    let composition = table(&artefact, "/composition");
    assert!(
        composition
            .columns
            .iter()
            .all(|species| !species.name.contains("Fe"))
    );
    // What is left is what it is beside iron.
    let (mixed, _) = run(folder.path(), "mixed", &scene(), &[]);
    let mixed = table(&mixed, "/gas");
    let (alone, beside) = (
        gas.values("enthalpy_j_kg").unwrap(),
        mixed.values("enthalpy_j_kg").unwrap(),
    );
    assert!((alone[0] - beside[0]).abs() < 1e-6 && (alone[23] / beside[23] - 1.0).abs() < 1e-9);
}

/// Enthalpy is zero at 300 K for the cold gas as it is named and for iron atoms: so it is for their mixture, where
/// nothing reacts.
#[test]
fn enthalpy_has_its_zeros_where_it_says() {
    let argon = gas(&scene());
    let c = argon
        .columns()
        .iter()
        .position(|column| column.name == "enthalpy_j_kg")
        .unwrap();
    for x in [0.0, 0.3, 1.0] {
        let cold = argon.at(300.0, x).unwrap().values[c];
        assert!(cold.abs() < 1e-3, "{x}: {cold} J/kg");
    }
    // Iron as a gas of atoms: 5/2 R/M and what its lowest levels take up.
    let warm = argon.at(1300.0, 1.0).unwrap().values[c];
    let flight = 2.5 * 8.314_462_618 / 55.845e-3 * 1000.0;
    assert!(warm > flight && warm < 1.3 * flight, "{warm} {flight}");
}

#[test]
fn sources_are_told_for_every_column() {
    let folder = tempfile::tempdir().unwrap();
    let (artefact, _) = run(folder.path(), "sources", &scene(), &[]);
    let sources: Value = Reader::open(&artefact)
        .unwrap()
        .json_at("/sources", 0)
        .unwrap();
    let columns = sources["columns"].as_array().unwrap();
    let table = table(&artefact, "/gas");
    assert_eq!(columns.len(), table.columns.len());
    for (told, column) in columns.iter().zip(&table.columns) {
        assert_eq!(told["name"], column.name.as_str());
        assert!(
            !told["sources"].as_array().unwrap().is_empty(),
            "{}",
            column.name
        );
    }
    assert!(sources["left_out"].as_array().unwrap().len() >= 3);
}

#[test]
fn the_parts_of_thermal_conductivity_add_up() {
    let folder = tempfile::tempdir().unwrap();
    let (artefact, _) = run(folder.path(), "parts", &scene(), &[]);
    let (gas, parts) = (table(&artefact, "/gas"), table(&artefact, "/parts"));
    let all = gas.values("thermal_conductivity_w_m_k").unwrap();
    for (k, whole) in all.iter().enumerate() {
        let sum: f64 = parts.columns.iter().map(|part| part.values[k]).sum();
        assert!((sum / whole - 1.0).abs() < 1e-12);
    }
    let composition = table(&artefact, "/composition");
    for k in 0..all.len() {
        let sum: f64 = composition
            .columns
            .iter()
            .map(|species| species.values[k])
            .sum();
        assert!((sum - 1.0).abs() < 1e-12);
    }
}

#[test]
fn scenes_with_faults_are_refused_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |name: &str, key: &str, value: Value, words: &[&str]| {
        let mut scene = scene();
        scene[key] = value;
        let (_, output) = run(folder.path(), name, &scene, &[]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{said}");
        for word in words {
            assert!(said.contains(word), "'{word}' is not in: {said}");
        }
    };
    refused("gas", "gas", json!({"Xe": 1.0}), &["/gas/Xe", "Xe"]);
    refused("sum", "gas", json!({"Ar": 0.5}), &["/gas", "0.5"]);
    refused(
        "cold",
        "temperatures",
        json!({"list-k": [100, 300]}),
        &["/temperatures/list-k/0", "100"],
    );
    refused(
        "pressure",
        "pressure_pa",
        json!(-1),
        &["/pressure_pa", "-1"],
    );
    refused(
        "typo",
        "iron_fraction",
        json!([0]),
        &["iron_fraction", "iron_mole_fraction"],
    );
}
