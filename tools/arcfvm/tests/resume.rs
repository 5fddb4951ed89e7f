//! An arc that was killed goes on to the bytes of one that was not.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Longest wait for a checkpoint.
const PATIENCE: Duration = Duration::from_secs(60);

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// `arcfvm run` of a scene with a checkpoint as often as may be.
fn arcfvm(scene: &str, folder: &Path, out: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_arcfvm"));
    command
        .current_dir(root())
        .args(["run", scene])
        .arg("--out")
        .arg(folder.join(out))
        .args(["--threads", "1", "--checkpoint-s", "0", "-q"]);
    command
}

/// Runs `command` to its end; warnings are allowed.
fn finish(mut command: Command) {
    let code = command.status().unwrap().code();
    assert!(matches!(code, Some(0 | 3)), "{code:?}");
}

fn goes_on(scene: &str, gas: Option<&str>) {
    let folder = tempfile::tempdir().unwrap();
    let of = |out: &str| {
        let mut command = arcfvm(scene, folder.path(), out);
        if let Some(gas) = gas {
            command.args(["--input", &format!("gas={gas}")]);
        }
        command
    };
    finish(of("straight.mcap"));
    let straight = std::fs::read(folder.path().join("straight.mcap")).unwrap();
    let mut resumed = 0;
    for milliseconds in [0, 60, 250] {
        let out = format!("killed-{milliseconds}.mcap");
        let checkpoint = folder.path().join(format!("{out}.checkpoint"));
        let mut child = of(&out).spawn().unwrap();
        let begun = Instant::now();
        while !checkpoint.exists() && child.try_wait().unwrap().is_none() {
            assert!(begun.elapsed() < PATIENCE, "no checkpoint");
            sleep(Duration::from_millis(1));
        }
        sleep(Duration::from_millis(milliseconds));
        child.kill().unwrap();
        child.wait().unwrap();
        if checkpoint.exists() {
            resumed += 1;
            let mut again = of(&out);
            again.arg("--resume");
            finish(again);
        }
        let found = std::fs::read(folder.path().join(&out)).unwrap();
        assert!(found == straight, "other bytes after {milliseconds} ms");
    }
    assert!(resumed > 0, "every run was over before it was killed");
}

#[test]
fn an_arc_between_wire_and_plate_goes_on_to_the_same_bytes() {
    let gas = "pipelines/gases/argon-1atm.json";
    goes_on("pipelines/verify/arc-surface/scene.json", Some(gas));
}

#[test]
fn an_arc_in_a_bed_that_boils_goes_on_to_the_same_bytes() {
    goes_on("pipelines/stability/bed/arc.json", None);
}
