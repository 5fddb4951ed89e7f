//! Our files open in other people's programs: MCAP readers for Foxglove's point clouds and grids, VTK
//! for ParaView, NumPy. The readers are Python packages in `build/python`, installed by `make test`.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stderr,
    reason = "a test may fail, and says what it skips"
)]

mod layout;
mod package;

use std::path::{Path, PathBuf};
use std::process::Command;

use artefact::{Frame, GRID, Header, Precision, Reader, Record, Table, Version, Writer};
use serde_json::Value;
use verification::skipped::skip;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .to_owned()
}

fn program(name: &str) -> PathBuf {
    Path::new(env!("CARGO_BIN_EXE_verify")).with_file_name(name)
}

/// The interpreter with the readers, or `None` where it is not installed.
fn python() -> Option<PathBuf> {
    let path = root().join("build/python/bin/python");
    if path.exists() && root().join("build/python/.installed").exists() {
        return Some(path);
    }
    let why = "no Python readers in build/python: run `make build/python/.installed`";
    skip("python", why);
    None
}

fn ask(python: &Path, script: &str, arguments: &[&str]) -> Value {
    let output = Command::new(python)
        .arg(root().join("tests/interop").join(script))
        .args(arguments)
        .env("PYTHONPATH", root().join("tools/python"))
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{script}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Three frames of a thousand particles, one without any, and tables on grids with uneven and even
/// axes, 4 mm along y, whose values are 1000 times the node's number and a part that is no round number.
fn sample(path: &Path) {
    let header = Header {
        kind: "particle-frames".to_owned(),
        version: Version::new(1, 0),
        tool: "poolsph".to_owned(),
        tool_version: "0.1.0".to_owned(),
        scene: serde_json::json!({"kind": "poolsph.scene", "version": 2}),
        inputs: Default::default(),
    };
    let mut writer = Writer::create(path, &header).unwrap();
    for step in 0..3 {
        let n = 1000 + step;
        writer
            .frame("/particles", 0.25 * step as f64, &particles(n))
            .unwrap();
    }
    writer.frame("/pool", 0.0, &particles(0)).unwrap();
    for (channel, height) in [("/plasma", 2e-3), ("/section", 1e-3)] {
        let radius = if channel == "/plasma" { 3e-3 } else { 2e-3 };
        let table = Table::grid(&[
            ("radius_m", "m", &[0.0, 1e-3, radius]),
            ("height_m", "m", &[0.0, height]),
        ])
        .column("temperature_k", "K", (0..6).map(|i| 1000.0 * f64::from(i)))
        .column("share", "1", (0..6).map(|i| f64::from(i) / 7.0))
        .attribute("y_m", "m", 4e-3);
        writer.table(channel, 0.5, &table).unwrap();
    }
    let record = Record::new().with("mass_kg", "kg", 0.5);
    writer.record("/balance", 0.5, &record).unwrap();
    writer.finish().unwrap();
}

fn particles(n: usize) -> Frame {
    let position = (0..n).map(|i| [i as f64 * 1e-3, 0.0, -1e-3]);
    Frame::new(Precision::F32)
        .positions(position)
        .scalar("temperature", "K", (0..n).map(|i| 300.0 + i as f64))
        .vector("velocity", "m/s", (0..n).map(|i| [0.0, i as f64, 1.0]))
        .flag("molten", (0..n).map(|i| u8::from(i > 500)))
        .id("id", 0..n as u32)
}

#[test]
fn point_clouds_are_read_by_the_packages_that_foxglove_publishes() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("frames.mcap");
    sample(&file);
    let found = ask(
        &python,
        "read_frames.py",
        &[file.to_str().unwrap(), "/particles"],
    );
    assert_eq!(found["schema"], "foxglove.PointCloud");
    assert_eq!(found["points"], serde_json::json!([1000, 1001, 1002]));
    assert_eq!(found["times_s"], serde_json::json!([0.0, 0.25, 0.5]));
    assert_eq!(found["stamp_s"], 0.5);
    assert_eq!(
        found["fields"],
        serde_json::json!([
            "x",
            "y",
            "z",
            "temperature",
            "velocity_x",
            "velocity_y",
            "velocity_z",
            "molten",
            "id"
        ])
    );
    assert_eq!(found["temperature_k"], serde_json::json!([300.0, 1301.0]));
    assert_eq!(found["metadata"]["fusionline"]["kind"], "particle-frames");
}

