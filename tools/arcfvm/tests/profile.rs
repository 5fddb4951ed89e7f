//! The surface of a pool as an input.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use artefact::{Header, Reader, Table, Version, Writer};
use serde_json::{Value, json};

const SCENE: &str = "pipelines/verify/arc-surface/scene.json";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A profile as `avg` writes it, of rings `d` wide; `height` goes with the radius.
fn write(path: &Path, d: f64, rings: u32, height: impl Fn(f64) -> f64, share: f64) {
    let header = Header {
        kind: "mean-fields".to_owned(),
        version: Version::new(1, 2),
        tool: "test".to_owned(),
        tool_version: "0".to_owned(),
        scene: json!({}),
        inputs: std::collections::BTreeMap::new(),
    };
    let outer: Vec<f64> = (1..=rings).map(|i| d * f64::from(i)).collect();
    let middle = |r: &f64| (0.5 * (r * r + (r - d) * (r - d))).sqrt();
    let radius: Vec<f64> = outer.iter().map(middle).collect();
    let table = Table::new(outer.len())
        .column("radius_m", "m", radius.iter().copied())
        .column("outer_radius_m", "m", outer.iter().copied())
        .column("height_m", "m", radius.iter().map(|r| height(*r)))
        .column("metal_share", "1", outer.iter().map(|_| share));
    let mut writer = Writer::create(path, &header).unwrap();
    writer.table("/profile", 0.0, &table).unwrap();
    writer.finish().unwrap();
}

/// `arcfvm` with the base of a small arc below a profile.
fn arcfvm(action: &str, folder: &Path, surface: &str) -> Output {
    let patch = folder.join("patch.json");
    let profile = json!({"r_m": [0, 0.008], "bottom_m": -0.002});
    let shape = json!({"shape": {"ring": null, "profile": profile}});
    std::fs::write(&patch, json!({"bodies": {"base": shape}}).to_string()).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_arcfvm"));
    command.current_dir(root()).args([action, SCENE, "--patch"]);
    command
        .arg(patch)
        .args(["--input", "gas=pipelines/gases/argon-1atm.json"]);
    let surface = folder.join(surface);
    command
        .arg("--input")
        .arg(format!("surface={}", surface.display()));
    if action == "run" {
        command.arg("--out").arg(folder.join("arc.mcap"));
        command.args(["--threads", "1", "--progress", "none"]);
    }
    command.output().unwrap()
}

/// A column and its values, with the name of its channel.
type Column = (String, Vec<f64>);

/// All columns of an artefact.
fn columns(path: &Path) -> Vec<Column> {
    let reader = Reader::open_kind(path, "arc-source", 1).unwrap();
    let all = ["/plasma", "/surface", "/lorentz"].into_iter();
    all.flat_map(|channel| {
        let table = reader.table(channel).unwrap();
        let own = table.columns.into_iter();
        own.map(move |c| (format!("{channel} {}", c.name), c.values))
    })
    .collect()
}

#[test]
fn a_level_pool_is_the_plate_without_one() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(&folder.join("mean.mcap"), 5e-4, 12, |_| 0.0, 1.0);
    let output = arcfvm("run", folder, "mean.mcap");
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let plain = folder.join("plain.mcap");
    let status = Command::new(env!("CARGO_BIN_EXE_arcfvm"))
        .current_dir(root())
        .args([
            "run",
            SCENE,
            "--input",
            "gas=pipelines/gases/argon-1atm.json",
        ])
        .arg("--out")
        .arg(&plain)
        .args(["--threads", "1", "-q"])
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(0));
    assert!(
        columns(&plain) == columns(&folder.join("arc.mcap")),
        "other fields"
    );
}

#[test]
fn a_pool_holds_its_volume_and_takes_up_all_that_its_surface_does() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // Middles of cells at -0.2 and -0.6 mm: two rows are open within 2 mm.
    let bowl = |r: f64| (-1e-3 + 250.0 * r * r).min(0.0);
    write(&folder.join("mean.mcap"), 2e-4, 30, bowl, 0.96);
    let output = arcfvm("run", folder, "mean.mcap");
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let reader = Reader::open_kind(folder.join("arc.mcap"), "arc-source", 1).unwrap();
    let table = reader.table("/surface").unwrap();
    let (radius, height) = (
        table.values("radius_m").unwrap(),
        table.values("surface_height_m").unwrap(),
    );
    for (r, z) in radius.iter().zip(height) {
        assert!(
            (z - bowl(*r)).abs() <= 2.05e-4,
            "{z} for {} at {r}",
            bowl(*r)
        );
    }
    let ring = |r: f64| 2.0 * std::f64::consts::PI * r * 4e-4;
    let sum = |of: &[f64]| {
        radius
            .iter()
            .zip(of)
            .map(|(r, v)| ring(*r) * v)
            .sum::<f64>()
    };
    // What the columns take up, as seen from above, is what the balance says, less the heat of its own current.
    let balance = reader.record("/balance").unwrap();
    let heat = balance.get("base_total_w").unwrap() - balance.get("base_joule_w").unwrap();
    let found = sum(table.values("heat_flux_total_w_m2").unwrap());
    assert!((found / heat - 1.0).abs() < 1e-9, "{found} W of {heat} W");
    assert!((sum(table.values("current_density_a_m2").unwrap()) / 80.0 - 1.0).abs() < 1e-6);
}

