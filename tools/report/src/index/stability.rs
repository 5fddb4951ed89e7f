//! Extreme cases: how each run ended, and whether it may end so.

use serde::Deserialize;
use serde_json::Value;

use super::heading;
use super::map::{Cell, Scales, svg};
use crate::html::{Rows, escape, figure, paragraph, verdict};
use crate::records::{Total, figure as digits};

/// One run.
#[derive(Debug, Clone, Deserialize)]
struct Row {
    name: String,
    #[serde(default)]
    at: Option<[usize; 2]>,
    #[serde(default)]
    parameters: Value,
    outcome: String,
    #[serde(default)]
    expected: Vec<String>,
    #[serde(default)]
    limits: Option<Vec<Total>>,
    #[serde(default)]
    conservation: Option<Vec<Total>>,
    #[serde(default)]
    message: String,
    #[serde(default)]
    broken: Vec<String>,
    holds: bool,
}

/// A record of `make stability`.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Record {
    case: String,
    tool: String,
    #[serde(default)]
    map: Option<Scales>,
    runs: Vec<Row>,
    holds: bool,
}

/// How many runs ended as they may.
pub(super) fn summary(records: &[Record]) -> String {
    let all = records.iter().map(|r| r.runs.len()).sum::<usize>();
    let good = records
        .iter()
        .flat_map(|r| &r.runs)
        .filter(|r| r.holds)
        .count();
    paragraph(&format!(
        "{good} of {all} runs with stiff or extreme parameters end as they may: stable, refused with a reason, \
         with smaller steps than asked for, or with a divergence that is detected and named."
    ))
}

/// The runs of a case: a map where there is a grid, and all runs in a table.
pub(super) fn section(record: &Record) -> String {
    let mut out = heading(&record.case, record.holds, ("as it may", "fails"));
    out += &paragraph(&format!("Program {}.", record.tool));
    let (mapped, single): (Vec<&Row>, Vec<&Row>) = record.runs.iter().partition(|r| r.at.is_some());
    if let Some(scales) = &record.map {
        out += &map(scales, &mapped);
        out += &wrong(&mapped);
        out += &format!(
            "<details>\n<summary>All {} runs of the map</summary>\n{}</details>\n",
            mapped.len(),
            table(&mapped)
        );
    }
    out += &table(&single);
    for row in single {
        if !row.message.is_empty() && row.outcome != "stable" {
            out += &said(row);
        }
    }
    out
}

fn said(row: &Row) -> String {
    format!(
        "<details>\n<summary>What it said: {}</summary>\n<pre>{}</pre>\n</details>\n",
        escape(&row.name),
        escape(&row.message)
    )
}

/// What is wrong with the runs of a map, each once, with the number of runs.
fn wrong(rows: &[&Row]) -> String {
    let mut found: Vec<(String, String, usize)> = Vec::new();
    for row in rows.iter().filter(|r| !r.holds) {
        let what = match row.broken.first() {
            Some(broken) => broken.clone(),
            None => format!("ended {}", row.outcome.replace('-', " ")),
        };
        // Figures differ from run to run; the words before the first of them do not.
        let kind: String = what.chars().take_while(|c| !c.is_ascii_digit()).collect();
        match found.iter_mut().find(|(known, ..)| *known == kind) {
            Some((_, _, more)) => *more += 1,
            None => found.push((kind, format!("{}: {what}", compact(&row.parameters)), 0)),
        }
    }
    let mut out = String::new();
    for (_, first, more) in found {
        let more = match more {
            0 => String::new(),
            1 => "; one more like this".to_owned(),
            n => format!("; {n} more like this"),
        };
        out += &format!("<li>{}{more}</li>\n", escape(&first));
    }
    if out.is_empty() {
        return out;
    }
    format!("<ul>\n{out}</ul>\n")
}

