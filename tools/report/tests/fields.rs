//! Pages of electric and magnetic fields from points with known content.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use artefact::{Frame, Header, Precision, Record, Table, Version, Writer};
use serde_json::{Value, json};

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn write(path: &Path, scene: Value, fill: impl FnOnce(&mut Writer)) {
    let header = Header {
        kind: "point-fields".to_owned(),
        version: Version::new(1, 0),
        tool: "emfield".to_owned(),
        tool_version: "0.1.0".to_owned(),
        scene,
        inputs: BTreeMap::new(),
    };
    let mut writer = Writer::create(path, &header).unwrap();
    fill(&mut writer);
    writer.finish().unwrap();
}

/// A ball of 1 mm in a lattice of 0.25 mm, whose flux density is 2 mT along x and, a quarter of a period off, 1.5 mT
/// along z; in the ball flows current.
fn ball(path: &Path) {
    let scene = json!({"title": "A ball", "geometry": "space",
        "domain": {"box": {"min_m": [-2e-3, -2e-3, -2e-3], "max_m": [2e-3, 2e-3, 2e-3]}},
        "bodies": [{"name": "ball", "shape": {"sphere": {"centre_m": [0, 0, 0], "radius_m": 1e-3}},
            "conductivity_s_m": 1e7}],
        "eddy_currents": {"harmonic": {"frequency_hz": 1e5}, "coils": [
            {"loop": {"centre_m": [0, 0, -1.5e-3], "radius_m": 1e-3, "wire_radius_m": 1e-4, "current_a": 1}}]},
        "output": {"lines": [{"name": "axis", "from_m": [0, 0, 0], "to_m": [0, 0, 1e-3], "points": 11}]}});
    let steps = -8..=8;
    let mut places: Vec<[f64; 3]> = Vec::new();
    for i in steps.clone() {
        for j in steps.clone() {
            for k in steps.clone() {
                places.push([i, j, k].map(|n| f64::from(n) * 2.5e-4));
            }
        }
    }
    let inside = |p: &[f64; 3]| p.iter().map(|x| x * x).sum::<f64>() <= 1e-6;
    let wall = |p: &[f64; 3]| p.iter().any(|x| x.abs() > 1.9e-3);
    let medium: Vec<u8> = places.iter().map(|p| u8::from(inside(p))).collect();
    let kind: Vec<u8> = places.iter().map(|p| 2 * u8::from(wall(p))).collect();
    let all = |v: [f64; 3]| vec![v; places.len()];
    let current = places.iter().map(|p| {
        if inside(p) {
            [-p[1] * 1e9, p[0] * 1e9, 0.0]
        } else {
            [0.0; 3]
        }
    });
    let current: Vec<[f64; 3]> = current.collect();
    let points = Frame::new(Precision::F64)
        .positions(places.iter().copied())
        .scalar("spacing", "m", vec![2.5e-4; places.len()])
        .flag("kind", kind)
        .flag("medium", medium)
        .vector("magnetic_flux_density_real", "T", all([2e-3, 0.0, 0.0]))
        .vector("magnetic_flux_density_imag", "T", all([0.0, 0.0, 1.5e-3]))
        .vector("current_density_real", "A/m2", all([0.0; 3]))
        .vector("current_density_imag", "A/m2", current);
    let z: Vec<f64> = (0..11).map(|k| f64::from(k) * 1e-4).collect();
    let still = |v: f64| vec![v; 11];
    let line = Table::new(11)
        .column("distance_m", "m", z.clone())
        .column("x_m", "m", still(0.0))
        .column("y_m", "m", still(0.0))
        .column("z_m", "m", z)
        .column("magnetic_flux_density_real_x", "T", still(2e-3))
        .column("magnetic_flux_density_imag_z", "T", still(1.5e-3));
    let totals = Record::new()
        .with("force_volume_z", "N", 0.0102)
        .with("force_maxwell_z", "N", 0.0099)
        .with("force_coil_z", "N", 0.0100)
        .with("force_spread", "N", 0.0003)
        .with("power_volume", "W", 2.5);
    write(path, scene, |writer| {
        writer.frame("/points", 0.0, &points).unwrap();
        writer.table("/line/axis", 0.0, &line).unwrap();
        writer.record("/totals", 0.0, &totals).unwrap();
    });
}

/// The exact field: a tenth of the greatest more along x.
fn exact(path: &Path) {
    let column = |name: &str, v: f64| json!({"name": name, "unit": "T", "values": vec![v; 11]});
    let file = json!({"kind": "field-exact", "version": "1.0", "source": "a sheet of paper",
        "lines": [{"name": "axis", "columns": [
            column("magnetic_flux_density_real_x", 2.4e-3), column("magnetic_flux_density_imag_z", 1.8e-3)]}],
        "totals": [{"name": "force_volume_z", "unit": "N", "value": 0.01}]});
    std::fs::write(path, file.to_string()).unwrap();
}

fn report(folder: &Path, words: &[String]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_report"));
    command.args(["field", "--study", "sample", "--out"]);
    command.arg(folder.join("report.html")).args(words);
    command.output().unwrap()
}

fn named(word: &str, folder: &Path, file: &str) -> [String; 2] {
    [
        word.to_owned(),
        format!("run={}", folder.join(file).display()),
    ]
}

#[test]
fn a_study_of_fields_shows_sections_lines_totals_and_points() {
    let folder = folder("fields");
    ball(&folder.join("ball.mcap"));
    exact(&folder.join("exact.json"));
    let words = [
        named("--fields", &folder, "ball.mcap"),
        named("--exact", &folder, "exact.json"),
    ];
    let output = report(&folder, &words.concat());
    assert!(output.status.success(), "{output:?}");
    let html = std::fs::read_to_string(folder.join("report.html")).unwrap();
    for heading in [
        "What came out",
        "Fields in a section",
        "Fields along lines",
        "The points",
    ] {
        assert!(html.contains(&format!(">{heading}</h2>")), "{heading}");
    }
    // |B| and |J| in the upright section, |J| in the level one, the cloud.
    assert_eq!(html.matches("data:image/png;base64,").count(), 4);
    // 2 % more than the exact one; 0.3 of 10.2 mN.
    assert!(html.contains(">10.20</td>") && html.contains(">+2.00 %</td>"));
    assert!(html.contains("differ by 300 \u{b5}N at most, 2.94 % of it"));
    // 0.5 of 3 mT.
    assert!(html.contains(">16.67 %</td>") && html.contains("a sheet of paper"));
    // A field that is everywhere the same, and its error.
    assert_eq!(html.matches("<svg").count(), 2);
    assert!(
        html.contains(
            "Arrows of one length show the direction while the current of the coils rises"
        )
    );
    assert!(!html.contains("Traction") && !html.contains("Fields over time"));
    assert!(!html.contains("http:") && !html.contains("https:") && !html.contains("<script"));
}

#[test]
fn another_kind_of_file_is_no_exact_solution() {
    let folder = folder("fields-kind");
    ball(&folder.join("ball.mcap"));
    let file = json!({"kind": "others", "source": "", "lines": []});
    std::fs::write(folder.join("exact.json"), file.to_string()).unwrap();
    let words = [
        named("--fields", &folder, "ball.mcap"),
        named("--exact", &folder, "exact.json"),
    ];
    let output = report(&folder, &words.concat());
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        said.contains("'others'") && said.contains("'field-exact'"),
        "{said}"
    );
}
