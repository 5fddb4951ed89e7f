//! The page of a study of jets: films of the runs, the cut, forces and energies over time.

mod curves;
mod film;
mod run;

use std::path::Path;

use ::run::Failure;

use super::{Named, certificate, errors, lead, runs};
use crate::draw::canvas::Canvas;
use crate::files::{JetFiles, save};
use crate::html::Page;
use crate::page::heat::totals;
use crate::records::RunRecord;

use self::run::Run;

/// The last picture of a run; nothing without frames.
pub(super) fn last(name: &str, path: &Path) -> Result<Option<Canvas>, Failure> {
    let run = Run::open(name, path)?;
    match run.frames() {
        0 => Ok(None),
        n => film::one(&run, n - 1).map(Some),
    }
}

/// Writes the page.
pub(crate) fn write(files: &JetFiles) -> Result<(), Failure> {
    let mut all = Vec::new();
    let mut records: Vec<Named> = Vec::new();
    for (name, path) in &files.frames {
        all.push(Run::open(name, path)?);
        if let Some(record) = RunRecord::beside(path) {
            records.push((name.clone(), record));
        }
    }
    let mut page = Page::new(&files.study, &lead(&records));
    page.section("What happens", film::section(&all)?);
    page.section("The cut over time", curves::cut(&all)?);
    page.section("Forces over time", curves::forces(&all)?);
    page.section("Energies over time", curves::energies(&all)?);
    page.section("The balance", totals::table(&records));
    let certificate = certificate(files.certificate.as_deref())?;
    page.section("Numerical error", errors(certificate.as_ref(), &records));
    page.section("How it was computed", runs::section(&records));
    save(&files.out, &page.render())
}
