//! Programs of other people on the problems of our cases.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::html::{Rows, escape, figure, note, paragraph, side_by_side};
use crate::plot::{Line, Plot};
use crate::records::{bytes, figure as digits};

/// A record of `make bench-others`.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Record {
    /// What was compared and how.
    #[serde(default)]
    about: Option<String>,
    #[serde(default)]
    threads: u64,
    problems: Vec<Problem>,
    #[serde(default)]
    missing: Vec<Missing>,
}

/// A problem that all solved.
#[derive(Debug, Clone, Deserialize)]
struct Problem {
    title: String,
    /// What the errors are.
    #[serde(default)]
    measure: Option<String>,
    rows: Vec<Row>,
}

/// One program at one size.
#[derive(Debug, Clone, Deserialize)]
struct Row {
    program: String,
    #[serde(default)]
    version: String,
    method: String,
    points: f64,
    run_time_s: f64,
    run_time_least_s: f64,
    run_time_greatest_s: f64,
    #[serde(default)]
    repeats: u64,
    #[serde(default)]
    peak_memory_bytes: Option<u64>,
    error: Option<f64>,
}

/// A run that gave no figure.
#[derive(Debug, Clone, Deserialize)]
struct Missing {
    what: String,
    why: String,
}

impl Problem {
    fn measure(&self) -> &str {
        self.measure.as_deref().unwrap_or("greatest error / range")
    }
}

/// A pair of plots and a table per problem.
pub(super) fn section(record: &Record) -> String {
    let usual = format!(
        "Programs from elsewhere on the problems of our cases, at equal numbers of points, nodes or cells, judged \
         by one function. Theirs: meshing, assembly and solution within a Python that is warm; imports are not \
         counted. Ours: a run of its own on {} threads, without reading its scene and writing its files.",
        record.threads
    );
    let about = |text: &String| format!("{text} Threads: {}.", record.threads);
    let mut out = paragraph(&record.about.as_ref().map_or(usual, about));
    for problem in &record.problems {
        out += &format!("<h3>{}</h3>\n", escape(&problem.title));
        out += &plots(problem);
        out += &table(problem);
    }
    for missing in &record.missing {
        // The first line tells enough; the rest is what a program printed on its way out.
        let why = missing.why.lines().last().unwrap_or_default();
        out += &note(&format!("No figure of {}: {why}", missing.what));
    }
    out
}

fn plots(problem: &Problem) -> String {
    let mut lines: BTreeMap<(&str, &str), Vec<&Row>> = BTreeMap::new();
    for row in &problem.rows {
        lines
            .entry((&row.program, &row.method))
            .or_default()
            .push(row);
    }
    let mut time = Plot::new("run time [s]", problem.measure()).log_log();
    let mut size = Plot::new("points, nodes, cells or unknowns", "run time [s]").log_log();
    for ((program, method), rows) in &lines {
        let name = format!("{program}, {method}");
        let error = |r: &&Row| Some([r.run_time_s, r.error?]);
        let span = |r: &&Row| Some([r.run_time_least_s, r.run_time_greatest_s, r.error?]);
        let line = Line::new(&name, rows.iter().filter_map(error).collect()).marked();
        time.add(line.with_spans(rows.iter().filter_map(span).collect()));
        let grown = rows.iter().map(|r| [r.points, r.run_time_s]).collect();
        size.add(Line::new(&name, grown).marked());
    }
    if time.is_empty() {
        return String::new();
    }
    side_by_side(&[
        figure(
            &time.html(),
            &format!(
                "Error ({}) over run time: lower and further left is better.",
                problem.measure()
            ),
        ),
        figure(&size.html(), "Run time over the size of the problem."),
    ])
}

fn table(problem: &Problem) -> String {
    let mut table = Rows::new(&[
        "Program",
        "Method",
        "#Points",
        "#Run time",
        "#Runs",
        "#Peak memory",
        "#Error",
    ]);
    for row in &problem.rows {
        table.row([
            escape(&format!("{} {}", row.program, row.version)),
            escape(&row.method),
            format!("{:.0}", row.points),
            format!("{} s", digits(row.run_time_s)),
            row.repeats.to_string(),
            row.peak_memory_bytes
                .map_or_else(|| "\u{2013}".to_owned(), bytes),
            row.error.map_or_else(|| "\u{2013}".to_owned(), digits),
        ]);
    }
    table.render()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_program_is_a_line_and_a_missing_one_is_told() {
        let row = |program: &str, points: u32, error: f64| {
            serde_json::json!({"program": program, "version": "1", "method": "m", "points": points,
                "run_time_s": 0.1, "run_time_least_s": 0.1, "run_time_greatest_s": 0.2, "error": error})
        };
        let record: Record = serde_json::from_value(serde_json::json!({"threads": 2,
            "problems": [{"name": "p", "title": "A problem",
                "rows": [row("a", 10, 0.1), row("a", 20, 0.03), row("b", 10, 0.2)]}],
            "missing": [{"what": "p: c", "why": "long\nnot installed"}]}))
        .unwrap();
        let html = section(&record);
        assert_eq!(html.matches("<svg").count(), 2);
        assert!(html.contains(">a, m</text>") && html.contains("No figure of p: c: not installed"));
    }
}
