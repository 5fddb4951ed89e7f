//! Gas tables with faults: told with file, column and row before anything is computed.

use serde_json::Value;

use crate::workplace::{Place, Told, root, tell};

/// Checks the arc of a study with a gas table that `change` spoilt.
fn told(change: impl Fn(&mut Value)) -> Told {
    let text = std::fs::read_to_string(root().join("pipelines/gases/argon-1atm.json")).unwrap();
    let mut table: Value = serde_json::from_str(&text).unwrap();
    change(&mut table);
    told_text(&serde_json::to_string_pretty(&table).unwrap())
}

fn told_text(text: &str) -> Told {
    let place = Place::new();
    let gas = place.file("gas.json", text);
    let scene = root().join("pipelines/gmaw-300a/arc.json");
    let input = format!("gas={}", gas.display());
    let told = tell(
        "arcfvm",
        &["check", scene.to_str().unwrap(), "--input", &input],
    );
    assert!([0, 1, 2].contains(&told.code), "{told:?}");
    told
}

#[test]
fn a_sound_table_is_accepted() {
    told(|_| ()).must(0, &["arcfvm"]);
}

#[test]
fn another_kind_and_a_newer_version_are_refused_by_name() {
    told(|t| t["kind"] = "steel-table".into()).must(1, &["'steel-table'", "'gas-table'"]);
    told(|t| t["version"] = "2.0".into())
        .must(1, &["gas.json", "version 2.0", "reads version 1.x"]);
    told(|t| t["version"] = "new".into()).must(1, &["gas.json:", "'new' is not a version"]);
}

#[test]
fn a_truncated_table_is_placed_at_its_line() {
    let text =
        "{\n  \"kind\": \"gas-table\",\n  \"version\": \"1.0\",\n  \"columns\": [\n    {\"na";
    told_text(text).must(1, &["gas.json:5:", "EOF"]);
}

#[test]
fn a_value_that_is_no_number_is_placed_at_its_line() {
    let told = told(|t| t["columns"][1]["values"][3] = Value::Null);
    told.must(1, &["gas.json:", "null"]);
}

#[test]
fn a_missing_column_is_named() {
    let told = told(|t| {
        let columns = t["columns"].as_array_mut().unwrap();
        columns.retain(|c| c["name"] != "viscosity_pa_s");
    });
    assert_ne!(told.code, 0);
    told.must(told.code, &["no column viscosity_pa_s"]);
}

#[test]
fn columns_of_unequal_length_and_temperatures_that_do_not_rise_are_refused() {
    let short = told(|t| {
        t["columns"][1]["values"].as_array_mut().unwrap().pop();
    });
    assert_ne!(short.code, 0);
    short.must(short.code, &["density_kg_m3", "equal length"]);
    let flat = told(|t| t["columns"][0]["values"][3] = t["columns"][0]["values"][2].clone());
    assert_ne!(flat.code, 0);
    flat.must(flat.code, &["row 3", "does not exceed"]);
}

#[test]
fn values_that_no_gas_can_have_are_refused_with_column_row_and_range() {
    let spoilt = |column: usize, row: usize, value: f64| {
        told(|t| t["columns"][column]["values"][row] = value.into())
    };
    let text = std::fs::read_to_string(root().join("pipelines/gases/argon-1atm.json")).unwrap();
    let table: Value = serde_json::from_str(&text).unwrap();
    let name = |column: usize| {
        table["columns"][column]["name"]
            .as_str()
            .unwrap()
            .to_owned()
    };
    let find = |wanted: &str| (0..8).find(|c| name(*c) == wanted).unwrap();
    spoilt(find("density_kg_m3"), 3, -0.5).must(
        1,
        &[
            "gas.json: column density_kg_m3, row 3",
            " K): -0.5 kg/m3 is out of range: above 0",
        ],
    );
    for zero in [
        "density_kg_m3",
        "specific_heat_j_kg_k",
        "viscosity_pa_s",
        "thermal_conductivity_w_m_k",
    ] {
        spoilt(find(zero), 5, 0.0).must(1, &[zero, "row 5", "above 0"]);
    }
    spoilt(find("electric_conductivity_s_m"), 2, -1e-3).must(1, &["row 2", "-0.001", "at least 0"]);
    spoilt(find("temperature_k"), 0, -300.0).must(1, &["temperature_k, row 0", "-300"]);
    // A gas may take up more radiation than it gives off.
    spoilt(find("net_emission_w_m3"), 2, -1.0).must(0, &["arcfvm"]);
}

/// Runs one iteration of an arc on coarse cells with a table that ends at `end` \[K\].
fn run_to(end: f64) -> Told {
    let text = std::fs::read_to_string(root().join("pipelines/gases/argon-1atm.json")).unwrap();
    let mut table: Value = serde_json::from_str(&text).unwrap();
    let rows = table["columns"][0]["values"].as_array().unwrap();
    let kept = rows.iter().filter(|t| t.as_f64().unwrap() <= end).count();
    for column in table["columns"].as_array_mut().unwrap() {
        column["values"].as_array_mut().unwrap().truncate(kept);
    }
    let place = Place::new();
    let input = format!(
        "gas={}",
        place.file("gas.json", table.to_string()).display()
    );
    let coarse = place.file(
        "coarse.json",
        r#"{"grid": {"r": {"at_m": [0, 0.025], "spacing_m": [0.001, 0.001]}, "z": {"at_m": [-0.005, 0.02], "spacing_m": [0.001, 0.001]}}, "iterate": {"most": 1}}"#,
    );
    let scene = root().join("pipelines/gmaw-300a/arc.json");
    let out = place.path("arc.mcap");
    let words = [
        scene.as_os_str(),
        "--patch".as_ref(),
        coarse.as_os_str(),
        "--out".as_ref(),
        out.as_os_str(),
    ];
    let words = words.map(|w| w.to_str().unwrap());
    let mut line = vec!["run", "--threads", "1", "--input", &input];
    line.extend(words);
    tell("arcfvm", &line)
}

#[test]
fn an_arc_hotter_than_its_table_is_done_with_a_warning() {
    run_to(8900.0).must(
        3,
        &[
            "warning: gas table",
            "gas.json, column temperature_k ends at 8900 K",
            "hot gas cells",
        ],
    );
    let whole = run_to(24_900.0);
    assert!(!whole.err.contains("warning: gas table"), "{whole:?}");
}
