//! Stiff and extreme cases: a scene, a list of patches or a grid of two parameters, and how each run
//! may end.
//!
//! A run ends well when it is stable, when it is refused before it starts, when a step beyond its
//! limit is sub-stepped, or when divergence is detected and named. A value that is not a number in
//! an output, a crash, an end that the case does not expect, a conserved total that is not conserved
//! or a broken [`check`] is a failure.

pub mod check;
pub mod grid;
mod stand;
pub mod told;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use self::check::{Bounds, Monotone};
use self::grid::{Grid, Scales};
use self::stand::Stand;
use self::told::Told;
use crate::bell::Bell;
use crate::lab::{LabError, read_json};

/// `pipelines/stability/<case>.json`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
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
    /// What the values of every run are bounded by, unless a run tells its own.
    pub bounds: Option<Bounds>,
    /// How a column goes along an axis in every run, unless a run tells its own.
    pub monotone: Option<Monotone>,
    /// What every run must tell.
    #[serde(default)]
    pub told: Told,
    /// The runs.
    #[serde(default)]
    pub runs: Vec<Variant>,
    /// Runs over a grid of parameters.
    pub grid: Option<Grid>,
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
#[serde(deny_unknown_fields)]
pub struct Variant {
    /// Name of the run.
    pub name: String,
    /// Merge patch on the scene.
    pub patch: Value,
    /// Ends that are good.
    pub expect: Vec<Outcome>,
    /// What its values are bounded by.
    pub bounds: Option<Bounds>,
    /// How a column goes along an axis.
    pub monotone: Option<Monotone>,
    /// What it must tell besides.
    #[serde(default)]
    pub told: Told,
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
    /// Stopped and named step, place and quantity; or gave up an iteration, and named equation and
    /// place.
    DivergedDetected,
    /// A crash, an unnamed failure or a value that is not a number.
    Failed,
}

/// One row of the record.
#[derive(Debug, Serialize)]
pub struct Row {
    name: String,
    /// Column and row of the map.
    #[serde(skip_serializing_if = "Option::is_none")]
    at: Option<[usize; 2]>,
    parameters: Value,
    outcome: Outcome,
    expected: Vec<Outcome>,
    /// The step that the scene asks for \[s\]; none where nothing marches in time.
    step_s: Option<f64>,
    limits: Value,
    conservation: Value,
    message: String,
    /// What was not conserved, and checks that are broken.
    broken: Vec<String>,
    holds: bool,
}

/// The record that `make stability` writes.
#[derive(Debug, Serialize)]
pub struct Record {
    case: String,
    tool: String,
    /// The axes of the grid, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    map: Option<Scales>,
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

/// Runs every variant and every node of the grid of `case`.
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
    let mut runs = Vec::new();
    for variant in &case.runs {
        runs.push(stand.variant(case, variant)?);
    }
    if let Some(grid) = &case.grid {
        runs.extend(stand.grid(case, grid)?);
    }
    Ok(Record {
        case: case.case.clone(),
        tool: case.tool.clone(),
        map: case.grid.as_ref().map(Grid::scales),
        holds: !runs.is_empty() && runs.iter().all(|r| r.holds),
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

/// Names and values of a node.
fn readable(parameters: &Value) -> String {
    let parts = parameters.as_object().into_iter().flatten();
    let part =
        |(name, value): (&String, &Value)| format!("{name} {}", value.as_str().unwrap_or_default());
    parts.map(part).collect::<Vec<_>>().join(", ")
}

impl Record {
    /// The record as a table for people.
    #[must_use]
    pub fn table(&self) -> String {
        let mut text = format!("{} ({})\n", self.case, self.tool);
        for row in &self.runs {
            let word = if row.holds { "holds " } else { "FAILED" };
            let name = match row.at {
                Some(_) => readable(&row.parameters),
                None => row.name.clone(),
            };
            text += &format!("  {word} {name:<32} {:?}\n", row.outcome);
            for what in &row.broken {
                text += &format!("         {what}\n");
            }
            if !row.expected.contains(&row.outcome) {
                text += &format!(
                    "         expected {:?}; it said:\n{}\n",
                    row.expected, row.message
                );
            }
        }
        text
    }
}