#[test]
fn grids_are_read_by_the_packages_that_foxglove_publishes_as_by_our_reader() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("frames.mcap");
    sample(&file);
    let found = ask(
        &python,
        "read_grid.py",
        &[file.to_str().unwrap(), "/section"],
    );
    assert_eq!(found["schema"], GRID);
    assert_eq!(found["times_s"], serde_json::json!([0.5]));
    assert_eq!(found["stamp_s"], 0.5);
    assert_eq!(found["frame_id"], "world");
    let table = Reader::open(&file).unwrap().table("/section").unwrap();
    assert_eq!(found["shape"], serde_json::json!(table.shape));
    for column in &table.columns {
        let values: Vec<f64> =
            serde_json::from_value(found["values"][&column.name].clone()).unwrap();
        assert_eq!(values, column.values, "{}, to the last bit", column.name);
        assert_eq!(found["units"][&column.name], column.unit.as_str());
    }
    let centres: Vec<[f64; 3]> = serde_json::from_value(found["centres"].clone()).unwrap();
    let (radius, height) = (
        table.axis("radius_m").unwrap(),
        table.axis("height_m").unwrap(),
    );
    assert_eq!(centres.len(), radius.len() * height.len());
    for (n, [x, y, z]) in centres.into_iter().enumerate() {
        let [i, j] = [n / height.len(), n % height.len()];
        let there = near(x, radius[i]) && near(y, 4e-3) && near(z, height[j]);
        assert!(there, "node {n} is at ({x}, {y}, {z}) m");
    }
}

/// Exports with the program `artefact` and returns the files it wrote.
fn export(file: &Path, to: &str, out: &Path) -> Vec<PathBuf> {
    let output = Command::new(program("artefact"))
        .arg("export")
        .arg(file)
        .args(["--to", to, "--out"])
        .arg(out)
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "export --to {to}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    let mut found = Vec::new();
    walk(out, &mut found);
    found.sort();
    found
}

fn walk(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            walk(&path, found);
        } else {
            found.push(path);
        }
    }
}

#[test]
fn exports_open_in_the_library_that_paraview_reads_with() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("frames.mcap");
    sample(&file);
    let written = export(&file, "vtu", &folder.path().join("vtu"));
    let readable: Vec<&str> = written
        .iter()
        .filter(|p| {
            p.extension()
                .is_some_and(|e| e == "vtu" || e == "vti" || e == "vtr")
        })
        .map(|p| p.to_str().unwrap())
        .collect();
    assert!(
        written
            .iter()
            .any(|p| p.extension().is_some_and(|e| e == "pvd")),
        "a series needs a .pvd: {written:?}"
    );
    let found = ask(&python, "open_exports.py", &readable);
    for step in 0..3 {
        let cloud = &found[format!("particles_0000{step}.vtu")];
        let n = 1000 + step;
        assert_eq!(cloud["points"], n, "{found}");
        assert_eq!(cloud["time_s"], 0.25 * f64::from(step));
        assert_eq!(cloud["arrays"]["temperature"]["tuples"], n);
        assert_eq!(cloud["arrays"]["temperature"]["unit"], "K");
        assert_eq!(cloud["arrays"]["velocity"]["components"], 3);
        assert_eq!(
            cloud["arrays"]["id"]["range"],
            serde_json::json!([0.0, f64::from(n - 1)])
        );
    }
    assert_eq!(found["pool_00000.vtu"]["points"], 0, "a frame without any");
    for (grid, radius, height) in [
        ("plasma_00000.vtr", 3e-3, 2e-3),
        ("section_00000.vti", 2e-3, 1e-3),
    ] {
        let nodes: Vec<[f64; 4]> = serde_json::from_value(found[grid]["nodes"].clone())
            .unwrap_or_else(|e| panic!("{grid}: {e} in {found}"));
        assert_eq!(nodes.len(), 6);
        for [x, y, z, value] in nodes {
            let i = [0.0, 1e-3, radius].iter().position(|r| near(*r, x));
            let j = [0.0, height].iter().position(|h| near(*h, z));
            let node = 2 * i.unwrap() + j.unwrap();
            assert!(near(y, 4e-3) && near(value, 1000.0 * node as f64), "{grid}");
        }
    }
    let series = std::fs::read_to_string(folder.path().join("vtu/balance.csv")).unwrap();
    assert_eq!(series, "log_time [s],mass_kg [kg]\r\n0.5,0.5\r\n");
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

