//! What distortion programs take over: a mesh under the temperatures of a run, and a fitted heat source.

use std::path::Path;
use std::process::Command;

use artefact::{Frame, Precision, Writer};
use serde_json::{Value, json};

use crate::skipped::skip;
use crate::{report, sample};

/// A block that is warmed as a whole from 300 K to 400 K and 350 K, by frames of points 1 mm apart.
fn warmed(path: &Path) {
    let header = sample::header("particle-frames", "poolsph");
    let mut writer = Writer::create(path, &header).unwrap();
    let plate = json!({"min_m": [0, 0, 0], "max_m": [0.01, 0.01, 0.01], "spacing_m": 1e-3,
        "particle_volume_m3": 1e-9, "melting_point_k": 1750.0, "direction": [0, 1, 0]});
    writer
        .json("/plate", 0.0, ("test.plate", "{}"), &plate)
        .unwrap();
    let mut places = Vec::new();
    for cell in 0..1000 {
        let at = [cell % 10, (cell / 10) % 10, cell / 100];
        places.push(at.map(|i| (f64::from(i) + 0.5) * 1e-3));
    }
    for (time, kelvin) in [(0.0, 300.0), (2.0, 400.0), (5.0, 350.0)] {
        let frame = Frame::new(Precision::F64)
            .positions(places.iter().copied())
            .scalar("temperature", "K", vec![kelvin; places.len()]);
        writer.frame("/particles", time, &frame).unwrap();
    }
    writer.finish().unwrap();
}

const MESH: &str = "*NODE, NSET=ALL
1, 0, 0, 0
2, 10, 0, 0
3, 10, 10, 0
4, 0, 10, 0
5, 0, 0, 10
6, 10, 0, 10
7, 10, 10, 10
8, 0, 10, 10
";

#[test]
fn a_block_that_is_warmed_as_a_whole_grows_by_its_expansion() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    warmed(Path::new(&at("block.mcap")));
    std::fs::write(at("mesh.inp"), MESH).unwrap();
    let words = [
        "calculix",
        &at("block.mcap"),
        "--mesh",
        &at("mesh.inp"),
        "--unit-m",
        "0.001",
        "--out",
        &at("block"),
    ];
    let output = report(&words);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{said}");
    assert!(said.contains("8 nodes, 2 steps"), "{said}");
    let start = std::fs::read_to_string(at("block-start.inp")).unwrap();
    assert!(
        start.contains("*INITIAL CONDITIONS, TYPE=TEMPERATURE\n1, 300.000\n"),
        "{start}"
    );
    let steps = std::fs::read_to_string(at("block-steps.inp")).unwrap();
    assert!(
        steps.contains("3, 3\n*TEMPERATURE\n1, 350.000\n"),
        "{steps}"
    );
    if Command::new("ccx").arg("-v").output().is_err() {
        skip("calculix", "ccx is not here: the steps are not run");
        return;
    }
    // Lengths in mm, stresses in MPa; 1.2e-5 1/K from 300 K on. What holds it lets it grow.
    let job = format!(
        "{MESH}*ELEMENT, TYPE=C3D8, ELSET=BLOCK\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*MATERIAL, NAME=STEEL\n*ELASTIC\n210000, 0.3\n\
         *EXPANSION, ZERO=300\n1.2e-5\n*SOLID SECTION, ELSET=BLOCK, MATERIAL=STEEL\n*BOUNDARY\n1, 1, 3\n2, 2, 3\n4, 3, 3\n4, 1, 1\n\
         *INCLUDE, INPUT=block-start.inp\n*INCLUDE, INPUT=block-steps.inp\n"
    );
    std::fs::write(at("job.inp"), job).unwrap();
    let ran = Command::new("ccx")
        .arg("job")
        .current_dir(folder.path())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&ran.stdout).into_owned();
    assert!(
        ran.status.success() && said.contains("Job finished"),
        "{said}"
    );
    let results = std::fs::read_to_string(at("job.frd")).unwrap();
    let grown = displacements(&results, 7);
    let exact = [1.2e-5 * 100.0 * 10.0, 1.2e-5 * 50.0 * 10.0];
    let last = grown.last().unwrap();
    assert!((last / exact[1] - 1.0).abs() < 1e-4, "{grown:?}");
    assert!(
        grown.iter().any(|x| (x / exact[0] - 1.0).abs() < 1e-4),
        "{grown:?}"
    );
}

