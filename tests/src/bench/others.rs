//! Programs of other people on the problems of our cases: `pipelines/bench/others`.
//!
//! They run in a Python of their own, time themselves without their imports, and print their error;
//! ours is run as a user runs it, and its frame is judged by the same function as theirs.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::io;
use super::record::load;
use crate::extreme::grid::merge;
use crate::lab::{Finished, Lab, LabError, read_json};
use crate::study::repeat::{Repeated, in_turns};

/// Where the scripts are.
const FOLDER: &str = "pipelines/bench/others";

/// `pipelines/bench/others/others.json`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Others {
    /// Script and method of each program.
    programs: BTreeMap<String, [String; 2]>,
    /// Our tool.
    tool: String,
    /// Merge patches of our methods by name.
    methods: BTreeMap<String, Value>,
    problems: Vec<Problem>,
}

/// A problem that all solve.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Problem {
    /// Its name in the scripts.
    name: String,
    title: String,
    /// The case of `pipelines/verify` whose scene it is.
    case: String,
    /// Side of the square \[m\].
    side_m: f64,
    /// Merge patch on the scene.
    #[serde(default)]
    patch: Value,
    /// Points along a side.
    along: Vec<u32>,
    /// Who takes part.
    programs: Vec<String>,
    /// The most points along a side of a program that would take too long beyond.
    #[serde(default)]
    most: BTreeMap<String, u32>,
}

/// One program, one method, one size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    pub(super) program: String,
    pub(super) version: String,
    pub(super) method: String,
    pub(super) problem: String,
    pub(super) points: u64,
    pub(super) run_time_s: f64,
    pub(super) run_time_least_s: f64,
    pub(super) run_time_greatest_s: f64,
    pub(super) repeats: usize,
    pub(super) peak_memory_bytes: Option<u64>,
    /// Greatest error at the points, as a part of the range of the solution; or what the problem's measure says.
    pub(super) error: f64,
}

/// All who solved a problem.
#[derive(Debug, Serialize)]
pub(super) struct Solved {
    pub(super) name: String,
    pub(super) title: String,
    /// What the errors are, where they are not parts of the range of the solution.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) measure: Option<String>,
    pub(super) rows: Vec<Row>,
}

/// A run that gave no figure.
#[derive(Debug, Serialize)]
pub(super) struct Missing {
    pub(super) what: String,
    pub(super) why: String,
}

impl Missing {
    /// What was found; what was not is told in `all` by its name.
    pub(super) fn or_found<T>(
        all: &mut Vec<Self>,
        what: String,
        found: Result<T, LabError>,
    ) -> Option<T> {
        found
            .map_err(|e| {
                all.push(Self {
                    what,
                    why: e.to_string(),
                });
            })
            .ok()
    }
}

/// The record that `make bench-others` writes.
#[derive(Debug, Serialize)]
pub struct Record {
    pub(super) kind: &'static str,
    pub(super) version: &'static str,
    /// What was compared and how, where it is not as in `make bench-others`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) about: Option<String>,
    pub(super) load_average: Option<f64>,
    pub(super) threads: usize,
    pub(super) problems: Vec<Solved>,
    pub(super) missing: Vec<Missing>,
}

