//! Sample commands in `--help` name what there is: files of the repository, or files that `make` makes; and the scenes
//! among them are checked.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Programs with the commands that have a help of their own.
const PROGRAMS: [(&str, &[&str]); 16] = [
    ("gasprop", &["run", "check"]),
    ("arcfvm", &["run", "check"]),
    ("poolsph", &["run", "check"]),
    ("heatsph", &["run", "check"]),
    ("emfield", &["run", "check"]),
    ("jetsph", &["run", "check"]),
    ("avg", &["run", "check"]),
    (
        "report",
        &[
            "page", "passes", "heat", "field", "gas", "index", "figures", "validate",
        ],
    ),
    (
        "artefact",
        &[
            "info",
            "ls",
            "validate",
            "diff",
            "export",
            "recover",
            "verify-hash",
        ],
    ),
    ("verify", &[]),
    ("stability", &[]),
    ("bench", &[]),
    ("certify", &[]),
    ("exact", &[]),
    ("fuzz", &[]),
    ("faults", &[]),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .canonicalize()
        .unwrap()
}

fn program(name: &str) -> PathBuf {
    Path::new(env!("CARGO_BIN_EXE_fuzz")).with_file_name(name)
}

fn said(name: &str, words: &[&str]) -> String {
    let output = Command::new(program(name)).args(words).output();
    let output = output.unwrap_or_else(|e| panic!("{name} is not built: {e}"));
    assert!(output.status.success(), "{name} {words:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// Sample commands of a help: each in one line, from the name of the program on.
fn samples(name: &str, help: &str) -> BTreeSet<String> {
    let whole = help.replace("\\\n", " ");
    let lines = whole.lines().filter_map(|line| {
        let line = line.trim().trim_start_matches("Example:").trim();
        let direct = [
            format!("target/release/{name} "),
            format!("cargo run --release -p {name} -- "),
        ];
        direct
            .iter()
            .find_map(|start| line.strip_prefix(start.as_str()))
            .or_else(|| {
                line.strip_prefix(&format!("{name} "))
                    .filter(|rest| rest.contains("--"))
            })
            .map(|rest| rest.split_whitespace().collect::<Vec<_>>().join(" "))
    });
    lines.collect()
}

/// Everything that makes files.
fn rules() -> String {
    let mut text = std::fs::read_to_string(root().join("Makefile")).unwrap();
    for entry in std::fs::read_dir(root().join("pipelines"))
        .unwrap()
        .flatten()
    {
        let own = std::fs::read_to_string(entry.path().join("rules.mk")).unwrap_or_default();
        // Names of folders that a study gives itself stand for them.
        let given = own.lines().filter_map(|line| line.split_once(" := "));
        let given: Vec<(String, String)> = given
            .map(|(name, value)| (format!("$({})", name.trim()), value.trim().to_owned()))
            .collect();
        text += &given
            .iter()
            .fold(own.clone(), |text, (name, value)| text.replace(name, value));
    }
    text
}

/// What a sample reads and does not find.
fn absent(sample: &str, rules: &str) -> Vec<String> {
    let mut words = sample.split_whitespace();
    let mut missing = Vec::new();
    while let Some(word) = words.next() {
        if word == "--out" {
            words.next();
            continue;
        }
        let path = word
            .split_once('=')
            .map_or(word, |(_, path)| path)
            .trim_matches('"');
        // What an earlier sample writes, or another user has, is called so.
        let theirs =
            path.contains('*') || path.ends_with(".part") || path.starts_with("build/other/");
        let is_there = match path.split_once('/') {
            Some(("pipelines" | "tests" | "tools", _)) => root().join(path).exists(),
            Some(("build", _)) => theirs || rules.contains(path),
            _ => true,
        };
        if !is_there {
            missing.push(path.to_owned());
        }
    }
    missing
}

#[test]
fn samples_name_what_there_is() {
    let rules = rules();
    let (mut wrong, mut count) = (Vec::new(), 0);
    for (name, commands) in PROGRAMS {
        let mut helps = vec![said(name, &["--help"])];
        helps.extend(
            commands
                .iter()
                .map(|command| said(name, &[command, "--help"])),
        );
        let own: BTreeSet<String> = helps.iter().flat_map(|help| samples(name, help)).collect();
        assert!(!own.is_empty(), "{name} shows no sample");
        for sample in own {
            count += 1;
            let missing = absent(&sample, &rules);
            if !missing.is_empty() {
                wrong.push(format!(
                    "{name} {sample}: there is no {}",
                    missing.join(", ")
                ));
            }
        }
    }
    assert!(
        wrong.is_empty() && count > 20,
        "{count} samples: {wrong:#?}"
    );
}

#[test]
fn scenes_of_samples_are_good() {
    let mut count = 0;
    for (name, commands) in PROGRAMS
        .iter()
        .filter(|(_, commands)| commands.contains(&"check"))
    {
        assert_eq!(commands[0], "run");
        for sample in samples(name, &said(name, &["--help"])) {
            let words: Vec<&str> = sample.split_whitespace().collect();
            let needs_a_study = sample.contains("=build/");
            if needs_a_study || words[0] != "run" {
                continue;
            }
            let out = words.iter().position(|word| *word == "--out").unwrap();
            let mut check = vec!["check"];
            check.extend(words[1..out].iter().chain(&words[out + 2..]));
            let output = Command::new(program(name))
                .current_dir(root())
                .args(&check)
                .output()
                .unwrap();
            let told = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(output.status.success(), "{name} {check:?}: {told}");
            count += 1;
        }
    }
    assert!(count >= 5, "{count}");
}
