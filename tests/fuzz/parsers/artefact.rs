//! Any bytes as an artefact: refused in words, or read and recovered; never a panic, never memory that the bytes only
//! claim.

#![no_main]

use std::io::Write;

use artefact::{Checkpoint, Reader, recover};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(folder) = tempfile::tempdir() else {
        return;
    };
    let path = folder.path().join("any.mcap");
    let written = std::fs::File::create(&path).and_then(|mut file| file.write_all(bytes));
    if written.is_err() {
        return;
    }
    if let Ok(reader) = Reader::open(&path) {
        let _ = reader.faults(8);
        let _ = reader.scrub();
    }
    let _ = Reader::recover(&path);
    let _ = recover(&path, &folder.path().join("saved.mcap"));
    let _ = Checkpoint::open(&path);
});
