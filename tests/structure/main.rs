//! The shape of the house: which crate may know which, how long a file may be, what stands at the top.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod arguments;
mod house;
mod owners;
mod skeleton;
mod texts;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

const NUMERICS: [&str; 12] = [
    "neighbours",
    "kernels",
    "props",
    "krylov",
    "relax",
    "wls",
    "quadrature",
    "shapes",
    "contact",
    "particles",
    "torch",
    "steps",
];
const HARNESS: [&str; 4] = ["artefact", "run", "columns", "figures"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .to_owned()
}

/// Arrows that a crate of ours may point along.
fn allowed(from: &str) -> BTreeSet<&'static str> {
    let set: &[&str] = match from {
        "neighbours" | "props" | "krylov" | "quadrature" | "steps" | "manual" => &[],
        "shapes" => &["quadrature"],
        "contact" => &["shapes"],
        "torch" => &["quadrature", "shapes"],
        "kernels" | "particles" => &["neighbours"],
        "wls" => &["neighbours", "krylov"],
        "relax" => &["krylov"],
        "artefact" => &["manual"],
        "run" => &["artefact", "manual"],
        "columns" => &["artefact", "particles"],
        "figures" | "fuzz" => &["artefact"],
        "report" => &[
            "artefact",
            "figures",
            "manual",
            "neighbours",
            "run",
            "torch",
        ],
        "sweep" => &["artefact", "figures", "manual", "run"],
        "verification" => &[
            "artefact",
            "figures",
            "kernels",
            "neighbours",
            "relax",
            "run",
            "wls",
        ],
        _ => return NUMERICS.iter().chain(&HARNESS).copied().collect(),
    };
    set.iter().copied().collect()
}

/// What cargo says of each of our crates.
fn packages() -> Vec<serde_json::Value> {
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
    metadata["packages"].as_array().unwrap().clone()
}

