//! What a run spent its time on, what it held in memory, and what it left out.

use std::collections::BTreeMap;

use run::duration;

use crate::html::{Rows, escape, percent};
use crate::records::{LeftOut, Memory, RunRecord, Spent, bytes};

/// Stages shorter than this part of a run are not named.
const SHOWN: f64 = 0.01;

const HEAD: [&str; 6] = [
    "",
    "#Time",
    "#Peak memory",
    "Time went to",
    "Memory went to",
    "Left out",
];

/// A run that is accounted for.
#[derive(Debug, Clone)]
pub(super) struct Cost<'a> {
    /// Its name in the table.
    pub(super) name: String,
    pub(super) tool: &'a str,
    pub(super) time_s: f64,
    pub(super) peak_memory_bytes: Option<u64>,
    pub(super) stages: &'a [Spent],
    pub(super) memory: &'a [Memory],
    pub(super) left_out: &'a [LeftOut],
}

impl<'a> Cost<'a> {
    /// Of a run record.
    pub(super) fn of(record: &'a RunRecord) -> Self {
        Self {
            name: record.tool.clone(),
            tool: &record.tool,
            time_s: record.wall_s,
            peak_memory_bytes: record.peak_memory_bytes,
            stages: &record.stages,
            memory: &record.memory,
            left_out: &record.left_out,
        }
    }
}

/// What physics costs where it is there but idle: ratios of time per step and of peak memory by
/// program and name, from `make bench`.
#[derive(Debug, Clone, Default)]
pub(super) struct Prices(BTreeMap<(String, String), [Option<f64>; 2]>);

impl Prices {
    pub(super) fn put(&mut self, tool: &str, physics: &str, ratios: [Option<f64>; 2]) {
        self.0.insert((tool.to_owned(), physics.to_owned()), ratios);
    }

    /// The price of what was left out, in words; nothing where it was not measured.
    fn of(&self, tool: &str, physics: &str) -> String {
        let key = (tool.to_owned(), physics.to_owned());
        let Some([time, memory]) = self.0.get(&key) else {
            return String::new();
        };
        let part = |ratio: &Option<f64>, what: &str| {
            ratio.map(|r| format!("{} {what}", percent(r - 1.0, 1)))
        };
        let parts = [part(time, "time"), part(memory, "memory")];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        format!(" <small>(would cost {} if idle)</small>", parts.join(", "))
    }
}

/// A row per run, and above it what all of several runs left out. Nothing without runs.
pub(super) fn table(first: &str, costs: &[Cost], prices: &Prices) -> String {
    let shared = |name: &str| {
        let has = |cost: &Cost| cost.left_out.iter().any(|absent| absent.name == name);
        costs.len() > 1 && costs.iter().all(has)
    };
    let own = |cost: &Cost| cost.left_out.iter().any(|absent| !shared(&absent.name));
    let alike = costs.len() > 1 && !costs.iter().any(own);
    let mut table = Rows::new(if alike { &HEAD[..5] } else { &HEAD });
    table.rename(0, first);
    let common = costs.first().map(|cost| left_out(cost, prices, &shared));
    for cost in costs {
        let mut cells = vec![
            escape(&cost.name),
            duration(cost.time_s),
            cost.peak_memory_bytes
                .map_or_else(|| "\u{2013}".to_owned(), bytes),
            stages(cost.stages),
            memory(cost.memory),
        ];
        if !alike {
            cells.push(left_out(cost, prices, &|name| !shared(name)));
        }
        table.row(cells);
    }
    match common.filter(|common| !common.is_empty()) {
        Some(common) => format!("<p>All left out {common}.</p>\n") + &table.render(),
        None => table.render(),
    }
}

fn stages(stages: &[Spent]) -> String {
    let mut named: Vec<&Spent> = stages.iter().filter(|s| s.share >= SHOWN).collect();
    named.sort_by(|a, b| b.share.total_cmp(&a.share));
    let one = |s: &&Spent| format!("{}&nbsp;{:.0}&nbsp;%", escape(&s.name), 100.0 * s.share);
    named.iter().map(one).collect::<Vec<_>>().join(", ")
}

fn memory(parts: &[Memory]) -> String {
    let mut named: Vec<&Memory> = parts.iter().filter(|p| p.bytes > 0).collect();
    named.sort_by_key(|part| std::cmp::Reverse(part.bytes));
    let one = |p: &&Memory| {
        format!(
            "{}&nbsp;{}",
            escape(&p.name),
            bytes(p.bytes).replace(' ', "&nbsp;")
        )
    };
    named.iter().take(4).map(one).collect::<Vec<_>>().join(", ")
}

/// What a run left out, of the names that are wanted.
fn left_out(cost: &Cost, prices: &Prices, wanted: &dyn Fn(&str) -> bool) -> String {
    let one = |absent: &LeftOut| {
        format!(
            "<span title=\"{}\">{}</span>{}",
            escape(&absent.why),
            escape(&absent.name.replace('_', " ")),
            prices.of(cost.tool, &absent.name)
        )
    };
    let named = cost.left_out.iter().filter(|absent| wanted(&absent.name));
    named.map(one).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_left_out_stands_with_its_price() {
        let record: RunRecord = serde_json::from_str(
            r#"{"tool": "t", "wall_s": 2, "peak_memory_bytes": 3000000,
                "stages": [{"name": "a", "share": 0.004}, {"name": "b", "share": 0.9}],
                "left_out": [{"name": "tension", "why": "no key"}, {"name": "heat", "why": "none"}]}"#,
        )
        .unwrap();
        let mut prices = Prices::default();
        prices.put("t", "tension", [Some(1.25), Some(0.99)]);
        prices.put("other", "heat", [Some(2.0), None]);
        let html = table("Run", &[Cost::of(&record)], &prices);
        assert!(html.contains("+25.0 % time, \u{2212}1.0 % memory"));
        assert!(html.contains(">heat</span></td>") && html.contains("3.0 MB"));
        assert!(html.contains("b&nbsp;90&nbsp;%") && !html.contains("a&nbsp;0"));
        // What all left out stands once.
        let html = table("Run", &[Cost::of(&record), Cost::of(&record)], &prices);
        assert_eq!(html.matches("tension").count(), 1);
        assert!(!html.contains("<th>Left out"));
        // What only one left out stands in its row.
        let mut less = record.clone();
        less.left_out.pop();
        let html = table("Run", &[Cost::of(&record), Cost::of(&less)], &prices);
        assert!(html.contains("<p>All left out <span title=\"no key\">tension"));
        assert!(html.contains("<th>Left out") && html.contains("<td><span title=\"none\">heat"));
    }
}
