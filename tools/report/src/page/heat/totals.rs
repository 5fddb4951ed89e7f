//! What every run told at its end, run beside run.

use crate::html::{Rows, escape};
use crate::page::{Named, grouped};
use crate::records::{Total, figure as digits};

/// The table; nothing without records.
pub(in crate::page) fn table(records: &[Named]) -> String {
    let mut names: Vec<(&str, &str)> = Vec::new();
    for total in records.iter().flat_map(|r| &r.1.closing) {
        let name = (total.name.as_str(), total.unit.as_str());
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let mut head = vec!["At the end".to_owned()];
    head.extend(records.iter().map(|r| format!("#{}", r.0)));
    head.push("Unit".to_owned());
    let mut table = Rows::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
    for (name, unit) in names {
        let value = |record: &Named| {
            let found = record.1.closing.iter().find(|t| t.name == name);
            found.map_or_else(|| "\u{2013}".to_owned(), shown)
        };
        let mut cells = vec![escape(&name.replace('_', " "))];
        cells.extend(records.iter().map(value));
        cells.push(escape(if unit == "1" { "" } else { unit }));
        table.row(cells);
    }
    table.render()
}

/// A count without decimals, another value with a sensible number of digits.
fn shown(total: &Total) -> String {
    let value = total.value;
    let count = total.unit == "1" && (0.0..1e15).contains(&value) && value.fract() <= 0.0;
    if count {
        grouped(value as usize)
    } else {
        digits(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::records::RunRecord;

    #[test]
    fn runs_stand_beside_each_other_and_counts_are_whole() {
        let record = |name: &str, totals: &[(&str, f64, &str)]| {
            let total = |(name, value, unit): &(&str, f64, &str)| Total {
                name: (*name).to_owned(),
                value: *value,
                unit: (*unit).to_owned(),
            };
            let closing = totals.iter().map(total).collect();
            let record = RunRecord {
                closing,
                ..RunRecord::default()
            };
            (name.to_owned(), record)
        };
        let html = table(&[
            record("cold", &[("newton_steps", 265.0, "1"), ("heat", -1.5, "J")]),
            record("hot", &[("newton_steps", 1254.0, "1")]),
        ]);
        assert!(html.contains(">cold<") && html.contains(">hot<"));
        assert!(html.contains(">newton steps</td><td class=\"number\">265</td>"));
        assert!(html.contains("1\u{2009}254") && html.contains("\u{2212}1.500"));
        assert_eq!(html.matches("<tr>").count(), 3);
    }
}
