//! Programs of other people beside `jetsph` on the clamped bar of `solid-bar`: `pipelines/bench/solid`.
//!
//! Each marches until its tip has come by again; what is compared is the first period, over that by finite elements, and
//! the time of the march alone, on one thread.

use std::path::Path;
use std::process::Command;

use serde::Deserialize;
use serde_json::{Value, json};

use super::others::{Missing, Record, Row, Solved, output};
use super::record::load;
use crate::lab::{Finished, Lab, LabError, read_json};
use crate::solid::{changed, fault, frames, swing};
use crate::study::repeat::{Repeated, in_turns};

/// Where scripts and their list are.
const FOLDER: &str = "pipelines/bench/solid";
/// Our tool.
const TOOL: &str = "jetsph";

/// `pipelines/bench/solid/solid.json`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Solids {
    /// The case of `pipelines/verify` whose scene it is.
    case: String,
    title: String,
    measure: String,
    /// Period by finite elements \[s\].
    period_s: f64,
    /// Rows through the thickness.
    ours: Vec<u32>,
    theirs: Vec<Theirs>,
}

/// A program and its rows.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Theirs {
    program: String,
    script: String,
    rows: Vec<u32>,
}

impl Solids {
    /// Reads the list below the root of the repository.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn read(root: &Path) -> Result<Self, LabError> {
        let path = root.join(FOLDER).join("solid.json");
        serde_json::from_value(read_json(&path)?).map_err(|e| wrong(&path, e.to_string()))
    }

    /// Has the bar swing by all programs. What fails is told in the record.
    #[must_use]
    pub fn solve(&self, lab: &Lab, python: Option<&Path>) -> Record {
        let (mut rows, mut missing) = (Vec::new(), Vec::new());
        let mut take = |what: String, found: Result<Row, LabError>| {
            rows.extend(Missing::or_found(&mut missing, what, found));
        };
        for of in &self.theirs {
            for count in &of.rows {
                let found = python.map_or_else(
                    || {
                        Err(wrong(
                            Path::new(FOLDER),
                            "cannot be installed here".to_owned(),
                        ))
                    },
                    |python| self.theirs(lab, python, of, *count),
                );
                take(format!("{}, {count} rows", of.program), found);
            }
        }
        for count in &self.ours {
            take(format!("{TOOL}, {count} rows"), self.ours(lab, *count));
        }
        let about = "A clamped bar swings by total Lagrangian particles until its tip has come by again. Theirs: steps alone; ours: a \
                     run without reading its scene and writing its files. One thread.";
        Record {
            kind: "others",
            version: "1.0",
            about: Some(about.to_owned()),
            load_average: load(),
            threads: lab.threads,
            problems: vec![Solved {
                name: self.case.clone(),
                title: self.title.clone(),
                measure: Some(self.measure.clone()),
                rows,
            }],
            missing,
        }
    }

    fn ours(&self, lab: &Lab, rows: u32) -> Result<Row, LabError> {
        let patch = changed(lab, &self.case, |solid| {
            let sides = &solid["body"]["box"];
            let at = |end: &str| sides[end][1].as_f64().unwrap_or(f64::NAN);
            solid["spacing_m"] = json!((at("max_m") - at("min_m")) / f64::from(rows));
        })?;
        let run = lab.run(TOOL, &self.case, &format!("{rows}-rows"), &patch)?;
        let name = run.scene["solids"][0]["name"].as_str().unwrap_or_default();
        let frames = frames(&run.artefact, name)?;
        let points = frames.first().map_or(0, artefact::Frame::len) as u64;
        let swing = swing(&frames)?.ok_or_else(|| fault(&run, "ends before the first period"))?;
        let version = run.record["tool_version"].as_str().unwrap_or_default();
        let version = version.to_owned();
        let mut batch = [Repeated::first(vec![run])?];
        in_turns(lab, &mut batch)?;
        let spread = batch[0].solver();
        let first = batch[0].runs().first();
        Ok(Row {
            program: TOOL.to_owned(),
            version,
            method: "total Lagrangian".to_owned(),
            problem: self.case.clone(),
            points,
            run_time_s: spread.median,
            run_time_least_s: spread.least,
            run_time_greatest_s: spread.greatest,
            repeats: batch[0].count(),
            peak_memory_bytes: first.and_then(Finished::peak_memory_bytes),
            error: (swing.period / self.period_s - 1.0).abs(),
        })
    }

    fn theirs(&self, lab: &Lab, python: &Path, of: &Theirs, rows: u32) -> Result<Row, LabError> {
        let script = Path::new(FOLDER).join(&of.script);
        let scene = Path::new("pipelines/verify").join(&self.case);
        let mut command = Command::new(python);
        // Its library of messages lies beside it.
        let library = python.parent().and_then(Path::parent);
        command.env(
            "LD_LIBRARY_PATH",
            library.map(|p| p.join("lib")).unwrap_or_default(),
        );
        command.env("OMP_NUM_THREADS", "1").current_dir(&lab.root);
        command.arg(&script).arg(scene.join("scene.json"));
        let said = output(command.arg(rows.to_string()))?;
        // Programs may talk before they tell.
        let last = said.lines().rev().find(|line| line.starts_with('{'));
        let mut told: Value = serde_json::from_str(last.unwrap_or_default())
            .map_err(|e| wrong(&script, format!("it printed no JSON: {e}")))?;
        let period = told["period_s"].as_f64();
        let period = period.ok_or_else(|| wrong(&script, "no period was found".to_owned()))?;
        if let Some(told) = told.as_object_mut() {
            told.remove("period_s");
        }
        told["problem"] = json!(self.case);
        told["error"] = json!((period / self.period_s - 1.0).abs());
        serde_json::from_value(told).map_err(|e| wrong(&script, e.to_string()))
    }
}

fn wrong(path: &Path, what: String) -> LabError {
    LabError::Content {
        path: path.to_owned(),
        what,
    }
}
