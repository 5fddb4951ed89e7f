//! What comes from elsewhere, scenes, files, signals and limits of the machine, is taken as it is meant, or refused in
//! words: one test for each kind of fault that was found by changed files.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tempfile::TempDir;

/// No refusal takes longer, on however busy a machine.
const AT_ONCE: Duration = Duration::from_secs(30);

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .canonicalize()
        .unwrap()
}

fn tool(name: &str) -> Command {
    let mut command = Command::new(Path::new(env!("CARGO_BIN_EXE_fuzz")).with_file_name(name));
    command.current_dir(root()).stdin(Stdio::null());
    command
}

fn scene(path: &str) -> Value {
    serde_json::from_str(&std::fs::read_to_string(root().join(path)).unwrap()).unwrap()
}

fn written(folder: &TempDir, name: &str, text: impl ToString) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, text.to_string()).unwrap();
    path
}

#[track_caller]
fn must(output: &Output, code: i32, words: &[&str]) {
    let said = String::from_utf8_lossy(&output.stderr).into_owned()
        + &String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(code), "{said}");
    for word in words {
        assert!(said.contains(word), "'{word}' is not in:\n{said}");
    }
}

#[test]
fn whole_numbers_may_be_written_as_floats_in_every_tool() {
    let folder = tempfile::tempdir().unwrap();
    let cases = [
        (
            "heatsph",
            "pipelines/verify/heat-patch/scene.json",
            json!({"dimensions": 2.0}),
        ),
        (
            "poolsph",
            "tests/resume/drop.json",
            json!({"heat": {"rest_interval_steps": 8.0}}),
        ),
        (
            "emfield",
            "pipelines/verify/em-bar/scene.json",
            json!({"method": {"order": 4.0}}),
        ),
        (
            "arcfvm",
            "pipelines/verify/arc-potential/scene.json",
            json!({"iterate": {"most": 1e3}}),
        ),
        (
            "gasprop",
            "pipelines/verify/gas-argon/scene.json",
            json!({"temperatures": {"even": {"count": 200.0}}}),
        ),
    ];
    for (name, scene, patch) in cases {
        // As a text: to write 1e3 as 1000.0 is the choice of this library.
        let patch = written(
            &folder,
            "patch.json",
            patch.to_string().replace("1000.0", "1e3"),
        );
        let mut check = tool(name);
        check.args(["check", scene, "--patch"]).arg(patch);
        must(&check.output().unwrap(), 0, &[name]);
    }
}

#[test]
fn an_integer_that_is_too_large_is_refused_at_its_place_in_the_patch() {
    let folder = tempfile::tempdir().unwrap();
    let patch = "{\n  \"points\": {\n    \"seed\": 18446744073709551616}}";
    let patch = written(&folder, "patch.json", patch);
    let mut check = tool("heatsph");
    check
        .args(["check", "pipelines/fgm-shock/disc-1023.json", "--patch"])
        .arg(patch);
    must(
        &check.output().unwrap(),
        2,
        &["patch.json:3:", "/points/seed", "is out of range"],
    );
}

#[test]
fn temperatures_below_absolute_zero_are_refused_in_every_tool() {
    let folder = tempfile::tempdir().unwrap();
    let mut heat = scene("pipelines/verify/heat-sin-xy/scene.json");
    heat["initial_temperature_k"] = json!(-40);
    let heat = written(&folder, "heat.json", heat);
    let told = tool("heatsph").arg("check").arg(heat).output().unwrap();
    must(
        &told,
        2,
        &[
            "/initial_temperature_k: -40 K is out of range: at least 0 K",
            "-40 degrees Celsius are 233.15 K",
        ],
    );
    let mut table = scene("tests/resume/drop.json");
    table["heat"]["specific_heat_j_kg_k"] = json!({"t_k": [-5, 3000], "value": [700, 700]});
    let table = written(&folder, "table.json", table);
    let told = tool("poolsph").arg("check").arg(table).output().unwrap();
    must(
        &told,
        2,
        &["/heat/specific_heat_j_kg_k/t_k/0: -5 K is out of range"],
    );
}

#[test]
fn what_has_no_end_or_no_writer_is_no_scene() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe");
    assert!(
        Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    let began = Instant::now();
    for path in [Path::new("/dev/zero"), &pipe] {
        let told = tool("heatsph").arg("check").arg(path).output().unwrap();
        must(&told, 2, &["it is no regular file"]);
        let mut patched = tool("heatsph");
        patched
            .args(["check", "pipelines/verify/heat-patch/scene.json", "--patch"])
            .arg(path);
        must(&patched.output().unwrap(), 2, &["it is no regular file"]);
    }
    assert!(began.elapsed() < AT_ONCE);
}

