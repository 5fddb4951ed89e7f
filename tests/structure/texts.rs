//! Texts: decisions, one file per tool, with numbers that run through all of them and entries of half a page in sentences below
//! 30 words; and the map from claims to cases.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::root;

/// Files of decisions, the one of the whole workspace among them.
fn files() -> Vec<PathBuf> {
    let tools = root().join("tools");
    let folders = std::fs::read_dir(&tools).unwrap();
    let mut files: Vec<PathBuf> = folders
        .map(|folder| folder.unwrap().path().join("DECISIONS.md"))
        .chain([tools.join("DECISIONS.md")])
        .filter(|file| file.is_file())
        .collect();
    files.sort();
    files
}

/// Entries of a file: number, and text below the heading.
fn entries(file: &Path) -> Vec<(u32, String)> {
    let text = std::fs::read_to_string(file).unwrap();
    let parts = text.split("\n## ").skip(1);
    parts
        .map(|part| {
            let (head, body) = part.split_once('\n').unwrap();
            let number = head.split_once('.').and_then(|(n, _)| n.parse().ok());
            let number = number.unwrap_or_else(|| panic!("{}: '{head}'", file.display()));
            (number, body.trim().to_owned())
        })
        .collect()
}

/// Numbers of a list such as `1 to 3, 93`.
fn listed(list: &str) -> BTreeSet<u32> {
    let number = |text: &str| text.trim().parse::<u32>().unwrap();
    list.split(',')
        .flat_map(|part| match part.split_once(" to ") {
            Some((from, to)) => number(from)..=number(to),
            None => number(part)..=number(part),
        })
        .collect()
}

#[test]
fn each_number_stands_once_and_where_the_table_says() {
    let mut found = BTreeMap::new();
    for file in files() {
        let numbers: Vec<u32> = entries(&file).iter().map(|entry| entry.0).collect();
        assert!(numbers.is_sorted(), "{}: {numbers:?}", file.display());
        for number in numbers {
            if let Some(other) = found.insert(number, file.clone()) {
                panic!("{number}: {} and {}", other.display(), file.display());
            }
        }
    }
    let tools = root().join("tools");
    let text = std::fs::read_to_string(tools.join("DECISIONS.md")).unwrap();
    let mut told = BTreeMap::new();
    for row in text.lines().filter(|line| line.ends_with(" |")).skip(1) {
        let [_, folder, numbers, _] = row.split('|').collect::<Vec<_>>()[..] else {
            panic!("{row}");
        };
        let folder = folder.trim().split(['[', ']']).nth(1).unwrap_or("");
        let file = tools.join(folder.trim_matches('`')).join("DECISIONS.md");
        for number in listed(numbers) {
            told.insert(number, file.clone());
        }
    }
    let missed: Vec<_> = found
        .iter()
        .filter(|(n, f)| told.get(n) != Some(f))
        .collect();
    assert!(missed.is_empty(), "not in the table: {missed:?}");
    assert_eq!(
        told.len(),
        found.len(),
        "the table tells more than there is"
    );
}

#[test]
fn each_decision_says_context_choice_and_cost() {
    for file in files() {
        for (number, text) in entries(&file) {
            for part in ["*Context.*", "*Choice.*", "*Cost.*"] {
                let lacks = format!("{}, {number}: no {part}", file.display());
                assert!(text.contains(part), "{lacks}");
            }
        }
    }
}

/// Lines that an entry of half a page takes at most, and characters of a line.
const PAGE: [usize; 2] = [18, 120];

#[test]
fn each_decision_takes_half_a_page_at_most() {
    let [most, width] = PAGE;
    let mut long = Vec::new();
    for file in files() {
        for (number, text) in entries(&file) {
            let parts = text.split("\n*");
            let lines: usize = parts.map(|part| part.chars().count().div_ceil(width)).sum();
            if lines > most {
                long.push(format!("{}, {number}: {lines} lines", file.display()));
            }
        }
    }
    assert!(
        long.is_empty(),
        "over {most} lines; figures belong into the README of their study: {long:#?}"
    );
}

/// Most words of a sentence, numbers and signs aside.
const BREATH: usize = 29;

/// Sentences of a text; what stands in backticks is one word, and a colon or semicolon ends a sentence too.
fn sentences(text: &str) -> Vec<String> {
    let mut code = false;
    let plain: String = text
        .chars()
        .filter_map(|c| {
            let tick = c == '`';
            code ^= tick;
            (!code || tick).then_some(if tick { 'x' } else { c })
        })
        .collect();
    let mut all = vec![String::new()];
    for word in plain.split_whitespace() {
        if let Some(last) = all.last_mut() {
            last.push(' ');
            last.push_str(word);
        }
        if word.ends_with(['.', ';', ':', '?']) {
            all.push(String::new());
        }
    }
    all
}

/// Words of a sentence, numbers and signs aside.
fn words(sentence: &str) -> usize {
    let all = sentence.split_whitespace();
    all.filter(|word| word.contains(char::is_alphabetic))
        .count()
}

#[test]
fn decisions_are_read_once() {
    let mut long = Vec::new();
    for file in files() {
        for (number, text) in entries(&file) {
            let all = sentences(&text).into_iter();
            let found = all.filter(|sentence| words(sentence) > BREATH);
            long.extend(found.map(|sentence| format!("{}, {number}:{sentence}", file.display())));
        }
    }
    assert!(long.is_empty(), "over {BREATH} words: {long:#?}");
}

#[test]
fn sentences_end_and_code_is_a_word() {
    let told = sentences("One `a b c` two. Three; four");
    assert_eq!(told, [" One xx two.", " Three;", " four"]);
    assert_eq!(words("10 % of a drop (0.2 mm)"), 4);
}

/// Texts of ours below a folder.
fn texts(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            if path.file_name().is_some_and(|n| n != "target") {
                texts(&path, found);
            }
        } else if path.extension().is_some_and(|e| e == "rs" || e == "md") {
            found.push(path);
        }
    }
}

#[test]
fn decisions_that_are_cited_exist() {
    let known: BTreeSet<u32> = files()
        .iter()
        .flat_map(|file| entries(file))
        .map(|entry| entry.0)
        .collect();
    let mut found = Vec::new();
    for folder in ["tools", "tests", "pipelines", "schemas"] {
        texts(&root().join(folder), &mut found);
    }
    let mut cited = 0;
    for file in found {
        let text = std::fs::read_to_string(&file).unwrap();
        for (at, word) in text.match_indices("DECISIONS ") {
            let after = &text[at + word.len()..];
            let digits = after.split(|c: char| !c.is_ascii_digit()).next().unwrap();
            if let Ok(number) = digits.parse() {
                cited += 1;
                assert!(known.contains(&number), "{}: {number}", file.display());
            }
        }
    }
    assert!(cited > 0);
}

#[test]
fn cases_that_claims_name_exist() {
    let text = std::fs::read_to_string(root().join("tests/README.md")).unwrap();
    let claims = text.split("\n## ").find(|part| part.starts_with("Claims"));
    let pipelines = root().join("pipelines");
    let named = claims.unwrap().split('`').skip(1).step_by(2);
    let cases = named.filter(|name| {
        let small = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        name.contains('-') && name.chars().all(small)
    });
    let mut count = 0;
    for name in cases {
        let code = root().join("tests/src/cases").join(name.replace('-', "_"));
        let folders = [pipelines.join("verify").join(name), pipelines.join(name)];
        let there = folders.iter().any(|folder| folder.is_dir());
        assert!(
            there || code.with_extension("rs").is_file(),
            "no case {name}"
        );
        count += 1;
    }
    assert!(count > 50, "{count}");
}
