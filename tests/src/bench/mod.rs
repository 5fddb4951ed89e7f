//! Speed of whole scenes: each of `pipelines/bench` is run as a user runs it, and the figures come
//! from the run records.
//!
//! Thread numbers take turns, so that a machine which slows down slows all of them; a figure is the
//! median over the runs.

pub mod absence;
pub mod fields;
pub mod flow;
pub mod grains;
pub mod others;
mod record;
pub mod solids;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use artefact::Reader;
use serde::{Deserialize, Serialize};
use serde_json::Value;

pub use record::{Count, Record, Verdict};
use record::{Samples, verdict};

use crate::lab::{LabError, discard_unfinished, read_json};
use crate::speed::Row;

/// The row that tells how far the time of a run is off what `check` tells, and the greatest factor that it should be.
const CHECK: &str = "time off check";
const FORETOLD: f64 = 2.0;

/// `pipelines/bench/<name>/bench.json`; paths count from the repository root.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bench {
    /// Name of the folder.
    #[serde(skip)]
    pub name: String,
    /// The tool that is timed.
    pub tool: String,
    /// The scene.
    pub scene: PathBuf,
    /// Merge patches on the scene, in order.
    #[serde(default)]
    pub patches: Vec<PathBuf>,
    /// Inputs by name.
    #[serde(default)]
    pub inputs: BTreeMap<String, Source>,
    /// Whether one run on the greatest number of threads must do.
    #[serde(default)]
    pub once: bool,
    /// What the figures should be.
    #[serde(default)]
    pub aims: Vec<Aim>,
}

/// Where an input comes from.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// A file.
    File(PathBuf),
    /// The artefact of another bench, which is run first.
    Bench(String),
}

/// A figure and the most that it should be.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Aim {
    /// Name of the row.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Threads at which it is judged.
    pub threads: usize,
    /// The most.
    pub max: f64,
}

/// Reads all of a folder in the order of their names.
///
/// # Errors
/// When a file cannot be read or does not describe a bench.
pub fn benches(folder: &Path) -> Result<Vec<Bench>, LabError> {
    let entries = std::fs::read_dir(folder).map_err(io(folder))?;
    let mut folders: Vec<PathBuf> = entries
        .filter_map(|entry| entry.ok().map(|e| e.path()))
        .filter(|path| path.join("bench.json").is_file())
        .collect();
    folders.sort();
    folders.iter().map(|folder| read(folder)).collect()
}

fn read(folder: &Path) -> Result<Bench, LabError> {
    let path = folder.join("bench.json");
    let mut bench: Bench =
        serde_json::from_value(read_json(&path)?).map_err(|e| LabError::Content {
            path,
            what: e.to_string(),
        })?;
    let name = folder.file_name().unwrap_or_default();
    bench.name = name.to_string_lossy().into_owned();
    Ok(bench)
}

/// The benches that `wanted` names (all if it is empty) and those whose artefacts they need, each
/// after what it needs.
///
/// # Errors
/// When a name is not known, or benches need each other in a circle.
pub fn in_order(all: &[Bench], wanted: &[String]) -> Result<Vec<Bench>, LabError> {
    let mut done = Vec::new();
    let names = all.iter().map(|bench| bench.name.clone());
    let wanted: Vec<String> = match wanted {
        [] => names.collect(),
        some => some.to_vec(),
    };
    for name in &wanted {
        visit(all, name, &mut Vec::new(), &mut done)?;
    }
    Ok(done)
}

fn visit(
    all: &[Bench],
    name: &str,
    under_way: &mut Vec<String>,
    done: &mut Vec<Bench>,
) -> Result<(), LabError> {
    if done.iter().any(|bench| bench.name == name) {
        return Ok(());
    }
    let wrong = |what: String| LabError::Content {
        path: "pipelines/bench".into(),
        what,
    };
    if under_way.iter().any(|other| other == name) {
        return Err(wrong(format!("'{name}' needs its own artefact")));
    }
    let Some(bench) = all.iter().find(|bench| bench.name == name) else {
        let known: Vec<&str> = all.iter().map(|bench| bench.name.as_str()).collect();
        let known = known.join(", ");
        return Err(wrong(format!("no bench '{name}'; known are {known}")));
    };
    under_way.push(name.to_owned());
    for source in bench.inputs.values() {
        if let Source::Bench(needed) = source {
            visit(all, needed, under_way, done)?;
        }
    }
    under_way.pop();
    done.push(bench.clone());
    Ok(())
}

/// Where and how benches are run.
#[derive(Debug, Clone)]
pub struct Stand {
    /// Folder of the programs.
    pub programs: PathBuf,
    /// Folder of records and artefacts.
    pub out: PathBuf,
    /// Numbers of threads, rising.
    pub threads: Vec<usize>,
    /// Runs on the greatest number of threads; on each smaller one it is run once.
    pub runs: usize,
}

