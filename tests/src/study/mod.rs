//! A convergence study: methods over the levels of a case, the observed orders, and whether the
//! targets hold.

pub(crate) mod repeat;
mod verdict;

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;
use serde_json::Value;

use crate::case::{Case, Costs, Errors, Measurement};
use crate::lab::{Lab, LabError};
use crate::norms::observed_order;
use repeat::{Repeated, in_turns};
pub use verdict::Verdict;
use verdict::verdicts;

/// One resolution in the record: time and errors of the same runs.
#[derive(Debug, Clone, Serialize)]
pub struct Level {
    level: u32,
    points: u64,
    spacing_m: f64,
    steps: u64,
    /// Median of the solver's time; least and greatest tell how far it can be trusted.
    run_time_s: f64,
    run_time_least_s: f64,
    run_time_greatest_s: f64,
    /// Median from the start of the process to its end.
    process_s: f64,
    repeats: usize,
    peak_memory_bytes: Option<u64>,
    threads: usize,
    errors: Errors,
    #[serde(skip_serializing_if = "Costs::is_empty")]
    costs: Costs,
}

/// One method over its resolutions.
#[derive(Debug, Clone, Serialize)]
pub struct Series {
    method: String,
    levels: Vec<Level>,
    order: BTreeMap<String, Option<f64>>,
    /// Why the patch of the user's leaves nothing to measure: the method has another body than the patch names, say.
    #[serde(skip_serializing_if = "Option::is_none")]
    refused: Option<String>,
    /// What levels or the method set and the user's patch holds fast, so that orders may mean nothing.
    #[serde(skip_serializing_if = "BTreeSet::is_empty")]
    held: BTreeSet<String>,
    /// What the finest level spent its time on, what it held, and what it did without, as its run
    /// record tells.
    stages: Value,
    memory: Value,
    left_out: Value,
}

/// The record that `make verify` writes. The first method stands at the top, as if it were alone.
#[derive(Debug, Serialize)]
pub struct Study {
    case: String,
    tool: String,
    reference: String,
    #[serde(flatten)]
    first: Series,
    targets: BTreeMap<String, Verdict>,
    /// Whether no target is missed.
    pub holds: bool,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    series: Vec<Series>,
}

/// Levels that are asked for, each once, the finest last.
fn rising(asked: &[u32]) -> Vec<u32> {
    asked
        .iter()
        .copied()
        .collect::<BTreeSet<_>>()
        .into_iter()
        .collect()
}

/// Runs `case` at `levels` with each of its methods, which take turns at every level.
///
/// Where a patch of the user's does not fit a method, the others go on and the record tells why. What a run has found is given to
/// `tell` as soon as it is known, for a study that is cut off.
///
/// # Errors
/// When a run fails, its artefact cannot be read, or a repeat of it writes other bytes; when no method is left.
pub fn study(
    case: &dyn Case,
    lab: &Lab,
    levels: &[u32],
    mut tell: impl FnMut(&str),
) -> Result<Study, LabError> {
    let levels = &rising(levels);
    let methods = case.methods();
    let mut all: Vec<Vec<Taken>> = methods.iter().map(|_| Vec::new()).collect();
    let mut refused: Vec<Option<LabError>> = methods.iter().map(|_| None).collect();
    for &level in levels {
        let mut batch = Vec::new();
        let mut found = Vec::new();
        for (m, method) in methods.iter().enumerate() {
            if refused[m].is_some() || !case.levels(method, levels).contains(&level) {
                continue;
            }
            match case.measure(lab, level, method) {
                Ok(measured) => {
                    tell(&line(&measured, method, level));
                    batch.push(Repeated::first(measured.runs.clone())?);
                    found.push((m, measured));
                }
                Err(error) if lab.patch.is_some() && error.is_of_the_scene() => {
                    refused[m] = Some(error);
                }
                Err(error) => return Err(error),
            }
        }
        in_turns(lab, &mut batch)?;
        for ((m, measured), times) in found.into_iter().zip(batch) {
            all[m].push(Taken {
                level,
                measured,
                times,
            });
        }
    }
    if all.iter().all(Vec::is_empty)
        && let Some(error) = refused.iter_mut().find_map(Option::take)
    {
        return Err(error);
    }
    let all = methods.iter().zip(all).zip(refused);
    let mut all: Vec<Series> = all
        .map(|((m, taken), refused)| Series {
            refused: refused.map(|error| error.to_string()),
            ..series(m, taken, lab)
        })
        .collect();
    let targets = verdicts(&case.targets(), &all, levels);
    let competing = all.split_off(1);
    let Some(first) = all.pop() else {
        unreachable!("a case names at least one method");
    };
    Ok(Study {
        case: case.name().to_owned(),
        tool: case.tool().to_owned(),
        reference: case.reference().to_owned(),
        holds: targets.values().all(|v| v.holds != Some(false)),
        targets,
        first,
        series: competing,
    })
}

