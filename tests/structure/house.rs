//! The page for maintainers, `tools/README.md`, shows the house as it is: its crates, arrows, rooms and paths.

use std::collections::BTreeSet;

use super::{allowed, packages, root};

fn page() -> String {
    std::fs::read_to_string(root().join("tools/README.md")).unwrap()
}

/// Words in backticks.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

/// Cells of the rows of all tables, heads and rules aside.
fn rows(text: &str) -> impl Iterator<Item = Vec<&str>> {
    let lines = text.lines().filter(|line| line.starts_with("| `"));
    lines.map(|line| line.trim_matches('|').split(" | ").collect())
}

/// Sections by heading.
fn sections(page: &str) -> impl Iterator<Item = (&str, &str)> {
    let parts = page.split("\n## ").skip(1);
    parts.filter_map(|part| part.split_once('\n'))
}

#[test]
fn the_arrows_of_the_page_are_those_that_are_allowed() {
    let page = page();
    let (_, arrows) = sections(&page)
        .find(|(head, _)| *head == "Crates and arrows")
        .unwrap();
    let mut named = BTreeSet::new();
    for cells in rows(arrows) {
        let told: BTreeSet<&str> = quoted(cells[1]).collect();
        for from in quoted(cells[0]) {
            assert_eq!(told, allowed(from), "what '{from}' may depend on");
            named.insert(from.to_owned());
        }
    }
    let packages = packages();
    let crates = packages.iter().map(|p| p["name"].as_str().unwrap());
    let missed: Vec<&str> = crates.filter(|name| !named.contains(*name)).collect();
    assert!(
        missed.is_empty(),
        "crates not in tools/README.md: {missed:?}"
    );
}

/// Rooms of a program as the page names them: folders end in `/`.
fn rooms<'a>(page: &'a str, tool: &str) -> BTreeSet<&'a str> {
    let of = format!("`{tool}`");
    let inside = format!("{tool}/src/");
    let mut found = BTreeSet::new();
    for (head, text) in sections(page).filter(|(head, _)| head.contains(&of)) {
        let alone = head.matches('`').count() == 2;
        for name in rows(text).flat_map(|cells| quoted(cells[0]).collect::<Vec<_>>()) {
            match name.strip_prefix(&inside) {
                Some(name) => found.insert(name),
                None => alone && found.insert(name),
            };
        }
    }
    found
}

#[test]
fn the_page_shows_every_room_of_every_program() {
    let page = page();
    let tools = root().join("tools");
    let mut wrong = Vec::new();
    for tool in std::fs::read_dir(&tools).unwrap() {
        let source = tool.unwrap().path().join("src");
        let Ok(entries) = std::fs::read_dir(&source) else {
            continue;
        };
        if !source.join("lib.rs").is_file() {
            continue;
        }
        let tool = source.parent().unwrap().file_name().unwrap();
        let tool = tool.to_str().unwrap();
        let rooms = rooms(&page, tool);
        for entry in entries.map(|entry| entry.unwrap().path()) {
            let name = format!("{}/", entry.file_name().unwrap().to_str().unwrap());
            if entry.is_dir() && !rooms.contains(name.as_str()) {
                wrong.push(format!("{tool}: {name} is not on the page"));
            }
        }
        let gone = rooms.iter().filter(|name| !source.join(name).exists());
        wrong.extend(gone.map(|name| format!("{tool}: {name} is on the page alone")));
    }
    assert!(wrong.is_empty(), "tools/README.md: {wrong:#?}");
}

#[test]
fn paths_of_the_page_exist() {
    let page = page();
    let ours = ["tools/", "tests/", "pipelines/", "schemas/"];
    let missing: Vec<&str> = quoted(&page)
        .filter(|word| ours.iter().any(|start| word.starts_with(start)))
        .filter(|word| !word.contains("NAME") && !root().join(word).exists())
        .collect();
    assert!(missing.is_empty(), "tools/README.md names {missing:?}");
}
