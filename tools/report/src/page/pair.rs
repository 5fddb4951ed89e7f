//! The page that compares two runs.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use run::Failure;
use serde_json::Value;

use super::beside::{self, Member, curves, numbers, pictures};
use super::runs;
use crate::csv::{self, Csv};
use crate::files::{PairFiles, save, warn};
use crate::html::{Page, Rows, escape, note, paragraph, percent};
use crate::records::figure as digits;

/// Hashes of what a stage has read, by name.
type Inputs = BTreeMap<String, String>;

/// Writes the page, and its table as CSV beside it; says what is not comparable.
pub(crate) fn write(files: &PairFiles) -> Result<ExitCode, Failure> {
    let names = names(&files.a, &files.b);
    let found = [artefacts(&files.a)?, artefacts(&files.b)?];
    let members = [
        Member::open(&names[0], &found[0])?,
        Member::open(&names[1], &found[1])?,
    ];
    let all = [numbers::of(&members[0])?, numbers::of(&members[1])?];
    let lead = paragraph(&format!(
        "A is {}, B is {}.",
        files.a.display(),
        files.b.display()
    ));
    let mut page = Page::new(&format!("{} and {}", names[0], names[1]), &lead);
    page.section("What was changed", changes(&members));
    let unlike = beside::unlike(&members);
    let numbers = beside::notes(&unlike) + &table(&names, &all);
    page.section("The numbers", numbers);
    for stage in beside::stages(&members) {
        let body = pictures::section(&members, stage)?;
        page.section(&format!("Pictures: {stage}"), body);
        let body = curves::section(&members, stage)?;
        page.section(&format!("Curves: {stage}"), body);
    }
    let records = beside::records(&members);
    page.section("How it was computed", runs::section(&records));
    let told = sheet(&names, &all);
    artefact::write_atomically(&files.out.with_extension("csv"), told.text().as_bytes())?;
    save(&files.out, &page.render())?;
    let mut ended = ExitCode::SUCCESS;
    for words in &unlike {
        ended = warn(&files.out, words)?;
    }
    Ok(ended)
}

/// What the runs are called: the ends of their paths that tell them apart.
fn names(a: &Path, b: &Path) -> [String; 2] {
    let parts = |path: &Path| -> Vec<String> {
        let parts = path
            .components()
            .map(|c| c.as_os_str().to_string_lossy().into_owned());
        parts.collect()
    };
    let (a, b) = (parts(a), parts(b));
    let end = |all: &[String], n: usize| all[all.len().saturating_sub(n)..].join("/");
    let longest = a.len().max(b.len());
    let apart = (1..=longest).find(|n| end(&a, *n) != end(&b, *n));
    match apart {
        Some(n) => [end(&a, n), end(&b, n)],
        None => ["A".to_owned(), "B".to_owned()],
    }
}

/// The artefacts in a folder by their names.
pub(crate) fn artefacts(folder: &Path) -> Result<Vec<(String, PathBuf)>, Failure> {
    let listed = std::fs::read_dir(folder).map_err(|source| Failure::Io {
        path: folder.to_owned(),
        action: "list",
        source,
    })?;
    let paths = listed.filter_map(|entry| entry.ok().map(|e| e.path()));
    let mut all: Vec<(String, PathBuf)> = paths
        .filter(|path| path.extension().is_some_and(|e| e == "mcap"))
        .map(|path| {
            (
                path.file_stem()
                    .unwrap_or_default()
                    .to_string_lossy()
                    .into_owned(),
                path,
            )
        })
        .collect();
    all.sort();
    if all.is_empty() {
        let what = format!("there is no artefact (*.mcap) in {}", folder.display());
        return Err(Failure::Usage(what));
    }
    Ok(all)
}

/// Keys of the scenes whose values differ.
fn changes(members: &[Member; 2]) -> String {
    let mut out = String::new();
    let mut table = Rows::new(&["Stage", "Key", "#A", "#B"]);
    for stage in beside::stages(members) {
        let both = (members[0].stage(stage), members[1].stage(stage));
        let (Some(a), Some(b)) = both else {
            let only = if both.0.is_some() { "A" } else { "B" };
            out += &note(&format!("Only {only} has '{stage}'."));
            continue;
        };
        let (a, b) = (a.reader.header(), b.reader.header());
        if (&a.tool, &a.tool_version) != (&b.tool, &b.tool_version) {
            let words = [a, b].map(|h| format!("{} {}", h.tool, h.tool_version));
            out += &note(&format!(
                "'{stage}' is of {} in A and of {} in B.",
                words[0], words[1]
            ));
        }
        out += &inputs(stage, &a.inputs, &b.inputs);
        let mut found = Vec::new();
        differences("", Some(&a.scene), Some(&b.scene), &mut found);
        for (key, a, b) in found {
            table.row([escape(stage), escape(&key), told(a), told(b)]);
        }
    }
    out += &table.render();
    if out.is_empty() {
        out = paragraph("The scenes are the same.");
    }
    out
}

