//! `report validate`: a weld and arcs against published values, row by row.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use artefact::Reader;
use run::Failure;

use crate::certified::{Certificate, Ran};
use crate::files::print;
use crate::targets::{Row, Targets, Verdict, compare, with_bands};
use crate::weld::Weld;

/// Prints each row; the exit code is 1 where a tolerance is missed or cannot be judged.
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
    let targets = Targets::read(targets, &balances)?;
    let mut rows = compare(&targets, stretch.as_ref(), &balances);
    if let Some(path) = certificate {
        with_bands(&mut rows, &Certificate::read(path)?.bands(&ran));
    }
    let text = table(&rows);
    print(&text)?;
    let failed = |row: &Row| {
        let judged = row.target.tolerance.is_some();
        judged && row.verdict != Verdict::Holds
    };
    Ok(if rows.iter().any(failed) {
        ExitCode::from(1)
    } else {
        ExitCode::SUCCESS
    })
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
