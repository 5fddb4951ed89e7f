//! Starts from another solution, as the program takes them.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use artefact::{Header, Reader, Table, Version, Writer};
use serde_json::{Value, json};

const SCENE: &str = "pipelines/verify/arc-surface/scene.json";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// `arcfvm run` of a small arc in argon, patched, from `start`.
fn run(folder: &Path, out: &str, patch: &Value, start: Option<&str>) -> Output {
    let patched = folder.join(format!("{out}.patch.json"));
    std::fs::write(&patched, patch.to_string()).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_arcfvm"));
    command.current_dir(root()).args(["run", SCENE, "--patch"]);
    command.arg(patched).arg("--out").arg(folder.join(out));
    command.args(["--input", "gas=pipelines/gases/argon-1atm.json"]);
    if let Some(start) = start {
        let start = folder.join(start);
        command
            .arg("--input")
            .arg(format!("start={}", start.display()));
    }
    command
        .args(["--threads", "1", "--progress", "none"])
        .output()
        .unwrap()
}

/// Iterations and notes of a run that converged.
fn record(folder: &Path, out: &str) -> (u64, String) {
    let text = std::fs::read_to_string(folder.join(out).with_extension("run.json")).unwrap();
    let record: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(record["outcome"], "done", "{record}");
    (
        record["steps"].as_u64().unwrap(),
        record["notes"].to_string(),
    )
}

fn balance(folder: &Path, out: &str, name: &str) -> f64 {
    let reader = Reader::open_kind(folder.join(out), "arc-source", 1).unwrap();
    reader.record("/balance").unwrap().get(name).unwrap()
}

/// The greatest difference of a column of `/plasma`, as part of its greatest value.
fn apart(folder: &Path, [a, b]: [&str; 2], column: &str) -> f64 {
    let values = [a, b].map(|out| {
        let reader = Reader::open(folder.join(out)).unwrap();
        reader
            .table("/plasma")
            .unwrap()
            .values(column)
            .unwrap()
            .to_vec()
    });
    let most = values[0].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let pairs = values[0].iter().zip(&values[1]);
    pairs.fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / most
}

#[test]
fn a_solution_holds_from_its_first_iterations_on() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (cold, again, patch) in [
        ("cold.mcap", "again.mcap", json!({})),
        // The other polarity, with the potential of the wire below that of the base.
        (
            "cold-minus.mcap",
            "again-minus.mcap",
            json!({
                "current": {"edges": {"top": [{"over_m": [0, 0.0008], "total_current_a": -80}]}},
                "bodies": {
                    "base": {"cathode": null, "anode": {"work_function_v": 4.65, "emissivity": 0.4}},
                    "wire": {"anode": null, "cathode": {
                        "work_function_v": 3.85, "ionisation_voltage_v": 15.68,
                        "richardson_a_m2_k2": 1.2e6, "emissivity": 0.4
                    }}
                }
            }),
        ),
    ] {
        run(folder, cold, &patch, None);
        let (from_cold, _) = record(folder, cold);
        run(folder, again, &patch, Some(cold));
        let (from_there, notes) = record(folder, again);
        assert!(
            from_cold > 50 && from_there <= 5,
            "{from_cold} {from_there}"
        );
        assert!(!notes.contains("interpolated"), "{notes}");
        for column in [
            "temperature_k",
            "axial_velocity_m_s",
            "pressure_pa",
            "potential_v",
        ] {
            let apart = apart(folder, [cold, again], column);
            assert!(apart < 1e-4, "{column}: {apart}");
        }
    }
}

#[test]
fn a_flow_that_vapour_drives_holds_too() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let steps = |out: &str, start: &[String]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_arcfvm"));
        let command = command
            .current_dir(root())
            .args([
                "run",
                "pipelines/verify/arc-evaporation/scene.json",
                "--out",
            ])
            .arg(folder.join(out))
            .args(["--threads", "1", "-q"])
            .args(start);
        assert_eq!(command.status().unwrap().code(), Some(0));
        record(folder, out).0
    };
    let cold = steps("cold.mcap", &[]);
    let start = format!("start={}", folder.join("cold.mcap").display());
    let again = steps("again.mcap", &["--input".to_owned(), start]);
    assert!(cold > 50 && again <= 5, "{cold} {again}");
}

/// A bed begins boiled as far as it had: its cavity holds, where a cold one grows anew.
#[test]
fn a_bed_that_boiled_is_not_cold_again() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let steps = |out: &str, start: &[String]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_arcfvm"));
        let command = command
            .current_dir(root())
            .args(["run", "pipelines/stability/bed/arc.json", "--out"])
            .arg(folder.join(out))
            .args(["--threads", "1", "-q"])
            .args(start);
        assert_eq!(command.status().unwrap().code(), Some(0));
        record(folder, out).0
    };
    let cold = steps("cold.mcap", &[]);
    let start = format!("start={}", folder.join("cold.mcap").display());
    let again = steps("again.mcap", &["--input".to_owned(), start]);
    let cavities = ["cold.mcap", "again.mcap"].map(|out| balance(folder, out, "cavity_volume_m3"));
    assert!(cavities[0] > 0.0, "nothing boiled");
    assert!(
        (cavities[1] / cavities[0] - 1.0).abs() < 1e-9,
        "{cavities:?}"
    );
    assert!(again < cold / 2, "{cold} {again}");
    assert!(apart(folder, ["cold.mcap", "again.mcap"], "temperature_k") < 1e-3);
}

#[test]
fn a_start_on_another_grid_is_interpolated_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    run(folder, "coarse.mcap", &json!({}), None);
    let fine = json!({"grid": {"r": 0.0003, "z": 0.0003}});
    run(folder, "fine.mcap", &fine, None);
    run(folder, "from-coarse.mcap", &fine, Some("coarse.mcap"));
    let (_, notes) = record(folder, "from-coarse.mcap");
    assert!(
        notes.contains("another grid") && notes.contains("coarse.mcap"),
        "{notes}"
    );
    for name in ["voltage_v", "base_total_w", "fastest_m_s"] {
        let [cold, warm] = ["fine.mcap", "from-coarse.mcap"].map(|out| balance(folder, out, name));
        assert!((warm / cold - 1.0).abs() < 1e-6, "{name}: {cold} {warm}");
    }
}

#[test]
fn a_start_that_is_no_arc_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let header = Header {
        kind: "mean-fields".to_owned(),
        version: Version::new(1, 2),
        tool: "test".to_owned(),
        tool_version: "0".to_owned(),
        scene: json!({}),
        inputs: std::collections::BTreeMap::new(),
    };
    let mut writer = Writer::create(folder.join("mean.mcap"), &header).unwrap();
    let table = Table::new(1).column("radius_m", "m", [1e-3]);
    writer.table("/profile", 0.0, &table).unwrap();
    writer.finish().unwrap();
    let output = run(folder, "arc.mcap", &json!({}), Some("mean.mcap"));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success() && !folder.join("arc.mcap").exists());
    assert!(
        said.contains("'mean-fields'") && said.contains("'arc-source'"),
        "{said}"
    );
}
