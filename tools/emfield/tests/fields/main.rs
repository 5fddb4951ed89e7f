//! Fields that the program writes, scene by scene.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod bars;
mod coils;
mod doubts;
mod enclosures;
mod grading;
mod halves;
mod magnets;
mod open;
mod paces;
mod saturation;
mod skins;
mod ways;

use std::path::{Path, PathBuf};

use artefact::{Reader, Record};
use serde_json::Value;

/// Runs the program on a scene and gives exit code, what it said and its artefact.
fn said(folder: &Path, scene: &Value) -> (i32, String, PathBuf) {
    let out = folder.join("fields.mcap");
    let file = folder.join("scene.json");
    std::fs::write(&file, scene.to_string()).unwrap();
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_emfield"))
        .args(["run", file.to_str().unwrap(), "--out"])
        .arg(&out)
        .args(["--threads", "2", "-q"])
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code().unwrap(), text, out)
}

/// The artefact of a scene that runs.
fn run(folder: &Path, scene: &Value) -> Reader {
    let (code, text, out) = said(folder, scene);
    assert_eq!(code, 0, "{text}");
    Reader::open_kind(&out, "point-fields", 1).unwrap()
}

/// The last record of a channel.
fn last(reader: &Reader, channel: &str) -> Record {
    let last = reader.count(channel) - 1;
    reader.record_at(channel, last).unwrap()
}

/// The scene with what drives its eddy currents.
fn driven(mut scene: Value, drive: &Value) -> Value {
    let currents = scene["eddy_currents"].as_object_mut().unwrap();
    currents.extend(drive.as_object().unwrap().clone());
    scene
}
