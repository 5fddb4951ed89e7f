//! Curves of several runs on one plot: over time, along the weld, along what a table runs over.

use artefact::{RECORD, Record, TABLE, Table};
use run::Failure;

use super::{Member, Stage};
use crate::field::columns::prefixed;
use crate::html::{escape, figure, side_by_side};
use crate::page::arc::reach;
use crate::page::balance::bare;
use crate::plot::{Line, Plot};

/// Most points of a line.
const MOST: usize = 300;
/// Measures along the weld.
const ALONG: [&str; 4] = ["penetration", "fused_width", "reinforcement", "bead_width"];

/// Units that take a prefix; others have a power, or one already.
const PREFIXED: [&str; 11] = [
    "m", "s", "J", "W", "A", "V", "N", "Pa", "W/m2", "A/m2", "N/m3",
];

/// A curve of a run: points of what it runs over and its value, in SI.
type Curve = (String, Vec<[f64; 2]>);

/// A quantity of several runs.
struct Family {
    channel: String,
    over: (String, String),
    name: String,
    unit: String,
    curves: Vec<Curve>,
}

/// The plots of a stage; nothing where no run has a curve of it.
///
/// # Errors
/// When a message cannot be read.
pub(in crate::page) fn section(members: &[Member], stage: &str) -> Result<String, Failure> {
    let mut families: Vec<Family> = Vec::new();
    for member in members {
        if let Some(stage) = member.stage(stage) {
            along(&member.name, stage, &mut families);
            records(&member.name, stage, &mut families)?;
            tables(&member.name, stage, &mut families)?;
        }
    }
    families.retain(tells);
    let mut out = String::new();
    let channels = families.iter().map(|f| f.channel.clone());
    let mut channels: Vec<String> = channels.collect();
    channels.dedup();
    for channel in channels {
        let own = families.iter().filter(|f| f.channel == channel);
        let plots: Vec<String> = own.map(drawn).collect();
        let name = channel.trim_start_matches('/').replace('_', " ");
        out += &format!(
            "<h3>{}</h3>\n{}",
            escape(&format!("{stage}: {name}")),
            side_by_side(&plots)
        );
    }
    Ok(out)
}

/// Adds a curve to the family of its quantity.
fn add(families: &mut Vec<Family>, like: Family) {
    let same = |f: &&mut Family| {
        (&f.channel, &f.name, &f.unit, &f.over)
            == (&like.channel, &like.name, &like.unit, &like.over)
    };
    match families.iter_mut().find(same) {
        Some(family) => family.curves.extend(like.curves),
        None => families.push(like),
    }
}

/// Whether anything changes along a curve, or from run to run.
fn tells(family: &Family) -> bool {
    let mut values = family
        .curves
        .iter()
        .flat_map(|(_, points)| points)
        .map(|p| p[1]);
    let first = values.next().unwrap_or(0.0);
    values.any(|v| (v - first).abs() > 1e-12 * first.abs())
}

fn drawn(family: &Family) -> String {
    let largest = |k: usize| {
        let all = family.curves.iter().flat_map(|(_, points)| points);
        all.map(|p| p[k].abs())
            .filter(|v| v.is_finite())
            .fold(0.0, f64::max)
    };
    let (name, unit) = &family.over;
    let scaled = |unit: &str, most: f64| match unit {
        "" | "1" => (String::new(), 1.0),
        plain if PREFIXED.contains(&plain) => {
            let (shown, factor) = prefixed(plain, most);
            (format!(" [{shown}]"), factor)
        }
        other => (format!(" [{other}]"), 1.0),
    };
    let (x_unit, x) = scaled(unit, largest(0));
    let (y_unit, y) = scaled(&family.unit, largest(1));
    let words = bare(&family.name, &family.unit).replace('_', " ");
    let over = bare(name, unit).replace('_', " ");
    let mut plot = Plot::new(&format!("{over}{x_unit}"), &format!("{words}{y_unit}"));
    for (run, points) in &family.curves {
        let points = points.iter().map(|p| [x * p[0], y * p[1]]);
        plot.add(Line::new(run, points.collect()));
    }
    figure(&plot.html(), &format!("{words} over {over}."))
}

