//! Thermocouples on a page: curves, peaks, cooling times, the heat-affected zone.

use artefact::Reader;
use run::Failure;

use crate::draw::axes::number;
use crate::html::{Rows, escape, figure, note, paragraph};
use crate::measure::heat_affected::{self, AC1, Zone};
use crate::plot::{Line, Plot};
use crate::probes::{BETWEEN, Cycle, cycles};

/// What is not told.
const UNTOLD: &str = "\u{2013}";

/// The section of a weld; nothing where it has no probes.
pub(super) fn section(reader: &Reader) -> Result<String, Failure> {
    let cycles = cycles(reader)?;
    if cycles.is_empty() {
        return Ok(String::new());
    }
    let mut plot = Plot::new("time [s]", "temperature [K]");
    for cycle in &cycles {
        plot.add(Line::new(&cycle.name, cycle.points.clone()));
    }
    let caption =
        "The temperature of the thermocouples. `report probes FILE --curves` writes it as CSV.";
    let mut out = figure(&plot.html(), caption) + &table(&cycles);
    let bare: usize = cycles.iter().map(|cycle| cycle.bare).sum();
    if bare > 0 {
        out += &note(&format!(
            "In {bare} readings a thermocouple touched no metal: what it shows there is the temperature of the nearest."
        ));
    }
    if let Some(zone) = heat_affected::zone(reader, AC1)? {
        out += &affected(zone);
    }
    Ok(out)
}

/// Peaks and cooling times; of any study with curves of temperature.
pub(super) fn table(cycles: &[Cycle]) -> String {
    let mut table = Rows::new(&[
        "Thermocouple",
        "#Peak [K]",
        "#Peak [\u{b0}C]",
        "#At [s]",
        "#t8/5 [s]",
    ]);
    for cycle in cycles {
        let Some([time, peak]) = cycle.peak() else {
            continue;
        };
        let cooling = cycle.cooling(BETWEEN);
        table.row([
            escape(&cycle.name),
            format!("{peak:.1}"),
            format!("{:.1}", peak - 273.15),
            number(time),
            cooling.map_or_else(|| UNTOLD.to_owned(), |s| format!("{s:.3}")),
        ]);
    }
    table.render()
}

fn affected(zone: Zone) -> String {
    let millimetres =
        |width: Option<f64>| width.map_or_else(|| UNTOLD.to_owned(), |w| format!("{:.2}", 1e3 * w));
    let mut table = Rows::new(&["Heat-affected zone", "#Width [mm]"]);
    let sides = match zone.along_y {
        true => ["on the surface, lesser x", "on the surface, greater x"],
        false => [
            "on the surface, left of the weld",
            "on the surface, right of the weld",
        ],
    };
    let place = if zone.along_y { "y = " } else { "a place of " };
    for (name, width) in [
        (sides[0], zone.left),
        (sides[1], zone.right),
        ("below the weld", zone.below),
    ] {
        table.row([name.to_owned(), millimetres(width)]);
    }
    table.render()
        + &paragraph(&format!(
            "Metal that has not melted and was hotter than {} K (Ac1), half way along the weld, at {place}{} mm. Peaks are those of \
             frames every {} s.",
            number(zone.isotherm),
            number((1e6 * zone.place).round() * 1e-3),
            number(zone.interval)
        ))
}
