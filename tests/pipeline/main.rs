//! `pipelines/rerun`: only what changed is made again, and an interrupted run is taken up.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod beside;
mod handover;
mod new;
mod package;
mod preview;
mod queue;
mod sensitivity;
mod slurm;
mod study;
mod sweep;

use std::path::{Path, PathBuf};
use std::process::Command;

fn script() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .join("pipelines/rerun")
}

/// Makes `out` from `scene` by a stage that logs each of its runs and ends with `code`.
fn make(folder: &Path, extra: &str, code: u8) -> Option<i32> {
    let stage = format!(
        "cp scene out; echo \"$*\" >> log; exit {code} #{extra}",
        extra = extra
    );
    Command::new(script())
        .current_dir(folder)
        .args(["out", "scene", "--", "sh", "-c", &stage, "stage"])
        .status()
        .unwrap()
        .code()
}

fn runs(folder: &Path) -> usize {
    std::fs::read_to_string(folder.join("log")).map_or(0, |t| t.lines().count())
}

fn scene(folder: &Path, text: &str) {
    std::fs::write(folder.join("scene"), text).unwrap();
}

#[test]
fn a_touched_scene_wakes_nothing_and_a_changed_one_does() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    scene(folder, "300 A");
    assert_eq!(make(folder, "", 0), Some(0));
    scene(folder, "300 A");
    assert_eq!(make(folder, "", 0), Some(0));
    assert_eq!(runs(folder), 1);
    scene(folder, "250 A");
    assert_eq!(make(folder, "", 0), Some(0));
    assert_eq!(runs(folder), 2);
    assert_eq!(
        std::fs::read_to_string(folder.join("out")).unwrap(),
        "250 A"
    );
}

#[test]
fn names_may_have_spaces() {
    let folder = tempfile::tempdir().unwrap();
    let make = || {
        let status = Command::new(script())
            .current_dir(folder.path())
            .args(["a b/out put", "my scene", "--", "sh", "-c"])
            .arg("cp 'my scene' 'a b/out put'; echo run >> log")
            .status();
        assert!(status.unwrap().success());
    };
    for (text, runs_so_far) in [("300 A", 1), ("300 A", 1), ("250 A", 2)] {
        std::fs::write(folder.path().join("my scene"), text).unwrap();
        make();
        assert_eq!(runs(folder.path()), runs_so_far);
    }
    let made = std::fs::read_to_string(folder.path().join("a b/out put"));
    assert_eq!(made.unwrap(), "250 A");
}

#[test]
fn a_page_is_named_when_it_is_made_and_when_it_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    scene(folder.path(), "300 A");
    let said = |out: &str| {
        let command = Command::new(script())
            .current_dir(folder.path())
            .args([out, "scene", "--", "cp", "scene", out])
            .output();
        String::from_utf8(command.unwrap().stdout).unwrap()
    };
    for _ in 0..2 {
        assert!(said("report.html").ends_with("to look at: report.html\n"));
        assert!(!said("pool.mcap").contains("look"));
    }
}

#[test]
fn what_is_up_to_date_says_again_what_its_run_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    scene(folder.path(), "300 A");
    let said = || {
        let stage = "cp scene pool.mcap; exit 3";
        let command = Command::new(script())
            .current_dir(folder.path())
            .args(["pool.mcap", "scene", "--", "sh", "-c", stage])
            .output()
            .unwrap();
        assert!(command.status.success());
        String::from_utf8(command.stderr).unwrap()
    };
    said();
    let record = |warnings: &[&str]| {
        let record =
            serde_json::json!({"notes": ["a note"], "tool": "poolsph", "warnings": warnings});
        let text = serde_json::to_string_pretty(&record).unwrap();
        std::fs::write(folder.path().join("pool.run.json"), text).unwrap();
    };
    record(&["has not \"converged\"", "the plate is molten through"]);
    let told = said();
    assert_eq!(told.matches("warning: ").count(), 2, "{told}");
    assert!(
        told.contains("the plate is molten through") && !told.contains("a note"),
        "{told}"
    );
    record(&[]);
    assert_eq!(said(), "");
}

#[test]
fn a_prerequisite_that_is_not_there_is_a_failure() {
    let folder = tempfile::tempdir().unwrap();
    let made = Command::new(script())
        .current_dir(folder.path())
        .args(["out", "absent", "--", "touch", "out"])
        .output()
        .unwrap();
    assert!(!made.status.success() && !folder.path().join("out").exists());
}

#[test]
fn another_command_is_a_change_but_threads_and_progress_are_none() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    scene(folder, "300 A");
    make(folder, " --threads 1 --progress plain", 0);
    make(folder, " --threads 2 --progress none", 0);
    assert_eq!(runs(folder), 1);
    make(folder, " --patch other.json", 0);
    assert_eq!(runs(folder), 2);
}

