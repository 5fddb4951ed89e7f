//! The shape of the house: which crate may know which, how long a file may be, what stands at the top.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

const NUMERICS: [&str; 7] = [
    "neighbours",
    "kernels",
    "props",
    "krylov",
    "relax",
    "wls",
    "shapes",
];
const HARNESS: [&str; 2] = ["artefact", "run"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .to_owned()
}

/// Arrows that a crate of ours may point along.
fn allowed(from: &str) -> BTreeSet<&'static str> {
    let set: &[&str] = match from {
        "neighbours" | "props" | "krylov" | "relax" | "shapes" | "artefact" => &[],
        "kernels" => &["neighbours"],
        "wls" => &["neighbours", "krylov"],
        "run" => &["artefact"],
        "report" => &["artefact", "run"],
        "verification" => &["artefact", "kernels", "neighbours", "relax", "run", "wls"],
        _ => return NUMERICS.iter().chain(&HARNESS).copied().collect(),
    };
    set.iter().copied().collect()
}

#[test]
fn crates_point_only_along_allowed_arrows() {
    let output = Command::new(env!("CARGO"))
        .args([
            "metadata",
            "--no-deps",
            "--format-version",
            "1",
            "--offline",
        ])
        .current_dir(root())
        .output()
        .unwrap();
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    let ours: BTreeSet<&str> = packages
        .iter()
        .map(|p| p["name"].as_str().unwrap())
        .collect();
    let mut wrong = Vec::new();
    for package in packages {
        let from = package["name"].as_str().unwrap();
        for dependency in package["dependencies"].as_array().unwrap() {
            let to = dependency["name"].as_str().unwrap();
            let built = dependency["kind"].as_str() != Some("dev");
            if built && ours.contains(to) && !allowed(from).contains(to) {
                wrong.push(format!("{from} -> {to}"));
            }
        }
    }
    assert!(wrong.is_empty(), "arrows that are not allowed: {wrong:?}");
}

/// Rust sources of the tools, without their test modules.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            if path
                .file_name()
                .is_some_and(|n| n != "target" && n != "tests")
            {
                sources(&path, found);
            }
        } else if path.extension().is_some_and(|e| e == "rs")
            && path.file_stem().is_some_and(|n| n != "tests")
        {
            found.push(path);
        }
    }
}

/// Lines before the unit tests of a file.
fn length(path: &Path) -> usize {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines()
        .take_while(|line| line.trim() != "#[cfg(test)]")
        .count()
}

#[test]
fn a_file_holds_one_idea() {
    let mut found = Vec::new();
    sources(&root().join("tools"), &mut found);
    sources(&root().join("tests"), &mut found);
    let long: Vec<String> = found
        .iter()
        .filter(|path| length(path) > 400)
        .map(|path| format!("{} ({} lines)", path.display(), length(path)))
        .collect();
    assert!(long.is_empty(), "files over 400 lines: {long:#?}");
}

#[test]
fn a_file_has_a_name_that_says_what_it_holds() {
    let mut found = Vec::new();
    sources(&root().join("tools"), &mut found);
    let vague = [
        "utils", "util", "common", "helpers", "helper", "manager", "misc",
    ];
    let named: Vec<_> = found
        .iter()
        .filter(|p| {
            p.components().any(|c| {
                vague
                    .iter()
                    .any(|v| Path::new(c.as_os_str()).file_stem() == Some(v.as_ref()))
            })
        })
        .collect();
    assert!(named.is_empty(), "names that say nothing: {named:?}");
}

#[test]
fn the_top_level_keeps_its_names() {
    let known: BTreeSet<&str> = [
        "Cargo.toml",
        "Cargo.lock",
        "LICENSE",
        "Makefile",
        "README.md",
        "tools",
        "schemas",
        "pipelines",
        "tests",
        "build",
        "target",
    ]
    .into();
    for entry in std::fs::read_dir(root()).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(
            name.starts_with('.') || known.contains(name.as_str()),
            "'{name}' does not belong at the top level"
        );
    }
}
