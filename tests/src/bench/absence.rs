//! What physics costs that is absent: nothing. Each of `pipelines/bench/absent` is a scene without
//! it and a patch that adds it with no strength.
//!
//! Three runs take turns: the scene as it is (`without`), with the patch (`idle`), and with the patch
//! and a second one that removes again what the first added (`removed`). The first and the last must
//! write the same bytes, the first must name what it does without and have no stage and no part of
//! memory that the idle run has not, and neither its step nor its memory may be larger. All run on one
//! thread, which a busy machine disturbs least, and their least times are compared.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::io;
use super::record::{OUTSIDE, load};
use crate::extreme::grid::merge;
use crate::lab::{LabError, discard_unfinished, read_json};

/// How much more counts as more, as a factor: two runs of the same program on the same scene differ
/// by this much on a busy machine.
const NOISE: f64 = 1.05;

/// `pipelines/bench/absent/<name>.json`; paths count from the repository root.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Absence {
    /// Name of the file.
    #[serde(skip)]
    pub name: String,
    /// What is absent, as the run record calls it under `left_out`.
    pub physics: String,
    /// The tool that is timed.
    pub tool: String,
    /// The scene.
    pub scene: PathBuf,
    /// Merge patch that makes the scene short and takes the physics out where it has it.
    #[serde(default)]
    pub patch: Value,
    /// Merge patch that adds the physics with no strength.
    pub adds: Value,
    /// Files of the inputs by name.
    #[serde(default)]
    pub inputs: BTreeMap<String, PathBuf>,
}

/// One of the three runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Figure {
    name: &'static str,
    steps: u64,
    /// Median, least and greatest time per step \[ms\]; of a steady run, of all of it.
    step_ms: f64,
    step_least_ms: f64,
    step_greatest_ms: f64,
    peak_memory_bytes: u64,
    /// Memory of the columns and lists that the plan names.
    planned_memory_bytes: u64,
}

/// What is claimed and whether it is so.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Claim {
    what: String,
    holds: bool,
}

/// The record that `make bench` writes to `build/bench/absent-NAME.json`.
#[derive(Debug, Serialize)]
pub struct Record {
    kind: &'static str,
    version: &'static str,
    name: String,
    physics: String,
    tool: String,
    threads: usize,
    repeats: usize,
    load_average: Option<f64>,
    figures: Vec<Figure>,
    /// Idle over without, of least times.
    time_ratio: f64,
    memory_ratio: f64,
    claims: Vec<Claim>,
    holds: bool,
}

/// Reads all of a folder in the order of their names; none where there is no such folder.
///
/// # Errors
/// When a file cannot be read or does not describe a pair.
pub fn absences(folder: &Path) -> Result<Vec<Absence>, LabError> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let entries = std::fs::read_dir(folder).map_err(io(folder))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|e| e.ok().map(|e| e.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "json"));
    paths.sort();
    let read = |path: &PathBuf| {
        let value = read_json(path)?;
        let mut one: Absence = serde_json::from_value(value).map_err(|e| LabError::Content {
            path: path.clone(),
            what: e.to_string(),
        })?;
        one.name = path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        Ok(one)
    };
    paths.iter().map(read).collect()
}

/// Where pairs are run.
#[derive(Debug, Clone)]
pub struct Bench<'a> {
    /// Folder of the programs.
    pub programs: &'a Path,
    /// Folder of records and artefacts.
    pub out: &'a Path,
    /// Runs of each of the three, in turns.
    pub runs: usize,
}

/// The names of the three runs, and how many of the patches each takes.
const TURNS: [(&str, usize); 3] = [("without", 1), ("idle", 2), ("removed", 3)];

