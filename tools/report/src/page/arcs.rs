//! Arcs beside each other.

use artefact::{Reader, Record};
use run::Failure;

use super::balance::bare;
use crate::html::{Rows, escape, figure, side_by_side};
use crate::plot::{Line, Plot};
use crate::records::figure as digits;

/// The balance of each arc that has one.
pub(super) fn balances(arcs: &[(String, Reader)]) -> Result<Vec<(String, Record)>, Failure> {
    let mut all = Vec::new();
    for (name, reader) in arcs.iter().filter(|(_, r)| r.has("/balance")) {
        all.push((name.clone(), reader.record("/balance")?));
    }
    Ok(all)
}

/// What is drawn over the current: value, axis, factor to the unit shown, caption.
const CURVES: [(&str, &str, f64, &str); 3] = [
    (
        "voltage_v",
        "voltage [V]",
        1.0,
        "Voltage of the arc over its current.",
    ),
    (
        "base_total_w",
        "heat of the base metal [kW]",
        1e-3,
        "What the base metal takes up, without drops.",
    ),
    (
        "wire_feed_m_s",
        "wire feed [m/min]",
        60.0,
        "How fast the wire melts.",
    ),
];

/// The section: every value of the balances, an arc to a column, and what changes with the current.
pub(super) fn section(arcs: &[(String, Record)]) -> String {
    let mut titles = vec!["Balance".to_owned()];
    titles.extend(arcs.iter().map(|(name, _)| format!("#{name}")));
    titles.push("Unit".to_owned());
    let titles: Vec<&str> = titles.iter().map(String::as_str).collect();
    let mut table = Rows::new(&titles);
    let mut named: Vec<(&str, &str)> = Vec::new();
    for entry in arcs.iter().flat_map(|(_, record)| &record.values) {
        if !named.iter().any(|(name, _)| *name == entry.name) {
            named.push((&entry.name, &entry.unit));
        }
    }
    for (name, unit) in named {
        let mut row = vec![escape(&bare(name, unit).replace('_', " "))];
        for (_, record) in arcs {
            row.push(
                record
                    .get(name)
                    .map_or_else(|_| "\u{2013}".to_owned(), digits),
            );
        }
        row.push(escape(if unit == "1" { "" } else { unit }));
        table.row(row);
    }
    let figures: Vec<String> = CURVES
        .iter()
        .map(|(name, axis, factor, caption)| (curve(arcs, name, axis, *factor), caption))
        .filter(|(plot, _)| !plot.is_empty())
        .map(|(plot, caption)| figure(&plot.html(), caption))
        .collect();
    side_by_side(&figures) + &table.render()
}

/// A value over the current, where currents differ.
fn curve(arcs: &[(String, Record)], name: &str, axis: &str, factor: f64) -> Plot {
    let mut plot = Plot::new("current [A]", axis);
    let at = |record: &Record| {
        let current = record.get("current_a").ok()?;
        Some([current, factor * record.get(name).ok()?])
    };
    let mut points: Vec<[f64; 2]> = arcs.iter().filter_map(|(_, r)| at(r)).collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points.dedup_by(|a, b| (a[0] - b[0]).abs() < 1e-9);
    if points.len() > 2 {
        plot.add(Line::new("", points));
    }
    plot
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sweep_is_drawn_and_two_polarities_are_not() {
        let arc = |current: f64| {
            let record = Record::new().with("current_a", "A", current);
            (
                format!("{current} A"),
                record.with("voltage_v", "V", 20.0 + 0.01 * current),
            )
        };
        let sweep: Vec<_> = [100.0, 300.0, 200.0].map(arc).into();
        let html = section(&sweep);
        assert!(html.contains("<svg") && html.contains("200 A"));
        let two: Vec<_> = [600.0, -600.0].map(arc).into();
        assert!(!section(&two).contains("<svg"));
    }
}
