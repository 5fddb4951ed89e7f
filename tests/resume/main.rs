//! A run gives the same bytes on any number of threads, and after any interruption: Ctrl-C leaves
//! a checkpoint and exit code 130; a kill at any moment leaves the last checkpoint; `--resume`
//! goes on to the bytes of a run that nothing disturbed.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use artefact::{Reader, beside};
use tempfile::TempDir;

const OUT: &str = "drop.mcap";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .to_owned()
}

/// `poolsph run` of the scene of this folder, with a checkpoint every 50 ms.
fn command(folder: &Path, threads: u8) -> Command {
    let program = Path::new(env!("CARGO_BIN_EXE_verify")).with_file_name("poolsph");
    assert!(
        program.exists(),
        "{} is not built: run `cargo build --release` first",
        program.display()
    );
    let mut command = Command::new(program);
    command
        .arg("run")
        .arg(root().join("tests/resume/scene.json"))
        .arg("--out")
        .arg(folder.join(OUT))
        .args(["--threads", &threads.to_string()])
        .args(["--checkpoint-s", "0.05", "--progress", "none", "-q"])
        .stderr(Stdio::piped());
    command
}

/// Runs to the end and gives the bytes.
fn finish(command: &mut Command, folder: &Path) -> Vec<u8> {
    let output = command.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let checkpoint = beside(&folder.join(OUT), ".checkpoint");
    assert!(!checkpoint.exists(), "a finished run needs no checkpoint");
    std::fs::read(folder.join(OUT)).unwrap()
}

/// The undisturbed run on one thread, made once for all tests.
fn straight() -> &'static [u8] {
    static BYTES: std::sync::OnceLock<Vec<u8>> = std::sync::OnceLock::new();
    BYTES.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let bytes = finish(&mut command(folder.path(), 1), folder.path());
        let reader = Reader::open(folder.path().join(OUT)).unwrap();
        happens(&reader);
        bytes
    })
}

/// The scene must be worth the test: metal moves, melts and sets.
fn happens(reader: &Reader) {
    let balance = reader.records("/balance").unwrap();
    let of =
        |name: &str| -> Vec<f64> { balance.iter().map(|(_, r)| r.get(name).unwrap()).collect() };
    let liquid = of("liquid_particles");
    let (first, last) = (liquid[0], liquid[liquid.len() - 1]);
    assert!(
        (first - last).abs() > 10.0,
        "{first} and {last} liquid particles"
    );
    assert!(of("kinetic_energy_j").iter().all(|e| e.is_finite()));
    let frames: Vec<_> = reader.frames("/particles").unwrap().collect();
    let at = |i: usize| frames[i].as_ref().unwrap().position_vectors().unwrap();
    let (start, end) = (at(0), at(frames.len() - 1));
    let moved = start.iter().zip(&end).map(|(a, b)| (a[2] - b[2]).abs());
    assert!(moved.fold(0.0, f64::max) > 1e-3);
}

/// Waits for the first checkpoint, and then for some part of a second.
fn after_a_checkpoint(child: &mut Child, folder: &Path, milliseconds: u64) {
    let checkpoint = beside(&folder.join(OUT), ".checkpoint");
    let start = Instant::now();
    while !checkpoint.exists() {
        let ended = child.try_wait().unwrap();
        assert!(ended.is_none(), "ended without a checkpoint: {ended:?}");
        assert!(start.elapsed() < Duration::from_secs(120), "no checkpoint");
        sleep(Duration::from_millis(2));
    }
    sleep(Duration::from_millis(milliseconds));
}

fn signal(child: &mut Child, name: &str) -> ExitStatus {
    let id = child.id().to_string();
    let sent = Command::new("kill").args(["-s", name, &id]).status();
    assert!(sent.unwrap().success());
    child.wait().unwrap()
}

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

#[test]
fn two_threads_write_the_bytes_of_one() {
    let folder = folder();
    let bytes = finish(&mut command(folder.path(), 2), folder.path());
    assert!(bytes == straight());
}

#[test]
fn ctrl_c_leaves_a_checkpoint_and_the_run_goes_on_to_the_same_bytes() {
    let folder = folder();
    let mut child = command(folder.path(), 2).spawn().unwrap();
    after_a_checkpoint(&mut child, folder.path(), 120);
    let status = signal(&mut child, "INT");
    assert_eq!(status.code(), Some(130));
    let out = folder.path().join(OUT);
    assert!(!out.exists(), "what is not whole does not bear the name");
    assert!(beside(&out, ".checkpoint").exists() && beside(&out, ".part").exists());
    let text = std::fs::read_to_string(out.with_extension("run.json")).unwrap();
    let record: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(record["outcome"], "interrupted");
    assert_eq!(record["exit_code"], 130);
    let steps = record["steps"].as_u64().unwrap();
    assert!((1..300).contains(&steps), "{steps} steps");

    let mut resumed = command(folder.path(), 1);
    let bytes = finish(resumed.arg("--resume"), folder.path());
    assert!(bytes == straight());
    let text = std::fs::read_to_string(out.with_extension("run.json")).unwrap();
    let record: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(
        (record["outcome"].as_str(), record["resumed"].as_u64()),
        (Some("done"), Some(1))
    );
}

#[test]
fn a_run_killed_at_any_moment_goes_on_to_the_same_bytes() {
    let folder = folder();
    let out = folder.path().join(OUT);
    let mut child = command(folder.path(), 2).spawn().unwrap();
    let mut killed = 0;
    // Moments that no two machines have in common: clock and load choose the step.
    for wait in [10, 170, 70] {
        after_a_checkpoint(&mut child, folder.path(), wait);
        if child.try_wait().unwrap().is_some() {
            break;
        }
        let status = signal(&mut child, "KILL");
        assert_eq!(status.code(), None, "killed");
        killed += 1;
        assert!(!out.exists());
        let part = Reader::recover(beside(&out, ".part")).unwrap();
        assert_eq!(part.times("/particles").unwrap()[0].to_bits(), 0);
        child = command(folder.path(), 2).arg("--resume").spawn().unwrap();
    }
    assert!(killed > 0);
    let ended = child.wait().unwrap();
    assert!(ended.success(), "{ended:?}");
    assert!(std::fs::read(&out).unwrap() == straight());
}

#[test]
fn a_changed_scene_is_not_taken_up_and_nothing_is_lost() {
    let folder = folder();
    let out = folder.path().join(OUT);
    let mut child = command(folder.path(), 1).spawn().unwrap();
    after_a_checkpoint(&mut child, folder.path(), 0);
    signal(&mut child, "INT");
    let kept = [beside(&out, ".checkpoint"), beside(&out, ".part")];
    let before = kept.each_ref().map(|path| std::fs::read(path).unwrap());
    let patch = folder.path().join("patch.json");
    std::fs::write(&patch, "{\"flow\": {\"viscosity_pa_s\": 0.005}}").unwrap();
    let mut other = command(folder.path(), 1);
    let output = other
        .args(["--resume", "--patch"])
        .arg(&patch)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success());
    assert!(
        said.contains("scene") && said.contains("cannot be resumed"),
        "{said}"
    );
    assert_eq!(
        kept.each_ref().map(|path| std::fs::read(path).unwrap()),
        before
    );
}
