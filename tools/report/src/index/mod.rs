//! The page of all evidence: exact cases, extreme cases, speed, studies.

mod bench;
mod stability;
mod verify;

use std::path::{Path, PathBuf};

use run::Failure;
use serde::de::DeserializeOwned;

use crate::command::{Folders, save};
use crate::html::{Page, escape, note, paragraph};

/// Writes the page.
pub(crate) fn write(folders: &Folders) -> Result<(), Failure> {
    let lead = "Evidence that the programs solve their equations: error against run time for cases with exact \
                solutions, how extreme cases end, how fast it is, and the studies themselves.";
    let mut page = Page::new("Fusionline: evidence", &paragraph(lead));
    if let Some(folder) = &folders.studies {
        page.section("Studies", studies(folder, &folders.out)?);
    }
    if let Some(folder) = &folders.verify {
        page.section(
            "Exact cases",
            all(folder, verify::summary, verify::section)?,
        );
    }
    if let Some(folder) = &folders.stability {
        page.section(
            "Extreme cases",
            all(folder, stability::summary, stability::section)?,
        );
    }
    if let Some(folder) = &folders.bench {
        page.section(
            "Speed",
            all(folder, |_: &[bench::Bench]| String::new(), bench::section)?,
        );
    }
    save(&folders.out, &page.render())
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
        let text = std::fs::read_to_string(&path).map_err(|source| Failure::Io {
            path: path.clone(),
            action: "read",
            source,
        })?;
        match serde_json::from_str::<T>(&text) {
            Ok(record) => records.push(record),
            Err(e) => {
                notes += &note(&format!(
                    "{} is not a record that can be shown: {e}",
                    path.display()
                ))
            }
        }
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

/// Links to the pages of studies.
fn studies(folder: &Path, out: &Path) -> Result<String, Failure> {
    let mut found: Vec<PathBuf> = entries(folder)?
        .into_iter()
        .map(|p| p.join("report.html"))
        .filter(|p| p.is_file())
        .collect();
    found.sort();
    let from = out.parent().unwrap_or(Path::new("."));
    let mut links = String::new();
    for path in &found {
        let name = path
            .parent()
            .and_then(Path::file_name)
            .unwrap_or_default()
            .to_string_lossy();
        let target = relative(from, path);
        links += &format!(
            "<li><a href=\"{}\">{}</a></li>\n",
            escape(&target),
            escape(&name)
        );
    }
    if links.is_empty() {
        return Ok(paragraph("Nothing here yet."));
    }
    Ok(format!("<ul>\n{links}</ul>\n"))
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
    let word = if holds { words.0 } else { words.1 };
    format!(
        "<h3 id=\"{0}\">{0} {1}</h3>\n",
        escape(name),
        crate::html::verdict(word, Some(holds))
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
