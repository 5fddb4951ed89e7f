//! `report validate`: a weld and arcs against published values, row by row.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use artefact::Reader;
use run::Failure;

use crate::certified::{Certificate, Ran};
use crate::files::{print, warn};
use crate::targets::{Row, Targets, Verdict, compare, with_bands};
use crate::weld::Weld;

/// Prints each row; the exit code is 1 where a tolerance is missed or cannot be judged, 3 where nothing is judged or bands are missing.
pub(crate) fn run(
    pool: Option<&Path>,
    arcs: &[(String, PathBuf)],
    targets: &Path,
    certificate: Option<&Path>,
) -> Result<ExitCode, Failure> {
    let mut ran: Vec<Ran> = Vec::new();
    let stretch = match pool {
        Some(pool) => {
            let reader = Reader::open_sound(pool, "particle-frames", 1)?;
            ran.push(("pool".to_owned(), reader.header().scene_sha256()));
            Weld::last(&reader)?.and_then(|weld| weld.bead())
        }
        None => None,
    };
    let mut balances = Vec::new();
    for (name, path) in arcs {
        let reader = Reader::open_sound(path, "arc-source", 1)?;
        ran.push((name.clone(), reader.header().scene_sha256()));
        balances.push((name.clone(), reader.record("/balance")?));
    }
    let place = targets;
    let targets = Targets::read(targets, &balances)?;
    let mut rows = compare(&targets, stretch.as_ref(), &balances);
    let certificate = certificate.map(Certificate::read).transpose()?;
    if let Some(certificate) = &certificate {
        with_bands(&mut rows, &certificate.bands(&ran));
    }
    let text = table(&rows);
    print(&text)?;
    let failed = |row: &Row| {
        let judged = row.target.tolerance.is_some();
        judged && row.verdict != Verdict::Holds
    };
    let doubts = doubts(&rows, certificate.as_ref());
    for doubt in &doubts {
        warn(place, doubt)?;
    }
    Ok(match (rows.iter().any(failed), doubts.is_empty()) {
        (true, _) => ExitCode::from(1),
        (false, true) => ExitCode::SUCCESS,
        (false, false) => ExitCode::from(3),
    })
}

/// What verdicts are worth less for: no band where the study has one, or that there are none.
fn doubts(rows: &[Row], certificate: Option<&Certificate>) -> Vec<String> {
    let mut doubts = Vec::new();
    let judged = || rows.iter().filter(|row| row.target.tolerance.is_some());
    if judged().count() == 0 {
        doubts.push("nothing is judged: no target has a tolerance".to_owned());
    }
    if let Some(certificate) = certificate {
        let bare =
            judged().filter(|row| row.band.is_none() && certificate.tells(&row.target.measure));
        let names: Vec<&str> = bare.map(|row| row.target.measure.as_str()).collect();
        if !names.is_empty() {
            doubts.push(format!(
                "verdicts without their numerical bands, which were found with other scenes: {}. \
                 `make certify STUDY={}` finds them anew",
                names.join(", "),
                certificate.study()
            ));
        }
    }
    doubts
}

/// The rows for people, in columns of fixed width.
fn table(rows: &[Row]) -> String {
    let titles = rows.iter().map(|r| r.target.title.chars().count());
    let wide = titles.chain([7]).max().unwrap_or(7).min(60);
    let mut text = format!(
        "{:<wide$}  {:<11} {:>9} {:>9} {:>9} {:>10}  {:<16} verdict\n",
        "measure", "kind", "published", "found", "band", "difference", "tolerance"
    );
    for row in rows {
        let unit = row.unit();
        let found = row
            .measured
            .map_or_else(|| "-".to_owned(), |m| format!("{} {unit}", row.shown(m)));
        let band = (row.band).map_or_else(
            || "-".to_owned(),
            |half| format!("{} {unit}", row.fine(half)),
        );
        text += &format!(
            "{:<wide$}  {:<11} {:>9} {:>9} {:>9} {:>10}  {:<16} {}\n",
            row.target.title,
            row.target.kind.word(),
            format!("{} {unit}", row.shown(row.target.value)),
            found,
            band,
            row.difference(),
            row.tolerance(),
            row.words().0
        );
    }
    text
}
