//! Files that contradict themselves are found, and nothing is made of them.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use artefact::{Checkpoint, Frame, Header, Precision, Reader, Table, Version, Writer};
use mcap::MAGIC;
use mcap::records::op;
use serde_json::json;
use tempfile::TempDir;

fn header(kind: &str, tool: &str, scene: &str) -> Header {
    Header {
        kind: kind.to_owned(),
        version: Version::new(1, 0),
        tool: tool.to_owned(),
        tool_version: "0.1.0".to_owned(),
        scene: json!({"kind": scene, "version": 1}),
        inputs: BTreeMap::new(),
    }
}

fn written(folder: &TempDir, header: &Header) -> PathBuf {
    let path = folder.path().join("a.mcap");
    let mut writer = Writer::create(&path, header).unwrap();
    for step in 0..3 {
        let frame = Frame::new(Precision::F64)
            .positions((0..20).map(|i| [f64::from(i), 0.0, 0.0]))
            .scalar("temperature", "K", (0..20).map(f64::from));
        writer.frame("/points", f64::from(step), &frame).unwrap();
        let table = Table::new(2).column("radius_m", "m", [0.0, 1e-3]);
        writer.table("/surface", f64::from(step), &table).unwrap();
    }
    writer.finish().unwrap();
    path
}

#[track_caller]
fn refused(path: &Path, words: &[&str]) {
    let faults = match Reader::open(path) {
        Ok(reader) => {
            assert!(reader.must_be_sound().is_err());
            reader.faults(usize::MAX)
        }
        Err(e) => vec![e.to_string()],
    };
    let said = faults.join("\n");
    for word in words {
        assert!(said.contains(word), "'{word}' is not in: {said}");
    }
}

#[test]
fn a_sound_file_is_sound() {
    let folder = tempfile::tempdir().unwrap();
    let path = written(&folder, &header("point-fields", "heatsph", "heatsph.scene"));
    let reader = Reader::open_sound(&path, "point-fields", 1).unwrap();
    assert!(reader.faults(usize::MAX).is_empty());
    // What others write with a tool of their own contradicts nothing.
    let path = written(&folder, &header("point-fields", "theirs", "theirs.scene"));
    Reader::open_sound(&path, "point-fields", 1).unwrap();
}

#[test]
fn kind_tool_and_scene_belong_together() {
    let folder = tempfile::tempdir().unwrap();
    let path = written(&folder, &header("arc-source", "poolsph", "poolsph.scene"));
    refused(
        &path,
        &["is of kind 'arc-source' by 'poolsph', which writes particle-frames"],
    );
    let path = written(&folder, &header("point-fields", "heatsph", "emfield.scene"));
    refused(
        &path,
        &["is by 'heatsph', its scene is of kind 'emfield.scene'"],
    );
}

/// Places of the records of a sort: start and end \[byte\].
fn places(bytes: &[u8], sort: u8) -> Vec<(usize, usize)> {
    let (mut found, mut at) = (Vec::new(), MAGIC.len());
    while at + 9 <= bytes.len() - MAGIC.len() {
        let length = u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap());
        let end = at + 9 + usize::try_from(length).unwrap();
        if bytes[at] == sort {
            found.push((at, end));
        }
        at = end;
    }
    found
}

/// The file with its checksums of data and summary taken off: 0 says in MCAP that there is none.
fn unsealed(bytes: &mut [u8]) {
    let (_, end) = places(bytes, op::DATA_END)[0];
    bytes[end - 4..end].fill(0);
    let (_, end) = places(bytes, op::FOOTER)[0];
    bytes[end - 4..end].fill(0);
}

#[test]
fn a_chunk_that_the_summary_does_not_list_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let path = written(&folder, &header("point-fields", "heatsph", "heatsph.scene"));
    let mut bytes = std::fs::read(&path).unwrap();
    unsealed(&mut bytes);
    assert!(places(&bytes, op::CHUNK).len() > 2);
    std::fs::write(&path, &bytes).unwrap();
    assert!(Reader::open(&path).unwrap().faults(9).is_empty());
    // The entry of the first chunk in the summary becomes a record that no reader knows.
    let (start, _) = places(&bytes, op::CHUNK_INDEX)[0];
    bytes[start] = 0x7f;
    std::fs::write(&path, &bytes).unwrap();
    refused(&path, &["damaged"]);
}

#[test]
fn a_record_that_none_of_ours_writes_is_found_among_the_data() {
    let folder = tempfile::tempdir().unwrap();
    let path = written(&folder, &header("point-fields", "heatsph", "heatsph.scene"));
    let mut bytes = std::fs::read(&path).unwrap();
    unsealed(&mut bytes);
    let (start, _) = places(&bytes, op::MESSAGE_INDEX)[0];
    // An index of messages that names no place in the summary any more.
    bytes[start] = 0x85;
    std::fs::write(&path, &bytes).unwrap();
    refused(&path, &["damaged"]);
}

/// A checkpoint with its body changed and its checksum made to fit.
fn forged(path: &Path, change: impl FnOnce(&mut Vec<u8>)) {
    let mut bytes = std::fs::read(path).unwrap();
    bytes.truncate(bytes.len() - 4);
    change(&mut bytes);
    bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
    std::fs::write(path, bytes).unwrap();
}

#[test]
fn a_checkpoint_belongs_to_the_build_that_wrote_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.checkpoint");
    let header = header("point-fields", "heatsph", "heatsph.scene");
    let mut checkpoint = Checkpoint::new(&header);
    checkpoint.put_f64("temperature", &[300.0, 400.0]);
    checkpoint.write(&path).unwrap();
    assert!(Checkpoint::read(&path, &header).is_ok());
    forged(&path, |bytes| {
        let key = b"\"build\":\"";
        let at = bytes.windows(key.len()).position(|w| w == key).unwrap() + key.len();
        bytes[at] = if bytes[at] == b'0' { b'1' } else { b'0' };
    });
    let refused = Checkpoint::read(&path, &header).unwrap_err().to_string();
    assert!(refused.contains("made with build"), "{refused}");
}

#[test]
fn a_checkpoint_holds_what_its_head_says_and_no_more() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.checkpoint");
    let mut checkpoint = Checkpoint::new(&header("point-fields", "heatsph", "heatsph.scene"));
    checkpoint.put_f64("temperature", &[300.0, 400.0]);
    checkpoint.write(&path).unwrap();
    forged(&path, |bytes| bytes.extend([0; 8]));
    let refused = Checkpoint::open(&path).unwrap_err().to_string();
    assert!(refused.contains("longer than its head says"), "{refused}");
    forged(&path, |bytes| bytes.truncate(bytes.len() - 9));
    let refused = Checkpoint::open(&path).unwrap_err().to_string();
    assert!(refused.contains("shorter than its head says"), "{refused}");
}
