//! Fields of probes over time.

use artefact::Record;
use run::Failure;

use super::Run;
use crate::field::columns::{Columns, QUANTITIES, prefixed};
use crate::html::{figure, side_by_side};
use crate::plot::{Line, Plot};

/// Channel of probes.
const PROBES: &str = "/probes";

/// The section; nothing without probes or where there is no time.
pub(super) fn section(run: &Run) -> Result<String, Failure> {
    if run.reader.count(PROBES) < 2 {
        return Ok(String::new());
    }
    let series = run.reader.records(PROBES)?;
    let times: Vec<f64> = series.iter().map(|(t, _)| *t).collect();
    let last = times.iter().copied().fold(0.0, f64::max);
    let (unit, scale) = prefixed("s", last);
    let mut figures = Vec::new();
    for quantity in &QUANTITIES {
        let probes: Vec<(String, Columns)> = names(&series)
            .into_iter()
            .map(|name| (name.clone(), columns(&series, &name)))
            .collect();
        let found = |c: &Columns| c.values(quantity);
        let all = probes.iter().filter_map(|(_, c)| found(c)).flatten();
        let most = all.map(f64::abs).fold(0.0, f64::max);
        let Some(own) = probes.iter().find_map(|(_, c)| c.unit(quantity)) else {
            continue;
        };
        let (own, factor) = prefixed(own, most);
        let mut plot = Plot::new(
            &format!("time [{unit}]"),
            &format!("{} [{own}]", quantity.title),
        );
        for (name, columns) in &probes {
            let values = found(columns).unwrap_or_default();
            let each = times.iter().zip(&values);
            plot.add(Line::new(
                name,
                each.map(|(t, v)| [scale * t, factor * v]).collect(),
            ));
        }
        if !plot.is_empty() {
            let words = format!("At the probes over time: {}.", quantity.title);
            figures.push(figure(&plot.html(), &words));
        }
    }
    Ok(side_by_side(&figures))
}

/// Names of probes: what stands before the first point of each entry.
fn names(series: &[(f64, Record)]) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for entry in series.first().iter().flat_map(|(_, r)| &r.values) {
        if let Some((name, _)) = entry.name.rsplit_once('.')
            && !found.iter().any(|f| f == name)
        {
            found.push(name.to_owned());
        }
    }
    found
}

/// The fields of a probe, one row for each instant.
fn columns(series: &[(f64, Record)], probe: &str) -> Columns {
    let entries = series
        .first()
        .iter()
        .flat_map(|(_, r)| &r.values)
        .collect::<Vec<_>>();
    let own = entries.iter().filter_map(|e| {
        let rest = e.name.strip_prefix(probe)?.strip_prefix('.')?;
        let values = series
            .iter()
            .map(|(_, r)| r.get(&e.name).unwrap_or(f64::NAN));
        Some((rest.to_owned(), e.unit.clone(), values.collect()))
    });
    Columns::of(own.collect())
}
