//! Averages that were interrupted go on to the bytes of averages that were not.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};

use artefact::{Frame, Header, Precision, Version, Writer, beside};
use serde_json::json;

/// Particle diameter \[m\].
const D: f64 = 0.5e-3;
/// Frames in the file.
const FRAMES: u32 = 400;

/// Liquid whose velocity and temperature are other in each frame, below a source that moves.
fn write_frames(path: &Path) {
    let header = Header {
        kind: "particle-frames".to_owned(),
        version: Version::new(1, 0),
        tool: "test".to_owned(),
        tool_version: "0".to_owned(),
        scene: json!({}),
        inputs: BTreeMap::new(),
    };
    let mut writer = Writer::create(path, &header).unwrap();
    let plate = json!({"spacing_m": D, "particle_volume_m3": D * D * D});
    writer.json("/plate", 0.0, ("test", "{}"), &plate).unwrap();
    let mut position = Vec::new();
    for i in -6..6 {
        for j in -8..8 {
            for k in -8..0 {
                position.push([i, j, k].map(|n: i32| (f64::from(n) + 0.5) * D));
            }
        }
    }
    for n in 0..FRAMES {
        let time = 0.0025 * f64::from(n);
        let source = json!({"time_s": time, "x_m": 0.0, "y_m": 1e-4 * time, "z_m": 0.0,
            "phase": f64::from(n % 4) / 4.0, "droplet": n / 4});
        writer
            .json("/source", time, ("test", "{}"), &source)
            .unwrap();
        let wave = |p: &[f64; 3]| (1e3 * p[1] + 0.7 * f64::from(n)).sin();
        let frame = Frame::new(Precision::F64)
            .positions(position.iter().copied())
            .vector("velocity", "m/s", position.iter().map(|p| [wave(p); 3]))
            .scalar(
                "temperature",
                "K",
                position.iter().map(|p| 2e3 + 9.0 * wave(p)),
            )
            .flag("molten", vec![1; position.len()])
            .scalar(
                "heat_from_arc",
                "J",
                position.iter().map(|p| f64::from(n) + wave(p)),
            )
            .id("id", (0..position.len()).map(|i| i as u32));
        writer.frame("/pool", time, &frame).unwrap();
    }
    writer.finish().unwrap();
}

/// `avg run` of a scene in `folder` with a checkpoint as often as may be.
fn avg(folder: &Path, out: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_avg"));
    command
        .arg("run")
        .arg(folder.join("avg.json"))
        .arg("--input")
        .arg(format!("frames={}", folder.join("pool.mcap").display()))
        .arg("--out")
        .arg(folder.join(out))
        .args(["--threads", "1", "--checkpoint-s", "0", "-q"]);
    command
}

fn study() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    write_frames(&folder.path().join("pool.mcap"));
    let scene = json!({
        "kind": "avg.scene", "version": 1, "follow": {}, "phases": {"count": 4},
        "profile": {"radius_m": 2e-3},
        "heat_map": {"x_m": [-3e-3, 3e-3], "y_m": [-4e-3, 4e-3], "interval_s": 0.006,
            "places": [{"name": "middle", "x_m": 0, "y_m": 1e-4}]},
        "sections": [
            {"name": "section_x0", "first_m": [-3e-3, 3e-3], "second_m": [-3e-3, 0.5e-3],
             "cut": {"plane": {"normal": "x", "half_thickness_m": D}}},
            {"name": "surface", "first_m": [-2e-3, 2e-3], "second_m": [-3e-3, 3e-3],
             "cut": {"surface": {"layer_m": 0.6 * D}}},
        ]
    });
    std::fs::write(folder.path().join("avg.json"), scene.to_string()).unwrap();
    folder
}

/// Runs to the end and gives the bytes.
fn finish(mut command: Command, out: &Path) -> Vec<u8> {
    let output = command.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(!beside(out, ".checkpoint").exists());
    std::fs::read(out).unwrap()
}

/// Kills the run soon after its first checkpoint, which it leaves.
fn kill(folder: &Path, out: &str) -> PathBuf {
    let checkpoint = beside(&folder.join(out), ".checkpoint");
    // On a busy machine a run may be done before it is killed.
    for _ in 0..20 {
        let mut child = avg(folder, out).spawn().unwrap();
        let start = Instant::now();
        while !checkpoint.exists() && child.try_wait().unwrap().is_none() {
            assert!(start.elapsed() < Duration::from_secs(60), "no checkpoint");
            sleep(Duration::from_millis(1));
        }
        sleep(Duration::from_millis(10));
        child.kill().unwrap();
        if !child.wait().unwrap().success() {
            return checkpoint;
        }
    }
    panic!("no run was killed in time");
}

#[test]
fn a_killed_run_goes_on_to_the_same_bytes() {
    let study = study();
    let folder = study.path();
    let straight = finish(avg(folder, "straight.mcap"), &folder.join("straight.mcap"));
    assert!(kill(folder, "mean.mcap").exists());
    let mut again = avg(folder, "mean.mcap");
    again.arg("--resume");
    let resumed = finish(again, &folder.join("mean.mcap"));
    assert!(resumed == straight, "other bytes");
    let record = std::fs::read_to_string(folder.join("mean.run.json")).unwrap();
    let record: serde_json::Value = serde_json::from_str(&record).unwrap();
    assert_eq!(record["resumed"], 1, "{record}");
}

#[test]
fn a_checkpoint_of_other_frames_is_refused() {
    let study = study();
    let folder = study.path();
    kill(folder, "mean.mcap");
    let scene = std::fs::read_to_string(folder.join("avg.json")).unwrap();
    let scene = scene.replace("\"count\":4", "\"count\":2");
    std::fs::write(folder.join("avg.json"), scene).unwrap();
    let mut again = avg(folder, "mean.mcap");
    let output = again.arg("--resume").output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("scene"), "{said}");
    assert!(!output.status.success());
}

#[test]
fn without_a_checkpoint_there_is_nothing_to_resume() {
    let study = study();
    let output = avg(study.path(), "mean.mcap")
        .arg("--resume")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("mean.mcap.checkpoint; run without --resume"),
        "{said}"
    );
    assert!(!study.path().join("mean.mcap").exists());
}
