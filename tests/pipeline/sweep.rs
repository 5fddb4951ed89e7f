//! `make sweep`: all points of a sweep, and only those that changed.

use std::process::{Command, Output};

use serde_json::{Value, json};

use super::study::Workshop;

/// Welds over currents and speeds: the arc hangs on the current alone, the pool on both.
pub(crate) fn welds(currents: &Value, speeds: &Value) -> Value {
    json!({
        "kind": "sweep", "version": 1, "study": "gmaw-quick",
        "parameters": [{"name": "current", "unit": "A", "values": currents}, {"name": "speed", "values": speeds}],
        "stages": [
            {"name": "arc", "tool": "arcfvm", "scene": "pipelines/gmaw-300a/arc.json",
             "template": {"current_a": "${current}"}, "inputs": [{"name": "gas", "file": "build/gases/argon.mcap"}]},
            {"name": "pool", "tool": "poolsph", "scene": "pipelines/gmaw-300a/pool.json",
             "patches": ["pipelines/gmaw-quick/pool.patch.json"],
             "template": {"speed_m_s": "${speed}"}, "inputs": [{"name": "arc", "stage": "arc"}]}
        ]
    })
}

impl Workshop {
    pub(crate) fn sweep(&self, sweep: &Value) {
        let path = self.root.join("pipelines/gmaw-quick/sweep.json");
        std::fs::write(path, format!("{sweep:#}\n")).unwrap();
    }

    /// Makes the sweep; how it ended, and how often each program ran, but for that of pages.
    fn swept(&self, words: &[&str]) -> (Output, [usize; 3]) {
        let log = self.root.join("log");
        let _ = std::fs::remove_file(&log);
        let ended = self.ask(&[&["sweep", "STUDY=gmaw-quick"], words].concat());
        let log = std::fs::read_to_string(log).unwrap_or_default();
        let count = |name: &str| log.lines().filter(|line| *line == name).count();
        (ended, ["gasprop", "arcfvm", "poolsph"].map(count))
    }

    /// What the page is made from.
    pub(crate) fn points(&self) -> Value {
        let path = self.root.join("build/gmaw-quick/sweep/points.json");
        serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
    }
}

fn told(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout)
}

#[test]
fn only_what_changed_is_made_and_points_share_what_they_can() {
    let workshop = Workshop::new();
    workshop.sweep(&welds(&json!([200, 300]), &json!([0.01, 0.02])));
    let (ended, runs) = workshop.swept(&["-j2", "THREADS=1"]);
    assert!(ended.status.success(), "{}", told(&ended));
    assert_eq!(runs, [1, 2, 4], "{}", told(&ended));
    assert!(workshop.root.join("build/gmaw-quick/sweep.html").exists());
    let (ended, runs) = workshop.swept(&[]);
    assert!(
        ended.status.success() && runs == [0, 0, 0],
        "{}",
        told(&ended)
    );
    for (currents, speeds, wanted) in [
        (json!([200, 300]), json!([0.01, 0.03]), [0, 0, 2]),
        (json!([200, 250, 300]), json!([0.01, 0.03]), [0, 1, 2]),
        (json!([300, 200]), json!([0.01]), [0, 0, 0]),
    ] {
        workshop.sweep(&welds(&currents, &speeds));
        assert_eq!(workshop.swept(&[]).1, wanted, "{currents} {speeds}");
    }
    workshop.add("gmaw-300a/pool.json", "another value");
    assert_eq!(workshop.swept(&[]).1, [0, 0, 2]);
}

#[test]
fn a_point_that_fails_is_told_and_the_others_are_made() {
    let workshop = Workshop::new();
    workshop.sweep(&welds(
        &json!([200, "impossible", 300]),
        &json!([0.01, 0.02]),
    ));
    let (ended, runs) = workshop.swept(&[]);
    assert!(!ended.status.success());
    let said = told(&ended);
    assert!(said.contains("Error 1"), "{said}");
    assert_eq!(
        runs,
        [1, 3, 4],
        "the pools of an arc that failed are not begun"
    );
    assert!(said.contains("4 of 6 points are made"), "{said}");
    let words = "current-impossible-speed-0.01: arc: arcfvm: that is impossible \
                 (build/gmaw-quick/sweep/current-impossible/arc.failed)";
    assert!(said.contains(words), "{said}");
    let points = workshop.points();
    let failed = |i: usize| {
        points["points"][i]["failed"]["stage"]
            .as_str()
            .map(str::to_owned)
    };
    assert_eq!((failed(1), failed(2)), (None, Some("arc".to_owned())));
    assert!(workshop.root.join("build/gmaw-quick/sweep.html").exists());
    // A point that was made once and fails now is no point that is made.
    workshop.sweep(&welds(&json!([200]), &json!([0.01, 0.02])));
    workshop.add("gmaw-quick/pool.patch.json", "impossible");
    let (ended, runs) = workshop.swept(&[]);
    assert!(!ended.status.success());
    assert_eq!(runs, [0, 0, 2]);
    assert!(
        told(&ended).contains("0 of 2 points are made"),
        "{}",
        told(&ended)
    );
    let made = workshop.points()["points"][0]["made"].clone();
    assert_eq!(
        made.as_array().unwrap().len(),
        1,
        "the arc, and no old pool: {made}"
    );
}

