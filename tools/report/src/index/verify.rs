//! Exact cases: error against run time, order, targets.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::heading;
use crate::html::{Rows, escape, figure, paragraph, side_by_side, verdict};
use crate::plot::{Line, Plot};
use crate::records::figure as digits;

/// More lines than this make a plot hard to read.
const MOST_LINES: usize = 8;

/// One resolution.
#[derive(Debug, Clone, Deserialize)]
struct Level {
    points: f64,
    #[serde(default)]
    spacing_m: f64,
    #[serde(default)]
    steps: f64,
    run_time_s: f64,
    #[serde(default)]
    threads: u64,
    errors: BTreeMap<String, Option<f64>>,
}

/// A target and what was found.
#[derive(Debug, Clone, Deserialize)]
struct Target {
    #[serde(default)]
    at_points: Option<f64>,
    #[serde(default)]
    max: Option<f64>,
    #[serde(default)]
    min: Option<f64>,
    #[serde(default)]
    found: Option<f64>,
    #[serde(default)]
    holds: Option<bool>,
}

/// A competing method.
#[derive(Debug, Clone, Deserialize)]
struct Series {
    method: String,
    levels: Vec<Level>,
    #[serde(default)]
    order: BTreeMap<String, Option<f64>>,
}

/// A record of `make verify`.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Study {
    case: String,
    tool: String,
    reference: String,
    #[serde(default)]
    method: Option<String>,
    levels: Vec<Level>,
    #[serde(default)]
    order: BTreeMap<String, Option<f64>>,
    #[serde(default)]
    targets: BTreeMap<String, Target>,
    holds: bool,
    #[serde(default)]
    series: Vec<Series>,
}

impl Study {
    fn method(&self) -> &str {
        self.method.as_deref().unwrap_or("default")
    }

    /// Quantities to plot: all, or where that would be too many lines those that targets name.
    fn plotted(&self) -> Vec<&str> {
        let all = self.quantities();
        if all.len() * (1 + self.series.len()) <= MOST_LINES {
            return all;
        }
        let named = |q: &&str| {
            self.targets
                .keys()
                .any(|t| t.strip_prefix("order_").unwrap_or(t) == *q)
        };
        let chosen: Vec<&str> = all.iter().copied().filter(named).collect();
        if chosen.is_empty() { all } else { chosen }
    }

    /// Quantities with an error, in the order of their names.
    fn quantities(&self) -> Vec<&str> {
        let first = self.levels.first();
        first
            .map(|l| l.errors.keys().map(String::as_str).collect())
            .unwrap_or_default()
    }
}

/// One row per case.
pub(super) fn summary(studies: &[Study]) -> String {
    let mut table = Rows::new(&[
        "Case",
        "Program",
        "#Points",
        "#Run time",
        "#Greatest error",
        "#Order",
        "Targets",
    ]);
    for study in studies {
        let Some(finest) = study.levels.last() else {
            continue;
        };
        let worst = finest
            .errors
            .iter()
            .filter_map(|(name, error)| Some((name, (*error)?)))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        let (error, order) = worst.map_or_else(
            || ("\u{2013}".to_owned(), "\u{2013}".to_owned()),
            |(name, error)| {
                let which = escape(&name.replace('_', " "));
                let error = format!("{}<br><small>{which}</small>", digits(error));
                (error, order(&study.order, name))
            },
        );
        let word = if study.holds { "all met" } else { "missed" };
        table.row([
            format!("<a href=\"#{0}\">{0}</a>", escape(&study.case)),
            escape(&study.tool),
            whole(finest.points),
            format!("{} s", digits(finest.run_time_s)),
            error,
            order,
            verdict(word, Some(study.holds)),
        ]);
    }
    let held = studies.iter().filter(|s| s.holds).count();
    let words = format!(
        "{held} of {} cases meet all of their targets. Errors are computed from the written files by code that \
         shares nothing with the solvers.",
        studies.len()
    );
    paragraph(&words) + &table.render()
}

fn order(orders: &BTreeMap<String, Option<f64>>, quantity: &str) -> String {
    match orders.get(quantity) {
        Some(Some(order)) => format!("{order:.2}").replace('-', "\u{2212}"),
        _ => "\u{2013}".to_owned(),
    }
}

