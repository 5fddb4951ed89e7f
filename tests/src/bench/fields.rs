//! Finite elements beside `emfield` on its own problems: `pipelines/bench/em`.
//!
//! Both get the scene of a case with lines along which fields are compared. What they find at the same places is
//! judged here by the exact solution; times are those of meshing or placing points, assembly and solution.

use std::path::{Path, PathBuf};
use std::process::Command;

use artefact::{Reader, Table};
use serde::Deserialize;
use serde_json::{Value, json};

use super::io;
use super::others::{Missing, Record, Row, Solved, output};
use super::record::load;
use crate::em::exact::{Entry, Known, lines};
use crate::em::frames::totals;
use crate::extreme::grid::merge;
use crate::lab::{Finished, Lab, LabError, read_json};
use crate::study::repeat::{Repeated, in_turns};

/// Where scripts and their list are.
const FOLDER: &str = "pipelines/bench/em";
/// Our tool.
const TOOL: &str = "emfield";

/// `pipelines/bench/em/em.json`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fields {
    problems: Vec<Problem>,
}

/// A problem that both solve.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Problem {
    name: String,
    title: String,
    /// The case of `pipelines/verify` whose scene it is.
    case: String,
    /// Merge patch with the lines.
    patch: Value,
    /// What is compared, and what its errors are.
    measures: Vec<[String; 2]>,
    /// Patches of ours by method.
    ours: Vec<Ours>,
    /// Their script.
    script: String,
    /// Order and size of their elements.
    theirs: Vec<[f64; 2]>,
}

/// One method of ours at its sizes.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Ours {
    method: String,
    patch: Value,
    spacings_m: Vec<f64>,
    /// First layer beside the surface over the spacing.
    #[serde(default)]
    first: Option<f64>,
}

/// A run, and its errors by measure.
struct Judged {
    row: Row,
    errors: Vec<f64>,
}

/// What someone found: fields along lines, totals.
struct Found {
    lines: Vec<(String, Vec<Vec<Entry>>)>,
    totals: Vec<(String, f64)>,
}

impl Fields {
    /// Reads the list of problems below the root of the repository.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn read(root: &Path) -> Result<Self, LabError> {
        let path = root.join(FOLDER).join("em.json");
        serde_json::from_value(read_json(&path)?).map_err(|e| wrong(&path, e.to_string()))
    }

    /// Has every problem solved by both. What fails is told in the record.
    #[must_use]
    pub fn solve(&self, lab: &Lab, python: &Path) -> Record {
        let mut missing = Vec::new();
        let mut problems = Vec::new();
        for problem in &self.problems {
            let judged = problem.solve(lab, python, &mut missing);
            for (k, [name, measure]) in problem.measures.iter().enumerate() {
                let row = |j: &Judged| Row {
                    error: j.errors[k],
                    ..j.row.clone()
                };
                problems.push(Solved {
                    name: format!("{}-{name}", problem.name),
                    title: format!("{}: {}", problem.title, name.replace('_', " ")),
                    measure: Some(measure.clone()),
                    rows: judged.iter().map(row).collect(),
                });
            }
        }
        let about = "Finite elements on the problems of emfield, judged at the same places by the exact solution. \
                     Theirs: meshing, assembly and solution; imports are not counted. Ours: a run without reading its \
                     scene and writing its files.";
        Record {
            kind: "others",
            version: "1.0",
            about: Some(about.to_owned()),
            load_average: load(),
            threads: lab.threads,
            problems,
            missing,
        }
    }
}

impl Problem {
    fn solve(&self, lab: &Lab, python: &Path, missing: &mut Vec<Missing>) -> Vec<Judged> {
        let mut all = Vec::new();
        let mut scene = None;
        let mut take = |what: String, found: Result<Judged, LabError>| {
            all.extend(Missing::or_found(missing, what, found));
        };
        for ours in &self.ours {
            for spacing in &ours.spacings_m {
                let what = format!("{}, {}, {spacing} m", self.name, ours.method);
                let run = self.run(lab, ours, *spacing);
                take(
                    what,
                    run.and_then(|run| {
                        scene.get_or_insert_with(|| run.scene.clone());
                        self.ours(lab, ours, *spacing, run)
                    }),
                );
            }
        }
        let Some(scene) = scene else {
            return all;
        };
        for [order, size] in &self.theirs {
            let what = format!("{}, elements of order {order} and size {size}", self.name);
            let found = self.theirs(lab, python, &scene, *order, *size);
            all.extend(Missing::or_found(missing, what, found));
        }
        all
    }

