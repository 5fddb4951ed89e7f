//! A full disk does not take the records that are there.

use std::path::Path;
use std::process::Command;

/// Whether a program, told to write `record` when the disk is full, leaves the older record there.
fn keeps_the_older(record: &Path, program: &mut Command) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    std::fs::write(record, "older").unwrap();
    let part = artefact::beside(record, ".part");
    std::os::unix::fs::symlink("/dev/full", part).unwrap();
    let output = program.current_dir(root).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("No space left on device"), "{said}");
    assert_eq!(std::fs::read(record).unwrap(), b"older");
}

#[test]
fn a_full_disk_leaves_the_older_records() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    keeps_the_older(
        &out.join("heat-patch.json"),
        Command::new(env!("CARGO_BIN_EXE_verify"))
            .args([
                "--case",
                "heat-patch",
                "--levels",
                "1",
                "--repeat-s",
                "0",
                "--out",
            ])
            .arg(out),
    );
    keeps_the_older(
        &out.join("heat-refusals.json"),
        Command::new(env!("CARGO_BIN_EXE_stability"))
            .args(["--case", "heat-refusals", "--out"])
            .arg(out),
    );
    let record = out.join("exact.json");
    keeps_the_older(
        &record,
        Command::new(env!("CARGO_BIN_EXE_exact"))
            .args(["pipelines/dielectric-sphere/scene.json", "--out"])
            .arg(&record),
    );
}
