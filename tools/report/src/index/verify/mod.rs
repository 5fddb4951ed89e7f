//! Exact cases: error against run time, order, targets.

mod record;

use std::collections::BTreeMap;

use super::cost::{self, Cost, Prices};
use super::judged;
use crate::html::{Rows, escape, figure, paragraph, side_by_side, verdict};
use crate::plot::{Line, Plot};
use crate::records::{bytes, figure as digits};
pub(super) use record::Study;
use record::{Level, Series, whole};

/// One row per case; figures are of its first method.
pub(super) fn summary(studies: &[Study]) -> String {
    let mut table = Rows::new(&[
        "Case",
        "Program",
        "#Methods",
        "#Points",
        "#Run time",
        "#Greatest error",
        "#Order",
        "Targets",
    ]);
    for study in studies {
        let Some(finest) = study.first.levels.last() else {
            continue;
        };
        let worst = finest
            .errors
            .iter()
            // An error that is no number is null in JSON, and the greatest of all.
            .map(|(name, error)| (name, error.unwrap_or(f64::NAN)))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        let (error, order) = worst.map_or_else(
            || ("\u{2013}".to_owned(), "\u{2013}".to_owned()),
            |(name, error)| {
                let which = escape(&name.replace('_', " "));
                let error = format!("{}<br><small>{which}</small>", digits(error));
                (error, order(&study.first.order, name))
            },
        );
        let met = study.targets.values().filter(|t| t.holds == Some(true));
        let word = format!("{} of {} met", met.count(), study.targets.len());
        table.row([
            format!("<a href=\"#{0}\">{0}</a>", escape(&study.case)),
            escape(&study.tool),
            (1 + study.series.len()).to_string(),
            whole(finest.points),
            format!("{} s", digits(finest.run_time_s)),
            error,
            order,
            match study.standing() {
                (why, None) => verdict(&format!("{word}, {why}"), None),
                (_, holds) => verdict(&word, holds),
            },
        ]);
    }
    let stand = |holds| studies.iter().filter(|s| s.standing().1 == holds).count();
    let open = match stand(None) {
        0 => String::new(),
        n => format!(" {n} are not judged: not all of their levels were run."),
    };
    let words = format!(
        "{} of {} cases meet all of their targets.{open} Errors are computed from the written files by code that \
         shares nothing with the solvers.",
        stand(Some(true)),
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
pub(super) fn section(study: &Study, prices: &Prices) -> String {
    let (word, holds) = study.standing();
    let mut out = judged(&study.case, &word, holds);
    out += &paragraph(&study.reference);
    let plotted = study.plotted();
    if study.series.is_empty() {
        out += &plots(study, &plotted, "error");
    } else {
        // One pair of plots per quantity, one line per method.
        for quantity in &plotted {
            let title = quantity.replace('_', " ");
            out += &plots(study, &[quantity], &format!("error: {title}"));
        }
    }
    if plotted.len() < study.quantities().len() {
        out += &paragraph(
            "The plots show what the targets name; the other errors are in the table of all levels.",
        );
    }
    out += &targets(study);
    out += &costs(study, prices);
    out + &levels(study)
}

/// Error over run time beside error over points.
fn plots(study: &Study, quantities: &[&str], title: &str) -> String {
    let mut time = Plot::new("run time [s]", title).log_log();
    let mut points = Plot::new("points, cells or particles", title).log_log();
    for quantity in quantities {
        for series in study.all() {
            let name = match (study.series.is_empty(), quantities) {
                (true, _) => quantity.replace('_', " "),
                (false, [_]) => series.method.clone(),
                (false, _) => format!("{}, {}", quantity.replace('_', " "), series.method),
            };
            let line = curve(&name, &series.levels, quantity, |l| l.run_time_s);
            time.add(line.with_spans(spans(&series.levels, quantity)));
            let order = match order(&series.order, quantity).as_str() {
                "\u{2013}" => name,
                order => format!("{name} (order {order})"),
            };
            points.add(curve(&order, &series.levels, quantity, |l| l.points));
        }
    }
    if time.is_empty() {
        return String::new();
    }
    slopes(&mut points, study, quantities);
    bounds(&mut points, study, quantities);
    side_by_side(&[
        figure(
            &time.html(),
            "Error over run time: lower and further left is better. Thin bars: least to greatest time of the repeats.",
        ),
        figure(
            &points.html(),
            "Error over the number of points. Dashed: slopes of first and second order; dotted: targets at their points.",
        ),
    ])
}

/// Least and greatest run time at the points of a curve.
fn spans(levels: &[Level], quantity: &str) -> Vec<[f64; 3]> {
    let span = |l: &Level| {
        let error = (*l.errors.get(quantity)?)?;
        Some([l.run_time_least_s?, l.run_time_greatest_s?, error])
    };
    levels.iter().filter_map(span).collect()
}

/// Targets of these quantities as short dotted lines where they are judged.
fn bounds(plot: &mut Plot, study: &Study, quantities: &[&str]) {
    for (key, target) in &study.targets {
        if !quantities.contains(&target.quantity(key)) {
            continue;
        }
        if let (Some(max), Some(points)) = (target.max, target.at_points) {
            let ends = vec![[points / 1.25, max], [points * 1.25, max]];
            plot.add(Line::new("", ends).dotted());
        }
    }
}

/// What the finest level of each method spent and left out.
fn costs(study: &Study, prices: &Prices) -> String {
    let cost = |series: &'_ Series| {
        let finest = series.levels.last()?;
        Some((
            series.method.clone(),
            finest.run_time_s,
            finest.peak_memory_bytes,
        ))
    };
    let none = (Vec::new(), Vec::new(), Vec::new());
    let rows: Vec<Cost> = study
        .all()
        .filter_map(|series| {
            let (name, time_s, peak_memory_bytes) = cost(series)?;
            Some(Cost {
                name,
                tool: &study.tool,
                time_s,
                peak_memory_bytes,
                stages: series.stages.as_ref().unwrap_or(&none.0),
                memory: series.memory.as_ref().unwrap_or(&none.1),
                left_out: series.left_out.as_ref().unwrap_or(&none.2),
            })
        })
        .collect();
    if study.all().all(|series| series.stages.is_none()) {
        return String::new();
    }
    cost::table("Finest level of", &rows, prices)
}

fn curve(name: &str, levels: &[Level], quantity: &str, at: impl Fn(&Level) -> f64) -> Line {
    let point = |l: &Level| Some([at(l), (*l.errors.get(quantity)?)?]);
    Line::new(name, levels.iter().filter_map(point).collect()).marked()
}

/// Slopes of first and second order, a little above the coarsest level, over the number of points. How
/// spacing falls with points is taken from the levels themselves.
fn slopes(plot: &mut Plot, study: &Study, quantities: &[&str]) {
    let levels = &study.first.levels;
    let (Some(first), Some(last)) = (levels.first(), levels.last()) else {
        return;
    };
    let shown = quantities.iter().filter_map(|q| *first.errors.get(*q)?);
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
    let mut table = Rows::new(&["Target", "Method", "At", "Bound", "#Found", "Verdict"]);
    for (key, target) in &study.targets {
        let (word, holds) = match target.holds {
            Some(true) => ("met", Some(true)),
            Some(false) => ("missed", Some(false)),
            None => ("not run", None),
        };
        table.row([
            escape(&target.quantity(key).replace('_', " ")),
            escape(target.method.as_deref().unwrap_or(&study.first.method)),
            target.place(),
            target.bound(),
            target.found(),
            verdict(word, holds),
        ]);
    }
    table.render()
}

fn levels(study: &Study) -> String {
    let (quantities, costs) = (study.quantities(), study.costs());
    let mut head: Vec<String> = [
        "Method",
        "#Points",
        "#Spacing",
        "#Steps",
        "#Run time",
        "#Runs",
        "#Peak memory",
        "#Threads",
    ]
    .map(str::to_owned)
    .into();
    let fixed = head.len();
    head.extend(
        quantities
            .iter()
            .chain(&costs)
            .map(|q| format!("#{}", q.replace('_', " "))),
    );
    let mut table = Rows::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
    for series in study.all() {
        for level in &series.levels {
            let dash = || "\u{2013}".to_owned();
            let mut cells = vec![
                escape(&series.method),
                whole(level.points),
                format!("{} mm", digits(1e3 * level.spacing_m)),
                whole(level.steps),
                format!("{} s", digits(level.run_time_s)),
                level.repeats.map_or_else(dash, |n| n.to_string()),
                level.peak_memory_bytes.map_or_else(dash, bytes),
                level.threads.to_string(),
            ];
            let error = |q: &&str| level.errors.get(*q).copied().flatten();
            cells.extend(
                quantities
                    .iter()
                    .map(|q| error(q).map_or_else(dash, digits)),
            );
            let cost = |name: &&str| {
                level
                    .costs
                    .get(*name)
                    .map_or_else(dash, |cost| digits(*cost))
            };
            cells.extend(costs.iter().map(cost));
            table.row(cells);
        }
        let mut cells = vec![format!("{}, order", escape(&series.method))];
        cells.resize(fixed, String::new());
        cells.extend(quantities.iter().map(|q| order(&series.order, q)));
        cells.resize(fixed + quantities.len() + costs.len(), String::new());
        table.row(cells);
    }
    format!(
        "<details>\n<summary>All levels</summary>\n{}</details>\n",
        table.render()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn study(methods: usize) -> Study {
        let level = |n: u32, error: f64| {
            serde_json::json!({"level": n, "points": 100 * n, "spacing_m": 1.0 / f64::from(n), "steps": 1,
                "run_time_s": 0.1, "run_time_least_s": 0.05, "run_time_greatest_s": 0.2, "repeats": 5,
                "threads": 2, "errors": {"a_linf": error, "b_l2": error}, "costs": {"iterations": 17}})
        };
        let series = |name: String| {
            serde_json::json!({"method": name, "levels": [level(1, 1e-2), level(2, 2.5e-3)],
                "order": {"a_linf": 2.0, "b_l2": null},
                "stages": [{"name": "solve", "wall_s": 0.1, "share": 1.0}], "memory": [],
                "left_out": [{"name": "radiation", "why": "no key"}]})
        };
        let mut value = series("first".to_owned());
        let more: Vec<_> = (1..methods)
            .map(|i| series(format!("method {i}")))
            .collect();
        value["series"] = more.into();
        for (key, text) in [("case", "c"), ("tool", "t"), ("reference", "r")] {
            value[key] = text.into();
        }
        value["holds"] = true.into();
        value["targets"] = serde_json::json!({
            "a_linf_at_level_3": {"quantity": "a_linf", "method": "first", "at_level": 3, "max": 1e-3,
                "found": null, "holds": null},
            "order_a_linf": {"quantity": "a_linf", "method": "first", "min": 1.8, "or_error_below": 1e-12,
                "finest_error": 2.5e-3, "found": 2.0, "holds": true}});
        serde_json::from_value(value).unwrap()
    }

    #[test]
    fn each_quantity_has_plots_with_a_line_per_method() {
        let html = section(&study(6), &Prices::default());
        // Only what targets name is drawn: one pair.
        assert_eq!(html.matches("<svg").count(), 2);
        for method in ["first", "method 5"] {
            assert!(html.contains(&format!(">{method} (order 2.00)</text>")));
        }
        assert!(html.contains("not run") && html.contains("or an error of at most"));
        assert!(html.contains("radiation"));
    }

    #[test]
    fn a_method_alone_shows_all_its_errors_in_one_plot() {
        let html = section(&study(1), &Prices::default());
        assert_eq!(html.matches("<svg").count(), 2);
        assert!(html.contains(">b l2</text>"));
        let table = summary(&[study(1)]);
        assert!(table.contains("1 of 2 met"));
    }

    #[test]
    fn what_a_run_takes_is_no_error() {
        assert!(!summary(&[study(1)]).contains("iterations"));
        let html = section(&study(2), &Prices::default());
        let (plots, levels) = html.split_once("<summary>").unwrap();
        assert!(!plots.contains("iterations"));
        assert!(
            levels.contains("iterations</th>") && levels.contains(">17.00</td>"),
            "{levels}"
        );
    }
}