/// What a measurement has found, in one line.
fn line(measured: &Measurement, method: &str, level: u32) -> String {
    let mut text = format!("  {method} level {level}: {} points ", measured.points);
    for (quantity, error) in measured.errors.iter().chain(&measured.costs) {
        text += &format!(" {quantity} {error:.3e}");
    }
    text
}

/// A level of a method with its repeats.
struct Taken {
    level: u32,
    measured: Measurement,
    times: Repeated,
}

fn series(method: &str, taken: Vec<Taken>, lab: &Lab) -> Series {
    let spacing: Vec<f64> = taken.iter().map(|t| t.measured.spacing_m).collect();
    let first = taken.first().map(|t| t.measured.errors.keys());
    let order = first.into_iter().flatten().map(|quantity| {
        let error = taken.iter().map(|t| t.measured.errors.get(quantity));
        let error: Vec<f64> = error.map(|e| e.copied().unwrap_or(f64::NAN)).collect();
        (quantity.clone(), observed_order(&spacing, &error))
    });
    let order = order.collect();
    let finest = taken.last().and_then(|t| t.times.runs().last());
    let runs = taken.iter().flat_map(|t| &t.measured.runs);
    let held = runs.flat_map(|run| run.held.iter().cloned()).collect();
    let told = |key: &str| finest.map_or(Value::Null, |run| run.record[key].clone());
    Series {
        method: method.to_owned(),
        order,
        refused: None,
        held,
        stages: told("stages"),
        memory: told("memory"),
        left_out: told("left_out"),
        levels: taken.into_iter().map(|t| level(t, lab.threads)).collect(),
    }
}

fn level(taken: Taken, threads: usize) -> Level {
    let Taken {
        level,
        measured,
        times,
    } = taken;
    let solver = times.solver();
    Level {
        level,
        points: measured.points,
        spacing_m: measured.spacing_m,
        steps: times.runs().iter().map(|run| run.steps()).sum(),
        run_time_s: solver.median,
        run_time_least_s: solver.least,
        run_time_greatest_s: solver.greatest,
        process_s: times.process().median,
        repeats: times.count(),
        peak_memory_bytes: times
            .runs()
            .iter()
            .filter_map(|run| run.peak_memory_bytes())
            .max(),
        threads,
        errors: measured.errors,
        costs: measured.costs,
    }
}

impl Study {
    /// The study as a table for people: points, run time, errors, orders, targets.
    #[must_use]
    pub fn table(&self) -> String {
        let mut text = format!("{}: {}\n", self.case, self.reference);
        for series in std::iter::once(&self.first).chain(&self.series) {
            if !self.series.is_empty() {
                text += &format!(" {}\n", series.method);
            }
            text += &series.table();
        }
        for (name, verdict) in &self.targets {
            text += &verdict.line(name);
        }
        text
    }
}

impl Series {
    fn table(&self) -> String {
        let mut text = String::new();
        if let Some(why) = &self.refused {
            let last = why.trim_end().lines().last().unwrap_or_default();
            text += &format!("  the patch does not fit: {last}\n");
        }
        for held in &self.held {
            text += &format!("  the patch holds {held}, which the case sets by level or method\n");
        }
        for level in &self.levels {
            text += &format!(
                "  {:>9} points {:>9.4} s x{} ",
                level.points, level.run_time_s, level.repeats
            );
            for (quantity, error) in level.errors.iter().chain(&level.costs) {
                text += &format!("  {quantity} {error:.3e}");
            }
            text.push('\n');
        }
        for (quantity, order) in &self.order {
            let shown = order.map_or_else(|| "-".to_owned(), |o| format!("{o:.2}"));
            text += &format!("  order of {quantity}: {shown}\n");
        }
        text
    }
}