impl Stand {
    /// Times a bench. The artefacts of the benches that it needs must be there.
    ///
    /// # Errors
    /// When a program cannot be started or fails, or what it wrote cannot be read.
    pub fn time(&self, bench: &Bench) -> Result<Record, LabError> {
        let most = self.threads.last().copied().unwrap_or(1);
        let mut samples = Samples::default();
        let mut last = Value::Null;
        let turns = if bench.once { 1 } else { self.runs.max(1) };
        for turn in 0..turns {
            for &threads in &self.threads {
                if threads == most || (turn == 0 && !bench.once) {
                    last = self.run(bench, threads)?;
                    samples.add(threads, &last);
                }
            }
        }
        let mut rows = samples.rows();
        let mut aims = bench.aims.clone();
        if let Some(off) = self.off(bench, &last)? {
            rows.push(Row::of(CHECK, "x", most, vec![off]));
            aims.push(Aim {
                name: CHECK.to_owned(),
                unit: "x".to_owned(),
                threads: most,
                max: FORETOLD,
            });
        }
        let mut record = Record::of_rows(&bench.name, rows);
        record.tool = Some(bench.tool.clone());
        record.outcome = last["outcome"].as_str().map(str::to_owned);
        record.counts = counts(&self.artefact(&bench.name), &last)?;
        let verdicts = aims.iter().map(|aim| verdict(aim, &record.rows));
        record.aims = verdicts.collect();
        Ok(record)
    }

    /// The artefact of a bench.
    #[must_use]
    pub fn artefact(&self, bench: &str) -> PathBuf {
        self.out.join(bench).join("run.mcap")
    }

    /// By what factor the time of a run is off what `check` tells of its scene, whichever is longer; `None` where it tells none.
    fn off(&self, bench: &Bench, record: &Value) -> Result<Option<f64>, LabError> {
        let mut command = self.command(bench, "check");
        command.arg("--json");
        let plan: Value =
            serde_json::from_str(&said(&mut command)?).map_err(|e| LabError::Content {
                path: bench.scene.clone(),
                what: format!("its plan is no JSON: {e}"),
            })?;
        let times = plan["time_s"].as_f64().zip(record["wall_s"].as_f64());
        Ok(times.map(|(told, taken)| (told / taken).max(taken / told)))
    }

    /// A command of the tool on the scene with all that belongs to it.
    fn command(&self, bench: &Bench, action: &str) -> Command {
        let mut command = Command::new(self.programs.join(&bench.tool));
        command.arg(action).arg(&bench.scene);
        for patch in &bench.patches {
            command.arg("--patch").arg(patch);
        }
        for (name, source) in &bench.inputs {
            let path = match source {
                Source::File(path) => path.clone(),
                Source::Bench(other) => self.artefact(other),
            };
            let input = format!("{name}={}", path.display());
            command.arg("--input").arg(input);
        }
        command
    }

    /// Runs the scene once; its run record.
    fn run(&self, bench: &Bench, threads: usize) -> Result<Value, LabError> {
        let out = self.artefact(&bench.name);
        discard_unfinished(&out);
        let mut command = self.command(bench, "run");
        command.arg("--out").arg(&out);
        command.args(["--threads", &threads.to_string(), "--progress", "none"]);
        said(&mut command)?;
        read_json(&out.with_extension("run.json"))
    }
}

/// What a command that does its work prints.
fn said(command: &mut Command) -> Result<String, LabError> {
    let output = command
        .output()
        .map_err(io(Path::new(command.get_program())))?;
    // 3: finished, with warnings that matter; the record tells the outcome.
    if !matches!(output.status.code(), Some(0 | 3)) {
        return Err(LabError::Tool {
            command: format!("{command:?}"),
            code: output.status.code(),
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
        });
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// How large the problem was, from what was written.
fn counts(artefact: &Path, record: &Value) -> Result<Vec<Count>, LabError> {
    let reader = Reader::open(artefact)?;
    let mut counts = Vec::new();
    let mut count = |name: &str, number: u64| {
        counts.push(Count {
            name: name.to_owned(),
            number,
        });
    };
    count("steps", record["steps"].as_u64().unwrap_or(0));
    if let Some(last) = reader.count("/particles").checked_sub(1) {
        count("particles", reader.frame("/particles", last)?.len() as u64);
    }
    if let Some(last) = reader.count("/balance").checked_sub(1) {
        for (name, at) in [("liquid at the start", 0), ("liquid at the end", last)] {
            let balance = reader.record_at("/balance", at)?;
            if let Ok(liquid) = balance.get("liquid_particles") {
                count(name, liquid as u64);
            }
        }
    }
    if reader.has("/plasma") {
        count("cells", reader.table("/plasma")?.len() as u64);
    }
    Ok(counts)
}

fn io(path: &Path) -> impl Fn(std::io::Error) -> LabError + use<> {
    let path = path.to_owned();
    move |source| LabError::Io {
        path: path.clone(),
        source,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn bench(name: &str, needs: &[&str]) -> Bench {
        let inputs: BTreeMap<&str, Value> = needs
            .iter()
            .map(|needed| (*needed, json!({"bench": needed})))
            .collect();
        let mut bench: Bench =
            serde_json::from_value(json!({"tool": "x", "scene": "x.json", "inputs": inputs}))
                .unwrap();
        bench.name = name.to_owned();
        bench
    }

    #[test]
    fn what_is_needed_comes_first_and_once() {
        let all = [bench("a", &["c"]), bench("b", &["c"]), bench("c", &[])];
        let names = |wanted: &[&str]| {
            let wanted: Vec<String> = wanted.iter().map(|w| (*w).to_owned()).collect();
            let order = in_order(&all, &wanted).unwrap();
            order.iter().map(|b| b.name.clone()).collect::<Vec<_>>()
        };
        assert_eq!(names(&[]), ["c", "a", "b"]);
        assert_eq!(names(&["b"]), ["c", "b"]);
        assert!(in_order(&all, &["d".to_owned()]).is_err());
        let circle = [bench("a", &["b"]), bench("b", &["a"])];
        assert!(in_order(&circle, &[]).is_err());
    }
}
