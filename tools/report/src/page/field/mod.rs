//! The page of a study of electric and magnetic fields.

mod cloud;
mod lines;
mod probes;
mod sections;
mod totals;
mod traction;

use artefact::Reader;
use run::Failure;

use super::{Named, lead, runs};
use crate::field::Points;
use crate::field::exact::Exact;
use crate::files::{FieldFiles, save};
use crate::html::Page;
use crate::records::RunRecord;

/// A run of the study.
struct Run {
    name: String,
    reader: Reader,
    points: Points,
    /// What is known of its solution.
    exact: Option<Exact>,
    record: Option<RunRecord>,
}

/// Writes the page.
pub(crate) fn write(files: &FieldFiles) -> Result<(), Failure> {
    let mut all = Vec::new();
    for (name, path) in &files.fields {
        let reader = Reader::open_sound(path, "point-fields", 1)?;
        let Some(points) = Points::last(&reader)? else {
            return Err(Failure::Other(format!("{}: no points", path.display())));
        };
        let exact = files.exact.iter().find(|(n, _)| n == name);
        all.push(Run {
            name: name.clone(),
            reader,
            points,
            exact: exact.map(|(_, path)| Exact::read(path)).transpose()?,
            record: RunRecord::beside(path),
        });
    }
    let named = |run: &Run| Some((run.name.clone(), run.record.clone()?));
    let records: Vec<Named> = all.iter().filter_map(named).collect();
    let mut page = Page::new(&files.study, &lead(&records));
    for run in &all {
        let title = |words: &str| match all.len() {
            1 => words.to_owned(),
            _ => format!("{words}: {}", run.name),
        };
        page.section(&title("What came out"), totals::section(run)?);
        page.section(&title("Fields in a section"), sections::section(run)?);
        page.section(&title("Fields along lines"), lines::section(run)?);
        page.section(&title("Traction"), traction::section(run)?);
        page.section(&title("Fields over time"), probes::section(run)?);
        page.section(&title("The points"), cloud::section(run)?);
    }
    page.section("How it was computed", runs::section(&records));
    save(&files.out, &page.render())
}
