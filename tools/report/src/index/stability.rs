//! Extreme cases: how each run ended, and whether it may end so.

use serde::Deserialize;
use serde_json::Value;

use super::heading;
use crate::html::{Rows, escape, paragraph, verdict};
use crate::records::{Total, figure as digits};

/// One run.
#[derive(Debug, Clone, Deserialize)]
struct Row {
    name: String,
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
    holds: bool,
}

/// A record of `make stability`.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Record {
    case: String,
    tool: String,
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

/// The runs of a case.
pub(super) fn section(record: &Record) -> String {
    let mut table = Rows::new(&[
        "Run",
        "Changed",
        "Ended",
        "May end",
        "Limits",
        "Conservation",
        "Verdict",
    ]);
    for row in &record.runs {
        let word = if row.holds { "as it may" } else { "fails" };
        table.row([
            escape(&row.name),
            format!("<code>{}</code>", escape(&compact(&row.parameters))),
            escape(&row.outcome.replace('-', " ")),
            escape(&row.expected.join(" or ").replace('-', " ")),
            totals(row.limits.as_deref()),
            totals(row.conservation.as_deref()),
            verdict(word, Some(row.holds)),
        ]);
    }
    let mut out = heading(&record.case, record.holds, ("as it may", "fails"));
    out += &paragraph(&format!("Program {}.", record.tool));
    out += &table.render();
    for row in record
        .runs
        .iter()
        .filter(|r| !r.message.is_empty() && r.outcome != "stable")
    {
        out += &format!(
            "<details>\n<summary>What it said: {}</summary>\n<pre>{}</pre>\n</details>\n",
            escape(&row.name),
            escape(&row.message)
        );
    }
    out
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
    fn a_refused_run_without_limits_is_a_row() {
        let record: Record = serde_json::from_value(serde_json::json!({"case": "c", "tool": "t", "holds": true, "runs": [
            {"name": "r", "parameters": {"a": 1}, "outcome": "refused", "expected": ["refused"], "limits": null,
             "conservation": null, "message": "too large", "holds": true}]}))
        .unwrap();
        let html = section(&record);
        assert!(html.contains("refused") && html.contains("too large"));
    }
}