#[test]
fn a_failure_is_handed_on_and_never_taken_for_made() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    scene(folder, "300 A");
    assert_eq!(make(folder, "", 1), Some(1));
    assert_eq!(make(folder, "", 0), Some(0), "the next call runs again");
    assert_eq!(runs(folder), 2);
}

#[test]
fn finished_with_warnings_counts_as_made() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    scene(folder, "300 A");
    assert_eq!(make(folder, "", 3), Some(0));
    make(folder, "", 3);
    assert_eq!(runs(folder), 1);
}

#[test]
fn an_interrupted_run_is_taken_up_unless_its_scene_changed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    scene(folder, "300 A");
    assert_eq!(make(folder, "", 130), Some(130));
    std::fs::write(folder.join("out.checkpoint"), "state").unwrap();
    assert_eq!(make(folder, "", 130), Some(130));
    let log = std::fs::read_to_string(folder.join("log")).unwrap();
    assert_eq!(
        log.lines().last(),
        Some(""),
        "without its partial file a checkpoint is of no use"
    );
    std::fs::write(folder.join("out.part"), "frames").unwrap();
    assert_eq!(make(folder, "", 130), Some(130));
    let log = std::fs::read_to_string(folder.join("log")).unwrap();
    assert_eq!(log.lines().last(), Some("--resume"));
    scene(folder, "250 A");
    make(folder, "", 0);
    let log = std::fs::read_to_string(folder.join("log")).unwrap();
    assert_eq!(
        log.lines().last(),
        Some(""),
        "a checkpoint of another scene is not taken up"
    );
    let kept = std::fs::read_to_string(folder.join("out.checkpoint.old"));
    assert_eq!(kept.unwrap(), "state", "and it is not lost");
    let kept = std::fs::read_to_string(folder.join("out.part.old"));
    assert_eq!(kept.unwrap(), "frames");
    assert!(!folder.join("out.checkpoint").exists());
}

#[test]
fn what_is_kept_is_looked_at() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    scene(folder, "300 A");
    make(folder, "", 0);
    let out = folder.join("out");
    for spoilt in ["", "30", "400 A"] {
        let before = runs(folder);
        std::fs::write(&out, spoilt).unwrap();
        assert_eq!(make(folder, "", 0), Some(0));
        assert_eq!(runs(folder), before + 1, "'{spoilt}' is not what was made");
        assert_eq!(std::fs::read_to_string(&out).unwrap(), "300 A");
    }
    std::fs::remove_file(&out).unwrap();
    make(folder, "", 0);
    assert_eq!(runs(folder), 5);
    make(folder, "", 0);
    assert_eq!(runs(folder), 5);
}

#[test]
fn a_command_that_leaves_nothing_has_made_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    scene(folder, "");
    assert_eq!(make(folder, "", 0), Some(1));
    scene(folder, "300 A");
    assert_eq!(make(folder, "", 0), Some(0));
}

#[test]
fn an_older_scene_of_the_same_length_is_another_scene() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let old = std::time::SystemTime::now() - std::time::Duration::from_secs(86_400);
    let put = |text: &str| {
        scene(folder, text);
        let file = std::fs::File::options()
            .write(true)
            .open(folder.join("scene"));
        file.unwrap().set_modified(old).unwrap();
    };
    put("300 A");
    make(folder, "", 0);
    // Long enough after its change for the hash to be kept with the times of the file.
    std::thread::sleep(std::time::Duration::from_millis(3100));
    make(folder, "", 0);
    let seen = std::fs::read_to_string(folder.join("out.seen")).unwrap();
    assert_eq!(seen.lines().count(), 2, "scene and output");
    put("250 A");
    make(folder, "", 0);
    assert_eq!(
        std::fs::read_to_string(folder.join("out")).unwrap(),
        "250 A"
    );
    assert_eq!(runs(folder), 2);
}

#[test]
fn a_scene_that_changes_while_its_stage_runs_is_computed_again() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    scene(folder, "300 A");
    let make = || {
        let stage = "cp scene out; echo run >> log; cp scene first; echo 250 A > scene";
        let command = ["out", "scene", "--", "sh", "-c", stage];
        let output = Command::new(script())
            .current_dir(folder)
            .args(command)
            .output();
        let output = output.unwrap();
        assert!(output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let said = make();
    assert!(said.contains("has changed meanwhile"), "{said}");
    // Put back as it was, with the time that it had.
    assert!(
        Command::new("cp")
            .args(["-p", "first", "scene"])
            .current_dir(folder)
            .status()
            .unwrap()
            .success()
    );
    make();
    assert_eq!(runs(folder), 2);
    make();
    assert_eq!(
        std::fs::read_to_string(folder.join("out")).unwrap(),
        "250 A\n"
    );
    make();
    assert_eq!(runs(folder), 3, "nothing changed in the last run");
}