/// Inputs of a stage that are not the same file in both runs.
fn inputs(stage: &str, a: &Inputs, b: &Inputs) -> String {
    let names: BTreeSet<&String> = a.keys().chain(b.keys()).collect();
    let other = names
        .into_iter()
        .filter(|name| a.get(*name) != b.get(*name));
    let names: Vec<&str> = other.map(String::as_str).collect();
    match names.is_empty() {
        true => String::new(),
        false => note(&format!(
            "'{stage}' has read other files as {}.",
            names.join(", ")
        )),
    }
}

/// A value of a scene in a few words; long ones by their beginning.
fn told(value: Option<&Value>) -> String {
    let Some(value) = value else {
        return "\u{2013}".to_owned();
    };
    let text = value.to_string();
    let short: String = text.chars().take(60).collect();
    let more = if short.len() < text.len() {
        "\u{2026}"
    } else {
        ""
    };
    escape(&format!("{short}{more}"))
}

type Difference<'a> = (String, Option<&'a Value>, Option<&'a Value>);

/// Every key below which two scenes differ, as deep as both have it.
fn differences<'a>(
    key: &str,
    a: Option<&'a Value>,
    b: Option<&'a Value>,
    found: &mut Vec<Difference<'a>>,
) {
    if a == b {
        return;
    }
    let (Some(Value::Object(one)), Some(Value::Object(other))) = (a, b) else {
        found.push((key.to_owned(), a, b));
        return;
    };
    let below = |name: &String| match key {
        "" => name.clone(),
        key => format!("{key}.{name}"),
    };
    for (name, value) in one {
        differences(&below(name), Some(value), other.get(name), found);
    }
    for (name, value) in other.iter().filter(|(name, _)| !one.contains_key(*name)) {
        differences(&below(name), None, Some(value), found);
    }
}

fn table(names: &[String; 2], all: &[Vec<numbers::Number>; 2]) -> String {
    let heads = [format!("#A: {}", names[0]), format!("#B: {}", names[1])];
    let head = [
        "Of",
        "Quantity",
        &heads[0],
        &heads[1],
        "#B \u{2212} A",
        "#of A",
        "Unit",
    ];
    let mut table = Rows::new(&head);
    for (quantity, values) in numbers::beside(all) {
        let difference = values[0].zip(values[1]).map(|(a, b)| b - a);
        let part = difference.zip(values[0]).filter(|(_, a)| a.abs() > 0.0);
        let share = match (difference, part) {
            (Some(d), _) if d.abs() <= 0.0 => "same".to_owned(),
            (_, Some((d, a))) => percent(d / a.abs(), 1),
            _ => String::new(),
        };
        table.row([
            escape(&quantity.origin()),
            escape(&quantity.words()),
            numbers::shown(values[0]),
            numbers::shown(values[1]),
            difference.map_or_else(String::new, digits),
            share,
            escape(numbers::unit(&quantity.unit)),
        ]);
    }
    table.render()
}

fn sheet(names: &[String; 2], all: &[Vec<numbers::Number>; 2]) -> Csv {
    let mut csv = Csv::default();
    csv.line(["of", "quantity", "unit", &names[0], &names[1], "difference"]);
    for (quantity, values) in numbers::beside(all) {
        let difference = values[0].zip(values[1]).map(|(a, b)| b - a);
        let cell = |v: Option<f64>| v.map_or_else(String::new, csv::number);
        csv.line([
            quantity.origin(),
            quantity.name.clone(),
            quantity.unit.clone(),
            cell(values[0]),
            cell(values[1]),
            cell(difference),
        ]);
    }
    csv
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn scenes_differ_where_a_key_differs() {
        let a = json!({"wire": {"diameter_m": 1, "feed": [1, 2]}, "same": 1, "gone": 1});
        let b = json!({"wire": {"diameter_m": 2, "feed": [1, 3]}, "same": 1, "new": {"x": 1}});
        let mut found = Vec::new();
        differences("", Some(&a), Some(&b), &mut found);
        let keys: Vec<&str> = found.iter().map(|(key, ..)| key.as_str()).collect();
        assert_eq!(keys, ["wire.diameter_m", "wire.feed", "gone", "new"]);
        assert_eq!(told(found[3].1), "\u{2013}");
    }

    #[test]
    fn other_inputs_are_told() {
        let of = |hash: &str| -> Inputs { [("arc".to_owned(), hash.to_owned())].into() };
        assert!(inputs("pool", &of("a"), &of("b")).contains("has read other files as arc"));
        assert!(inputs("pool", &of("a"), &Inputs::new()).contains("arc"));
        assert_eq!(inputs("pool", &of("a"), &of("a")), "");
    }

    #[test]
    fn runs_are_called_by_what_tells_them_apart() {
        let name = |a: &str, b: &str| names(Path::new(a), Path::new(b));
        assert_eq!(
            name("build/gmaw-quick", "build/my-weld/"),
            ["gmaw-quick", "my-weld"]
        );
        assert_eq!(
            name("build/a/sweep/x", "build/b/sweep/x"),
            ["a/sweep/x", "b/sweep/x"]
        );
        assert_eq!(name("build/a", "build/a"), ["A", "B"]);
    }
}
