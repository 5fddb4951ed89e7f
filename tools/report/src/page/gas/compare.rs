//! A gas against published tables and values.

use super::curves::caption;
use super::{Table, percent, words};
use crate::gas::Gas;
use crate::gas::reference::{Published, Reference};
use crate::html::{Rows, escape, figure, paragraph, side_by_side, verdict};
use crate::plot::{Line, Plot};
use crate::records::figure as digits;

/// The section.
pub(super) fn section(table: &Table, reference: &Reference) -> String {
    let mut out = paragraph(&reference.title);
    out += &values(&table.gas, reference);
    for published in &reference.tables {
        out += &one(&table.gas, &table.name, published);
    }
    out
}

/// A judged word.
fn judged(holds: bool) -> String {
    verdict(if holds { "holds" } else { "missed" }, Some(holds))
}

fn values(gas: &Gas, reference: &Reference) -> String {
    let mut rows = Rows::new(&[
        "Value",
        "#Ours",
        "#Published",
        "#Off",
        "#Allowed",
        "",
        "Source",
    ]);
    for value in &reference.values {
        let Some((ours, at)) = value.of(gas) else {
            let none = || "\u{2013}".to_owned();
            rows.row([
                escape(&words(&value.column)),
                none(),
                digits(value.value),
                none(),
                format!("{:.0} %", 100.0 * value.tolerance),
                verdict("not judged: not in the table", None),
                escape(&value.source),
            ]);
            continue;
        };
        let off = ours / value.value - 1.0;
        let what = if value.peak { "peak of " } else { "" };
        rows.row([
            escape(&format!("{what}{}, {at:.0} K", words(&value.column))),
            digits(ours),
            digits(value.value),
            percent(off),
            format!("{:.0} %", 100.0 * value.tolerance),
            judged(off.abs() <= value.tolerance),
            escape(&value.source),
        ]);
    }
    rows.render()
}

fn one(gas: &Gas, name: &str, published: &Published) -> String {
    let mut out = paragraph(&published.source);
    let mut figures = Vec::new();
    for column in published.properties() {
        let title = format!("{} [{}]", words(&column.name), column.unit);
        let rows = published.rows(&column.name);
        let mut plot = Plot::new("temperature [K]", &title);
        let last = rows.last().map_or(0.0, |row| row[0]);
        let mut ours = gas.line(&gas.table, &column.name, 0, f64::NEG_INFINITY);
        ours.retain(|point| point[0] <= last);
        plot.add(Line::new(name, ours));
        plot.add(Line::new("published", rows).dotted());
        figures.push(figure(&plot.html(), &caption(&column.name)));
    }
    out += &side_by_side(&figures);
    out + &bounds(gas, published) + &whole(gas, published)
}

fn bounds(gas: &Gas, published: &Published) -> String {
    let mut rows = Rows::new(&[
        "Column",
        "#From [K]",
        "#To [K]",
        "#Worst",
        "#At [K]",
        "#Allowed",
        "#Mean",
        "#Allowed",
        "",
    ]);
    for bound in &published.bounds {
        let range = [bound.from_k, bound.to_k];
        let none = || "\u{2013}".to_owned();
        let found = published.deviation(gas, &bound.column, range);
        let holds = found.is_some_and(|found| {
            found.worst.abs() <= bound.worst && bound.mean.is_none_or(|mean| found.mean <= mean)
        });
        let word = match published.is_met(gas, &bound.column, range) {
            true => judged(holds),
            false if found.is_some() && !holds => judged(holds),
            false => verdict("not judged: the table does not reach as far", None),
        };
        rows.row([
            escape(&words(&bound.column)),
            digits(bound.from_k),
            digits(bound.to_k),
            found.map_or_else(none, |found| percent(found.worst)),
            found.map_or_else(none, |found| format!("{:.0}", found.at)),
            format!("{:.0} %", 100.0 * bound.worst),
            found.map_or_else(none, |found| format!("{:.2} %", 100.0 * found.mean)),
            bound.mean.map_or_else(
                || "\u{2013}".to_owned(),
                |mean| format!("{:.0} %", 100.0 * mean),
            ),
            word,
        ]);
    }
    rows.render()
}

/// Ratios of what is not judged, over the whole range.
fn whole(gas: &Gas, published: &Published) -> String {
    let free = |name: &str| published.bounds.iter().all(|bound| bound.column != name);
    let mut rows = Rows::new(&["Column", "#At [K]", "#Ours / published"]);
    for column in published.properties().filter(|c| free(&c.name)) {
        let all = published.rows(&column.name);
        for [t, value] in all.iter().step_by((all.len() / 8).max(1)) {
            if let Some(ours) = gas.at(&column.name, 0, *t) {
                rows.row([
                    escape(&words(&column.name)),
                    format!("{t:.0}"),
                    format!("{:.2}", ours / value),
                ]);
            }
        }
    }
    rows.render()
}