impl Others {
    /// Reads the list of programs and problems below the root of the repository.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn read(root: &Path) -> Result<Self, LabError> {
        let path = root.join(FOLDER).join("others.json");
        serde_json::from_value(read_json(&path)?).map_err(|e| LabError::Content {
            path,
            what: e.to_string(),
        })
    }

    /// Has every problem solved by all. What fails is told in the record.
    #[must_use]
    pub fn solve(&self, lab: &Lab, python: &Path) -> Record {
        let mut missing = Vec::new();
        let mut problems = Vec::new();
        for problem in &self.problems {
            let mut rows = Vec::new();
            for &along in &problem.along {
                let named = |what: &str| format!("{}, {along} x {along}: {what}", problem.name);
                let mut take = |what: String, found: Result<Vec<Row>, LabError>| {
                    let found = Missing::or_found(&mut missing, what, found);
                    rows.extend(found.into_iter().flatten());
                };
                take(named(&self.tool), self.ours(lab, python, problem, along));
                let fits = |p: &&String| problem.most.get(*p).is_none_or(|most| along <= *most);
                for program in problem.programs.iter().filter(fits) {
                    take(named(program), self.theirs(python, problem, program, along));
                }
            }
            problems.push(Solved {
                name: problem.name.clone(),
                title: problem.title.clone(),
                measure: None,
                rows,
            });
        }
        Record {
            kind: "others",
            version: "1.0",
            about: None,
            load_average: load(),
            threads: lab.threads,
            problems,
            missing,
        }
    }

    /// Files that are needed: scenes and scripts.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        let scene = |p: &Problem| {
            Path::new("pipelines/verify")
                .join(&p.case)
                .join("scene.json")
        };
        let scripts = self.programs.values();
        let scripts = scripts.map(|[script, _]| Path::new(FOLDER).join(script));
        self.problems.iter().map(scene).chain(scripts).collect()
    }

    fn theirs(
        &self,
        python: &Path,
        problem: &Problem,
        program: &str,
        along: u32,
    ) -> Result<Vec<Row>, LabError> {
        let [script, method] = self
            .programs
            .get(program)
            .ok_or_else(|| LabError::Content {
                path: FOLDER.into(),
                what: format!("no program '{program}'"),
            })?;
        let words = [&problem.name, &along.to_string(), method];
        let told = ask(python, script, &words.map(String::as_str))?;
        let row = serde_json::from_value(told).map_err(|e| LabError::Content {
            path: script.into(),
            what: e.to_string(),
        })?;
        Ok(vec![row])
    }

    fn ours(
        &self,
        lab: &Lab,
        python: &Path,
        problem: &Problem,
        along: u32,
    ) -> Result<Vec<Row>, LabError> {
        let mut batch = Vec::new();
        let mut judged = Vec::new();
        for (method, own) in &self.methods {
            let mut patch = problem.patch.clone();
            let spacing = problem.side_m / f64::from(along - 1);
            merge(&mut patch, &json!({"points": {"spacing_m": spacing}}));
            merge(&mut patch, own);
            let label = format!("{method}-{along}");
            let run = lab.run(&self.tool, &problem.case, &label, &patch)?;
            judged.push((method, judge(lab, python, problem, &run)?));
            batch.push(Repeated::first(vec![run])?);
        }
        in_turns(lab, &mut batch)?;
        let rows = judged.into_iter().zip(batch);
        let row = |((method, told), times): ((&String, Value), Repeated)| {
            let spread = times.solver();
            let run = times.runs().first();
            let version = run.and_then(|r| r.record["tool_version"].as_str());
            Row {
                program: self.tool.clone(),
                version: version.unwrap_or_default().to_owned(),
                method: method.clone(),
                problem: problem.name.clone(),
                points: told["points"].as_u64().unwrap_or(0),
                run_time_s: spread.median,
                run_time_least_s: spread.least,
                run_time_greatest_s: spread.greatest,
                repeats: times.count(),
                peak_memory_bytes: run.and_then(Finished::peak_memory_bytes),
                error: told["error"].as_f64().unwrap_or(f64::NAN),
            }
        };
        Ok(rows.map(row).collect())
    }
}

/// What the scripts say of the last frame of a run.
fn judge(lab: &Lab, python: &Path, problem: &Problem, run: &Finished) -> Result<Value, LabError> {
    let folder = run.artefact.with_extension("npz");
    let _ = std::fs::remove_dir_all(&folder);
    let mut command = Command::new(lab.programs.join("artefact"));
    command.arg("export").arg(&run.artefact);
    command
        .args(["--to", "npz", "--channel", "/points", "--out"])
        .arg(&folder);
    output(&mut command)?;
    let frames = folder.join("points");
    let entries = std::fs::read_dir(&frames).map_err(io(&frames))?;
    let all = entries.filter_map(|e| e.ok().map(|e| e.path()));
    let last = all.max().ok_or_else(|| LabError::Content {
        path: frames.clone(),
        what: "no frame".to_owned(),
    })?;
    let told = ask(
        python,
        "judge.py",
        &[&problem.name, &last.display().to_string()],
    );
    let _ = std::fs::remove_dir_all(&folder);
    told
}

/// The JSON that a script prints.
fn ask(python: &Path, script: &str, words: &[&str]) -> Result<Value, LabError> {
    let script: PathBuf = Path::new(FOLDER).join(script);
    let mut command = Command::new(python);
    command.args(["-W", "ignore"]).arg(&script).args(words);
    let said = output(&mut command)?;
    serde_json::from_str(said.trim()).map_err(|e| LabError::Content {
        path: script,
        what: format!("it printed no JSON: {e}"),
    })
}

pub(super) fn output(command: &mut Command) -> Result<String, LabError> {
    let program = PathBuf::from(command.get_program());
    let output = command.output().map_err(io(&program))?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    Err(LabError::Tool {
        command: format!("{command:?}"),
        code: output.status.code(),
        stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
    })
}

impl Record {
    /// The record as a table for people.
    #[must_use]
    pub fn table(&self) -> String {
        let mut text = String::new();
        for problem in &self.problems {
            text += &format!("{}: {}\n", problem.name, problem.title);
            for row in &problem.rows {
                text += &format!(
                    "  {:>8} points  {:12} {:16} {:>9.4} s x{}  error {:.2e}  peak {:.0} MB\n",
                    row.points,
                    row.program,
                    row.method,
                    row.run_time_s,
                    row.repeats,
                    row.error,
                    1e-6 * row.peak_memory_bytes.unwrap_or(0) as f64
                );
            }
        }
        for missing in &self.missing {
            text += &format!("  MISSING {}: {}\n", missing.what, missing.why);
        }
        text
    }

    /// Whether all programs gave all figures.
    #[must_use]
    pub fn whole(&self) -> bool {
        self.missing.is_empty()
    }
}
