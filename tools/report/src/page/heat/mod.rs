//! The page of a study of heat: bodies that conduct, side by side.

mod curves;
mod field;
mod surface;
pub(super) mod totals;

use artefact::Reader;
use run::Failure;

use super::{Named, certificate, errors, lead, probes, runs};
use crate::files::{HeatFiles, save};
use crate::heat::Points;
use crate::html::Page;
use crate::probes::cycles;
use crate::records::RunRecord;

/// A run of the study.
struct Run {
    name: String,
    reader: Reader,
    /// The last frame.
    points: Option<Points>,
}

/// Writes the page.
pub(crate) fn write(files: &HeatFiles) -> Result<(), Failure> {
    let mut all = Vec::new();
    let mut records: Vec<Named> = Vec::new();
    for (name, path) in &files.frames {
        let reader = Reader::open_sound(path, "point-fields", 1)?;
        all.push(Run {
            name: name.clone(),
            points: Points::last(&reader)?,
            reader,
        });
        if let Some(record) = RunRecord::beside(path) {
            records.push((name.clone(), record));
        }
    }
    let mut page = Page::new(&files.study, &lead(&records));
    page.section(
        "The temperature at the end",
        field::section(&all, &records)?,
    );
    let mut body = curves::section(&all)?;
    for run in &all {
        let cycles = cycles(&run.reader)?;
        // Peaks and cooling times are those of a weld.
        if run.reader.header().scene.get("torches").is_some() && !cycles.is_empty() {
            body += &run.heading(&all);
            body += &probes::table(&cycles);
        }
    }
    page.section("Temperatures over time", body);
    page.section("Heat through the surface", surface::section(&all)?);
    let body = surface::balance(&all)? + &totals::table(&records);
    page.section("The balance of heat", body);
    let certificate = certificate(files.certificate.as_deref())?;
    page.section("Numerical error", errors(certificate.as_ref(), &records));
    page.section("How it was computed", runs::section(&records));
    save(&files.out, &page.render())
}

impl Run {
    /// Whether it has no time.
    fn steady(&self) -> bool {
        self.reader.header().scene.get("steady").is_some()
    }

    /// A heading where there is more than one run.
    fn heading(&self, runs: &[Self]) -> String {
        if runs.len() < 2 {
            return String::new();
        }
        format!("<h3>{}</h3>\n", crate::html::escape(&self.name))
    }

    /// The name of something in this run: with that of the run where there is more than one.
    fn own(&self, runs: &[Self], name: &str) -> String {
        match (runs.len(), name) {
            (0 | 1, _) => name.to_owned(),
            (_, "") => self.name.clone(),
            _ => format!("{}: {name}", self.name),
        }
    }
}
