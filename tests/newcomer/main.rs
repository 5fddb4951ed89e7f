//! The book: its pages are all there, and what they name exists. `make newcomer` types its commands.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .to_owned()
}

fn read(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|e| panic!("{path}: {e}"))
}

/// Pages of the book by name, with their texts.
fn pages() -> Vec<(String, String)> {
    let folder = root().join("tools/book/src");
    let mut pages: Vec<(String, String)> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            (name, std::fs::read_to_string(path).unwrap())
        })
        .collect();
    pages.sort();
    pages
}

/// What stands between single backquotes.
fn quoted(text: &str) -> Vec<String> {
    let mut fenced = false;
    let lines = text.lines().filter(|line| {
        let fence = line.starts_with("```");
        fenced ^= fence;
        !fenced && !fence
    });
    let plain: String = lines.collect::<Vec<_>>().join("\n");
    plain
        .split('`')
        .skip(1)
        .step_by(2)
        .map(str::to_owned)
        .collect()
}

#[test]
fn the_summary_lists_every_page_once() {
    let summary = read("tools/book/src/SUMMARY.md");
    let listed: Vec<&str> = summary
        .split("](")
        .skip(1)
        .filter_map(|part| part.split(')').next())
        .collect();
    let unique: BTreeSet<&str> = listed.iter().copied().collect();
    assert_eq!(listed.len(), unique.len(), "{listed:?}");
    for (name, text) in pages() {
        assert_eq!(
            unique.contains(name.as_str()),
            name != "SUMMARY.md",
            "{name}"
        );
        for link in text
            .split("](")
            .skip(1)
            .filter_map(|part| part.split(')').next())
        {
            let there = root().join("tools/book/src").join(link);
            assert!(there.exists(), "{name}: {link}");
        }
    }
}

#[test]
fn cases_studies_and_folders_that_pages_name_exist() {
    let families = [
        "arc", "dem", "em", "flow", "heat", "jet", "liquid", "pool", "saw", "solid", "fracture",
        "gas",
    ];
    let mut cases = 0;
    for (name, text) in pages() {
        for word in quoted(&text) {
            let family = word.split('-').next().unwrap();
            let plain = word
                .chars()
                .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-');
            if plain && word.contains('-') && families.contains(&family) {
                let folders = ["pipelines/verify", "pipelines"].map(|f| root().join(f).join(&word));
                assert!(
                    folders.iter().any(|f| f.exists()),
                    "{name}: no case or study {word}"
                );
                cases += 1;
            }
            let own = word.starts_with("pipelines/my-weld");
            if (word.starts_with("pipelines/")
                || word.starts_with("tools/")
                || word.starts_with("schemas/"))
                && !own
            {
                assert!(root().join(&word).exists(), "{name}: there is no {word}");
            }
        }
    }
    assert!(cases > 30, "{cases}");
}

#[test]
fn make_knows_every_target_that_pages_name() {
    let help = Command::new("make")
        .arg("help")
        .current_dir(root())
        .output()
        .unwrap();
    let help = String::from_utf8(help.stdout).unwrap();
    let known: BTreeSet<&str> = help
        .lines()
        .filter_map(|line| line.trim().strip_prefix("make ")?.split_whitespace().next())
        .collect();
    let mut named = 0;
    for (name, text) in pages() {
        for target in text.split("make ").skip(1).filter_map(|rest| {
            let word: String = rest
                .chars()
                .take_while(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || *c == '-')
                .collect();
            let before = &text[..text.len() - rest.len() - "make ".len()];
            before.ends_with(['`', '\n']).then_some(word)
        }) {
            let own = target == "my-weld";
            assert!(
                own || known.contains(target.as_str()),
                "{name}: make {target}"
            );
            named += 1;
        }
    }
    assert!(named > 6, "{named}");
}
