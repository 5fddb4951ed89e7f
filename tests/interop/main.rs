//! Our files open in other people's programs: MCAP readers for Foxglove's point clouds, VTK for
//! ParaView, NumPy. The readers are Python packages in `build/python`, installed by `make test`.

use std::path::{Path, PathBuf};
use std::process::Command;

use artefact::{Frame, Header, Precision, Table, Version, Writer};
use serde_json::Value;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .to_owned()
}

fn program(name: &str) -> PathBuf {
    Path::new(env!("CARGO_BIN_EXE_verify")).with_file_name(name)
}

/// The interpreter with the readers, or `None` (said aloud) where it is not installed. Continuous
/// integration sets `FUSIONLINE_NEEDS_PYTHON`, and there its absence is a failure.
fn python() -> Option<PathBuf> {
    let path = root().join("build/python/bin/python");
    if path.exists() && root().join("build/python/.installed").exists() {
        return Some(path);
    }
    assert!(
        std::env::var_os("FUSIONLINE_NEEDS_PYTHON").is_none(),
        "{} is not installed: run `make build/python/.installed`",
        path.display()
    );
    eprintln!("skipped: no Python readers in build/python");
    None
}

fn ask(python: &Path, script: &str, arguments: &[&str]) -> Value {
    let output = Command::new(python)
        .arg(root().join("tests/interop").join(script))
        .args(arguments)
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{script}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Three frames of a thousand particles, and a table on a grid with uneven axes.
fn sample(path: &Path) {
    let header = Header {
        kind: "particle-frames".to_owned(),
        version: Version::new(1, 0),
        tool: "poolsph".to_owned(),
        tool_version: "0.1.0".to_owned(),
        scene: serde_json::json!({"kind": "poolsph.scene", "version": 1}),
        inputs: Default::default(),
    };
    let mut writer = Writer::create(path, &header).unwrap();
    for step in 0..3 {
        let n = 1000 + step;
        let position = (0..n).map(|i| [i as f64 * 1e-3, 0.0, -1e-3]);
        let frame = Frame::new(Precision::F32)
            .positions(position)
            .scalar("temperature", "K", (0..n).map(|i| 300.0 + i as f64))
            .flag("molten", (0..n).map(|i| u8::from(i > 500)))
            .id("id", 0..n as u32);
        writer
            .frame("/particles", 0.25 * step as f64, &frame)
            .unwrap();
    }
    let table = Table::grid(&[
        ("radius_m", "m", &[0.0, 1e-3, 3e-3]),
        ("height_m", "m", &[0.0, 2e-3]),
    ])
    .column("temperature_k", "K", (0..6).map(|i| 1000.0 * f64::from(i)));
    writer.table("/plasma", 0.5, &table).unwrap();
    writer.finish().unwrap();
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
        serde_json::json!(["x", "y", "z", "temperature", "molten", "id"])
    );
    assert_eq!(found["temperature_k"], serde_json::json!([300.0, 1301.0]));
    assert_eq!(found["metadata"]["fusionline"]["kind"], "particle-frames");
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
    let clouds: Vec<&Value> = found
        .as_object()
        .unwrap()
        .iter()
        .filter(|(name, _)| name.ends_with(".vtu"))
        .map(|(_, value)| value)
        .collect();
    assert_eq!(clouds.len(), 3, "{found}");
    for cloud in clouds {
        let n = cloud["points"].as_u64().unwrap();
        assert!((1000..1003).contains(&n));
        assert_eq!(cloud["arrays"]["temperature"]["tuples"], n);
    }
    let grid = found
        .as_object()
        .unwrap()
        .iter()
        .find(|(name, _)| name.ends_with(".vtr") || name.ends_with(".vti"))
        .map(|(_, value)| value)
        .expect("the table on a grid is exported");
    assert_eq!(grid["points"], 6);
    assert_eq!(
        grid["arrays"]["temperature_k"]["range"],
        serde_json::json!([0.0, 5000.0])
    );
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
    let text = found.to_string();
    assert!(text.contains("temperature"), "{text}");
}
