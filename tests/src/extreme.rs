//! Stiff and extreme cases: a scene, a list of patches, and how each run may end.
//!
//! A run ends well when it is stable, when it is refused before it starts, when a step beyond its
//! limit is sub-stepped, or when divergence is detected and named. A value that is not a number in
//! an output, a crash, or an end that the case does not expect is a failure.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::bell::Bell;
use crate::lab::{LabError, discard_unfinished, read_json};

/// `pipelines/stability/<case>.json`.
#[derive(Debug, Clone, Deserialize)]
pub struct Extreme {
    /// Name of the case.
    pub case: String,
    /// The tool that is put to the test.
    pub tool: String,
    /// The scene that the patches vary.
    pub scene: PathBuf,
    /// Named inputs.
    #[serde(default)]
    pub inputs: BTreeMap<String, Source>,
    /// The runs.
    pub runs: Vec<Variant>,
}

/// Where an input comes from.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum Source {
    /// A file.
    File(PathBuf),
    /// An arc that is made on the spot.
    Made {
        /// Its width and peaks.
        bell: Bell,
    },
}

/// One run of a case.
#[derive(Debug, Clone, Deserialize)]
pub struct Variant {
    /// Name of the run.
    pub name: String,
    /// Merge patch on the scene.
    pub patch: Value,
    /// Ends that are good.
    pub expect: Vec<Outcome>,
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// Finished; every value is a number.
    Stable,
    /// The scene was refused before anything was computed.
    Refused,
    /// Finished with smaller steps than asked for.
    Substepped,
    /// Stopped and named step, place and quantity.
    DivergedDetected,
    /// A crash, an unnamed failure or a value that is not a number.
    Failed,
}

/// One row of the record.
#[derive(Debug, Serialize)]
pub struct Row {
    name: String,
    parameters: Value,
    outcome: Outcome,
    expected: Vec<Outcome>,
    /// The step that the scene asks for \[s\]; none where nothing marches in time.
    step_s: Option<f64>,
    limits: Value,
    conservation: Value,
    message: String,
    holds: bool,
}

/// The record that `make stability` writes.
#[derive(Debug, Serialize)]
pub struct Record {
    case: String,
    tool: String,
    runs: Vec<Row>,
    /// Whether every run ended as it may.
    pub holds: bool,
}

/// Reads the cases of a folder in the order of their names.
///
/// # Errors
/// When a file cannot be read or does not describe a case.
pub fn cases(folder: &Path) -> Result<Vec<Extreme>, LabError> {
    let entries = std::fs::read_dir(folder).map_err(|source| LabError::Io {
        path: folder.to_owned(),
        source,
    })?;
    let mut paths: Vec<PathBuf> = entries
        .filter_map(|e| e.ok().map(|e| e.path()))
        .filter(|p| p.extension().is_some_and(|e| e == "json"))
        .collect();
    paths.sort();
    paths
        .iter()
        .map(|path| {
            serde_json::from_value(read_json(path)?).map_err(|e| LabError::Content {
                path: path.clone(),
                what: e.to_string(),
            })
        })
        .collect()
}

/// Runs every variant of `case`.
///
/// # Errors
/// When a program cannot be started or a file not be written.
pub fn run(
    case: &Extreme,
    programs: &Path,
    out: &Path,
    threads: usize,
) -> Result<Record, LabError> {
    let folder = out.join(&case.case);
    std::fs::create_dir_all(&folder).map_err(|source| LabError::Io {
        path: folder.clone(),
        source,
    })?;
    let stand = Stand {
        inputs: inputs(case, &folder)?,
        programs,
        folder: &folder,
        threads,
    };
    let runs = case.runs.iter().map(|variant| stand.row(case, variant));
    let runs = runs.collect::<Result<Vec<_>, _>>()?;
    Ok(Record {
        case: case.case.clone(),
        tool: case.tool.clone(),
        holds: runs.iter().all(|r| r.holds),
        runs,
    })
}

/// The inputs as words of a command line; what is to be made is made.
fn inputs(case: &Extreme, folder: &Path) -> Result<Vec<String>, LabError> {
    let word = |(name, source): (&String, &Source)| {
        let path = match source {
            Source::File(path) => path.clone(),
            Source::Made { bell } => {
                let path = folder.join(format!("{name}.input.mcap"));
                bell.write(&path)?;
                path
            }
        };
        Ok(format!("{name}={}", path.display()))
    };
    case.inputs.iter().map(word).collect()
}

/// Where a case is run.
struct Stand<'a> {
    inputs: Vec<String>,
    programs: &'a Path,
    folder: &'a Path,
    threads: usize,
}