impl Bench<'_> {
    /// Times the scene without the physics, with it idle, and with it removed again.
    ///
    /// # Errors
    /// When a program cannot be started or fails, or a file cannot be read or written.
    pub fn time(&self, pair: &Absence) -> Result<Record, LabError> {
        let folder = self.out.join("absent").join(&pair.name);
        std::fs::create_dir_all(&folder).map_err(io(&folder))?;
        let mut scene = read_json(&pair.scene)?;
        merge(&mut scene, &pair.patch);
        let patches = [
            ("short", pair.patch.clone()),
            ("adds", pair.adds.clone()),
            ("removes", inverse(&scene, &pair.adds)),
        ];
        let mut files = Vec::new();
        for (name, patch) in patches {
            let path = folder.join(format!("{name}.patch.json"));
            let patch = if patch.is_null() {
                Value::Object(Map::new())
            } else {
                patch
            };
            std::fs::write(&path, patch.to_string()).map_err(io(&path))?;
            files.push(path);
        }
        let mut told: [Vec<Value>; 3] = Default::default();
        for _ in 0..self.runs.max(1) {
            for ((name, patches), told) in TURNS.iter().zip(&mut told) {
                told.push(self.run(
                    pair,
                    &folder.join(format!("{name}.mcap")),
                    &files[..*patches],
                )?);
            }
        }
        let bytes = |name: &str| {
            let path = folder.join(format!("{name}.mcap"));
            std::fs::read(&path).map_err(io(&path))
        };
        let same = bytes("without")? == bytes("removed")?;
        Ok(self.record(pair, &told, same))
    }

    fn run(&self, pair: &Absence, out: &Path, patches: &[PathBuf]) -> Result<Value, LabError> {
        discard_unfinished(out);
        let program = self.programs.join(&pair.tool);
        let mut command = Command::new(&program);
        command.arg("run").arg(&pair.scene);
        for patch in patches {
            command.arg("--patch").arg(patch);
        }
        for (name, path) in &pair.inputs {
            command
                .arg("--input")
                .arg(format!("{name}={}", path.display()));
        }
        command.arg("--out").arg(out);
        command.args(["--threads", "1", "--progress", "none"]);
        let output = command.output().map_err(io(&program))?;
        if !matches!(output.status.code(), Some(0 | 3)) {
            return Err(LabError::Tool {
                command: format!("{command:?}"),
                code: output.status.code(),
                stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
            });
        }
        read_json(&out.with_extension("run.json"))
    }

    fn record(&self, pair: &Absence, told: &[Vec<Value>; 3], same: bool) -> Record {
        let figures: Vec<Figure> = TURNS
            .iter()
            .zip(told)
            .map(|((name, _), t)| figure(name, t))
            .collect();
        let claims = claims(pair, told, &figures, same);
        let ratio = |of: fn(&Figure) -> f64| of(&figures[1]) / of(&figures[0]);
        Record {
            kind: "absence",
            version: "1.0",
            name: pair.name.clone(),
            physics: pair.physics.clone(),
            tool: pair.tool.clone(),
            threads: 1,
            repeats: self.runs.max(1),
            load_average: load(),
            time_ratio: ratio(|f| f.step_least_ms),
            memory_ratio: ratio(|f| f.peak_memory_bytes as f64),
            holds: claims.iter().all(|claim| claim.holds),
            claims,
            figures,
        }
    }
}

/// Median and ends of one of the three.
fn figure(name: &'static str, told: &[Value]) -> Figure {
    let steps = told.first().and_then(|r| r["steps"].as_u64()).unwrap_or(0);
    let mut times: Vec<f64> = told
        .iter()
        .map(|r| 1e3 * inside(r) / steps.max(1) as f64)
        .collect();
    times.sort_by(f64::total_cmp);
    let peak = told.iter().filter_map(|r| r["peak_memory_bytes"].as_u64());
    let planned = told.first().and_then(|r| r["memory"].as_array());
    let planned = planned.into_iter().flatten();
    Figure {
        name,
        steps,
        step_ms: times[times.len() / 2],
        step_least_ms: times[0],
        step_greatest_ms: times[times.len() - 1],
        peak_memory_bytes: peak.min().unwrap_or(0),
        planned_memory_bytes: planned.filter_map(|part| part["bytes"].as_u64()).sum(),
    }
}

/// Time of the stages that are steps \[s\].
fn inside(record: &Value) -> f64 {
    let stages = record["stages"].as_array().into_iter().flatten();
    let inside = stages.filter(|s| !OUTSIDE.contains(&s["name"].as_str().unwrap_or_default()));
    inside.filter_map(|stage| stage["wall_s"].as_f64()).sum()
}

fn names<'a>(record: &'a Value, list: &str) -> Vec<&'a str> {
    let parts = record[list].as_array().into_iter().flatten();
    parts.filter_map(|part| part["name"].as_str()).collect()
}

fn claims(pair: &Absence, told: &[Vec<Value>; 3], figures: &[Figure], same: bool) -> Vec<Claim> {
    let (without, idle) = (&told[0][0], &told[1][0]);
    let physics = pair.physics.replace('_', " ");
    let within = |list: &str| {
        let more = names(idle, list);
        names(without, list).iter().all(|name| more.contains(name))
    };
    let claim = |what: String, holds| Claim { what, holds };
    vec![
        claim(
            "a scene from which it was removed runs as one that never had it, to the byte"
                .to_owned(),
            same,
        ),
        claim(
            format!("the run without it says that it leaves out {physics}; the idle one does not"),
            names(without, "left_out").contains(&pair.physics.as_str())
                && !names(idle, "left_out").contains(&pair.physics.as_str()),
        ),
        claim(
            "the run without it has no stage and no part of memory that the idle one has not"
                .to_owned(),
            within("stages") && within("memory"),
        ),
        claim(
            format!("a step without it takes no longer than {NOISE} times an idle one"),
            figures[0].step_least_ms <= NOISE * figures[1].step_least_ms,
        ),
        claim(
            format!("a run without it needs no more memory than {NOISE} times an idle one"),
            figures[0].peak_memory_bytes as f64 <= NOISE * figures[1].peak_memory_bytes as f64,
        ),
    ]
}

