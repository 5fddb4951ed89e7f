//! One skeleton: names that every stage keeps, and physics that does not read the scene.
//!
//! What does not keep to it yet is listed by name. A list may only get shorter: an exception that no longer exists fails.

use std::collections::BTreeSet;

use super::{modules, needs, root};

const STAGES: [&str; 7] = [
    "gasprop", "arcfvm", "poolsph", "avg", "emfield", "heatsph", "jetsph",
];

/// Rooms of a stage: what each holds, and the names that it may have.
const ROOMS: [(&str, &[&str]); 5] = [
    ("the `impl Tool`", &["program"]),
    ("what was typed", &["scene"]),
    (
        "what the scene contains, made into a problem",
        &["assemble"],
    ),
    ("the loop over steps or iterations", &["march", "iterate"]),
    ("what is written", &["frames"]),
];

/// Rooms that a stage lacks, or has under another name.
const LACKING: [(&str, &str); 3] = [
    ("avg", "march or iterate"),
    ("gasprop", "frames"),
    ("gasprop", "march or iterate"),
];

/// Modules that may read the scene: the program around the physics.
const PROGRAM: [&str; 11] = [
    "program", "scene", "assemble", "march", "iterate", "frames", "plan", "settings", "simulate",
    "memory", "trial",
];

/// The one file of a folder of physics that may read the scene: it makes what the others compute with.
const SETUP: &str = "setup";

fn source(stage: &str) -> std::path::PathBuf {
    root().join("tools").join(stage).join("src")
}

/// Fails where `found` and the list of `known` exceptions differ.
fn only(known: &[(&str, &str)], found: &[(&str, String)], what: &str) {
    let known: BTreeSet<(&str, &str)> = known.iter().copied().collect();
    let found: BTreeSet<(&str, &str)> = found.iter().map(|(s, n)| (*s, n.as_str())).collect();
    let new: Vec<_> = found.difference(&known).collect();
    assert!(new.is_empty(), "{what}: {new:?}");
    let gone: Vec<_> = known.difference(&found).collect();
    assert!(
        gone.is_empty(),
        "no exceptions any more, strike them off: {gone:?}"
    );
}

#[test]
fn every_stage_has_the_same_rooms() {
    let mut found = Vec::new();
    for stage in STAGES {
        let source = source(stage);
        let has = |name: &str| {
            source.join(name).is_dir() || source.join(name).with_extension("rs").is_file()
        };
        for (_, names) in ROOMS {
            if !names.iter().any(|name| has(name)) {
                found.push((stage, names.join(" or ")));
            }
        }
    }
    only(&LACKING, &found, "rooms that stages lack");
}

#[test]
fn the_program_is_where_its_name_says() {
    for stage in STAGES {
        let program = source(stage).join("program.rs");
        if let Ok(text) = std::fs::read_to_string(&program) {
            assert!(text.contains("impl Tool for"), "{}", program.display());
        }
    }
}

#[test]
fn physics_does_not_read_the_scene() {
    let mut found = Vec::new();
    for stage in STAGES {
        let files = modules(&source(stage));
        for (module, others) in needs(&source(stage)) {
            let reads = others.iter().any(|other| other[0] == "scene");
            let text = std::fs::read_to_string(&files[&module]).unwrap();
            let setup = module.len() > 1 && module.last().is_some_and(|name| name == SETUP);
            let program = PROGRAM.contains(&module[0].as_str()) || text.contains("impl Tool for");
            if reads && !program && !setup {
                found.push((stage, module.join("/")));
            }
        }
    }
    assert!(found.is_empty(), "physics that reads the scene: {found:?}");
}
