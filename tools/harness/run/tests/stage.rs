//! A whole stage (`examples/rod.rs`) driven as a user drives it.

#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use artefact::Reader;
use serde_json::Value;

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/rod.json");

/// The program, which `cargo test` builds beside the tests.
fn program() -> PathBuf {
    let here = std::env::current_exe().expect("a program");
    let folder = here
        .parent()
        .and_then(Path::parent)
        .expect("target/release");
    folder.join("examples").join("rod")
}

fn rod(folder: &Path, words: &[&str]) -> Command {
    let mut command = Command::new(program());
    command
        .current_dir(folder)
        .args(words)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

fn finished(folder: &Path, words: &[&str]) -> (Option<i32>, String, String) {
    let Output {
        status,
        stdout,
        stderr,
    } = rod(folder, words)
        .output()
        .expect("the example is built by cargo test");
    (
        status.code(),
        String::from_utf8(stdout).expect("text"),
        String::from_utf8(stderr).expect("text"),
    )
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).expect("a file")).expect("JSON")
}

/// The record, which must fit its published schema however the run ended.
fn record(folder: &Path, name: &str) -> Value {
    let record = json(&folder.join(name));
    let schema =
        json(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../schemas/run-record.v1.json"));
    if let Err(e) = jsonschema::validate(&schema, &record) {
        panic!("{}: {e}", e.instance_path());
    }
    record
}

fn patch(folder: &Path, name: &str, text: &str) -> String {
    std::fs::write(folder.join(name), text).expect("a patch");
    name.to_owned()
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> = entries
        .map(|e| {
            e.expect("an entry")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    names.sort();
    names
}

fn temp() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

#[test]
fn a_run_writes_artefact_and_record_and_says_what_it_did() {
    let folder = temp();
    let (code, stdout, stderr) = finished(
        folder.path(),
        &["run", SCENE, "--out", "rod.mcap", "--threads", "2"],
    );
    assert_eq!((code, stdout.as_str()), (Some(0), ""), "{stderr}");
    assert_eq!(names(folder.path()), ["rod.mcap", "rod.run.json"]);
    for part in [
        "points               21",
        "step_conduction",
        "left out             source",
        "time s",
        "heat",
        "conduction",
        "done in",
    ] {
        assert!(stderr.contains(part), "{part} is not in\n{stderr}");
    }
    let reader = Reader::open_kind(folder.path().join("rod.mcap"), "rod-temperature", 1)
        .expect("an artefact");
    assert_eq!(
        reader.times("/temperature").expect("tables"),
        [10.0, 20.0, 30.0, 40.0]
    );
    let record = record(folder.path(), "rod.run.json");
    assert_eq!(record["kind"], "run-record");
    assert_eq!(record["outcome"], "done");
    assert_eq!(record["steps"], 400);
    assert_eq!(record["threads"], 2);
    assert_eq!(record["substepped"], false);
    assert_eq!(record["scene"], reader.header().scene);
    assert_eq!(record["scene_hash"], reader.header().scene_sha256());
    assert_eq!(record["left_out"][0]["name"], "source");
    assert_eq!(record["limits"][0]["unit"], "s");
    assert_eq!(
        record["history"][0]["values"].as_array().map(Vec::len),
        Some(4)
    );
    assert!((record["closing"][0]["value"].as_f64().expect("heat") - 6300.0).abs() < 1e-6);
    assert!(record["peak_memory_bytes"].as_u64().expect("peak") > 1 << 20);
    let stages = record["stages"].as_array().expect("stages");
    let total: f64 = stages
        .iter()
        .map(|s| s["wall_s"].as_f64().expect("seconds"))
        .sum();
    let wall = record["wall_s"].as_f64().expect("seconds");
    assert!(
        (total - wall).abs() < 0.1 * wall,
        "stages add to {total} s of {wall} s"
    );
}

#[test]
fn the_result_follows_its_formula() {
    // cos(pi x) on an insulated rod with mirrored ends at -h/2 and L + h/2 decays by a known
    // factor per step: 1 - 4 a dt/h^2 sin^2(pi h/(2 (L + h))) for the mode on half-cells.
    let folder = temp();
    let (n, h, a, dt, steps) = (21_u32, 0.05_f64, 0.01_f64, 0.1_f64, 400);
    let start = format!("300 + 100*cos(pi*(x + {})/{})", h / 2.0, h * f64::from(n));
    let text = format!(r#"{{"start_k": {{"expr": "{start}"}}}}"#);
    let (code, _, stderr) = finished(
        folder.path(),
        &[
            "run",
            SCENE,
            "--out",
            "rod.mcap",
            "--patch",
            &patch(folder.path(), "p.json", &text),
        ],
    );
    assert_eq!(code, Some(0), "{stderr}");
    let reader = Reader::open(folder.path().join("rod.mcap")).expect("an artefact");
    let table = reader.table_at("/temperature", 3).expect("a table");
    let angle = std::f64::consts::PI / f64::from(n);
    let factor = (1.0 - 4.0 * a * dt / (h * h) * (angle / 2.0).sin().powi(2)).powi(steps);
    for (i, found) in (0..n).zip(table.values("temperature_k").expect("a column")) {
        let wanted = 300.0 + 100.0 * factor * (angle * (f64::from(i) + 0.5)).cos();
        assert!(
            (found - wanted).abs() < 1e-9,
            "point {i}: {found} K, wanted {wanted} K"
        );
    }
}

#[test]
fn the_same_scene_gives_the_same_bytes_and_a_patch_is_recorded_merged() {
    let folder = temp();
    let shorter = patch(folder.path(), "p.json", r#"{"time": {"steps": 200}}"#);
    for (out, threads) in [("a.mcap", "1"), ("b.mcap", "2")] {
        let words = [
            "run",
            SCENE,
            "--out",
            out,
            "--patch",
            &shorter,
            "--threads",
            threads,
            "-q",
        ];
        let (code, stdout, stderr) = finished(folder.path(), &words);
        assert_eq!((code, stdout.as_str(), stderr.as_str()), (Some(0), "", ""));
    }
    let bytes = |name| std::fs::read(folder.path().join(name)).expect("bytes");
    assert!(bytes("a.mcap") == bytes("b.mcap"));
    let record = record(folder.path(), "a.run.json");
    assert_eq!(
        (
            &record["scene"]["time"]["steps"],
            &record["scene"]["spacing_m"]
        ),
        (&200.into(), &0.05.into())
    );
}

#[test]
fn check_prints_the_plan_and_writes_nothing() {
    let folder = temp();
    let (code, stdout, stderr) = finished(folder.path(), &["check", SCENE]);
    assert_eq!((code, stderr.as_str()), (Some(0), ""));
    assert!(
        stdout.contains("points               21") && stdout.contains("1.2500e-1 s"),
        "{stdout}"
    );
    assert!(names(folder.path()).is_empty());
    let unstable = patch(folder.path(), "p.json", "{\"time\":\n {\"step_s\": 0.2}}");
    let (code, stdout, stderr) = finished(folder.path(), &["check", SCENE, "--patch", &unstable]);
    assert_eq!((code, stdout.as_str()), (Some(2), ""));
    assert!(
        stderr.starts_with(
            "rod: p.json:2:13: /time/step_s: 0.2 s is out of range: at most 1.2500e-1 s"
        ),
        "{stderr}"
    );
}

#[test]
fn the_schema_is_printed_and_admits_the_sample() {
    let (code, stdout, _) = finished(temp().path(), &["schema"]);
    assert_eq!(code, Some(0));
    let schema: Value = serde_json::from_str(&stdout).expect("JSON");
    let sample: Value =
        serde_json::from_str(&std::fs::read_to_string(SCENE).expect("the sample")).expect("JSON");
    assert!(jsonschema::is_valid(&schema, &sample));
    assert!(!jsonschema::is_valid(
        &schema,
        &serde_json::json!({"kind": "rod.scene", "version": 1})
    ));
}

#[test]
fn help_shows_a_sample_and_the_exit_codes() {
    for words in [&["--help"][..], &["run", "--help"]] {
        let (code, stdout, _) = finished(temp().path(), words);
        assert_eq!(code, Some(0));
        assert!(
            stdout.contains("cargo run --release -p run --example rod -- run"),
            "{stdout}"
        );
        assert!(stdout.contains("130"), "{stdout}");
    }
}

#[test]
fn usage_and_scene_faults_end_with_2() {
    let folder = temp();
    let bad = patch(
        folder.path(),
        "bad.json",
        r#"{"spacing_mm": 50, "length_m": -1}"#,
    );
    let cases: [(&[&str], &[&str]); 10] = [
        (&[], &["Usage: rod"]),
        (&["run", SCENE], &["--out"]),
        (
            &["run", SCENE, "--out", "x.mcap", "--tempo", "3"],
            &["--tempo"],
        ),
        (
            &["run", SCENE, "--out", "x.mcap", "--threads", "0"],
            &["--threads"],
        ),
        (
            &["run", "nothing.json", "--out", "x.mcap"],
            &["nothing.json: cannot read"],
        ),
        (
            &["run", SCENE, "--out", "x.mcap", "--input", "nte=x"],
            &["did you mean 'note'?"],
        ),
        (
            &["run", SCENE, "--out", "x.mcap", "--input", "note=nothing"],
            &["note=nothing: there is no such file"],
        ),
        (
            &["run", SCENE, "--out", "x.mcap", "--input", "note=/"],
            &["note=/: is a folder, wanted is a file"],
        ),
        (
            &["run", SCENE, "--out", "x.mcap", "--resume"],
            &["there is no x.mcap.checkpoint"],
        ),
        (
            &["run", SCENE, "--out", "x.mcap", "--patch", &bad],
            &["bad.json:1:2: /spacing_mm", "0.05", "-1 m"],
        ),
    ];
    for (words, wanted) in cases {
        let (code, stdout, stderr) = finished(folder.path(), words);
        assert_eq!(
            (code, stdout.as_str()),
            (Some(2), ""),
            "{words:?}: {stderr}"
        );
        for part in wanted {
            assert!(
                stderr.contains(part),
                "{words:?}: {part} is not in\n{stderr}"
            );
        }
    }
    assert_eq!(names(folder.path()), ["bad.json"]);
}

#[test]
fn a_place_that_cannot_be_written_ends_with_1_before_any_work() {
    let folder = temp();
    let file = patch(folder.path(), "file", "not a folder");
    for (out, wanted) in [
        ("file/rod.mcap", "file: cannot create the folder"),
        ("/proc/rod.mcap", "/proc/rod.mcap.lock: cannot create"),
    ] {
        let (code, _, stderr) = finished(folder.path(), &["run", SCENE, "--out", out]);
        assert_eq!(code, Some(1));
        assert!(stderr.contains(wanted), "{stderr}");
    }
    assert_eq!(names(folder.path()), [file]);
}

#[test]
fn the_folder_of_the_artefact_is_made() {
    let folder = temp();
    let (code, _, stderr) = finished(
        folder.path(),
        &["run", SCENE, "--out", "build/study/rod.mcap", "-q"],
    );
    assert_eq!(code, Some(0), "{stderr}");
    assert_eq!(
        names(&folder.path().join("build/study")),
        ["rod.mcap", "rod.run.json"]
    );
}

#[test]
fn a_full_disk_ends_with_1_and_leaves_no_artefact() {
    // A limit on the size of files stands for the disk; without the signal it is a plain error.
    let folder = temp();
    let many = patch(
        folder.path(),
        "p.json",
        r#"{"time": {"steps": 4000, "table_steps": 1}}"#,
    );
    let script = r#"trap "" XFSZ; ulimit -f 16; exec "$0" "$@""#;
    let output = Command::new("sh")
        .current_dir(folder.path())
        .args(["-c", script])
        .arg(program())
        .args(["run", SCENE, "--out", "rod.mcap", "--patch", &many, "-q"])
        .output()
        .expect("a shell");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    assert!(
        stderr.contains(".part: cannot write: File too large"),
        "{stderr}"
    );
    assert!(!folder.path().join("rod.mcap").exists());
}

#[test]
fn divergence_ends_with_1_and_its_place_in_the_record() {
    let folder = temp();
    let runaway = patch(
        folder.path(),
        "p.json",
        r#"{"source": {"rate_k_s": {"expr": "T"}}}"#,
    );
    let words = ["run", SCENE, "--out", "rod.mcap", "--patch", &runaway, "-q"];
    // However slow the machine is, no checkpoint falls due.
    let rare = ["--checkpoint-s", "3600"];
    let (code, _, stderr) = finished(folder.path(), &[&words[..], &rare].concat());
    assert_eq!(code, Some(1));
    assert!(
        stderr.contains("temperature") && stderr.contains("is not within 0 K to 1e5 K"),
        "{stderr}"
    );
    let record = record(folder.path(), "rod.run.json");
    assert_eq!(
        (&record["outcome"], &record["exit_code"]),
        (&"diverged".into(), &1.into())
    );
    assert!(
        record["divergence"]["place"]
            .as_str()
            .expect("a place")
            .starts_with("point ")
    );
    assert!(record["divergence"]["step"].as_u64().expect("a step") > 10);
    assert_eq!(
        names(folder.path()),
        ["p.json", "rod.mcap.part", "rod.run.json"]
    );
}

#[test]
fn a_temperature_beyond_a_table_ends_with_1_and_its_place() {
    let folder = temp();
    let narrow = r#"{"source": {"rate_k_s": 10}, "diffusivity_m2_s": {"t_k": [100, 401], "value": [0.01, 0.01]}}"#;
    let narrow = patch(folder.path(), "p.json", narrow);
    let (code, _, stderr) = finished(
        folder.path(),
        &["run", SCENE, "--out", "rod.mcap", "--patch", &narrow, "-q"],
    );
    assert_eq!(code, Some(1));
    assert!(
        stderr.contains("is outside of the table, 100 K to 401 K"),
        "{stderr}"
    );
    let record = record(folder.path(), "rod.run.json");
    assert_eq!(record["outcome"], "diverged");
    let place = record["divergence"]["place"].as_str().expect("a place");
    assert!(place.starts_with("point "), "{place}");
}

#[test]
fn a_warning_that_matters_ends_with_3() {
    let folder = temp();
    let steady = patch(folder.path(), "p.json", r#"{"time": {"steady_k_s": 1e-9}}"#);
    let (code, _, stderr) = finished(
        folder.path(),
        &["run", SCENE, "--out", "rod.mcap", "--patch", &steady],
    );
    assert_eq!(code, Some(3));
    assert!(
        stderr.contains("warning: not steady") && stderr.contains("with 1 warning"),
        "{stderr}"
    );
    let record = record(folder.path(), "rod.run.json");
    assert_eq!(record["outcome"], "warned");
    assert!(
        record["warnings"][0]
            .as_str()
            .expect("a warning")
            .starts_with("not steady")
    );
    assert!(folder.path().join("rod.mcap").exists());
}

/// A run of some seconds.
const LONG: &str = r#"{"time": {"steps": 1500000, "table_steps": 10000}}"#;

fn started(folder: &Path, out: &str) -> Child {
    let long = patch(folder, "long.json", LONG);
    rod(
        folder,
        &["run", SCENE, "--out", out, "--patch", &long, "-q"],
    )
    .spawn()
    .expect("a child")
}

fn wait_for(path: &Path) {
    let start = Instant::now();
    while !path.exists() {
        assert!(
            start.elapsed() < Duration::from_secs(30),
            "{} does not appear",
            path.display()
        );
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn signal(child: &Child, name: &str) {
    let status = Command::new("kill")
        .args([name, &child.id().to_string()])
        .status()
        .expect("kill");
    assert!(status.success());
}

fn undisturbed(folder: &Path) -> Vec<u8> {
    assert!(
        started(folder, "whole.mcap")
            .wait()
            .expect("an end")
            .success()
    );
    std::fs::read(folder.join("whole.mcap")).expect("bytes")
}

fn resumed(folder: &Path) -> Vec<u8> {
    let words = [
        "run",
        SCENE,
        "--out",
        "cut.mcap",
        "--patch",
        "long.json",
        "--resume",
        "-q",
    ];
    let (code, _, stderr) = finished(folder, &words);
    assert_eq!(code, Some(0), "{stderr}");
    assert!(!folder.join("cut.mcap.checkpoint").exists() && !folder.join("cut.mcap.part").exists());
    std::fs::read(folder.join("cut.mcap")).expect("bytes")
}

#[test]
fn a_full_disk_says_what_is_kept_and_the_run_goes_on_to_the_same_bytes() {
    let folder = temp();
    let much = r#"{"spacing_m": 0.002, "diffusivity_m2_s": 0.001,
        "time": {"step_s": 1e-3, "steps": 8000, "table_steps": 8}}"#;
    let much = patch(folder.path(), "much.json", much);
    let words = |out| ["run", SCENE, "--out", out, "--patch", &much, "-q"];
    let (code, _, stderr) = finished(folder.path(), &words("whole.mcap"));
    assert_eq!(code, Some(0), "{stderr}");
    let whole = std::fs::read(folder.path().join("whole.mcap")).expect("bytes");
    // Files of this shell may have half the size, in blocks of 512 bytes; the signal is ignored.
    let script = format!(
        "trap '' 25; ulimit -f {}; exec \"$0\" \"$@\"",
        whole.len() / 1024
    );
    let Output { status, stderr, .. } = Command::new("sh")
        .current_dir(folder.path())
        .args(["-c", &script])
        .arg(program())
        .args(words("cut.mcap"))
        .args(["--checkpoint-s", "0"])
        .output()
        .expect("a shell");
    let stderr = String::from_utf8_lossy(&stderr);
    assert_eq!(status.code(), Some(1), "{stderr}");
    for part in [
        "cut.mcap.part: cannot write",
        "kept are cut.mcap.checkpoint and cut.mcap.part",
        "--resume",
    ] {
        assert!(stderr.contains(part), "{part} is not in\n{stderr}");
    }
    let told = record(folder.path(), "cut.run.json");
    assert_eq!(told["outcome"], "failed");
    let mut again = words("cut.mcap").to_vec();
    again.push("--resume");
    let (code, _, stderr) = finished(folder.path(), &again);
    assert_eq!(code, Some(0), "{stderr}");
    let found = std::fs::read(folder.path().join("cut.mcap")).expect("bytes");
    assert!(found == whole, "other bytes");
}

#[test]
fn an_interrupted_run_ends_with_130_and_goes_on_to_the_same_bytes() {
    let folder = temp();
    for name in ["-INT", "-TERM"] {
        // The second run begins afresh.
        std::fs::remove_file(folder.path().join("cut.mcap.checkpoint")).ok();
        let child = started(folder.path(), "cut.mcap");
        wait_for(&folder.path().join("cut.mcap.part"));
        std::thread::sleep(Duration::from_millis(100));
        signal(&child, name);
        let output = child.wait_with_output().expect("an end");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(130), "{stderr}");
        assert!(
            stderr.contains("interrupted; a checkpoint is written"),
            "{stderr}"
        );
        assert!(folder.path().join("cut.mcap.checkpoint").exists());
        let record = record(folder.path(), "cut.run.json");
        assert_eq!(record["outcome"], "interrupted");
        assert!(record["steps"].as_u64().expect("steps") < 1_500_000);
    }
    let whole = undisturbed(folder.path());
    assert!(resumed(folder.path()) == whole);
    let record = record(folder.path(), "cut.run.json");
    assert_eq!(
        (&record["outcome"], &record["resumed"], &record["steps"]),
        (&"done".into(), &1.into(), &1_500_000.into())
    );
    assert_eq!(
        record["history"][0]["values"].as_array().map(Vec::len),
        Some(150)
    );
}

#[test]
fn a_killed_run_goes_on_from_its_last_checkpoint_to_the_same_bytes() {
    let folder = temp();
    let mut child = started(folder.path(), "cut.mcap");
    wait_for(&folder.path().join("cut.mcap.checkpoint"));
    std::thread::sleep(Duration::from_millis(150));
    signal(&child, "-KILL");
    assert!(!child.wait().expect("an end").success());
    assert!(resumed(folder.path()) == undisturbed(folder.path()));
}

#[test]
fn a_checkpoint_of_another_scene_is_refused() {
    let folder = temp();
    let mut child = started(folder.path(), "cut.mcap");
    wait_for(&folder.path().join("cut.mcap.checkpoint"));
    signal(&child, "-INT");
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    let other = patch(folder.path(), "other.json", r#"{"spacing_m": 0.1}"#);
    let words = [
        "run",
        SCENE,
        "--out",
        "cut.mcap",
        "--patch",
        "long.json",
        "--patch",
        &other,
        "--resume",
        "-q",
    ];
    let (code, _, stderr) = finished(folder.path(), &words);
    assert_eq!(code, Some(1));
    assert!(
        stderr.contains("cut.mcap.checkpoint") && stderr.contains("scene"),
        "{stderr}"
    );
    let checkpoint = folder.path().join("cut.mcap.checkpoint");
    let mut bytes = std::fs::read(&checkpoint).expect("bytes");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&checkpoint, bytes).expect("a damaged checkpoint");
    let words = [
        "run",
        SCENE,
        "--out",
        "cut.mcap",
        "--patch",
        "long.json",
        "--resume",
        "-q",
    ];
    let (code, _, stderr) = finished(folder.path(), &words);
    assert_eq!(code, Some(1));
    assert!(stderr.contains("damaged: CRC"), "{stderr}");
}

fn bytes(folder: &Path, name: &str) -> Vec<u8> {
    std::fs::read(folder.join(name)).expect("bytes")
}

#[test]
fn a_checkpoint_is_not_discarded_by_a_run_from_the_start() {
    let folder = temp();
    let folder = folder.path();
    let child = started(folder, "cut.mcap");
    wait_for(&folder.join("cut.mcap.part"));
    std::thread::sleep(Duration::from_millis(100));
    signal(&child, "-INT");
    assert!(!child.wait_with_output().expect("an end").status.success());
    let (checkpoint, part) = (
        bytes(folder, "cut.mcap.checkpoint"),
        bytes(folder, "cut.mcap.part"),
    );
    let steps = record(folder, "cut.run.json")["steps"].to_string();

    let again = ["run", SCENE, "--out", "cut.mcap", "--patch", "long.json"];
    let (code, _, stderr) = finished(folder, &again);
    assert_eq!(code, Some(2), "{stderr}");
    for word in [
        "cut.mcap.checkpoint: holds this very run at step",
        steps.as_str(),
        "--resume",
        "rm cut.mcap.checkpoint",
    ] {
        assert!(stderr.contains(word), "{word} is not in\n{stderr}");
    }
    assert!(bytes(folder, "cut.mcap.checkpoint") == checkpoint);
    assert!(bytes(folder, "cut.mcap.part") == part);

    // Another scene cannot take it up: it runs, and what was there is kept.
    let short = patch(folder, "short.json", r#"{"time": {"steps": 200}}"#);
    let other = ["run", SCENE, "--out", "cut.mcap", "--patch", &short];
    let (code, _, stderr) = finished(folder, &other);
    assert_eq!(code, Some(0), "{stderr}");
    assert!(
        stderr.contains("kept as cut.mcap.checkpoint.old"),
        "{stderr}"
    );
    assert!(bytes(folder, "cut.mcap.checkpoint.old") == checkpoint);
    assert!(bytes(folder, "cut.mcap.part.old") == part);
    assert!(!folder.join("cut.mcap.checkpoint").exists());
    let notes = record(folder, "cut.run.json")["notes"].to_string();
    assert!(notes.contains("made with scene"), "{notes}");

    // Put back, it goes on.
    std::fs::rename(
        folder.join("cut.mcap.checkpoint.old"),
        folder.join("cut.mcap.checkpoint"),
    )
    .expect("a name");
    std::fs::rename(
        folder.join("cut.mcap.part.old"),
        folder.join("cut.mcap.part"),
    )
    .expect("a name");
    assert!(resumed(folder) == undisturbed(folder));
}

#[test]
fn a_damaged_checkpoint_does_not_stand_in_the_way() {
    let folder = temp();
    let folder = folder.path();
    std::fs::write(folder.join("rod.mcap.checkpoint"), "no checkpoint").expect("a file");
    let (code, _, stderr) = finished(folder, &["run", SCENE, "--out", "rod.mcap"]);
    assert_eq!(code, Some(0), "{stderr}");
    assert!(
        stderr.contains("kept as rod.mcap.checkpoint.old"),
        "{stderr}"
    );
    assert_eq!(
        names(folder),
        ["rod.mcap", "rod.mcap.checkpoint.old", "rod.run.json"]
    );
}