/// Displacement along x of a node in all results of CalculiX.
fn displacements(results: &str, node: u64) -> Vec<f64> {
    let (mut found, mut inside) = (Vec::new(), false);
    for line in results.lines() {
        if line.starts_with(" -4") {
            inside = line.contains("DISP");
        }
        let own = line.starts_with(" -1")
            && line.get(3..13).and_then(|n| n.trim().parse().ok()) == Some(node);
        if inside && own {
            found.push(line[13..25].trim().parse().unwrap());
        }
    }
    found
}

#[test]
fn nodes_outside_of_the_metal_are_told_and_keep_the_start() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    warmed(Path::new(&at("block.mcap")));
    std::fs::write(at("mesh.inp"), "*NODE\n1, 5, 5, 5\n22, 50, 5, 5\n").unwrap();
    let words = |mesh: &str| {
        let (block, mesh, out) = (at("block.mcap"), at(mesh), at("out"));
        report(&[
            "calculix",
            &block,
            "--mesh",
            &mesh,
            "--unit-m",
            "1e-3",
            "--celsius",
            "--out",
            &out,
        ])
    };
    let output = words("mesh.inp");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(said.contains("warning: 1 of 2 nodes"), "{said}");
    let start = std::fs::read_to_string(at("out-start.inp")).unwrap();
    assert!(start.contains("1, 26.850\n22, 26.850\n"), "{start}");
    let steps = std::fs::read_to_string(at("out-steps.inp")).unwrap();
    assert!(!steps.contains("\n22, "), "{steps}");
    std::fs::write(at("none.inp"), "*ELEMENT\n1, 2\n").unwrap();
    let refused = words("none.inp");
    let said = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        said.contains("none.inp") && said.contains("*NODE"),
        "{said}"
    );
}

#[test]
fn the_pool_of_a_weld_is_an_ellipsoid_with_the_power_that_it_took() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pool.mcap");
    sample::weld(&path, 8.0, 9, true);
    // Nothing is told of its metal: nothing can be fitted.
    let refused = report(&["goldak", path.to_str().unwrap()]);
    let said = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2), "{said}");
    assert!(said.contains("--melt"), "{said}");
    let output = report(&["goldak", "--melt", path.to_str().unwrap()]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    let torch: Value = serde_json::from_slice(&output.stdout).unwrap();
    // 1.8 x 2600 W are stored.
    let power = torch["power_w"].as_f64().unwrap();
    assert!((power / 4680.0 - 1.0).abs() < 1e-9, "{power}");
    let speed = torch["path"]["speed_m_s"].as_f64().unwrap();
    assert!((speed - 5e-3).abs() < 1e-12);
    let shape = &torch["shape"]["double_ellipsoid"];
    let of = |key: &str| shape[key].as_f64().unwrap();
    println!("{shape}");
    assert!((of("half_width_m") - sample::HALF).abs() < sample::D);
    assert!((of("depth_m") - sample::DEEP).abs() < sample::D);
    assert!(of("front_m") > 0.0 && of("rear_m") > of("front_m"));
}

#[test]
fn the_last_frame_is_handed_over_however_few_are() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    warmed(Path::new(&at("block.mcap")));
    std::fs::write(at("mesh.inp"), MESH).unwrap();
    let output = report(&[
        "calculix",
        &at("block.mcap"),
        "--mesh",
        &at("mesh.inp"),
        "--unit-m",
        "0.001",
        "--every",
        "10",
        "--out",
        &at("block"),
    ]);
    assert!(output.status.success(), "{output:?}");
    let steps = std::fs::read_to_string(at("block-steps.inp")).unwrap();
    assert!(
        steps.contains("5, 5\n*TEMPERATURE\n1, 350.000\n"),
        "{steps}"
    );
}

#[test]
fn a_drop_on_its_way_is_no_part_of_the_body() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    sample::weld(Path::new(&at("pool.mcap")), 8.0, 2, true);
    // The sample has a drop beside the plate.
    std::fs::write(at("mesh.inp"), "*NODE\n1, 20, 30, -20\n2, 0, 10, -2\n").unwrap();
    let words = [
        "calculix",
        &at("pool.mcap"),
        "--mesh",
        &at("mesh.inp"),
        "--unit-m",
        "0.001",
        "--out",
        &at("out"),
    ];
    let output = report(&words);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(said.contains("warning: 1 of 2 nodes"), "{said}");
}
