//! Whether targets are met.

use std::collections::BTreeMap;

use serde::Serialize;

use super::{Level, Series};
use crate::case::{Bound, Span, Target};
use crate::norms::observed_order;

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
    /// What `max` is a multiple of: times the error of the first method.
    #[serde(skip_serializing_if = "Option::is_none")]
    times: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    min: Option<f64>,
    /// What will do in place of an order, and the error at the finest level.
    #[serde(skip_serializing_if = "Option::is_none")]
    or_error_below: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    finest_error: Option<f64>,
    found: Option<f64>,
    /// `None` where the level of the target was not run, or the user's patch does not fit the method.
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
        let mut verdict = Verdict::open(target, series);
        verdict.judge(target, series, all.first(), levels);
        if series.is_some_and(|s| s.refused.is_some()) {
            verdict.holds = None;
        }
        (target.name(), verdict)
    });
    judged.collect()
}

impl Verdict {
    /// A verdict that is not yet found, and is missed so far.
    fn open(target: &Target, series: Option<&Series>) -> Self {
        let named = target.method.clone().unwrap_or_default();
        Self {
            quantity: target.quantity.clone(),
            method: series.map_or(named, |s| s.method.clone()),
            at_level: None,
            at_points: None,
            max: None,
            times: None,
            min: None,
            or_error_below: None,
            finest_error: None,
            found: None,
            holds: Some(false),
        }
    }

    fn judge(
        &mut self,
        target: &Target,
        series: Option<&Series>,
        first: Option<&Series>,
        levels: &[u32],
    ) {
        match target.bound {
            Bound::Error { max } => {
                self.max = Some(max);
                self.judge_error(target, series, levels);
            }
            Bound::Multiple {
                times,
                or_error_below,
            } => {
                self.times = Some(times);
                let of =
                    first.and_then(|first| error(level(first, target.level)?, &target.quantity));
                self.max = of.map(|of| (times * of).max(or_error_below));
                self.judge_error(target, series, levels);
            }
            Bound::Order {
                min,
                over,
                or_error_below,
            } => {
                self.min = Some(min);
                self.or_error_below = or_error_below;
                self.judge_order(series, over, levels);
            }
        }
    }

    /// The error at the level of the target against `max`.
    fn judge_error(&mut self, target: &Target, series: Option<&Series>, levels: &[u32]) {
        let at = series.and_then(|series| level(series, target.level));
        self.at_level = target.level;
        self.at_points = at.map(|level| level.points);
        self.found = at.and_then(|level| error(level, &target.quantity));
        let asked = target.level.is_none_or(|level| levels.contains(&level));
        let holds = self
            .found
            .zip(self.max)
            .is_some_and(|(found, max)| found <= max);
        self.holds = asked.then_some(holds);
    }

    /// The order over the levels of `over` against `min`.
    fn judge_order(&mut self, series: Option<&Series>, over: Span, levels: &[u32]) {
        self.found = series.and_then(|s| match over {
            Span::All => s.order.get(&self.quantity).copied().flatten(),
            Span::FinestTwo => finest_order(s, &self.quantity),
        });
        let rises = self
            .found
            .zip(self.min)
            .is_some_and(|(order, min)| order >= min);
        self.finest_error = self
            .or_error_below
            .and(series.and_then(|s| level(s, None)))
            .and_then(|level| error(level, &self.quantity));
        let exact = self
            .or_error_below
            .zip(self.finest_error)
            .is_some_and(|(below, error)| error <= below);
        // Two levels make an order.
        let single = series.is_some_and(|s| s.levels.len() < 2) && levels.len() < 2;
        self.holds = (rises || exact || !single).then_some(rises || exact);
    }
}

/// The order between the two finest levels; none of a single level.
fn finest_order(series: &Series, quantity: &str) -> Option<f64> {
    let [.., coarse, fine] = series.levels.as_slice() else {
        return None;
    };
    let errors = [error(coarse, quantity)?, error(fine, quantity)?];
    observed_order(&[coarse.spacing_m, fine.spacing_m], &errors)
}

/// The wanted level of a series, or its finest.
fn level(series: &Series, wanted: Option<u32>) -> Option<&Level> {
    match wanted {
        Some(wanted) => series.levels.iter().find(|level| level.level == wanted),
        None => series.levels.last(),
    }
}

/// An error or a cost of a level.
fn error(level: &Level, quantity: &str) -> Option<f64> {
    let found = level.errors.get(quantity);
    found.or_else(|| level.costs.get(quantity)).copied()
}

