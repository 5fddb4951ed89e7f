//! When all has ended: what was made, the page, and what failed.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

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

/// What the runs of a point warned of, as their records tell.
fn warnings(points: &Points, runs: &[usize]) -> Vec<String> {
    let of = |run: &Run| -> Vec<String> {
        let text = std::fs::read_to_string(run.out.with_extension("run.json"));
        let record: Value = serde_json::from_str(&text.unwrap_or_default()).unwrap_or_default();
        let all = record["warnings"].as_array().into_iter().flatten();
        let stage = &points.sweep.stages[run.stage].name;
        all.filter_map(Value::as_str)
            .map(|told| format!("{stage}: warning: {told}"))
            .collect()
    };
    let runs = runs.iter().map(|r| &points.runs[*r]);
    runs.filter(|run| end(run) == End::Made)
        .flat_map(of)
        .collect()
}

/// How a sweep ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Ended {
    /// Points that are not made.
    failed: usize,
    /// Points whose runs warned of something.
    doubtful: usize,
    /// Statements of the page on what is not comparable.
    unlike: usize,
}

impl Ended {
    /// A point that is not there is a failure; what is there with reservations ends as a run with warnings does.
    pub(crate) fn code(self) -> ExitCode {
        ExitCode::from(self.number())
    }

    fn number(self) -> u8 {
        match self {
            Self { failed: 1.., .. } => 1,
            Self {
                doubtful: 0,
                unlike: 0,
                ..
            } => 0,
            _ => 3,
        }
    }
}

/// What the page tells of points that are not comparable.
#[derive(Debug, serde::Deserialize)]
struct Unlike {
    told: Vec<String>,
}

/// The same as a file beside the page.
fn unlike_file(points: &Points) -> PathBuf {
    points.out.with_added_extension("told.json")
}

/// What the page told when it was made.
///
/// # Errors
/// When its file cannot be read.
fn unlike(points: &Points) -> Result<Vec<String>, Failure> {
    let path = unlike_file(points);
    if !path.is_file() {
        return Ok(Vec::new());
    }
    let unlike: Unlike = artefact::json_artefact(&path, "sweep-told", 1)?;
    Ok(unlike.told)
}

/// Writes the record and the page, and tells what failed, what runs warned of, and what is not comparable.
///
/// # Errors
/// When no page can be made.
pub(crate) fn conclude(points: &Points) -> Result<Ended, Failure> {
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
    let mut doubtful = 0;
    for (point, trouble) in points.points.iter().zip(&troubles) {
        let told = warnings(points, &point.runs);
        doubtful += usize::from(trouble.is_none() && !told.is_empty());
        for words in told {
            say += &format!("{}: {words}\n", point.name);
        }
    }
    let made = points.points.len() - failed;
    say += &format!("sweep: {made} of {} points are made\n", points.points.len());
    if doubtful > 0 {
        say += &format!("sweep: {doubtful} of them warned of something\n");
    }
    let unlike = unlike(points)?;
    for words in &unlike {
        say += &format!("sweep: not comparable: {words}\n");
    }
    tell(&say);
    Ok(Ended {
        failed,
        doubtful,
        unlike: unlike.len(),
    })
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

/// The page, made again only if what it shows has changed; its table as CSV stands beside it, and what it tells of points that
/// are not comparable.
fn page(points: &Points, record: &Path) -> Result<(), Failure> {
    let name = |ending: &str| points.out.with_added_extension(ending);
    let (page, table) = (name("html"), name("csv"));
    if !table.is_file() || !unlike_file(points).is_file() {
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]

    use super::*;
    use crate::points::tests::welds;

    #[test]
    fn points_that_are_not_there_are_a_failure_and_doubts_are_warnings() {
        let code = |failed, doubtful, unlike| {
            let ended = Ended {
                failed,
                doubtful,
                unlike,
            };
            ended.number()
        };
        assert_eq!((code(0, 0, 0), code(0, 1, 0), code(0, 0, 1)), (0, 3, 3));
        assert_eq!((code(1, 0, 0), code(1, 2, 3)), (1, 1));
    }

    #[test]
    fn what_the_runs_of_a_point_warned_of_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let mut points = welds();
        for run in &mut points.runs {
            run.out = folder.path().join(run.out.file_name().unwrap());
            for file in [
                run.out.clone(),
                run.log(),
                artefact::beside(&run.out, ".key"),
            ] {
                std::fs::write(file, "").unwrap();
            }
        }
        let record = folder.path().join("pool.run.json");
        std::fs::write(record, r#"{"warnings": ["the plate is molten through"]}"#).unwrap();
        let told = warnings(&points, &points.points[0].runs);
        assert_eq!(told, ["pool: warning: the plate is molten through"]);
        std::fs::remove_file(folder.path().join("pool.mcap")).unwrap();
        assert!(warnings(&points, &points.points[0].runs).is_empty());
    }
}