/// Plots and tables of a case.
pub(super) fn section(study: &Study) -> String {
    let mut out = heading(&study.case, study.holds, ("targets met", "targets missed"));
    out += &paragraph(&study.reference);
    let mut time = Plot::new("run time [s]", "error").log_log();
    let mut points = Plot::new("points, cells or particles", "error").log_log();
    for quantity in study.plotted() {
        let own = std::iter::once((study.method(), &study.levels, &study.order));
        let others = study
            .series
            .iter()
            .map(|s| (s.method.as_str(), &s.levels, &s.order));
        for (method, levels, orders) in own.chain(others) {
            let name = if study.series.is_empty() {
                quantity.replace('_', " ")
            } else {
                format!("{}, {method}", quantity.replace('_', " "))
            };
            time.add(curve(&name, levels, quantity, |l| l.run_time_s));
            let order = match order(orders, quantity).as_str() {
                "\u{2013}" => name,
                order => format!("{name} (order {order})"),
            };
            points.add(curve(&order, levels, quantity, |l| l.points));
        }
    }
    guides(&mut points, study);
    out += &side_by_side(&[
        figure(
            &time.svg(),
            "Error over run time: lower and further left is better.",
        ),
        figure(
            &points.svg(),
            "Error over the number of points. Dashed: slopes of first and second order.",
        ),
    ]);
    if study.plotted().len() < study.quantities().len() {
        out += &paragraph(
            "The plots show what the targets name; the other errors are in the table of all levels.",
        );
    }
    out += &targets(study);
    out += &levels(study);
    out
}

/// A count.
fn whole(count: f64) -> String {
    format!("{count:.0}")
}

fn curve(name: &str, levels: &[Level], quantity: &str, at: impl Fn(&Level) -> f64) -> Line {
    let point = |l: &Level| Some([at(l), (*l.errors.get(quantity)?)?]);
    Line::new(name, levels.iter().filter_map(point).collect()).marked()
}

/// Slopes of first and second order, a little above the coarsest level, over the number of points. How
/// spacing falls with points is taken from the levels themselves.
fn guides(plot: &mut Plot, study: &Study) {
    let (Some(first), Some(last)) = (study.levels.first(), study.levels.last()) else {
        return;
    };
    let shown = study
        .plotted()
        .into_iter()
        .filter_map(|q| *first.errors.get(q)?);
    let worst = 1.8 * shown.fold(0.0, f64::max);
    let ratio = last.spacing_m / first.spacing_m;
    if !(worst > 0.0 && ratio > 0.0 && ratio < 1.0) {
        return;
    }
    for power in [1, 2] {
        let points = vec![
            [first.points, worst],
            [last.points, worst * ratio.powi(power)],
        ];
        plot.add(Line::new("", points).guide());
    }
}

fn targets(study: &Study) -> String {
    let mut table = Rows::new(&["Target", "Bound", "#Found", "Verdict"]);
    for (name, target) in &study.targets {
        let bound = match (target.max, target.min, target.at_points) {
            (Some(max), _, Some(points)) => {
                format!("at most {} at {} points", digits(max), whole(points))
            }
            (Some(max), _, None) => format!("at most {}", digits(max)),
            (None, Some(min), _) => format!("at least {}", digits(min)),
            (None, None, _) => String::new(),
        };
        let holds = target.holds.unwrap_or(false);
        table.row([
            escape(&name.replace('_', " ")),
            bound,
            target.found.map_or_else(|| "nothing".to_owned(), digits),
            verdict(if holds { "met" } else { "missed" }, Some(holds)),
        ]);
    }
    table.render()
}

fn levels(study: &Study) -> String {
    let quantities = study.quantities();
    let mut head = vec![
        "Method".to_owned(),
        "#Points".to_owned(),
        "#Spacing".to_owned(),
        "#Steps".to_owned(),
        "#Run time".to_owned(),
        "#Threads".to_owned(),
    ];
    head.extend(
        quantities
            .iter()
            .map(|q| format!("#{}", q.replace('_', " "))),
    );
    let mut table = Rows::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
    let own = (study.method(), &study.levels, &study.order);
    let others = study
        .series
        .iter()
        .map(|s| (s.method.as_str(), &s.levels, &s.order));
    for (method, levels, orders) in std::iter::once(own).chain(others) {
        for level in levels {
            let mut cells = vec![
                escape(method),
                whole(level.points),
                format!("{} mm", digits(1e3 * level.spacing_m)),
                whole(level.steps),
                format!("{} s", digits(level.run_time_s)),
                level.threads.to_string(),
            ];
            let error = |q: &&str| level.errors.get(*q).copied().flatten();
            cells.extend(
                quantities
                    .iter()
                    .map(|q| error(q).map_or_else(|| "\u{2013}".to_owned(), digits)),
            );
            table.row(cells);
        }
        let mut cells = vec![
            format!("{}, order", escape(method)),
            String::new(),
            String::new(),
            String::new(),
            String::new(),
            String::new(),
        ];
        cells.extend(quantities.iter().map(|q| order(orders, q)));
        table.row(cells);
    }
    format!(
        "<details>\n<summary>All levels</summary>\n{}</details>\n",
        table.render()
    )
}