/// No more points than are seen, with every peak: of each block of neighbours the first, the least and the greatest in their order.
fn thinned(points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    if points.len() <= MOST {
        return points;
    }
    let last = points.len() - 1;
    let mut kept = Vec::new();
    for (block, own) in points.chunks(points.len().div_ceil(MOST / 3)).enumerate() {
        let by = |a: &&[f64; 2], b: &&[f64; 2]| a[1].total_cmp(&b[1]);
        let place = |found: Option<&[f64; 2]>| own.iter().position(|p| Some(p) == found);
        let mut places = vec![0];
        places.extend(place(own.iter().min_by(by)));
        places.extend(place(own.iter().max_by(by)));
        let end = block * points.len().div_ceil(MOST / 3) + own.len() - 1;
        places.extend((end == last).then_some(own.len() - 1));
        places.sort_unstable();
        places.dedup();
        kept.extend(places.into_iter().map(|k| own[k]));
    }
    kept
}

/// Measures of the bead along the weld.
fn along(run: &str, stage: &Stage, families: &mut Vec<Family>) {
    let Some(stretch) = stage.stretch.as_ref().filter(|s| s.beads.len() > 2) else {
        return;
    };
    for name in ALONG {
        let Some(measure) = crate::measure::bead::measure_of(name) else {
            continue;
        };
        let points = stretch.beads.iter().map(|(y, bead)| [*y, measure.of(bead)]);
        add(
            families,
            Family {
                channel: "along the weld".to_owned(),
                over: ("place along the weld".to_owned(), "m".to_owned()),
                name: name.to_owned(),
                unit: measure.unit.to_owned(),
                curves: vec![(run.to_owned(), thinned(points.collect()))],
            },
        );
    }
}

/// Records over time.
fn records(run: &str, stage: &Stage, families: &mut Vec<Family>) -> Result<(), Failure> {
    for channel in stage.reader.channels() {
        if channel.schema != RECORD || channel.messages < 3 {
            continue;
        }
        let rows: Vec<(f64, Record)> = stage.reader.records(&channel.name)?;
        let Some((_, first)) = rows.first() else {
            continue;
        };
        for entry in &first.values {
            let points = rows
                .iter()
                .filter_map(|(t, r)| Some([*t, r.get(&entry.name).ok()?]));
            add(
                families,
                Family {
                    channel: channel.name.clone(),
                    over: ("time".to_owned(), "s".to_owned()),
                    name: entry.name.clone(),
                    unit: entry.unit.clone(),
                    curves: vec![(run.to_owned(), thinned(points.collect()))],
                },
            );
        }
    }
    Ok(())
}

/// Columns of the last table of each channel over its first one, where that rises.
fn tables(run: &str, stage: &Stage, families: &mut Vec<Family>) -> Result<(), Failure> {
    for channel in stage.reader.channels() {
        if channel.schema != TABLE || channel.messages == 0 {
            continue;
        }
        let table = stage.reader.table_at(&channel.name, channel.messages - 1)?;
        let Some(over) = table.columns.first() else {
            continue;
        };
        let rises = over.values.windows(2).all(|w| w[1] > w[0]);
        if !table.axes.is_empty() || !rises || over.values.len() < 3 {
            continue;
        }
        let end = end(stage, &table, &over.values);
        for column in &table.columns[1..] {
            let points = over.values.iter().zip(&column.values);
            let points = points.filter(|(x, _)| **x <= end).map(|(x, y)| [*x, *y]);
            add(
                families,
                Family {
                    channel: channel.name.clone(),
                    over: (over.name.clone(), over.unit.clone()),
                    name: column.name.clone(),
                    unit: column.unit.clone(),
                    curves: vec![(run.to_owned(), thinned(points.collect()))],
                },
            );
        }
    }
    Ok(())
}

/// How far along a table something is to be seen: an arc ends long before its gas.
fn end(stage: &Stage, table: &Table, over: &[f64]) -> f64 {
    match stage.is("arc-source") {
        true => reach(table, over),
        false => f64::INFINITY,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thinned_curve_keeps_its_peaks_and_its_ends() {
        // Pulses of one record each.
        let pulse = |k: i32| f64::from(u8::from(k % 97 == 50)) * f64::from(k);
        let points: Vec<[f64; 2]> = (0..5000).map(|k| [f64::from(k), pulse(k)]).collect();
        let kept = thinned(points.clone());
        assert!(kept.len() <= MOST + 1, "{}", kept.len());
        assert!(
            points
                .iter()
                .filter(|p| p[1] > 4000.0)
                .all(|p| kept.contains(p))
        );
        assert_eq!((kept[0], kept[kept.len() - 1]), (points[0], points[4999]));
        assert!(kept.windows(2).all(|w| w[1][0] > w[0][0]));
        assert_eq!(thinned(points[..300].to_vec()).len(), 300);
    }
}