#[test]
fn crates_point_only_along_allowed_arrows() {
    let packages = packages();
    let ours: BTreeSet<&str> = packages
        .iter()
        .map(|p| p["name"].as_str().unwrap())
        .collect();
    let mut wrong = Vec::new();
    for package in &packages {
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

/// Files of a crate by the path of their module; `lib.rs` and `main.rs` stand apart.
fn modules(source: &Path) -> BTreeMap<Vec<String>, PathBuf> {
    let mut found = Vec::new();
    sources(source, &mut found);
    let module = |path: &PathBuf| {
        let inside = path.strip_prefix(source).unwrap().with_extension("");
        let mut parts: Vec<String> = inside
            .iter()
            .map(|part| part.to_str().unwrap().to_owned())
            .collect();
        parts.pop_if(|last| last == "mod");
        let apart = parts.len() == 1 && (parts[0] == "lib" || parts[0] == "main");
        (!apart).then(|| (parts, path.clone()))
    };
    found.iter().filter_map(module).collect()
}

/// The text of a path at the start of `code`, with the braces of a group.
fn path(code: &str) -> &str {
    let mut depth = 0_i32;
    let end = code.find(|c: char| {
        depth += i32::from(c == '{') - i32::from(c == '}');
        !(c.is_alphanumeric() || "_:{}".contains(c) || (c == ',' && depth > 0)) || depth < 0
    });
    &code[..end.unwrap_or(code.len())]
}

/// Paths of the crate that a file names, its tests aside, from the root of the crate.
fn named(module: &[String], text: &str) -> Vec<Vec<String>> {
    let text = text.split("#[cfg(test)]").next().unwrap();
    let code: String = text
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .flat_map(str::chars)
        .filter(|c| !c.is_whitespace())
        .collect();
    let parts = |words: &str| -> Vec<String> {
        let words = words.split("::").filter(|word| !word.is_empty());
        words.map(str::to_owned).collect()
    };
    let mut all = Vec::new();
    let mut name = |base: &[String], rest: &str| {
        let (stem, items) = rest.split_once('{').unwrap_or((rest, ""));
        for item in items.trim_end_matches('}').split(',') {
            all.push([base, &parts(stem), &parts(item)].concat());
        }
    };
    for (at, word) in code.match_indices("crate::") {
        name(&[], path(&code[at + word.len()..]));
    }
    for (at, word) in code.match_indices("usesuper::") {
        let rest = path(&code[at + word.len()..]);
        let below = rest.trim_start_matches("super::");
        let ups = 1 + (rest.len() - below.len()) / "super::".len();
        name(&module[..module.len() - ups], below);
    }
    all
}

/// Modules that each module needs: those that hold what it names, but for the ones that it lies in.
fn needs(source: &Path) -> BTreeMap<Vec<String>, BTreeSet<Vec<String>>> {
    let modules = modules(source);
    let holder = |path: &Vec<String>| {
        let mut holders = (1..=path.len()).rev().map(|n| path[..n].to_vec());
        holders.find(|part| modules.contains_key(part))
    };
    let own = |(module, file): (&Vec<String>, &PathBuf)| {
        let text = std::fs::read_to_string(file).unwrap();
        let paths = named(module, &text);
        let held = paths.iter().filter_map(holder);
        let others = held.filter(|other| !module.starts_with(other));
        (module.clone(), others.collect())
    };
    modules.iter().map(own).collect()
}

/// A way from a module back to itself.
fn circle(needs: &BTreeMap<Vec<String>, BTreeSet<Vec<String>>>) -> Option<String> {
    let mut left = needs.clone();
    // What needs nothing that is left is in no circle.
    while let Some(free) = left
        .iter()
        .find(|(_, others)| others.iter().all(|other| !left.contains_key(other)))
        .map(|(module, _)| module.clone())
    {
        left.remove(&free);
    }
    let mut at = left.keys().next()?.clone();
    let mut way = Vec::new();
    while !way.contains(&at) {
        let next = left[&at].iter().find(|other| left.contains_key(*other));
        way.push(std::mem::replace(&mut at, next?.clone()));
    }
    way.push(at.clone());
    let names = way.iter().skip_while(|module| **module != at);
    Some(names.map(|m| m.join("::")).collect::<Vec<_>>().join(" -> "))
}

#[test]
fn no_file_needs_itself_by_way_of_others() {
    let mut crates = Vec::new();
    for folder in ["tools", "tools/numerics", "tools/harness"] {
        for entry in std::fs::read_dir(root().join(folder)).unwrap() {
            let source = entry.unwrap().path().join("src");
            if source.is_dir() {
                crates.push(source);
            }
        }
    }
    assert!(crates.len() > 12, "{crates:?}");
    let found: Vec<String> = crates
        .iter()
        .filter_map(|source| Some(format!("{}: {}", source.display(), circle(&needs(source))?)))
        .collect();
    assert!(found.is_empty(), "circles: {found:#?}");
}

#[test]
fn a_circle_of_files_is_found() {
    let module = |name: &str| vec![name.to_owned()];
    assert_eq!(
        named(
            &module("a"),
            "use crate::b::{C, d::E};\nuse super::f;\n// use crate::g;\n"
        ),
        [vec!["b", "C"], vec!["b", "d", "E"], vec!["f"]]
    );
    let tied = |pairs: &[(&str, &str)]| {
        let mut needs = BTreeMap::new();
        for name in ["a", "b", "c"] {
            let others = pairs.iter().filter(|(from, _)| *from == name);
            needs.insert(module(name), others.map(|(_, to)| module(to)).collect());
        }
        circle(&needs)
    };
    assert_eq!(tied(&[("a", "b"), ("b", "c"), ("a", "c")]), None);
    assert_eq!(
        tied(&[("a", "b"), ("b", "c"), ("c", "b")]).unwrap(),
        "b -> c -> b"
    );
}