impl Stand<'_> {
    fn row(&self, case: &Extreme, variant: &Variant) -> Result<Row, LabError> {
        let patch = self.folder.join(format!("{}.patch.json", variant.name));
        let artefact = self.folder.join(format!("{}.mcap", variant.name));
        std::fs::write(&patch, variant.patch.to_string()).map_err(|source| LabError::Io {
            path: patch.clone(),
            source,
        })?;
        let record_path = artefact.with_extension("run.json");
        for old in [&artefact, &record_path] {
            // A leftover of an earlier run must not be taken for the result of this one.
            let _ = std::fs::remove_file(old);
        }
        discard_unfinished(&artefact);
        let mut command = Command::new(self.programs.join(&case.tool));
        command.arg("run").arg(&case.scene);
        command.arg("--patch").arg(&patch);
        command.arg("--out").arg(&artefact);
        for input in &self.inputs {
            command.arg("--input").arg(input);
        }
        command.args(["--threads", &self.threads.to_string(), "--progress", "none"]);
        let output = start(&mut command, &case.tool)?;
        let record = read_json(&record_path).unwrap_or(Value::Null);
        let message = String::from_utf8_lossy(&output.stderr);
        let outcome = match output.status.code() {
            Some(0 | 3) if !numbers_only(self.programs, &artefact)? => Outcome::Failed,
            Some(0 | 3) if record["substepped"].as_bool() == Some(true) => Outcome::Substepped,
            Some(0 | 3) => Outcome::Stable,
            Some(2) => Outcome::Refused,
            Some(1) if record["outcome"].as_str() == Some("diverged") => Outcome::DivergedDetected,
            _ => Outcome::Failed,
        };
        let lost = match outcome {
            Outcome::Stable | Outcome::Substepped => lost(&record["closing"]),
            _ => None,
        };
        let mut said: Vec<&str> = message.lines().rev().take(6).collect();
        said.reverse();
        said.extend(lost.as_deref());
        Ok(Row {
            name: variant.name.clone(),
            parameters: variant.patch.clone(),
            outcome,
            expected: variant.expect.clone(),
            step_s: record["scene"]["time"]["step_s"].as_f64(),
            limits: record["limits"].clone(),
            conservation: record["closing"].clone(),
            message: said.join("\n"),
            holds: variant.expect.contains(&outcome) && lost.is_none(),
        })
    }
}

/// What a run that finished may lose, as parts of the whole.
const CONSERVED: [(&str, f64); 2] = [("mass_error", 1e-12), ("energy_balance", 5e-3)];

/// A conserved total that was not conserved.
fn lost(closing: &Value) -> Option<String> {
    let totals = closing.as_array()?;
    CONSERVED.iter().find_map(|(name, most)| {
        let total = totals.iter().find(|total| total["name"] == *name)?;
        // null is a number that is not finite.
        let error = total["value"].as_f64().unwrap_or(f64::INFINITY);
        (error.abs() > *most).then(|| format!("{name} is {error:e}, at most {most:e}"))
    })
}

/// Whether `artefact validate` finds the file whole and free of values that are not numbers.
fn numbers_only(programs: &Path, artefact: &Path) -> Result<bool, LabError> {
    let mut command = Command::new(programs.join("artefact"));
    command.arg("validate").arg(artefact);
    Ok(start(&mut command, "artefact")?.status.success())
}

fn start(command: &mut Command, name: &str) -> Result<std::process::Output, LabError> {
    command.output().map_err(|source| LabError::Io {
        path: PathBuf::from(name),
        source,
    })
}

impl Record {
    /// The record as a table for people.
    #[must_use]
    pub fn table(&self) -> String {
        let mut text = format!("{} ({})\n", self.case, self.tool);
        for row in &self.runs {
            let word = if row.holds { "holds " } else { "FAILED" };
            text += &format!("  {word} {:<32} {:?}\n", row.name, row.outcome);
            if !row.holds {
                text += &format!(
                    "         expected {:?}; it said:\n{}\n",
                    row.expected, row.message
                );
            }
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn what_is_lost_is_told() {
        let closing = |mass: Value, energy: f64| {
            json!([{"name": "mass_error", "value": mass, "unit": "1"},
                   {"name": "energy_balance", "value": energy, "unit": "1"}])
        };
        assert_eq!(lost(&closing(json!(1e-15), 1e-4)), None);
        assert_eq!(lost(&json!([])), None);
        assert!(
            lost(&closing(json!(1e-11), 1e-4))
                .unwrap()
                .contains("mass_error")
        );
        assert!(
            lost(&closing(json!(0.0), -0.01))
                .unwrap()
                .contains("energy_balance")
        );
        assert!(lost(&closing(Value::Null, 0.0)).is_some());
    }
}
