//! Temperatures of monitors over time, in every run and in all of them.

use artefact::Record;
use run::Failure;

use super::Run;
use crate::html::{figure, side_by_side};
use crate::plot::{Line, Plot};

/// Records of a channel over time.
pub(super) type Series = Vec<(f64, Record)>;

/// The records of a channel; none where there is none, or only one of them.
pub(super) fn series(run: &Run, channel: &str) -> Result<Series, Failure> {
    if !run.reader.has(channel) {
        return Ok(Vec::new());
    }
    Ok(run.reader.records(channel)?)
}

/// The points of a curve.
pub(super) fn curve(series: &Series, name: &str) -> Vec<[f64; 2]> {
    let at = |(t, r): &(f64, Record)| r.get(name).ok().map(|v| [*t, v]);
    series.iter().filter_map(at).collect()
}

/// The section; nothing where nothing was written over time.
pub(super) fn section(runs: &[Run]) -> Result<String, Failure> {
    let empty = || Plot::new("time [s]", "temperature [K]");
    let mut all = empty();
    let mut figures = Vec::new();
    for run in runs {
        let series = series(run, "/monitors")?;
        let (Some((_, first)), true) = (series.first(), series.len() > 1) else {
            continue;
        };
        let mut own = empty();
        for entry in &first.values {
            let points = curve(&series, &entry.name);
            all.add(Line::new(&run.own(runs, &entry.name), points.clone()));
            own.add(Line::new(&entry.name, points));
        }
        let caption = format!("{}: the temperature of its monitors.", run.name);
        figures.push(figure(&own.html(), &caption));
    }
    if all.is_empty() {
        return Ok(String::new());
    }
    if figures.len() < 2 {
        let caption = "The temperature of the monitors.";
        return Ok(figure(&all.html(), caption));
    }
    let whole = figure(&all.html(), "The monitors of all runs.");
    Ok(whole + &side_by_side(&figures))
}
