//! Thermocouples: what their curves tell, and `report probes`.

use std::path::Path;
use std::process::ExitCode;

use artefact::Reader;
use run::Failure;

use crate::files::print;
use crate::measure::heat_affected::{self, Zone};

/// Channels of temperatures at places, with the kind of their artefact.
const CHANNELS: [(&str, &str); 2] = [
    ("particle-frames", "/probes"),
    ("point-fields", "/monitors"),
];
/// 800 and 500 degrees Celsius \[K\]: between them austenite of steel is transformed.
pub(crate) const BETWEEN: [f64; 2] = [1073.15, 773.15];
/// A couple farther from metal than this many spacings touches none.
const TOUCHES: f64 = 1.0;

/// A curve of temperature over time.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Cycle {
    /// Name of the probe.
    pub(crate) name: String,
    /// Time \[s\] and temperature \[K\], rising in time.
    pub(crate) points: Vec<[f64; 2]>,
    /// Readings in which it touched no metal.
    pub(crate) bare: usize,
}

impl Cycle {
    /// Time and temperature of the greatest temperature \[s, K\].
    pub(crate) fn peak(&self) -> Option<[f64; 2]> {
        let hotter = |a: [f64; 2], b: [f64; 2]| if b[1] > a[1] { b } else { a };
        self.points.iter().copied().reduce(hotter)
    }

    /// Time of cooling from one temperature to a lower one \[s\]: from the last time that it is left downwards; none where it is
    /// never left, or the other not reached.
    pub(crate) fn cooling(&self, [from, to]: [f64; 2]) -> Option<f64> {
        let falls = |pair: &[[f64; 2]], t: f64| pair[0][1] >= t && pair[1][1] < t;
        let at = |pair: &[[f64; 2]], t: f64| {
            let [[begin, high], [end, low]] = [pair[0], pair[1]];
            begin + (end - begin) * (high - t) / (high - low)
        };
        let pairs: Vec<_> = self.points.windows(2).collect();
        let first = pairs.iter().rposition(|pair| falls(pair, from))?;
        let last = pairs[first..].iter().find(|pair| falls(pair, to))?;
        Some(at(last, to) - at(pairs[first], from))
    }
}

/// The curves of an artefact; none where it has none, or no time.
///
/// # Errors
/// A message that cannot be read.
pub(crate) fn cycles(reader: &Reader) -> artefact::Result<Vec<Cycle>> {
    let kind = reader.header().kind.as_str();
    let channel = CHANNELS.iter().find(|(of, _)| *of == kind);
    let Some((_, channel)) = channel.filter(|(_, channel)| reader.count(channel) > 1) else {
        return Ok(Vec::new());
    };
    let spacing = reader.header().scene["spacing_m"].as_f64();
    let series = reader.records(channel)?;
    let entries = series.first().map(|(_, first)| first.values.as_slice());
    let names = entries.unwrap_or_default().iter().filter(|e| e.unit == "K");
    let of = |name: &str| {
        let points = series
            .iter()
            .filter_map(|(t, r)| Some([*t, r.get(name).ok()?]));
        let away = series
            .iter()
            .filter_map(|(_, r)| r.get(&format!("{name}.away")).ok());
        let off = |away: &f64| spacing.is_some_and(|d| *away > TOUCHES * d);
        Cycle {
            name: name.to_owned(),
            points: points.collect(),
            bare: away.filter(off).count(),
        }
    };
    Ok(names.map(|entry| of(&entry.name)).collect())
}

/// Prints what curves tell, or the curves themselves, as CSV.
///
/// # Errors
/// A file without curves.
pub(crate) fn run(path: &Path, curves: bool, isotherm: f64) -> Result<ExitCode, Failure> {
    let reader = Reader::open(path)?;
    reader.must_be_sound()?;
    let cycles = cycles(&reader)?;
    if cycles.is_empty() {
        let what = format!(
            "{}: there are no curves of temperature: say output.probes (poolsph) or output.monitors (heatsph) in the scene",
            path.display()
        );
        return Err(Failure::Other(what));
    }
    let zone = heat_affected::zone(&reader, isotherm)?;
    print(&if curves {
        table(&cycles)
    } else {
        told(&cycles, zone)
    })?;
    Ok(ExitCode::SUCCESS)
}

/// All curves, one column each.
fn table(cycles: &[Cycle]) -> String {
    let names = cycles.iter().map(|cycle| format!(",{}_k", cycle.name));
    let mut text = format!("time_s{}\n", names.collect::<String>());
    let times = cycles.first().map_or(&[][..], |cycle| &cycle.points);
    for (row, [time, _]) in times.iter().enumerate() {
        text += &time.to_string();
        for cycle in cycles {
            text += &format!(",{}", cycle.points[row][1]);
        }
        text.push('\n');
    }
    text
}

/// What curves tell, one row each; a field that cannot be told is empty.
fn told(cycles: &[Cycle], zone: Option<Zone>) -> String {
    let mut text =
        "probe,peak_k,peak_time_s,cooling_800_500_s,readings,readings_off_metal\n".to_owned();
    let field = |value: Option<f64>| value.map(|v| v.to_string()).unwrap_or_default();
    for cycle in cycles {
        let peak = cycle.peak();
        text += &format!(
            "{},{},{},{},{},{}\n",
            cycle.name,
            field(peak.map(|p| p[1])),
            field(peak.map(|p| p[0])),
            field(cycle.cooling(BETWEEN)),
            cycle.points.len(),
            cycle.bare
        );
    }
    if let Some(zone) = zone {
        text += "\nisotherm_k,place_y_m,heat_affected_left_m,heat_affected_right_m,heat_affected_below_m,frames_interval_s\n";
        text += &format!(
            "{},{},{},{},{},{}\n",
            zone.isotherm,
            zone.place,
            field(zone.left),
            field(zone.right),
            field(zone.below),
            zone.interval
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cycle(points: &[[f64; 2]]) -> Cycle {
        Cycle {
            name: "a".to_owned(),
            points: points.to_vec(),
            bare: 0,
        }
    }

    #[test]
    fn cooling_is_that_of_the_last_pass() {
        // Two passes: from 1200 K to 900 K, then from 1300 K at 4 s to 600 K at 11 s.
        let of = cycle(&[
            [0.0, 300.0],
            [1.0, 1200.0],
            [3.0, 900.0],
            [4.0, 1300.0],
            [11.0, 600.0],
        ]);
        assert_eq!(of.peak(), Some([4.0, 1300.0]));
        assert!((of.cooling(BETWEEN).unwrap() - 3.0).abs() < 1e-9);
    }

    #[test]
    fn what_is_not_reached_is_not_told() {
        assert_eq!(
            cycle(&[[0.0, 300.0], [1.0, 1000.0], [2.0, 400.0]]).cooling(BETWEEN),
            None
        );
        assert_eq!(cycle(&[[0.0, 1400.0], [1.0, 900.0]]).cooling(BETWEEN), None);
        assert_eq!(cycle(&[]).peak(), None);
    }

    #[test]
    fn tables_have_a_field_for_everything() {
        let cycles = [cycle(&[[0.0, 300.0], [1.0, 1000.0]])];
        assert_eq!(table(&cycles), "time_s,a_k\n0,300\n1,1000\n");
        let told = told(&cycles, None);
        assert!(told.ends_with("a,1000,1,,2,0\n"), "{told}");
    }
}