impl Verdict {
    /// The verdict in a line for people.
    pub(super) fn line(&self, name: &str) -> String {
        let bound = match (self.max, self.min, self.or_error_below) {
            (Some(max), ..) => match self.times {
                Some(times) => format!("at most {max:.3e} ({times} times the first method)"),
                None => format!("at most {max:.3e}"),
            },
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
            costs: [("iterations".to_owned(), 10.0 * f64::from(level))].into(),
        };
        Series {
            method: method.to_owned(),
            levels: errors.iter().map(level).collect(),
            order: [("a".to_owned(), order)].into(),
            refused: None,
            held: std::collections::BTreeSet::new(),
            stages: Value::Null,
            memory: Value::Null,
            left_out: Value::Null,
        }
    }

    #[test]
    fn an_order_at_the_end_looks_at_the_two_finest_levels() {
        let mut made = series("bent", &[(1, 1e-2), (2, 6e-3), (3, 1.5e-3)], Some(1.4));
        for (level, spacing) in made.levels.iter_mut().zip([0.4, 0.2, 0.1]) {
            level.spacing_m = spacing;
        }
        let judged = |target: Target| {
            let all = verdicts(
                std::slice::from_ref(&target),
                std::slice::from_ref(&made),
                &[1, 2, 3],
            );
            let verdict = &all[&target.name()];
            (verdict.found, verdict.holds)
        };
        let (found, holds) = judged(Target::order("a", 1.9).at_the_end());
        assert!((found.unwrap() - 2.0).abs() < 1e-12);
        assert_eq!(holds, Some(true));
        assert_eq!(judged(Target::order("a", 2.1).at_the_end()).1, Some(false));
        assert_eq!(judged(Target::order("a", 1.9)).1, Some(false));
    }

    #[test]
    fn an_order_of_one_level_is_open() {
        let made = [series("fine", &[(1, 1e-3)], None)];
        let judged = |target: Target, levels: &[u32]| {
            let all = verdicts(std::slice::from_ref(&target), &made, levels);
            all[&target.name()].holds
        };
        assert_eq!(judged(Target::order("a", 1.9), &[1]), None);
        assert_eq!(judged(Target::order("a", 1.9), &[1, 2]), Some(false));
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
    fn a_method_that_the_patch_does_not_fit_leaves_its_targets_open() {
        let mut series = series("fine", &[], None);
        series.refused = Some("a sphere has no place here".to_owned());
        for target in [Target::error("a", 1.0), Target::order("a", 2.0)] {
            let judged = verdicts(std::slice::from_ref(&target), &[series.clone()], &[1, 2]);
            assert_eq!(judged[&target.name()].holds, None);
        }
    }

    #[test]
    fn an_error_is_judged_at_its_level_and_method() {
        assert_eq!(holds(Target::error("a", 1e-4), &[1, 2]), Some(true));
        let coarse = Target::error("a", 5e-4).at_level(1);
        assert_eq!(holds(coarse.clone(), &[1, 2]), Some(false));
        assert_eq!(holds(coarse.of("exact"), &[1, 2]), Some(true));
        let absent = Target::error("a", 1.0).at_level(3);
        assert_eq!(holds(absent.clone(), &[1, 2]), None);
        let cost = |most| Target::error("iterations", most);
        assert_eq!(holds(cost(20.0), &[1, 2]), Some(true));
        assert_eq!(holds(cost(19.0), &[1, 2]), Some(false));
        // A level that was asked for and is not there is no excuse.
        assert_eq!(holds(absent, &[1, 2, 3]), Some(false));
    }

    #[test]
    fn a_multiple_is_of_the_first_method_at_the_same_level() {
        let within = |times, below| Target::multiple("a", times, below).of("rough");
        let judge = |target: Target| {
            let all = [
                series("fine", &[(1, 1e-3), (2, 1e-4)], Some(2.0)),
                series("rough", &[(1, 2e-3), (2, 4e-4)], Some(2.0)),
            ];
            let judged = verdicts(std::slice::from_ref(&target), &all, &[1, 2]);
            judged[&target.name()].holds
        };
        assert_eq!(judge(within(3.0, 1e-10)), Some(false));
        assert_eq!(judge(within(3.0, 1e-10).at_level(1)), Some(true));
        assert_eq!(judge(within(3.0, 4e-4)), Some(true));
        let absent = Target::multiple("b", 3.0, 1e-10).of("rough");
        assert_eq!(judge(absent), Some(false));
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
