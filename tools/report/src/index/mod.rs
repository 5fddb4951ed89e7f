//! The page of all evidence: exact cases, extreme cases, speed, studies.

mod absence;
mod bench;
mod cards;
mod cost;
mod faults;
mod map;
mod others;
mod stability;
mod verify;

use std::path::{Path, PathBuf};

use run::Failure;
use serde::de::DeserializeOwned;
use serde_json::Value;

use self::cards::{Card, cards};
use self::cost::{Cost, Prices};
use crate::certified;
use crate::files::{Folders, save};
use crate::html::{Page, escape, note, paragraph};
use crate::records::RunRecord;

/// Writes the page.
pub(crate) fn write(folders: &Folders) -> Result<(), Failure> {
    let lead = "Evidence that the programs solve their equations: error against run time for cases with exact \
                solutions, how extreme cases end, how fast it is, and the studies themselves.";
    let mut page = Page::new("Fusionline: evidence", &paragraph(lead));
    let missing = folders
        .missing()
        .map(|folder| note(&format!("There is no folder {}.", folder.display())));
    page.section("Not there", missing.collect());
    let speed = match &folders.bench {
        Some(folder) => Speed::read(folder)?,
        None => Speed::default(),
    };
    let prices = absence::prices(&speed.absences);
    if let Some(folder) = &folders.studies {
        page.section("Studies", studies(folder, &folders.out, &prices)?);
    }
    if let Some(folder) = &folders.certify {
        page.section("Studies and their errors", certificates(folder)?);
    }
    if let Some(folder) = &folders.verify {
        page.section(
            "Exact cases",
            all(folder, verify::summary, |study| {
                verify::section(study, &prices)
            })?,
        );
    }
    if let Some(folder) = &folders.stability {
        page.section(
            "Extreme cases",
            all(folder, stability::summary, stability::section)?,
        );
    }
    if folders.bench.is_some() {
        page.section("Speed", speed.section());
        page.section("Absent physics", absence::section(&speed.absences));
        page.section(
            "Other programs",
            speed.others.iter().map(others::section).collect(),
        );
    }
    if let Some(folder) = &folders.faults {
        page.section(
            "What machines do to runs",
            all(folder, |_| String::new(), faults::section)?,
        );
    }
    save(&folders.out, &page.render())
}

/// What `make bench` writes, by kind.
#[derive(Debug, Default)]
struct Speed {
    benches: Vec<bench::Bench>,
    absences: Vec<absence::Record>,
    others: Vec<others::Record>,
    notes: String,
}

impl Speed {
    fn read(folder: &Path) -> Result<Self, Failure> {
        let mut all = Self::default();
        for path in files(folder)? {
            let kind = parsed::<Value>(&path)?.ok();
            match kind.as_ref().and_then(|v| v["kind"].as_str()) {
                Some("absence") => take(&path, &mut all.absences, &mut all.notes)?,
                Some("others") => take(&path, &mut all.others, &mut all.notes)?,
                _ => take(&path, &mut all.benches, &mut all.notes)?,
            }
        }
        Ok(all)
    }

    fn section(&self) -> String {
        let bodies: String = self.benches.iter().map(bench::section).collect();
        match bodies.is_empty() && self.notes.is_empty() {
            true => paragraph("Nothing here yet."),
            false => self.notes.clone() + &bodies,
        }
    }
}

/// What `make certify` writes, by kind.
fn certificates(folder: &Path) -> Result<String, Failure> {
    let (mut studies, mut proofs, mut out) = (Vec::new(), Vec::new(), String::new());
    for path in files(folder)? {
        let kind = parsed::<Value>(&path)?.ok();
        match kind.as_ref().and_then(|v| v["kind"].as_str()) {
            Some("certificate-proof") => take(&path, &mut proofs, &mut out)?,
            Some("certificate") => take(&path, &mut studies, &mut out)?,
            _ => {}
        }
    }
    out += &proofs.iter().map(certified::proved).collect::<String>();
    out += &studies.iter().map(certified::section).collect::<String>();
    Ok(match out.is_empty() {
        true => paragraph("Nothing here yet."),
        false => out,
    })
}

/// A record of a file, or why it is none.
fn parsed<T: DeserializeOwned>(path: &Path) -> Result<serde_json::Result<T>, Failure> {
    let text = std::fs::read_to_string(path).map_err(|source| Failure::Io {
        path: path.to_owned(),
        action: "read",
        source,
    })?;
    Ok(serde_json::from_str(&text))
}

/// Adds the record of a file; what cannot be read is named.
fn take<T: DeserializeOwned>(
    path: &Path,
    records: &mut Vec<T>,
    notes: &mut String,
) -> Result<(), Failure> {
    match parsed(path)? {
        Ok(record) => records.push(record),
        Err(e) => {
            *notes += &note(&format!(
                "{} is not a record that can be shown: {e}",
                path.display()
            ));
        }
    }
    Ok(())
}