#[test]
fn the_force_in_a_pool_counts_its_depth_from_the_surface_above() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let bowl = |r: f64| (-1e-3 + 250.0 * r * r).min(0.0);
    write(&folder.join("mean.mcap"), 2e-4, 30, bowl, 1.0);
    arcfvm("run", folder, "mean.mcap");
    let reader = Reader::open_kind(folder.join("arc.mcap"), "arc-source", 1).unwrap();
    let (force, plasma) = (
        reader.table("/lorentz").unwrap(),
        reader.table("/plasma").unwrap(),
    );
    let surface = reader.table("/surface").unwrap();
    let heights = plasma.axis("height_m").unwrap();
    let depths = force.axis("depth_m").unwrap();
    let mut sunk = 0;
    for (i, top) in surface
        .values("surface_height_m")
        .unwrap()
        .iter()
        .enumerate()
    {
        sunk += usize::from(*top < -1e-6);
        for (k, depth) in depths.iter().enumerate() {
            let row = heights
                .iter()
                .position(|z| (z - (top - depth)).abs() < 1e-9);
            for name in ["lorentz_radial_n_m3", "lorentz_axial_n_m3"] {
                let found = force.values(name).unwrap()[i * depths.len() + k];
                let own = row.map(|j| plasma.values(name).unwrap()[i * heights.len() + j]);
                let own = own.unwrap_or(0.0);
                assert!(
                    (found - own).abs() <= 1e-9 * own.abs(),
                    "{name} {i} {k}: {found} {own}"
                );
            }
        }
    }
    let first = force.values("lorentz_radial_n_m3").unwrap()[0];
    assert!(sunk > 3 && first < -1.0, "{sunk} {first}");
}

#[test]
fn the_arc_of_the_study_stands_over_the_pool_that_it_is_given() {
    let folder = tempfile::tempdir().unwrap();
    let surface = folder.path().join("mean.mcap");
    let pool = |r: f64| if r < 1e-3 { -1.9e-3 } else { 1.1e-3 };
    write(&surface, 5e-4, 15, pool, 1.0);
    let output = Command::new(env!("CARGO_BIN_EXE_arcfvm"))
        .current_dir(root())
        .args(["check", "pipelines/gmaw-300a/arc.json", "--patch"])
        .arg("pipelines/gmaw-two-pass/arc.patch.json")
        .args(["--input", "gas=pipelines/gases/argon-1atm.json", "--input"])
        .arg(format!("surface={}", surface.display()))
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{output:?}");
}

#[test]
fn what_is_no_pool_of_this_arc_is_refused_with_figures() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    type Surface = fn(f64) -> f64;
    let cases: [(&str, Surface, f64, &[&str]); 4] = [
        (
            "deep.mcap",
            |r| if r < 1e-3 { -2.5e-3 } else { 0.0 },
            1.0,
            &[
                "/bodies/base/shape/profile",
                "deep.mcap",
                "bottom_m is -2.000 mm",
                "z = -2.500 mm at r = 0.354 mm",
            ],
        ),
        (
            "high.mcap",
            |r| if r > 5e-3 { 7e-3 } else { 0.0 },
            1.0,
            &[
                "high.mcap",
                "leaves the domain, which ends at 6.000 mm",
                "z = 7.000 mm at r = 5.256 mm",
            ],
        ),
        (
            "bare.mcap",
            |_| 0.0,
            0.83,
            &["bare.mcap", "r = 0.500 mm", "83.0 %", "profile/radius_m"],
        ),
        ("wire.mcap", |_| 4e-3, 1.0, &["overlaps"]),
    ];
    for (name, height, share, wanted) in cases {
        write(&folder.join(name), 5e-4, 12, height, share);
        let output = arcfvm("check", folder, name);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success(), "{name}");
        for word in wanted {
            assert!(said.contains(word), "{name}: {word} is not in: {said}");
        }
    }
}

#[test]
fn files_without_a_profile_are_refused_by_kind_or_channel() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let told = |name: &str| {
        let output = arcfvm("check", folder, name);
        assert!(!output.status.success());
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let header = |kind: &str| Header {
        kind: kind.to_owned(),
        version: Version::new(1, 0),
        tool: "test".to_owned(),
        tool_version: "0".to_owned(),
        scene: json!({}),
        inputs: std::collections::BTreeMap::new(),
    };
    for (name, kind) in [
        ("old.mcap", "mean-fields"),
        ("frames.mcap", "particle-frames"),
    ] {
        let mut writer = Writer::create(folder.join(name), &header(kind)).unwrap();
        let table = Table::new(1).column("radius_m", "m", [1e-3]);
        writer.table("/surface", 0.0, &table).unwrap();
        writer.finish().unwrap();
    }
    let said = told("old.mcap");
    assert!(
        said.contains("no channel '/profile'") && said.contains("scene of avg"),
        "{said}"
    );
    let said = told("frames.mcap");
    assert!(
        said.contains("'particle-frames'") && said.contains("'mean-fields'"),
        "{said}"
    );
}

#[test]
fn a_pool_that_no_cell_tells_is_said_to_be_level() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let shallow = |r: f64| (-1.5e-4 + 50.0 * r * r).min(0.0);
    write(&folder.join("mean.mcap"), 5e-4, 12, shallow, 1.0);
    let output = arcfvm("check", folder, "mean.mcap");
    let said = String::from_utf8_lossy(&output.stdout).into_owned()
        + &String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    for word in [
        "\"base\" bends by 0.144 mm alone",
        "from z = -0.144 to 0.000 mm",
        "level at z = 0.000 mm",
    ] {
        assert!(said.contains(word), "{word} is not in: {said}");
    }
    let told: Value = json!({"kind": "surface-profile", "version": "1.0", "radius_m": [0.001], "height_m": [0.0]});
    std::fs::write(folder.join("level.json"), told.to_string()).unwrap();
    let output = arcfvm("check", folder, "level.json");
    assert_eq!(output.status.code(), Some(0));
    assert!(!String::from_utf8_lossy(&output.stdout).contains("no cell tells"));
}