#[test]
fn points_that_are_not_comparable_end_a_sweep_with_a_warning_and_again_the_next_time() {
    let workshop = Workshop::new();
    let report = workshop.root.join("target/release/report");
    let copies = std::fs::read_to_string(&report).unwrap();
    let words = r#"echo '{"kind": "sweep-told", "version": "1.0", "told": ["1.0 s and 0.1 s are unlike"]}' > "${out%.html}.told.json""#;
    std::fs::write(
        &report,
        format!("{copies}{words}\n: > \"${{out%.html}}.csv\"\n"),
    )
    .unwrap();
    workshop.sweep(&welds(&json!([200, 300]), &json!([0.01])));
    for _ in 0..2 {
        let (ended, _) = workshop.swept(&[]);
        let said = told(&ended);
        assert!(
            said.contains("Error 3") && said.contains("2 of 2 points are made"),
            "{said}"
        );
        assert!(
            said.contains("sweep: not comparable: 1.0 s and 0.1 s are unlike"),
            "{said}"
        );
    }
    // A point that fails weighs more.
    workshop.sweep(&welds(&json!([200, "impossible"]), &json!([0.01])));
    let said = told(&workshop.swept(&[]).0);
    assert!(
        said.contains("Error 1") && said.contains("not comparable"),
        "{said}"
    );
}

#[test]
fn a_run_by_hand_has_the_same_key() {
    let workshop = Workshop::new();
    workshop.sweep(&welds(&json!([200]), &json!([0.01])));
    assert!(workshop.swept(&[]).0.status.success());
    let (scene, gas) = ("pipelines/gmaw-300a/arc.json", "build/gases/argon.mcap");
    let out = "build/gmaw-quick/sweep/current-200/arc.mcap";
    let patch = "build/gmaw-quick/sweep/current-200/arc.patch.json";
    let program = "target/release/arcfvm";
    let input = format!("gas={gas}");
    let by_hand = Command::new("pipelines/rerun")
        .current_dir(&workshop.root)
        .args([out, scene, patch, gas, program, "--", program, "run", scene])
        .args(["--patch", patch, "--input", &input, "--out", out])
        .args(["--threads", "7", "--progress", "none"])
        .output()
        .unwrap();
    assert!(
        told(&by_hand).contains("is up to date"),
        "{}",
        told(&by_hand)
    );
}

#[test]
fn a_sweep_tells_its_story_and_its_faults() {
    let workshop = Workshop::new();
    workshop.sweep(&welds(&json!([200]), &json!([0.01])));
    let (story, runs) = workshop.swept(&["-n"]);
    assert_eq!(runs, [0, 0, 0]);
    let words = "target/release/poolsph run pipelines/gmaw-300a/pool.json \
                 --patch pipelines/gmaw-quick/pool.patch.json \
                 --patch build/gmaw-quick/sweep/current-200-speed-0.01/pool.patch.json \
                 --input arc=build/gmaw-quick/sweep/current-200/arc.mcap";
    assert!(told(&story).contains(words), "{}", told(&story));
    assert!(!workshop.root.join("build/gmaw-quick/sweep.html").exists());
    workshop.sweep(&json!({"kind": "sweep", "version": 1, "study": "gmaw-quick", "parameters": [], "stages": []}));
    let (ended, _) = workshop.swept(&[]);
    assert!(
        told(&ended).contains("pipelines/gmaw-quick/sweep.json:"),
        "{}",
        told(&ended)
    );
    let none = workshop.ask(&["sweep", "STUDY=gmaw-slow"]);
    assert!(
        told(&none).contains("pipelines/gmaw-slow/sweep.json"),
        "{}",
        told(&none)
    );
}
