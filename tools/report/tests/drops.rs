//! The page of drops, from a drop with known content.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use artefact::{Frame, Header, Precision, Record, Table, Version, Writer};
use serde_json::Value;

fn write(path: &Path, fill: impl FnOnce(&mut Writer)) {
    let header = Header {
        kind: "point-fields".to_owned(),
        version: Version::new(1, 0),
        tool: "emfield".to_owned(),
        tool_version: "0.1.0".to_owned(),
        scene: Value::Null,
        inputs: BTreeMap::new(),
    };
    let mut writer = Writer::create(path, &header).unwrap();
    fill(&mut writer);
    writer.finish().unwrap();
}

#[test]
fn a_study_of_drops_shows_motion_curves_and_shapes() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("drops");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    write(&folder.join("moves.mcap"), |writer| {
        for step in 0..5 {
            let time = 1e-6 * f64::from(step);
            let long = 1e-3 * (1.0 + 0.02 * f64::from(step));
            let row = Record::new()
                .with("radius_z", "m", long)
                .with("mode_2", "m", long - 1e-3);
            writer.record("/liquid", time, &row).unwrap();
            let places = (0..400).map(|k| {
                let (z, turn) = (1.0 - (f64::from(k) + 0.5) / 200.0, 2.4 * f64::from(k));
                let ring = 1e-3 * (1.0 - z * z).sqrt();
                [ring * turn.cos(), ring * turn.sin(), long * z]
            });
            let frame = Frame::new(Precision::F32).positions(places);
            writer.frame("/surface", time, &frame).unwrap();
        }
    });
    write(&folder.join("rests.mcap"), |writer| {
        let row = Record::new().with("deformation", "1", 0.125);
        writer.record("/liquid", 0.0, &row).unwrap();
        let table = Table::new(3).column("r_m", "m", [1e-3, 7e-4, 0.0]).column(
            "z_m",
            "m",
            [0.0, 7e-4, 1e-3],
        );
        writer.table("/outline", 0.0, &table).unwrap();
    });
    let named = |name: &str| format!("{name}={}", folder.join(format!("{name}.mcap")).display());
    let mut command = Command::new(env!("CARGO_BIN_EXE_report"));
    command.args(["drop", "--study", "sample", "--out"]);
    command.arg(folder.join("report.html"));
    command.args(["--drop", &named("moves"), "--drop", &named("rests")]);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let html = std::fs::read_to_string(folder.join("report.html")).unwrap();
    for words in [
        "<animate",
        "5 frames",
        "moves: radii over time",
        "Outlines of drops at rest",
        "deformation",
        "1.250000e-1",
    ] {
        assert!(html.contains(words), "{words}");
    }
}

/// Two spheres of surface points, a parcel between them, in frames that bring them together.
fn meet(writer: &mut Writer) {
    let sphere = |middle: f64| {
        (0..300).map(move |k| {
            let (z, turn) = (1.0 - (f64::from(k) + 0.5) / 150.0, 2.4 * f64::from(k));
            let ring = 1e-3 * (1.0 - z * z).sqrt();
            [ring * turn.cos(), ring * turn.sin(), middle + 1e-3 * z]
        })
    };
    for step in 0..4 {
        let (time, apart) = (1e-3 * f64::from(step), 3e-3 - 5e-4 * f64::from(step));
        let both = || sphere(-0.5 * apart).chain(sphere(0.5 * apart));
        let group = (0..600).map(|k| u32::from(k >= 300));
        let row = Record::new()
            .with("drops", "1", 2.0)
            .with("extent_z", "m", apart + 2e-3);
        writer.record("/liquid", time, &row).unwrap();
        let frame = || Frame::new(Precision::F32).positions(both());
        writer
            .frame("/points", time, &frame().id("group", group))
            .unwrap();
        let areas = frame().scalar("area", "m2", (0..600).map(|_| 4.2e-8));
        writer.frame("/surface", time, &areas).unwrap();
        let places = [
            [0.0, 0.0, -0.5 * apart],
            [0.0, 0.0, 0.5 * apart],
            [4e-3, 0.0, 0.0],
        ];
        let groups = Frame::new(Precision::F32)
            .positions(places)
            .flag("shaped", [1, 1, 0]);
        writer.frame("/groups", time, &groups).unwrap();
    }
}

#[test]
fn drops_that_meet_have_a_film_and_a_picture_for_each_frame() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("meeting");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("meet.mcap");
    write(&file, meet);
    let mut command = Command::new(env!("CARGO_BIN_EXE_report"));
    command.args(["drop", "--study", "sample", "--out"]);
    command.arg(folder.join("report.html"));
    command
        .arg("--drop")
        .arg(format!("meet={}", file.display()));
    assert!(command.status().unwrap().success());
    let page = std::fs::read_to_string(folder.join("report.html")).unwrap();
    assert!(
        page.contains("numbered anew in each frame; parcels grey; 4 pictures"),
        "{page}"
    );
    assert_eq!(page.matches("data:image/png").count(), 5);
    assert!(page.contains("meet: lengths over time") && page.contains("meet: drops over time"));
    // No ray from a middle tells the outline of two drops.
    assert!(!page.contains("<animate"));
}
