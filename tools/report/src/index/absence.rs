//! Physics that is absent: what it would cost idle, and that it costs nothing.

use serde::Deserialize;

use super::cost::Prices;
use crate::html::{Rows, escape, paragraph, verdict};
use crate::records::{bytes, figure as digits};

/// A record of absent physics of `make bench`.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Record {
    physics: String,
    tool: String,
    name: String,
    figures: Vec<Figure>,
    time_ratio: Option<f64>,
    memory_ratio: Option<f64>,
    claims: Vec<Claim>,
}

/// One of the three runs.
#[derive(Debug, Clone, Deserialize)]
struct Figure {
    step_least_ms: f64,
    #[serde(default)]
    peak_memory_bytes: u64,
}

/// What is claimed.
#[derive(Debug, Clone, Deserialize)]
struct Claim {
    what: String,
    holds: bool,
}

/// What each physics costs idle.
pub(super) fn prices(records: &[Record]) -> Prices {
    let mut prices = Prices::default();
    for record in records {
        prices.put(
            &record.tool,
            &record.physics,
            [record.time_ratio, record.memory_ratio],
        );
    }
    prices
}

/// All pairs in one table; nothing without records.
pub(super) fn section(records: &[Record]) -> String {
    if records.is_empty() {
        return String::new();
    }
    let mut table = Rows::new(&[
        "Physics",
        "#Step",
        "#idle",
        "#removed",
        "#Ratio",
        "#Memory",
        "#idle",
        "#Ratio",
        "Absent, it costs nothing",
    ]);
    for record in records {
        let step = |i: usize| {
            let figure = record.figures.get(i);
            figure.map_or_else(String::new, |f| format!("{} ms", digits(f.step_least_ms)))
        };
        let memory = |i: usize| {
            let figure = record.figures.get(i);
            figure.map_or_else(String::new, |f| bytes(f.peak_memory_bytes))
        };
        let ratio = |r: Option<f64>| r.map_or_else(String::new, |r| format!("\u{d7} {r:.2}"));
        table.row([
            format!(
                "{}<br><small>{}: {}</small>",
                escape(&record.physics),
                escape(&record.tool),
                escape(&record.name)
            ),
            step(0),
            step(1),
            step(2),
            ratio(record.time_ratio),
            memory(0),
            memory(1),
            ratio(record.memory_ratio),
            judged(&record.claims),
        ]);
    }
    let words = "The same scene without the physics, with it but of no strength (idle), and with it taken out again by \
                 a patch (removed): least time per step over turns on one thread, and peak memory. The ratios, idle \
                 over without, are the prices of what studies leave out.";
    paragraph(words) + &table.render()
}

/// One word where all holds, and what does not where it does not.
fn judged(claims: &[Claim]) -> String {
    let broken: Vec<&Claim> = claims.iter().filter(|claim| !claim.holds).collect();
    if broken.is_empty() {
        let all: Vec<&str> = claims.iter().map(|claim| claim.what.as_str()).collect();
        return format!(
            "<span title=\"{}\">{}</span>",
            escape(&all.join("; ")),
            verdict(&format!("{} of {0} hold", claims.len()), Some(true))
        );
    }
    let one = |claim: &&Claim| format!("<br><small>not so: {}</small>", escape(&claim.what));
    let told: String = broken.iter().map(one).collect();
    verdict("no", Some(false)) + &told
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_that_fails_is_spelt_out() {
        let record = |holds: bool| -> Record {
            serde_json::from_value(serde_json::json!({"physics": "tension", "tool": "t", "name": "pair",
                "figures": [{"step_least_ms": 2.0, "peak_memory_bytes": 1000000}, {"step_least_ms": 3.0},
                            {"step_least_ms": 2.0}],
                "time_ratio": 1.5, "memory_ratio": 1.1,
                "claims": [{"what": "same bytes", "holds": holds}, {"what": "told", "holds": true}]}))
            .unwrap()
        };
        let html = section(&[record(true)]);
        assert!(html.contains("2 of 2 hold") && html.contains("\u{d7} 1.50"));
        assert!(section(&[record(false)]).contains("not so: same bytes"));
        assert!(section(&[]).is_empty());
    }
}
