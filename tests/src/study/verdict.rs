//! Whether targets are met.

use std::collections::BTreeMap;

use serde::Serialize;

use super::{Level, Series};
use crate::case::{Bound, Target};

/// A target with what was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    quantity: String,
    method: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    at_level: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    at_points: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    max: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    min: Option<f64>,
    /// What will do in place of an order, and the error at the finest level.
    #[serde(skip_serializing_if = "Option::is_none")]
    or_error_below: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    finest_error: Option<f64>,
    found: Option<f64>,
    /// `None` where the level of the target was not run.
    pub(super) holds: Option<bool>,
}

/// Judges every target; a method or quantity that is not there is a target missed.
pub(super) fn verdicts(
    targets: &[Target],
    all: &[Series],
    levels: &[u32],
) -> BTreeMap<String, Verdict> {
    let judged = targets.iter().map(|target| {
        let wanted = |s: &&Series| target.method.as_ref().is_none_or(|m| *m == s.method);
        let series = all.iter().find(wanted);
        (target.name(), verdict(target, series, levels))
    });
    judged.collect()
}

fn verdict(target: &Target, series: Option<&Series>, levels: &[u32]) -> Verdict {
    let named = target.method.clone().unwrap_or_default();
    let mut verdict = Verdict {
        quantity: target.quantity.clone(),
        method: series.map_or(named, |s| s.method.clone()),
        at_level: None,
        at_points: None,
        max: None,
        min: None,
        or_error_below: None,
        finest_error: None,
        found: None,
        holds: Some(false),
    };
    let finest = series.and_then(|s| s.levels.last());
    match target.bound {
        Bound::Error { max } => {
            let at = match target.level {
                Some(wanted) => {
                    series.and_then(|s| s.levels.iter().find(|level| level.level == wanted))
                }
                None => finest,
            };
            verdict.max = Some(max);
            verdict.at_level = target.level;
            verdict.at_points = at.map(|level| level.points);
            verdict.found = at.and_then(|level| error(level, &target.quantity));
            let asked = target.level.is_none_or(|level| levels.contains(&level));
            verdict.holds = asked.then_some(verdict.found.is_some_and(|e| e <= max));
        }
        Bound::Order {
            min,
            or_error_below,
        } => {
            let order = series.and_then(|s| s.order.get(&target.quantity));
            verdict.min = Some(min);
            verdict.or_error_below = or_error_below;
            verdict.found = order.copied().flatten();
            let rises = verdict.found.is_some_and(|order| order >= min);
            verdict.finest_error = or_error_below
                .and(finest)
                .and_then(|level| error(level, &target.quantity));
            let exact = or_error_below
                .zip(verdict.finest_error)
                .is_some_and(|(below, error)| error <= below);
            verdict.holds = Some(rises || exact);
        }
    }
    verdict
}

fn error(level: &Level, quantity: &str) -> Option<f64> {
    level.errors.get(quantity).copied()
}

impl Verdict {
    /// The verdict in a line for people.
    pub(super) fn line(&self, name: &str) -> String {
        let bound = match (self.max, self.min, self.or_error_below) {
            (Some(max), ..) => format!("at most {max:.3e}"),
            (_, Some(min), Some(below)) => format!("at least {min}, or an error below {below:.0e}"),
            (_, Some(min), None) => format!("at least {min}"),
            _ => String::new(),
        };
        let mut found = self
            .found
            .map_or_else(|| "nothing".to_owned(), |f| format!("{f:.3e}"));
        if let Some(error) = self.finest_error {
            found += &format!(" and an error of {error:.3e}");
        }
        let word = match self.holds {
            Some(true) => "holds ",
            Some(false) => "MISSED",
            None => "open  ",
        };
        format!("  {word} {name}: {bound}, found {found}\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    fn series(method: &str, errors: &[(u32, f64)], order: Option<f64>) -> Series {
        let level = |&(level, error): &(u32, f64)| Level {
            level,
            points: u64::from(level) * 100,
            spacing_m: 1.0,
            steps: 1,
            run_time_s: 1.0,
            run_time_least_s: 1.0,
            run_time_greatest_s: 1.0,
            process_s: 1.0,
            repeats: 1,
            peak_memory_bytes: None,
            threads: 1,
            errors: [("a".to_owned(), error)].into(),
        };
        Series {
            method: method.to_owned(),
            levels: errors.iter().map(level).collect(),
            order: [("a".to_owned(), order)].into(),
            stages: Value::Null,
            memory: Value::Null,
            left_out: Value::Null,
        }
    }

    fn holds(target: Target, levels: &[u32]) -> Option<bool> {
        let all = [
            series("fine", &[(1, 1e-3), (2, 1e-4)], Some(2.0)),
            series("exact", &[(1, 1e-15), (2, 3e-15)], Some(-1.5)),
        ];
        let judged = verdicts(std::slice::from_ref(&target), &all, levels);
        judged[&target.name()].holds
    }

    #[test]
    fn an_error_is_judged_at_its_level_and_method() {
        assert_eq!(holds(Target::error("a", 1e-4), &[1, 2]), Some(true));
        let coarse = Target::error("a", 5e-4).at_level(1);
        assert_eq!(holds(coarse.clone(), &[1, 2]), Some(false));
        assert_eq!(holds(coarse.of("exact"), &[1, 2]), Some(true));
        let absent = Target::error("a", 1.0).at_level(3);
        assert_eq!(holds(absent.clone(), &[1, 2]), None);
        // A level that was asked for and is not there is no excuse.
        assert_eq!(holds(absent, &[1, 2, 3]), Some(false));
    }

    #[test]
    fn what_is_exact_needs_no_order() {
        let order = Target::order("a", 1.8);
        assert_eq!(holds(order.clone(), &[1, 2]), Some(true));
        let exact = order.of("exact");
        assert_eq!(holds(exact.clone(), &[1, 2]), Some(false));
        assert_eq!(
            holds(exact.clone().or_error_below(1e-12), &[1, 2]),
            Some(true)
        );
        assert_eq!(holds(exact.or_error_below(1e-15), &[1, 2]), Some(false));
    }

    #[test]
    fn a_name_that_is_not_there_is_a_target_missed() {
        assert_eq!(holds(Target::error("b", 1.0), &[1, 2]), Some(false));
        assert_eq!(holds(Target::order("b", 1.0), &[1, 2]), Some(false));
        assert_eq!(
            holds(Target::error("a", 1.0).of("none"), &[1, 2]),
            Some(false)
        );
    }
}
