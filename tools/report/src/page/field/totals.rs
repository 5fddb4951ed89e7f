//! Forces and heat by each way of finding them, and the times of the run.

use artefact::{Entry, Record};
use run::{Failure, duration};

use super::Run;
use crate::field::columns::prefixed;
use crate::html::{Rows, escape, paragraph, percent};
use crate::page::{grouped, tiles};
use crate::records::{RunRecord, bytes, figure as digits};

/// Channel of totals.
const TOTALS: &str = "/totals";
/// Ways of finding a total: begin of its name, what it is.
const WAYS: [(&str, &str); 5] = [
    (
        "force_volume",
        "Force: integral of J \u{d7} B over the volume",
    ),
    (
        "force_maxwell",
        "Force: Maxwell's stress on the surface of the body",
    ),
    ("force_coil", "Force: reaction on the coils"),
    ("power_volume", "Joule heat: integral over the volume"),
    (
        "power_poynting",
        "Joule heat: Poynting's flux through the surface",
    ),
];
/// Begin of the names of electric forces of bodies.
const ELECTRIC: &str = "electric_force_";
/// Stages of the program that belong together.
const PARTS: [(&str, &[&str]); 3] = [
    ("cloud", &["plan", "points", "cloud"]),
    ("weights", &["weights"]),
    ("solve", &["assemble", "factorise", "solve"]),
];

/// The section.
pub(super) fn section(run: &Run) -> Result<String, Failure> {
    let record = match run.reader.count(TOTALS).checked_sub(1) {
        Some(last) => run.reader.record_at(TOTALS, last)?,
        None => Record::new(),
    };
    Ok(tiles(&facts(run, &record)) + &spread(&record) + &table(run, &record))
}

fn facts(run: &Run, record: &Record) -> Vec<(String, String)> {
    let mut facts = vec![(grouped(run.points.position.len()), "points".to_owned())];
    for (name, words) in [
        ("force_volume", "force along z"),
        ("power_volume", "Joule heat"),
    ] {
        let found = record.values.iter().find(|e| {
            e.name.starts_with(name) && !e.name.ends_with("_x") && !e.name.ends_with("_y")
        });
        if let Some(entry) = found {
            facts.push((with_unit(entry.value, &entry.unit), words.to_owned()));
        }
    }
    if let Some(record) = &run.record {
        for (name, stages) in PARTS {
            let spent = seconds(record, stages);
            if spent > 0.0 {
                facts.push((duration(spent), name.to_owned()));
            }
        }
        if let Some(peak) = record.peak_memory_bytes {
            facts.push((bytes(peak), "peak memory".to_owned()));
        }
    }
    facts
}

fn seconds(record: &RunRecord, stages: &[&str]) -> f64 {
    let own = record
        .stages
        .iter()
        .filter(|s| stages.contains(&s.name.as_str()));
    own.map(|s| s.wall_s).sum()
}

fn with_unit(value: f64, unit: &str) -> String {
    let (unit, factor) = prefixed(unit, value.abs());
    format!("{} {unit}", digits(factor * value))
}

