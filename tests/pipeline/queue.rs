//! `make sweep ENGINE=hq`: a job definition file, run by HyperQueue's own server and worker, which its Python package brings along.

use std::path::Path;
use std::process::Command;

use serde_json::json;
use verification::skipped::skip;

use super::study::Workshop;
use super::sweep::welds;

#[test]
fn hyperqueue_makes_the_points_in_their_order_and_tells_what_failed() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let python = project.join("build/python/bin");
    let known = Command::new(python.join("python3"))
        .args(["-c", "import hyperqueue, tomllib"])
        .output();
    if !known.is_ok_and(|output| output.status.success()) {
        skip(
            "hyperqueue",
            "it is not in build/python: no job of it is run",
        );
        return;
    }
    let workshop = Workshop::new();
    workshop.sweep(&welds(
        &json!([200, "impossible", 300]),
        &json!([0.01, 0.02]),
    ));
    let commands = project.join("tests/pipeline");
    let path = std::env::var("PATH").unwrap();
    let path = format!("{}:{}:{path}", commands.display(), python.display());
    let ended = Command::new("make")
        .current_dir(&workshop.root)
        .args(["sweep", "STUDY=gmaw-quick", "ENGINE=hq", "THREADS=1"])
        .env("PATH", path)
        .env_remove("MAKEFLAGS")
        .env_remove("MAKELEVEL")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert!(
        !ended.status.success() && said.contains("Error 1"),
        "{said}"
    );
    assert!(said.contains("4 of 6 points are made"), "{said}");
    let log = std::fs::read_to_string(workshop.root.join("log")).unwrap();
    let count = |name: &str| log.lines().filter(|line| *line == name).count();
    assert_eq!(
        ["gasprop", "arcfvm", "poolsph"].map(count),
        [1, 3, 4],
        "{said}"
    );
}