    fn run(&self, lab: &Lab, ours: &Ours, spacing: f64) -> Result<Finished, LabError> {
        let mut patch = self.patch.clone();
        merge(&mut patch, &ours.patch);
        merge(&mut patch, &json!({"points": {"spacing_m": spacing}}));
        if let Some(first) = ours.first {
            let first = first * spacing;
            merge(
                &mut patch,
                &json!({"points": {"layers": {"first_m": first}}}),
            );
        }
        let label = format!("{}-{:.0}nm", ours.method.replace(' ', "-"), 1e9 * spacing);
        lab.run(TOOL, &self.case, &label, &patch)
    }

    fn ours(&self, lab: &Lab, ours: &Ours, _: f64, run: Finished) -> Result<Judged, LabError> {
        let known = Known::of(&run.scene).map_err(|e| wrong(&run.artefact, e))?;
        let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
        let points = reader.frame("/points", 0)?.len() as u64;
        let mut found = Found {
            lines: Vec::new(),
            totals: Vec::new(),
        };
        let places = lines(&run.scene).map_err(|e| wrong(&run.artefact, e))?;
        for (name, places) in &places {
            let table = reader.table_at(&format!("/line/{name}"), 0)?;
            let rows = (0..places.len()).map(|n| row(&table, n)).collect();
            found.lines.push((name.clone(), rows));
        }
        let record = totals(&run)?;
        found.totals = record
            .values
            .iter()
            .map(|e| (e.name.clone(), e.value))
            .collect();
        let errors = self.judge(&run.scene, &known, &found, &run.artefact)?;
        let version = run.record["tool_version"].as_str().unwrap_or_default();
        let version = version.to_owned();
        let mut batch = [Repeated::first(vec![run])?];
        in_turns(lab, &mut batch)?;
        let spread = batch[0].solver();
        let row = Row {
            program: TOOL.to_owned(),
            version,
            method: ours.method.clone(),
            problem: self.name.clone(),
            points,
            run_time_s: spread.median,
            run_time_least_s: spread.least,
            run_time_greatest_s: spread.greatest,
            repeats: batch[0].count(),
            peak_memory_bytes: batch[0]
                .runs()
                .first()
                .and_then(Finished::peak_memory_bytes),
            error: f64::NAN,
        };
        Ok(Judged { row, errors })
    }

    fn theirs(
        &self,
        lab: &Lab,
        python: &Path,
        scene: &Value,
        order: f64,
        size: f64,
    ) -> Result<Judged, LabError> {
        let script = Path::new(FOLDER).join(&self.script);
        let file = lab.out.join(format!("{}.scene.json", self.name));
        std::fs::write(&file, scene.to_string()).map_err(io(&file))?;
        let mut command = Command::new(python);
        command.args(["-W", "ignore"]).arg(&script).arg(&file);
        command.args([order.to_string(), size.to_string(), lab.threads.to_string()]);
        let said = output(&mut command)?;
        // Programs may talk before they tell.
        let last = said.lines().rev().find(|line| line.starts_with('{'));
        let told: Value = serde_json::from_str(last.unwrap_or_default())
            .map_err(|e| wrong(&script, format!("it printed no JSON: {e}")))?;
        let known = Known::of(scene).map_err(|e| wrong(&script, e))?;
        let found = read(&told["values"]).ok_or_else(|| wrong(&script, "no values".to_owned()))?;
        let errors = self.judge(scene, &known, &found, &script)?;
        let mut row = told;
        row["problem"] = json!(self.name);
        row["error"] = json!(0.0);
        let row: Row = serde_json::from_value(row).map_err(|e| wrong(&script, e.to_string()))?;
        Ok(Judged { row, errors })
    }

    /// The errors of what was found, measure by measure.
    fn judge(
        &self,
        scene: &Value,
        known: &Known,
        found: &Found,
        path: &Path,
    ) -> Result<Vec<f64>, LabError> {
        let places = lines(scene).map_err(|e| wrong(path, e))?;
        let one = |[name, _]: &[String; 2]| match known.totals().iter().find(|t| t.0 == *name) {
            Some((_, _, wanted)) => {
                let total = found.totals.iter().find(|t| t.0 == *name);
                total.map(|t| (t.1 / wanted - 1.0).abs())
            }
            None => along(name, &places, known, found),
        };
        let all = self
            .measures
            .iter()
            .map(|m| one(m).ok_or_else(|| wrong(path, format!("no {} was found", m[0]))));
        all.collect()
    }
}