#[test]
fn more_threads_than_the_machine_can_use_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("t.mcap");
    let mut run = tool("heatsph");
    run.args([
        "run",
        "pipelines/verify/heat-patch/scene.json",
        "--threads",
        "65535",
        "--out",
    ])
    .arg(&out);
    must(
        &run.output().unwrap(),
        2,
        &["--threads 65535: this machine runs"],
    );
    assert!(!out.exists());
}

#[test]
fn nothing_of_a_scene_or_a_name_acts_on_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let mut odd = scene("pipelines/verify/heat-patch/scene.json");
    odd["ti\u{1b}[2Jtle\u{202e}"] = json!("x");
    let odd = written(&folder, "odd\u{7}.json", odd);
    let file = folder.path().join("no\u{1b}[31m.mcap");
    let commands: [(&str, &[&std::ffi::OsStr]); 4] = [
        ("heatsph", &["check".as_ref(), odd.as_ref()]),
        ("heatsph", &["check".as_ref(), "--tem\u{1b}po".as_ref()]),
        ("artefact", &["info".as_ref(), file.as_ref()]),
        (
            "report",
            &["figures".as_ref(), "--pool".as_ref(), file.as_ref()],
        ),
    ];
    for (name, words) in commands {
        let told = tool(name).args(words).output().unwrap();
        let said = [told.stdout, told.stderr].concat();
        assert!(!said.is_empty());
        let said = String::from_utf8(said).unwrap();
        let acts = |c: char| (c.is_control() && c != '\n' && c != '\t') || c == '\u{202e}';
        assert!(!said.contains(acts), "{said:?}");
    }
}

/// A run that lasts long enough to be told to end, and writes a checkpoint only then; it ends by itself where the caller has turned
/// signals off.
fn long_run(folder: &TempDir, before: &str) -> Child {
    let patch = written(folder, "long.json", json!({"time": {"end_s": 0.5}}));
    let out = folder.path().join("long.mcap");
    let program = tool("poolsph");
    let mut command = Command::new("sh");
    command.current_dir(root()).stderr(Stdio::piped());
    command.args(["-c", &format!("{before} exec \"$0\" \"$@\"")]);
    command.arg(program.get_program());
    command.args([
        "run",
        "tests/resume/drop.json",
        "-q",
        "--threads",
        "1",
        "--patch",
    ]);
    command.arg(patch).arg("--out").arg(&out);
    let child = command.spawn().unwrap();
    let part = folder.path().join("long.mcap.part");
    let began = Instant::now();
    // With its head the run has begun, and listens.
    while std::fs::metadata(&part).map_or(0, |m| m.len()) < 500 {
        assert!(began.elapsed() < AT_ONCE, "no run");
        sleep(Duration::from_millis(20));
    }
    child
}

fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill")
        .args([name, &child.id().to_string()])
        .status();
    assert!(sent.unwrap().success());
}

#[test]
fn every_signal_that_tells_a_run_to_end_leaves_a_checkpoint() {
    for name in ["-HUP", "-USR1", "-XCPU", "-TERM", "-INT"] {
        let folder = tempfile::tempdir().unwrap();
        let child = long_run(&folder, "");
        signal(&child, name);
        let told = child.wait_with_output().unwrap();
        must(&told, 130, &["a checkpoint is written"]);
        assert!(
            folder.path().join("long.mcap.checkpoint").exists(),
            "{name}"
        );
    }
}

#[test]
fn a_signal_that_the_caller_turned_off_stays_off() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = long_run(&folder, "trap '' HUP;");
    signal(&child, "-HUP");
    sleep(Duration::from_millis(500));
    assert!(child.try_wait().unwrap().is_none(), "nohup did not hold");
    child.kill().unwrap();
    assert_eq!(child.wait().unwrap().signal(), Some(9));
}

#[test]
fn a_limit_on_the_length_of_files_is_told_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let run = tool("heatsph");
    let mut command = Command::new("sh");
    command.current_dir(root());
    command
        .args(["-c", "ulimit -f 2; exec \"$0\" \"$@\""])
        .arg(run.get_program());
    command.args([
        "run",
        "pipelines/verify/heat-sin-xy/scene.json",
        "-q",
        "--out",
    ]);
    let told = command.arg(folder.path().join("h.mcap")).output().unwrap();
    must(&told, 1, &["File too large", "make room"]);
}

#[test]
fn a_check_leaves_nothing_however_it_ends() {
    let folder = tempfile::tempdir().unwrap();
    let mut check = tool("emfield");
    check.args(["check", "pipelines/levitation-field/scene.json"]);
    check.env("TMPDIR", folder.path()).stdout(Stdio::null());
    let mut child = check.spawn().unwrap();
    sleep(Duration::from_millis(900));
    child.kill().unwrap();
    child.wait().unwrap();
    let left: Vec<_> = std::fs::read_dir(folder.path())
        .unwrap()
        .flatten()
        .collect();
    assert!(left.is_empty(), "{left:?}");
}