/// Two digits and a unit.
fn short(value: f64, unit: &str) -> String {
    let (unit, factor) = prefixed(unit, value.abs());
    let shown = factor * value;
    let count = (1.0 - shown.abs().max(1e-300).log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{shown:.count$} {unit}")
}

/// What the ways of finding the force differ by.
fn spread(record: &Record) -> String {
    let Some(entry) = record.values.iter().find(|e| e.name == "force_spread") else {
        return String::new();
    };
    let (spread, unit) = (entry.value, entry.unit.as_str());
    let along = |name: &str| {
        let parts = ["x", "y", "z"].map(|k| record.get(&format!("{name}_{k}")).unwrap_or(0.0));
        parts.iter().map(|v| v * v).sum::<f64>().sqrt()
    };
    let most = ["force_volume", "force_maxwell", "force_coil"].map(along);
    let most = most.into_iter().fold(0.0, f64::max);
    let mut text = format!(
        "Three ways of finding the force differ by {} at most",
        short(spread, unit)
    );
    if most > 0.0 {
        text += &format!(", {:.2} % of it", 100.0 * spread / most);
    }
    paragraph(&(text + ": they share the points but not the error, and so tell how good it is."))
}

/// A row for each way; columns along the axes.
fn table(run: &Run, record: &Record) -> String {
    let known = |e: &Entry| run.exact.as_ref().and_then(|x| x.total(&e.name));
    let judged = record.values.iter().any(|e| known(e).is_some());
    let mut heads = vec!["Total", "#x", "#y", "#z", "#Sum", "Unit"];
    if judged {
        heads.extend(["#Exact", "#Error"]);
    }
    let mut table = Rows::new(&heads);
    let mut ways: Vec<(String, String)> = WAYS.map(|(n, w)| (n.to_owned(), w.to_owned())).to_vec();
    ways.extend(bodies(record));
    ways.extend(enclosures(record));
    for (name, words) in ways {
        let part = |axis: &str| {
            let whole = format!("{name}{axis}");
            record.values.iter().find(|e| e.name == whole)
        };
        let all = ["_x", "_y", "_z", ""].map(part);
        let exact = all
            .iter()
            .flatten()
            .rev()
            .find_map(|e| Some((e.value, known(e)?)));
        if let Some(cells) = row(&words, all, judged, exact) {
            table.row(cells);
        }
    }
    table.render()
}

/// The cells of a way of finding a total; `None` where it was not gone.
fn row(
    words: &str,
    all: [Option<&Entry>; 4],
    judged: bool,
    exact: Option<(f64, f64)>,
) -> Option<Vec<String>> {
    let unit = all.iter().flatten().next()?.unit.clone();
    let sizes = all.iter().flatten().map(|e| e.value.abs());
    let most = sizes.fold(0.0, f64::max);
    let (shown, factor) = prefixed(&unit, most);
    let cell = |value: f64| decimals(factor * value, factor * most);
    let mut cells = vec![escape(words)];
    for entry in all {
        cells.push(entry.map_or_else(String::new, |e| cell(e.value)));
    }
    cells.push(escape(&shown));
    match exact {
        Some((value, wanted)) => {
            cells.extend([cell(wanted), percent(value / wanted - 1.0, 2)]);
        }
        None if judged => cells.extend([String::new(), String::new()]),
        None => {}
    }
    Some(cells)
}

/// A value with the decimals that give the largest beside it four digits.
fn decimals(value: f64, most: f64) -> String {
    if !(1e-3..1e5).contains(&most) {
        return digits(value);
    }
    let count = (3.0 - most.log10().floor()).clamp(0.0, 6.0) as usize;
    let text = format!("{value:.count$}");
    match text.trim_start_matches('-').trim_start_matches(['0', '.']) {
        "" => "0".to_owned(),
        _ => text.replace('-', "\u{2212}"),
    }
}

/// Electric forces of bodies.
fn bodies(record: &Record) -> Vec<(String, String)> {
    let mut found: Vec<(String, String)> = Vec::new();
    for entry in &record.values {
        let Some(rest) = entry.name.strip_prefix(ELECTRIC) else {
            continue;
        };
        let axes = ["_x", "_y", "_z"].iter();
        let body = axes
            .filter_map(|axis| rest.strip_suffix(axis))
            .next()
            .unwrap_or(rest);
        let name = format!("{ELECTRIC}{body}");
        if !found.iter().any(|(n, _)| *n == name) {
            found.push((
                name,
                format!("Electric force on {body}: traction over its surface"),
            ));
        }
    }
    found
}

/// What is found over closed surfaces around bodies: `NAME.force_z`, `NAME.electric_force_z`, `NAME.power`.
fn enclosures(record: &Record) -> Vec<(String, String)> {
    let mut found: Vec<(String, String)> = Vec::new();
    for entry in &record.values {
        let whole = entry.name.as_str();
        let name = ["_x", "_y", "_z"]
            .iter()
            .find_map(|axis| whole.strip_suffix(axis))
            .unwrap_or(whole);
        let Some((surface, what)) = name.rsplit_once('.') else {
            continue;
        };
        let words = match what {
            "force" => "Force: Maxwell's stress over the surface",
            "electric_force" => "Electric force: Maxwell's stress over the surface",
            "power" => "Joule heat: Poynting's flux through the surface",
            _ => continue,
        };
        if !found.iter().any(|(n, _)| n == name) {
            found.push((name.to_owned(), format!("{words} \"{surface}\"")));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_have_the_decimals_of_the_largest() {
        assert_eq!(decimals(26.545, 26.545), "26.55");
        assert_eq!(decimals(-0.005, 26.545), "\u{2212}0.01");
        assert_eq!(decimals(-0.0005, 26.545), "0");
        assert_eq!(decimals(0.0, 0.0), "0");
    }

    #[test]
    fn bodies_are_named_by_their_forces() {
        let record = Record::new()
            .with("electric_force_left drop_x", "N", 1.0)
            .with("electric_force_left drop_z", "N", 1.0)
            .with("force_spread", "N", 1.0);
        let found = bodies(&record);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].0, "electric_force_left drop");
    }

    #[test]
    fn a_body_may_be_called_as_an_axis_is() {
        let record = Record::new()
            .with("electric_force_coil_x_x", "N", 1.0)
            .with("electric_force_coil_x_z", "N", 1.0);
        let found = bodies(&record);
        assert_eq!(
            (found.len(), found[0].0.as_str()),
            (1, "electric_force_coil_x")
        );
    }

    #[test]
    fn the_spread_of_forces_has_its_own_unit() {
        let record = |unit: &str| {
            Record::new()
                .with("force_spread", unit, 2.0)
                .with("force_volume_x", unit, 4.0)
        };
        assert!(spread(&record("N/m")).contains("N/m at most"));
        assert!(spread(&record("N")).contains("N at most"));
    }

    #[test]
    fn surfaces_around_bodies_are_named() {
        let record = Record::new()
            .with("near.force_x", "N", 1.0)
            .with("near.force_z", "N", 1.0)
            .with("near.force_spread", "N", 1.0)
            .with("near.power", "W", 1.0)
            .with("force_volume_x", "N", 1.0);
        let names: Vec<String> = enclosures(&record).into_iter().map(|w| w.0).collect();
        assert_eq!(names, ["near.force", "near.power"]);
    }
}