/// The greatest error of a quantity along all lines, over its greatest value there (a potential: over the greatest
/// difference from that in the middle).
fn along(
    stem: &str,
    places: &[(String, Vec<[f64; 3]>)],
    known: &Known,
    found: &Found,
) -> Option<f64> {
    let own = |entries: &[Entry]| -> Vec<(String, f64)> {
        let all = entries.iter().filter(|e| e.0.starts_with(stem));
        all.map(|e| (e.0.clone(), e.2)).collect()
    };
    let middle = own(&known.fields([0.0; 3]));
    let (mut worst, mut most) = (0.0_f64, 0.0_f64);
    for (name, places) in places {
        let rows = &found.lines.iter().find(|(n, _)| n == name)?.1;
        for (p, row) in places.iter().zip(rows) {
            if row.is_empty() {
                continue;
            }
            let wanted = own(&known.fields(*p));
            let (mut far, mut size) = (0.0, 0.0);
            for ((name, w), (_, m)) in wanted.iter().zip(&middle) {
                let value = row.iter().find(|e| e.0 == *name)?.2;
                far += (value - w).powi(2);
                let from = if stem == "potential" { *m } else { 0.0 };
                size += (w - from).powi(2);
            }
            // A value that is no number must not pass.
            worst = if far.is_nan() {
                f64::INFINITY
            } else {
                worst.max(far.sqrt())
            };
            most = most.max(size.sqrt());
        }
    }
    (most > 0.0).then(|| worst / most)
}

/// The fields of one place of a line of ours.
fn row(table: &Table, n: usize) -> Vec<Entry> {
    let all = table.columns.iter().filter(|c| !c.name.ends_with("_m"));
    all.map(|c| (c.name.clone(), "", c.values[n])).collect()
}

/// What a script told: `{"lines": {name: [{column: value}]}, "totals": {name: value}}`.
fn read(values: &Value) -> Option<Found> {
    let mut lines = Vec::new();
    for (name, rows) in values["lines"].as_object()? {
        let mut own = Vec::new();
        for row in rows.as_array()? {
            let entries = row.as_object()?.iter();
            let one = |(n, v): (&String, &Value)| Some((n.clone(), "", v.as_f64()?));
            own.push(entries.map(one).collect::<Option<Vec<Entry>>>()?);
        }
        lines.push((name.clone(), own));
    }
    let totals = values["totals"].as_object().into_iter().flatten();
    let total = |(n, v): (&String, &Value)| Some((n.clone(), v.as_f64()?));
    Some(Found {
        lines,
        totals: totals.map(total).collect::<Option<_>>()?,
    })
}

fn wrong(path: &Path, what: String) -> LabError {
    LabError::Content {
        path: PathBuf::from(path),
        what,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exact_fields_have_no_error_and_others_have_theirs() {
        let text = include_str!("../../../pipelines/dielectric-sphere/scene.json");
        let scene: Value = serde_json::from_str(text).unwrap();
        let known = Known::of(&scene).unwrap();
        let places = lines(&scene).unwrap();
        let found = |more: f64| Found {
            lines: places
                .iter()
                .map(|(n, all)| {
                    let row = |p: &[f64; 3]| -> Vec<Entry> {
                        let fields = known.fields(*p).into_iter();
                        fields.map(|(n, u, v)| (n, u, v + more)).collect()
                    };
                    (n.clone(), all.iter().map(row).collect())
                })
                .collect(),
            totals: Vec::new(),
        };
        assert!(along("potential", &places, &known, &found(0.0)).unwrap() < 1e-15);
        let shifted = along("potential", &places, &known, &found(1.0)).unwrap();
        // 2e-4 m along z: 5 MV/m times that, less the part of the dipole.
        assert!((shifted * 1e3 - 1.0).abs() < 0.02, "{shifted}");
        assert!(along("nothing", &places, &known, &found(0.0)).is_none());
    }

    #[test]
    fn all_problems_have_their_case_and_script() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        for problem in Fields::read(&root).unwrap().problems {
            let scene = root
                .join("pipelines/verify")
                .join(&problem.case)
                .join("scene.json");
            let mut scene = read_json(&scene).unwrap();
            merge(&mut scene, &problem.patch);
            let known = Known::of(&scene).unwrap();
            assert!(known.file(&scene).is_ok());
            assert!(root.join(FOLDER).join(&problem.script).is_file());
        }
    }
}
