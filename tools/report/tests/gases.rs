//! Pages of gases from tables with known content.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use artefact::{Header, Table, Version, Writer};
use serde_json::json;

/// A gas whose electric conductivity is `factor (1 + x) T`, with iron or without.
fn table(path: &Path, factor: f64, iron: &[f64]) {
    let header = Header {
        kind: "gas-table".to_owned(),
        version: Version::new(1, 0),
        tool: "gasprop".to_owned(),
        tool_version: "0.1.0".to_owned(),
        scene: json!({"title": "Phlogiston"}),
        inputs: BTreeMap::new(),
    };
    let t: Vec<f64> = (1..=20).map(|k| 1000.0 * f64::from(k)).collect();
    let over = |of: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
        iron.iter()
            .flat_map(|x| t.iter().map(|t| of(*t, *x)))
            .collect()
    };
    let empty = || {
        Table::grid(&[
            ("iron_mole_fraction", "1", iron),
            ("temperature_k", "K", &t),
        ])
    };
    let gas = empty()
        .column(
            "electric_conductivity_s_m",
            "S/m",
            over(&|t, x| factor * (1.0 + x) * t),
        )
        .column("viscosity_pa_s", "Pa s", over(&|t, _| 1e-8 * t))
        .attribute("pressure_pa", "Pa", 101_325.0)
        .attribute(
            "interpolation_error_temperature_viscosity_pa_s",
            "1",
            0.0123,
        );
    let composition =
        empty()
            .column("Ph", "1", over(&|_, _| 1.0))
            .column("rare", "1", over(&|_, _| 1e-9));
    let parts = empty().column(
        "thermal_conductivity_heavy_w_m_k",
        "W/(m K)",
        over(&|t, _| t),
    );
    let sources = json!({
        "columns": [{"name": "viscosity_pa_s", "unit": "Pa s", "what": "how it drags", "sources": ["Stahl 1703"]}],
        "left_out": ["dephlogistication"],
    });
    let mut writer = Writer::create(path, &header).unwrap();
    writer.table("/gas", 0.0, &gas).unwrap();
    writer.table("/composition", 0.0, &composition).unwrap();
    writer.table("/parts", 0.0, &parts).unwrap();
    writer
        .json("/sources", 0.0, ("gasprop.sources.v1", "{}"), &sources)
        .unwrap();
    writer.finish().unwrap();
}

fn report(folder: &Path, words: &[String]) -> (Output, String) {
    let out = folder.join("report.html");
    let output = Command::new(env!("CARGO_BIN_EXE_report"))
        .args(["gas", "--study", "sample", "--out"])
        .arg(&out)
        .args(words)
        .output()
        .unwrap();
    let html = std::fs::read_to_string(out).unwrap_or_default();
    (output, html)
}

fn word(flag: &str, name: &str, file: &Path) -> [String; 2] {
    [flag.to_owned(), format!("{name}={}", file.display())]
}

fn reference(folder: &Path) -> PathBuf {
    let path = folder.join("reference.json");
    let column =
        |name: &str, values: [f64; 3]| json!({"name": name, "unit": "1", "values": values});
    let bound = |worst: f64| json!({"column": "electric_conductivity_s_m", "from_k": 0, "to_k": 1e5, "worst": worst});
    let value = |value: f64| json!({"column": "electric_conductivity_s_m", "at_k": 10_000, "value": value, "tolerance": 0.05, "source": "Becher"});
    let reference = json!({
        "kind": "gas-reference",
        "version": "1.0",
        "title": "Phlogiston as published",
        "tables": [{
            "source": "Becher 1667",
            "columns": [
                column("temperature_k", [2500.0, 5000.0, 12_500.0]),
                column("electric_conductivity_s_m", [2500.0, 5000.0, 12_500.0 / 0.9]),
            ],
            "bounds": [bound(0.11), bound(0.05)],
        }],
        "values": [value(10_100.0), value(20_000.0)],
    });
    std::fs::write(&path, reference.to_string()).unwrap();
    path
}

#[test]
fn a_page_of_gases_compares_and_judges() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (base, other) = (folder.join("base.mcap"), folder.join("other.mcap"));
    table(&base, 1.0, &[0.0, 0.5, 1.0]);
    table(&other, 0.7, &[0.0, 0.5, 1.0]);
    let words = [
        word("--table", "phlogiston", &base),
        word("--reference", "phlogiston", &reference(folder)),
        word("--variant", "phlogiston/weaker", &other),
    ];
    let (output, html) = report(folder, &words.concat());
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    for heading in [
        "phlogiston against published tables",
        "phlogiston",
        "What uncertain inputs change",
        "Where the columns come from",
    ] {
        assert!(html.contains(&format!(">{heading}</h2>")), "{heading}");
    }
    // 10 % off is inside 11 % and outside 5 %; 10,000 is 1 % off 10,100 and half of 20,000.
    assert_eq!(html.matches(">holds<").count(), 2);
    assert_eq!(html.matches(">missed<").count(), 2);
    assert!(html.contains("\u{2212}10.0 %"), "deviation");
    // The variant has 0.7 of the conductivity everywhere, and the same viscosity.
    assert!(html.contains("\u{2212}30.0 %") && html.contains("weaker"));
    assert!(html.contains("1.23 %"), "interpolation");
    assert!(html.contains("Stahl 1703") && html.contains("dephlogistication"));
    assert!(html.contains(">Ph</text>") && !html.contains(">rare</text>"));
    assert!(html.contains("x(Fe) = 0.5"));
    assert!(!html.contains("http:") && !html.contains("<script"));
}

#[test]
fn a_variant_that_is_compared_with_published_tables_is_no_uncertain_input() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (base, other) = (folder.join("base.mcap"), folder.join("other.mcap"));
    table(&base, 2.0, &[0.0]);
    table(&other, 1.0, &[0.0]);
    let words = [
        word("--table", "pure", &base),
        word("--variant", "pure/warm", &other),
        word("--reference", "pure/warm", &reference(folder)),
    ];
    let (output, html) = report(folder, &words.concat());
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(html.contains(">pure/warm against published tables</h2>"));
    assert!(!html.contains("What uncertain inputs change"));
    // The variant agrees as the gas of the other test does; the gas itself is twice as conductive.
    assert!(html.contains("\u{2212}10.0 %"));
}

#[test]
fn a_gas_without_iron_has_one_line_and_no_word_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let base = folder.join("base.mcap");
    table(&base, 1.0, &[0.0]);
    let (output, html) = report(folder, &word("--table", "pure", &base));
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(!html.contains("x(Fe)") && !html.contains("What uncertain inputs change"));
    assert!(!html.contains("published"));
}

#[test]
fn names_that_are_no_tables_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let base = folder.join("base.mcap");
    table(&base, 1.0, &[0.0]);
    let told = |more: [String; 2], code: i32, said: &str| {
        let words = [word("--table", "pure", &base), more].concat();
        let (output, _) = report(folder, &words);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{text}");
        assert!(text.contains(said), "'{said}' is not in: {text}");
    };
    told(
        word("--reference", "other", &reference(folder)),
        2,
        "'other' is not the name",
    );
    told(word("--variant", "pure", &base), 2, "NAME/VARIANT=FILE");
    told(
        word("--variant", "other/x", &base),
        2,
        "'other' is not the name",
    );
    told(word("--reference", "pure", &base), 1, "base.mcap");
}