/// The patch that takes back from `patched` what `patch` did to `scene`.
fn inverse(scene: &Value, patch: &Value) -> Value {
    let Value::Object(changes) = patch else {
        return scene.clone();
    };
    let mut back = Map::new();
    for (key, change) in changes {
        let value = match scene.get(key) {
            None => Value::Null,
            Some(old) if old.is_object() && change.is_object() => inverse(old, change),
            Some(old) => old.clone(),
        };
        back.insert(key.clone(), value);
    }
    Value::Object(back)
}

impl Record {
    /// The record as a table for people.
    #[must_use]
    pub fn table(&self) -> String {
        let mut text = format!("{}: {} of {}\n", self.name, self.physics, self.tool);
        for f in &self.figures {
            text += &format!(
                "  {:8} {:10.4} ms per step ({:.4} to {:.4}), peak {:.1} MB\n",
                f.name,
                f.step_ms,
                f.step_least_ms,
                f.step_greatest_ms,
                1e-6 * f.peak_memory_bytes as f64
            );
        }
        text += &format!(
            "  idle over without: time {:.3}, memory {:.3}\n",
            self.time_ratio, self.memory_ratio
        );
        for claim in &self.claims {
            let word = if claim.holds { "holds " } else { "FAILED" };
            text += &format!("  {word} {}\n", claim.what);
        }
        text
    }

    /// Whether all that is claimed is so.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.holds
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn an_inverse_patch_takes_everything_back() {
        let scene = json!({"a": {"b": 1}, "c": [1, 2], "g": 5});
        let patch = json!({"a": {"b": 2, "d": {"e": 3}}, "c": [0], "f": {"h": 1}, "g": null});
        let mut patched = scene.clone();
        merge(&mut patched, &patch);
        assert_eq!(
            patched,
            json!({"a": {"b": 2, "d": {"e": 3}}, "c": [0], "f": {"h": 1}})
        );
        merge(&mut patched, &inverse(&scene, &patch));
        assert_eq!(patched, scene);
    }

    fn told(stages: &[(&str, f64)], left_out: &[&str], peak: u64) -> Vec<Value> {
        let stages: Vec<Value> = stages
            .iter()
            .map(|(name, wall_s)| json!({"name": name, "wall_s": wall_s}))
            .collect();
        let left_out: Vec<Value> = left_out
            .iter()
            .map(|n| json!({"name": n, "why": ""}))
            .collect();
        vec![
            json!({"steps": 10, "stages": stages, "left_out": left_out, "peak_memory_bytes": peak,
            "memory": [{"name": "columns", "bytes": 50}]}),
        ]
    }

    #[test]
    fn absent_physics_that_costs_something_is_found() {
        let pair: Absence = serde_json::from_value(
            json!({"physics": "tension", "tool": "t", "scene": "s", "adds": {"tension": {}}}),
        )
        .unwrap();
        let judged = |without: Vec<Value>, same: bool| {
            let idle = told(&[("plan", 9.0), ("flow", 1.0), ("tension", 0.5)], &[], 80);
            let all = [without.clone(), idle, without];
            let figures: Vec<Figure> = all.iter().map(|t| figure("x", t)).collect();
            let found = claims(&pair, &all, &figures, same);
            found.iter().map(|claim| claim.holds).collect::<Vec<_>>()
        };
        let good = told(&[("plan", 1.0), ("flow", 1.0)], &["tension"], 60);
        assert_eq!(judged(good.clone(), true), [true; 5]);
        assert_eq!(judged(good, false), [false, true, true, true, true]);
        let loud = told(&[("flow", 1.0)], &["heat"], 60);
        assert_eq!(judged(loud, true), [true, false, true, true, true]);
        let hidden = told(&[("flow", 1.0), ("search", 0.1)], &["tension"], 60);
        assert_eq!(judged(hidden, true), [true, true, false, true, true]);
        let slow = told(&[("flow", 1.6)], &["tension"], 60);
        assert_eq!(judged(slow, true), [true, true, true, false, true]);
        let fat = told(&[("flow", 1.0)], &["tension"], 90);
        assert_eq!(judged(fat, true), [true, true, true, true, false]);
    }
}
