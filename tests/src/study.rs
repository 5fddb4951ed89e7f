//! A convergence study: the levels of a case, the observed orders, and whether the targets hold.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError};
use crate::norms::observed_order;

/// One resolution in the record.
#[derive(Debug, Serialize)]
pub struct Level {
    points: u64,
    spacing_m: f64,
    steps: u64,
    run_time_s: f64,
    threads: usize,
    errors: Errors,
}

/// One method over all resolutions.
#[derive(Debug, Serialize)]
pub struct Series {
    method: String,
    levels: Vec<Level>,
    order: BTreeMap<String, Option<f64>>,
}

/// A target with what was found.
#[derive(Debug, Serialize)]
pub struct Verdict {
    #[serde(skip_serializing_if = "Option::is_none")]
    at_points: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    max: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    min: Option<f64>,
    found: Option<f64>,
    holds: bool,
}

/// The record that `make verify` writes.
#[derive(Debug, Serialize)]
pub struct Study {
    case: String,
    tool: String,
    reference: String,
    levels: Vec<Level>,
    order: BTreeMap<String, Option<f64>>,
    targets: BTreeMap<String, Verdict>,
    /// Whether every target is met.
    pub holds: bool,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    series: Vec<Series>,
}

/// Runs `case` at `levels` with each of its methods. The first method is judged by the targets.
///
/// # Errors
/// When a run fails or its artefact cannot be read.
pub fn study(case: &dyn Case, lab: &Lab, levels: &[u32]) -> Result<Study, LabError> {
    let mut all = Vec::new();
    for method in case.methods() {
        let found = levels
            .iter()
            .map(|level| case.measure(lab, *level, method))
            .collect::<Result<Vec<_>, _>>()?;
        all.push(series(method, found, lab.threads));
    }
    let competing = if all.len() > 1 {
        all.split_off(1)
    } else {
        Vec::new()
    };
    let Some(first) = all.pop() else {
        unreachable!("a case names at least one method");
    };
    let targets = verdicts(&case.targets(), &first);
    Ok(Study {
        case: case.name().to_owned(),
        tool: case.tool().to_owned(),
        reference: case.reference().to_owned(),
        holds: targets.values().all(|v| v.holds),
        targets,
        levels: first.levels,
        order: first.order,
        series: competing,
    })
}

fn series(method: &str, found: Vec<Measurement>, threads: usize) -> Series {
    let spacing: Vec<f64> = found.iter().map(|m| m.spacing_m).collect();
    let mut order = BTreeMap::new();
    for quantity in found.first().map(|m| m.errors.keys()).into_iter().flatten() {
        let error: Vec<f64> = found
            .iter()
            .map(|m| m.errors.get(quantity).copied().unwrap_or(f64::NAN))
            .collect();
        order.insert(quantity.clone(), observed_order(&spacing, &error));
    }
    let levels = found
        .into_iter()
        .map(|m| Level {
            points: m.points,
            spacing_m: m.spacing_m,
            steps: m.steps,
            run_time_s: m.run_time_s,
            threads,
            errors: m.errors,
        })
        .collect();
    Series {
        method: method.to_owned(),
        levels,
        order,
    }
}

fn verdicts(targets: &[Target], series: &Series) -> BTreeMap<String, Verdict> {
    let finest = series.levels.last();
    targets
        .iter()
        .map(|target| match target {
            Target::Error { quantity, max } => {
                let found = finest.and_then(|l| l.errors.get(*quantity).copied());
                let verdict = Verdict {
                    at_points: finest.map(|l| l.points),
                    max: Some(*max),
                    min: None,
                    found,
                    holds: found.is_some_and(|e| e <= *max),
                };
                ((*quantity).to_owned(), verdict)
            }
            Target::Order { quantity, min } => {
                let found = series.order.get(*quantity).copied().flatten();
                let verdict = Verdict {
                    at_points: None,
                    max: None,
                    min: Some(*min),
                    found,
                    holds: found.is_some_and(|o| o >= *min),
                };
                (format!("order_{quantity}"), verdict)
            }
        })
        .collect()
}

impl Study {
    /// The study as a table for people: points, run time, errors, orders, targets.
    #[must_use]
    pub fn table(&self) -> String {
        let mut text = format!("{}: {}\n", self.case, self.reference);
        for level in &self.levels {
            text += &format!("  {:>9} points {:>9.2} s ", level.points, level.run_time_s);
            for (quantity, error) in &level.errors {
                text += &format!("  {quantity} {error:.3e}");
            }
            text.push('\n');
        }
        for (quantity, order) in &self.order {
            let shown = order.map_or_else(|| "-".to_owned(), |o| format!("{o:.2}"));
            text += &format!("  order of {quantity}: {shown}\n");
        }
        for (name, verdict) in &self.targets {
            let bound = match (verdict.max, verdict.min) {
                (Some(max), _) => format!("at most {max:.3e}"),
                (_, Some(min)) => format!("at least {min}"),
                _ => String::new(),
            };
            let found = verdict
                .found
                .map_or_else(|| "nothing".to_owned(), |f| format!("{f:.3e}"));
            let word = if verdict.holds { "holds " } else { "MISSED" };
            text += &format!("  {word} {name}: {bound}, found {found}\n");
        }
        text
    }
}
