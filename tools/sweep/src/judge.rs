//! When all has ended: what was made, the page, and what failed.

use std::path::Path;
use std::process::Command;

use run::Failure;
use serde_json::{Value, json};

use crate::files::keep;
use crate::here::status;
use crate::points::{Points, Run};
use crate::rules::PROGRAMS;

/// How a run ended.
#[derive(Debug, Clone, PartialEq, Eq)]
enum End {
    /// Its artefact is that of this sweep.
    Made,
    /// With the last of what it said.
    Failed(String),
    /// It was interrupted, or what it is made from was not made.
    NotMade,
}

/// A run is made when this sweep has looked at it (it has a log), it did not fail, and the key of what it is made from
/// stands beside it.
fn end(run: &Run) -> End {
    if let Ok(text) = std::fs::read_to_string(run.failed()) {
        let mut lines = text.lines().filter(|line| !line.trim().is_empty());
        let last = lines
            .next_back()
            .unwrap_or("it said nothing")
            .trim()
            .to_owned();
        return End::Failed(last);
    }
    let key = artefact::beside(&run.out, ".key");
    if run.log().is_file() && key.is_file() && run.out.is_file() {
        End::Made
    } else {
        End::NotMade
    }
}

/// What became of a point: nothing where it was made.
fn trouble(points: &Points, runs: &[usize]) -> Option<(String, String)> {
    let mut first = None;
    for run in runs.iter().map(|r| &points.runs[*r]) {
        let stage = points.sweep.stages[run.stage].name.clone();
        match end(run) {
            End::Made => {}
            End::Failed(words) => {
                let told = format!("{words} ({})", run.failed().display());
                return Some((stage, told));
            }
            End::NotMade => {
                let what = "was not run: it was interrupted, or what it needs is not there";
                first.get_or_insert((stage, what.to_owned()));
            }
        }
    }
    first
}

/// Writes the record and the page, and tells what failed; the number of points that failed.
///
/// # Errors
/// When no page can be made.
pub(crate) fn conclude(points: &Points) -> Result<usize, Failure> {
    let troubles: Vec<Option<(String, String)>> = points
        .points
        .iter()
        .map(|p| trouble(points, &p.runs))
        .collect();
    let record = points.out.join("points.json");
    keep(&record, &format!("{:#}\n", told(points, &troubles)))?;
    page(points, &record)?;
    let failed = troubles.iter().flatten().count();
    let mut say = String::new();
    for (point, trouble) in points.points.iter().zip(&troubles) {
        if let Some((stage, words)) = trouble {
            say += &format!("{}: {stage}: {words}\n", point.name);
        }
    }
    let made = points.points.len() - failed;
    say += &format!("sweep: {made} of {} points are made\n", points.points.len());
    tell(&say);
    Ok(failed)
}

#[allow(clippy::print_stderr, reason = "a program talks to its user")]
fn tell(words: &str) {
    eprint!("{}", artefact::shown(words));
}

/// The record that the page is made from.
fn told(points: &Points, troubles: &[Option<(String, String)>]) -> Value {
    let sweep = &points.sweep;
    let parameters = sweep.parameters.iter();
    let parameters = parameters.map(|p| json!({"name": p.name, "unit": p.unit}));
    let one = |(point, trouble): (&crate::points::Point, &Option<(String, String)>)| {
        let values = point.values.iter();
        let values = values.map(|v| json!({"name": v.name, "number": v.value.as_f64()}));
        let runs = point.runs.iter().map(|r| &points.runs[*r]);
        let made = runs.filter(|run| trouble.is_none() || end(run) == End::Made);
        let made = made.map(|run| {
            json!({"stage": sweep.stages[run.stage].name, "file": run.out.display().to_string()})
        });
        let failed = trouble
            .as_ref()
            .map(|(stage, what)| json!({"stage": stage, "what": what}));
        json!({
            "name": point.name,
            "values": values.collect::<Vec<_>>(),
            "made": made.collect::<Vec<_>>(),
            "failed": failed,
        })
    };
    json!({
        "kind": "sweep-points", "version": "1.0",
        "study": sweep.study, "title": sweep.title,
        "parameters": parameters.collect::<Vec<_>>(),
        "figures": sweep.figures,
        "whole": sweep.whole,
        "points": points.points.iter().zip(troubles).map(one).collect::<Vec<_>>(),
    })
}

/// The page, made again only if what it shows has changed; its table as CSV stands beside it.
fn page(points: &Points, record: &Path) -> Result<(), Failure> {
    let name = |ending: &str| points.out.with_added_extension(ending);
    let (page, table) = (name("html"), name("csv"));
    if !table.is_file() {
        let _ = std::fs::remove_file(artefact::beside(&page, ".key"));
    }
    let report = format!("{PROGRAMS}/report");
    let mut rerun = Command::new("pipelines/rerun");
    rerun.arg(&page).arg(record);
    for run in points.runs.iter().filter(|run| end(run) == End::Made) {
        rerun.arg(&run.out);
    }
    rerun.args([&report, "--", &report, "sweep", "--points"]);
    rerun.arg(record).arg("--out").arg(&page);
    match status(&mut rerun)? {
        true => Ok(()),
        false => Err(Failure::Other(format!("{} was not made", page.display()))),
    }
}