/// All records of a folder, summed up and one after another. What cannot be read is named.
fn all<T: DeserializeOwned>(
    folder: &Path,
    summary: impl Fn(&[T]) -> String,
    one: impl Fn(&T) -> String,
) -> Result<String, Failure> {
    let mut records = Vec::new();
    let mut notes = String::new();
    for path in files(folder)? {
        take(&path, &mut records, &mut notes)?;
    }
    if records.is_empty() && notes.is_empty() {
        return Ok(paragraph("Nothing here yet."));
    }
    let bodies: String = records.iter().map(one).collect();
    Ok(notes + &summary(&records) + &bodies)
}

/// JSON files of a folder in the order of their names, without the run records of artefacts; none
/// where there is no such folder.
fn files(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let mut found: Vec<PathBuf> = entries(folder)?
        .into_iter()
        .filter(|p| p.is_file() && record(p))
        .collect();
    found.sort();
    Ok(found)
}

fn record(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.ends_with(".json") && !name.ends_with(".run.json")
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let listed = std::fs::read_dir(folder).map_err(|source| Failure::Io {
        path: folder.to_owned(),
        action: "list",
        source,
    })?;
    Ok(listed
        .filter_map(|entry| entry.ok().map(|e| e.path()))
        .collect())
}

/// Cards of the pages of studies, and what their runs spent and left out.
fn studies(folder: &Path, out: &Path, prices: &Prices) -> Result<String, Failure> {
    let mut folders = entries(folder)?;
    folders.sort();
    let from = out.parent().unwrap_or(Path::new("."));
    let mut found = Vec::new();
    let mut records = Vec::new();
    for study in &folders {
        let name = study.file_name().unwrap_or_default().to_string_lossy();
        let mut link = |page: &Path, words: &str| {
            found.push(Card {
                name: words.to_owned(),
                link: relative(from, page),
                // A page that cannot be read is linked to all the same.
                page: std::fs::read_to_string(page).unwrap_or_default(),
            });
        };
        let page = study.join("report.html");
        if page.is_file() {
            records.extend(runs(study)?);
            link(&page, &name);
        }
        for page in sweeps(study)? {
            let sweep = page.file_stem().unwrap_or_default().to_string_lossy();
            link(&page, &format!("{name}: {sweep}"));
        }
    }
    if found.is_empty() {
        return Ok(paragraph("Nothing here yet."));
    }
    let costs: Vec<Cost> = records
        .iter()
        .map(|(name, record)| Cost {
            name: name.clone(),
            ..Cost::of(record)
        })
        .collect();
    let table = cost::table("Run", &costs, prices);
    Ok(cards(&found) + &table)
}

/// The pages of sweeps of a study: those with a folder of points beside them.
fn sweeps(study: &Path) -> Result<Vec<PathBuf>, Failure> {
    let mut found = entries(study)?;
    let swept = |page: &Path| page.with_extension("").join("points.json").is_file();
    found.retain(|page| page.extension().is_some_and(|e| e == "html") && swept(page));
    found.sort();
    Ok(found)
}

/// The run records of a study by the names of their artefacts.
fn runs(study: &Path) -> Result<Vec<(String, RunRecord)>, Failure> {
    let mut found: Vec<PathBuf> = entries(study)?;
    found.retain(|p| p.to_string_lossy().ends_with(".run.json"));
    found.sort();
    let whole = study.file_name().unwrap_or_default().to_string_lossy();
    let read = |path: &PathBuf| {
        let stem = path.file_name()?.to_string_lossy().replace(".run.json", "");
        let record = RunRecord::beside(&path.with_file_name(format!("{stem}.mcap")))?;
        Some((format!("{whole}: {stem}"), record))
    };
    Ok(found.iter().filter_map(read).collect())
}

/// The way from a folder to a file, for a link.
fn relative(from: &Path, to: &Path) -> String {
    let plain = |path: &Path| -> Vec<String> {
        let here = Path::new(".");
        let path = if path.as_os_str().is_empty() {
            here
        } else {
            path
        };
        let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        whole
            .components()
            .map(|c| c.as_os_str().to_string_lossy().into_owned())
            .collect()
    };
    let (from, to) = (plain(from), plain(to));
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let up = std::iter::repeat_n("..".to_owned(), from.len() - shared);
    up.chain(to[shared..].iter().cloned())
        .collect::<Vec<_>>()
        .join("/")
}

/// A heading with a place that links can point to.
fn heading(name: &str, holds: bool, words: (&str, &str)) -> String {
    judged(name, if holds { words.0 } else { words.1 }, Some(holds))
}

/// The same with a verdict that may be open.
fn judged(name: &str, word: &str, holds: Option<bool>) -> String {
    format!(
        "<h3 id=\"{0}\">{0} {1}</h3>\n",
        escape(name),
        crate::html::verdict(word, holds)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_go_from_page_to_page() {
        let way = relative(
            Path::new("build/report"),
            Path::new("build/gmaw/report.html"),
        );
        assert_eq!(way, "../gmaw/report.html");
        assert_eq!(relative(Path::new(""), Path::new("a/b.html")), "a/b.html");
    }

    #[test]
    fn records_of_runs_are_no_evidence() {
        assert!(record(Path::new("a/cores.json")));
        assert!(!record(Path::new("a/flow.run.json")) && !record(Path::new("a/flow.mcap")));
    }

    #[test]
    fn a_folder_that_is_not_there_is_empty() {
        assert!(files(Path::new("no/such/folder")).unwrap().is_empty());
    }
}