fn map(scales: &Scales, rows: &[&Row]) -> String {
    let mut cells = Vec::new();
    for row in rows {
        cells.extend(row.at.map(|at| Cell {
            at,
            outcome: &row.outcome,
            holds: row.holds,
        }));
    }
    let good = rows.iter().filter(|r| r.holds).count();
    let caption = format!(
        "How each run ended. {good} of {} end as they may and keep their bounds; the others are framed and crossed.",
        rows.len()
    );
    figure(&svg(scales, &cells), &caption)
}

fn table(rows: &[&Row]) -> String {
    let mut table = Rows::new(&[
        "Run",
        "Changed",
        "Ended",
        "May end",
        "Limits",
        "Conservation",
        "Verdict",
    ]);
    for row in rows {
        let word = if row.holds { "as it may" } else { "fails" };
        let mut judged = verdict(word, Some(row.holds));
        for what in &row.broken {
            judged += &format!("<br><small>{}</small>", escape(what));
        }
        table.row([
            escape(&row.name),
            format!("<code>{}</code>", escape(&compact(&row.parameters))),
            escape(&row.outcome.replace('-', " ")),
            escape(&row.expected.join(" or ").replace('-', " ")),
            totals(row.limits.as_deref()),
            totals(row.conservation.as_deref()),
            judged,
        ]);
    }
    table.render()
}

/// The leaves of a patch as `key.key = value`.
fn compact(value: &Value) -> String {
    fn walk(value: &Value, path: &str, out: &mut Vec<String>) {
        match value {
            Value::Object(map) => {
                for (key, inner) in map {
                    let longer = if path.is_empty() {
                        key.clone()
                    } else {
                        format!("{path}.{key}")
                    };
                    walk(inner, &longer, out);
                }
            }
            Value::String(text) => out.push(format!("{path} = {text}")),
            leaf => out.push(format!("{path} = {leaf}")),
        }
    }
    let mut out = Vec::new();
    if !value.is_null() {
        walk(value, "", &mut out);
    }
    out.join(", ")
}

fn totals(totals: Option<&[Total]>) -> String {
    let one = |t: &Total| {
        let unit = if t.unit == "1" { "" } else { &t.unit };
        format!(
            "{} {} {}",
            escape(&t.name.replace('_', " ")),
            digits(t.value),
            escape(unit)
        )
        .trim_end()
        .to_owned()
    };
    totals
        .unwrap_or_default()
        .iter()
        .map(one)
        .collect::<Vec<_>>()
        .join("<br>")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_patch_reads_as_its_leaves() {
        let patch = serde_json::json!({"time": {"step_s": 1e-3}, "heat": null});
        assert_eq!(compact(&patch), "time.step_s = 0.001, heat = null");
    }

    #[test]
    fn a_grid_is_a_map_and_what_is_broken_is_told() {
        let record: Record = serde_json::from_value(serde_json::json!({"case": "c", "tool": "t", "holds": false,
            "map": {"x": {"name": "a", "values": ["1", "2"]}},
            "runs": [
                {"name": "x0-y0", "at": [0, 0], "parameters": {"a": "1"}, "outcome": "stable", "holds": true},
                {"name": "x1-y0", "at": [1, 0], "parameters": {"a": "2"}, "outcome": "stable", "holds": false,
                 "broken": ["temperature is 2"]}]}))
        .unwrap();
        assert!(
            wrong(&record.runs.iter().collect::<Vec<_>>()).contains("a = 2: temperature is 2</li>")
        );
        let html = section(&record);
        assert!(html.contains("<svg") && html.contains("1 of 2 end as they may"));
        assert!(html.contains("temperature is 2") && html.contains("All 2 runs"));
    }

    #[test]
    fn a_refused_run_without_limits_is_a_row() {
        let record: Record = serde_json::from_value(serde_json::json!({"case": "c", "tool": "t", "holds": true, "runs": [
            {"name": "r", "parameters": {"a": 1}, "outcome": "refused", "expected": ["refused"], "limits": null,
             "conservation": null, "message": "too large", "holds": true}]}))
        .unwrap();
        let html = section(&record);
        assert!(html.contains("refused") && html.contains("too large"));
    }
}