#[test]
fn exports_open_in_numpy() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("frames.mcap");
    sample(&file);
    let written = export(&file, "npz", &folder.path().join("npz"));
    let readable: Vec<&str> = written
        .iter()
        .filter(|p| p.extension().is_some_and(|e| e == "npz"))
        .map(|p| p.to_str().unwrap())
        .collect();
    assert!(!readable.is_empty());
    let found = ask(&python, "open_exports.py", &readable);
    let frame = &found["particles_00002.npz"]["arrays"];
    assert_eq!(frame["temperature"]["shape"], serde_json::json!([1002]));
    assert_eq!(frame["log_time_s"]["shape"], serde_json::json!([]));
    let grid = &found["plasma_00000.npz"]["arrays"];
    assert_eq!(grid["temperature_k"]["shape"], serde_json::json!([3, 2]));
    assert_eq!(grid["radius_m"]["shape"], serde_json::json!([3]));
    let series = &found["balance.npz"]["arrays"];
    assert_eq!(series["mass_kg"]["shape"], serde_json::json!([1]));
}

/// The Python programs in a page of ours.
fn programs_in(page: &str) -> Vec<String> {
    let text = std::fs::read_to_string(root().join(page)).unwrap();
    let blocks = text.split("```python\n").skip(1);
    blocks
        .map(|block| block.split("```").next().unwrap().to_owned())
        .collect()
}

/// Runs a program on `file` and gives what it printed.
fn print_of(python: &Path, folder: &Path, program: &str, file: &Path) -> String {
    let script = folder.join("program.py");
    std::fs::write(&script, program).unwrap();
    let output = Command::new(python)
        .arg(&script)
        .arg(file)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}\nin\n{program}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn the_programs_that_our_pages_show_do_what_they_say() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("frames.mcap");
    sample(&file);
    let programs = programs_in("tools/harness/artefact/FORMAT.md");
    let [frames, grids, tables] = programs.as_slice() else {
        panic!("{} programs", programs.len());
    };
    let told = print_of(&python, folder.path(), frames, &file);
    let lines: Vec<&str> = told.lines().collect();
    assert_eq!(lines.len(), 3, "{told}");
    assert!(lines[2].starts_with("0.5 s 1002 1.001"), "{told}");
    assert!(lines[2].contains("\"temperature\":\"K\""), "{told}");
    let told = print_of(&python, folder.path(), tables, &file);
    let share = 5.0 / 7.0;
    let lines = |channel: &str| {
        format!("{channel} temperature_k K (3, 2) 5000.0\n{channel} share 1 (3, 2) {share}\n")
    };
    assert_eq!(told, lines("/plasma"));
    let told = print_of(&python, folder.path(), grids, &file);
    assert_eq!(told, lines("/section"));

    let readme = programs_in("README.md");
    assert_eq!(readme.len(), 1, "the README shows one program");
    let name = "build/gmaw-quick/pool.mcap";
    assert!(readme[0].contains(name), "{}", readme[0]);
    let program = readme[0].replace(name, file.to_str().unwrap());
    let told = print_of(&python, folder.path(), &program, &file);
    let last = told.lines().last().unwrap();
    assert_eq!(last, "0.5 s 1301.0 K", "{told}");
}
