//! What machines do to runs: kills, full disks, second writers, places of others.

use serde::Deserialize;

use crate::html::{Rows, escape, verdict};

/// The table of `make faults`.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Table {
    seed: u64,
    rows: Vec<Row>,
    holds: bool,
}

/// A fault, who met it, and what came of it.
#[derive(Debug, Clone, Deserialize)]
struct Row {
    fault: String,
    who: String,
    times: u64,
    expected: String,
    found: String,
    holds: Option<bool>,
}

/// All faults, those of a kind together.
pub(super) fn section(table: &Table) -> String {
    let mut rows = table.rows.clone();
    rows.sort_by(|a, b| a.fault.cmp(&b.fault));
    let mut shown = Rows::new(&[
        "Fault",
        "Stage or study",
        "#Times",
        "Must be",
        "Found",
        "Holds",
    ]);
    for row in &rows {
        let word = match row.holds {
            Some(true) => "holds",
            Some(false) => "fails",
            None => "not judged",
        };
        shown.row([
            escape(&row.fault),
            escape(&row.who),
            row.times.to_string(),
            escape(&row.expected),
            escape(&row.found),
            verdict(word, row.holds),
        ]);
    }
    let killed = rows.iter().filter(|row| row.fault.starts_with("killed"));
    let killed: u64 = killed.map(|row| row.times).sum();
    let word = if table.holds {
        "all holds"
    } else {
        "not all holds"
    };
    let lead = format!(
        "<p>{}: {killed} kills at random moments (seed {}), and what else machines do.</p>\n",
        verdict(word, Some(table.holds)),
        table.seed
    );
    lead + &shown.render()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_fault_has_a_row_and_what_was_not_tried_is_not_judged() {
        let table = serde_json::from_str::<Table>(
            r#"{"kind": "faults", "version": "1.0", "seed": 1, "holds": true, "rows": [
            {"fault": "killed at a random moment", "who": "avg", "times": 30, "expected": "a", "found": "b", "holds": true},
            {"fault": "a folder of another user", "who": "avg", "times": 0, "expected": "c", "found": "d", "holds": null}]}"#,
        );
        let html = section(&table.unwrap());
        for word in [
            "30 kills at random moments (seed 1)",
            "not judged",
            "all holds",
        ] {
            assert!(html.contains(word), "{word}: {html}");
        }
    }
}
