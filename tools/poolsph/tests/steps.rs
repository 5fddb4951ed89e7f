//! Steps beyond a limit are divided or refused, and what is prescribed in time arrives.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::process::{Command, Output};

use serde_json::{Value, json};

/// What the program says to a scene, and the record of its run.
fn program(command: &str, scene: &Value) -> (Output, Value) {
    let folder = tempfile::tempdir().unwrap();
    let [path, out] = ["scene.json", "out.mcap"].map(|name| folder.path().join(name));
    std::fs::write(&path, scene.to_string()).unwrap();
    let mut program = Command::new(env!("CARGO_BIN_EXE_poolsph"));
    program.arg(command).arg(&path);
    if command == "run" {
        program.arg("--out").arg(&out).args(["--progress", "none"]);
    }
    let output = program.output().unwrap();
    let record = std::fs::read_to_string(out.with_extension("run.json"));
    let record = record.map_or(Value::Null, |text| serde_json::from_str(&text).unwrap());
    (output, record)
}

fn said(output: &Output) -> String {
    [&output.stdout, &output.stderr]
        .map(|bytes| String::from_utf8_lossy(bytes).into_owned())
        .concat()
}

fn drop(step: f64) -> Value {
    json!({
        "kind": "poolsph.scene", "version": 2, "spacing_m": 1e-3, "time": {"step_s": step, "end_s": 3.0 * step},
        "density_kg_m3": 7850,
        "bodies": [{"shape": {"sphere": {"centre_m": [0, 0, 0], "radius_m": 4e-3}}, "state": "liquid"}],
        "flow": {"method": "projection", "viscosity_pa_s": 0.004}, "tension": {"surface_tension_n_m": 1.0},
        "output": {"particles_interval_s": 3.0 * step}
    })
}

#[test]
fn a_step_that_nothing_divides_is_refused() {
    // The capillary limit is 1.118e-3 s here: sqrt(m / (2 pi gamma)).
    for command in ["check", "run"] {
        let (output, _) = program(command, &drop(3e-3));
        let said = said(&output);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(
            said.contains("/time/step_s") && said.contains("'capillary', 1.118e-3 s"),
            "{said}"
        );
    }
    let (output, _) = program("check", &drop(1.1e-3));
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert!(
        said(&output).contains("step_capillary"),
        "{}",
        said(&output)
    );
}

/// A plate that conducts heat, with `more` in its scene.
fn plate(step: f64, steps: f64, more: &Value) -> Value {
    let mut scene = json!({
        "kind": "poolsph.scene", "version": 2, "spacing_m": 1e-3, "time": {"step_s": step, "end_s": steps * step},
        "density_kg_m3": 7850,
        "bodies": [{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [6e-3, 6e-3, 3e-3]}}, "state": "solid", "temperature_k": 300}],
        "heat": {"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": 600},
        "output": {"particles_interval_s": steps * step}
    });
    let keys = scene.as_object_mut().unwrap();
    keys.extend(more.as_object().unwrap().clone());
    scene
}

#[test]
fn the_record_counts_the_steps_that_were_divided() {
    // The limit of conduction lies between the two steps.
    for (step, divided) in [(1e-3, 0), (1.0, 5)] {
        let (output, record) = program("run", &plate(step, 5.0, &json!({})));
        assert!(output.status.success(), "{}", said(&output));
        assert_eq!(
            record["steps_divided"], divided,
            "{step}: {}",
            record["limits"]
        );
        assert_eq!(record["substepped"], divided > 0);
    }
}

#[test]
fn a_flux_between_two_steps_arrives() {
    let heat = |flux: &str| {
        let arc = json!({"arc": {"flux_w_m2": {"expr": flux}}});
        let (output, record) = program("run", &plate(1e-3, 20.0, &arc));
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        let rows = record["closing"].as_array().unwrap();
        let row = rows.iter().find(|row| row["name"] == "energy_in_arc_j");
        row.unwrap_or_else(|| panic!("{rows:?}"))["value"]
            .as_f64()
            .unwrap()
    };
    // 1e5 J/m2 each.
    let even = heat("5e6");
    for pulse in [
        "if(t - 0.0122, if(0.0123 - t, 1e9, 0), 0)",
        "1e12*max(0, 1 - abs(t - 0.00712345)/1e-7)",
        "5e6*(1 + sin(2000*pi*t))",
    ] {
        let heat = heat(pulse);
        assert!(
            (heat / even - 1.0).abs() < 1e-3,
            "{pulse}: {heat} of {even}"
        );
    }
}
