//! The arc: its fields, and what it gives to the base metal.

use artefact::{Reader, Record, Table};
use run::Failure;

use super::{encoding, grouped, tiles};
use crate::html::{figure, picture, side_by_side};
use crate::picture::arc::{Plasma, lorentz};
use crate::plot::{Line, Plot};

/// A curve of `/surface`: column, name, factor to the unit shown.
type Curve<'a> = (&'a str, &'a str, f64);

/// Parts of the heat by the middle of their column's name.
const PARTS: [(&str, &str); 7] = [
    ("total", "total"),
    ("convection", "conduction and convection"),
    ("radiation", "radiation of the arc"),
    ("electron", "electrons"),
    ("ion", "ions"),
    ("emission", "radiation of the surface"),
    ("vapour", "evaporation"),
];
const CURRENT: [Curve<'static>; 3] = [
    ("current_density_a_m2", "all", 1e-6),
    ("ion_current_density_a_m2", "ions", 1e-6),
    ("electron_current_density_a_m2", "electrons", 1e-6),
];
const PRESSURE: [Curve<'static>; 1] = [("arc_pressure_pa", "", 1.0)];
const SPEED: [Curve<'static>; 1] = [("gas_radial_velocity_m_s", "", 1.0)];
const GAS: [Curve<'static>; 1] = [("gas_temperature_k", "", 1e-3)];
/// What lies beyond the radius where every curve is below this share of its peak is not shown.
const SHOWN: f64 = 0.01;

/// The section.
pub(super) fn section(reader: &Reader) -> Result<String, Failure> {
    let mut out = String::new();
    let plasma = match reader.has("/plasma") {
        true => Plasma::read(&reader.table("/plasma")?)?,
        false => None,
    };
    let balance = match reader.has("/balance") {
        true => Some(reader.record("/balance")?),
        false => None,
    };
    out += &tiles(&facts(balance.as_ref(), plasma.as_ref()));
    if let Some(canvas) = plasma.as_ref().and_then(Plasma::picture) {
        let caption = "The arc in a plane through its axis. Right of the axis the temperature of the gas, with \
                       lines at 5, 10, 15, 20 and 25 thousand kelvin; left its speed, with arrows along the flow. \
                       Brown is the wire, grey the base metal, sand what else there is, such as flux.";
        let image = picture(&canvas, caption).map_err(|e| encoding(&e))?;
        out += &figure(&image, caption);
    }
    if reader.has("/surface") {
        out += &surface(&reader.table("/surface")?);
    }
    if reader.has("/lorentz")
        && let Some(canvas) = lorentz(&reader.table("/lorentz")?)?
    {
        let caption = "The Lorentz force in the base metal, from the axis of the arc outwards. It drives the \
                       liquid inwards and down.";
        let image = picture(&canvas, caption).map_err(|e| encoding(&e))?;
        out += &figure(&image, caption);
    }
    Ok(out)
}

fn facts(balance: Option<&Record>, plasma: Option<&Plasma>) -> Vec<(String, String)> {
    let mut facts = Vec::new();
    if let Some(balance) = balance {
        for (name, unit, factor, words) in [
            ("current_a", "A", 1.0, "current"),
            ("voltage_v", "V", 1.0, "voltage"),
            ("power_w", "kW", 1e-3, "power"),
        ] {
            if let Ok(value) = balance.get(name) {
                facts.push((format!("{:.1} {unit}", factor * value), words.to_owned()));
            }
        }
    }
    if let Some(hottest) = plasma.and_then(Plasma::hottest) {
        let words = "highest gas temperature".to_owned();
        facts.push((format!("{} K", grouped(hottest.round() as usize)), words));
    }
    if let Some(fastest) = plasma.and_then(Plasma::fastest) {
        facts.push((format!("{fastest:.0} m/s"), "highest gas speed".to_owned()));
    }
    facts
}

fn surface(table: &Table) -> String {
    let Ok(radius) = table.values("radius_m") else {
        return String::new();
    };
    let end = reach(table, radius);
    let heat = heat(table);
    let height = |name: &str| {
        table.scalar(name).map_or_else(
            |_| String::new(),
            |h| format!(", {:.2} mm above it", 1e3 * h),
        )
    };
    let kinds: [(&[Curve<'_>], &str, String); 5] = [
        (
            &heat,
            "heat flux [W/mm\u{b2}]",
            "Heat that enters the base metal, by the way it comes. Losses are negative.".to_owned(),
        ),
        (
            &CURRENT,
            "current density [A/mm\u{b2}]",
            "Current density at the surface, and who carries it.".to_owned(),
        ),
        (
            &PRESSURE,
            "pressure [Pa]",
            "Pressure of the arc on the surface: it presses the pool down.".to_owned(),
        ),
        (
            &SPEED,
            "radial velocity of the gas [m/s]",
            format!(
                "Gas along the surface{}: its shear drags the liquid outwards.",
                height("gas_velocity_height_m")
            ),
        ),
        (
            &GAS,
            "gas temperature [1000 K]",
            format!(
                "Gas over the surface{}: it heats what it touches.",
                height("gas_temperature_height_m")
            ),
        ),
    ];
    let figures: Vec<String> = kinds
        .into_iter()
        .map(|(curves, title, caption)| (plot(table, radius, end, curves, title), caption))
        .filter(|(plot, _)| !plot.is_empty())
        .map(|(plot, caption)| figure(&plot.html(), &caption))
        .collect();
    side_by_side(&figures)
}

/// Curves over the radius \[m\] up to an end.
fn plot(table: &Table, radius: &[f64], end: f64, curves: &[Curve<'_>], title: &str) -> Plot {
    let mut plot = Plot::new("radius r [mm]", title).through(0.0);
    for (column, name, factor) in curves {
        if let Ok(values) = table.values(column) {
            let inside = radius.iter().zip(values).filter(|(r, _)| **r <= end);
            let points = inside.map(|(r, v)| [1e3 * r, factor * v]);
            plot.add(Line::new(name, points.collect()));
        }
    }
    plot
}

/// Every part of the heat flux that the table has, the known ones first.
fn heat(table: &Table) -> Vec<Curve<'_>> {
    let part = |column: &'_ str| -> Option<String> {
        let part = column.strip_prefix("heat_flux_")?.strip_suffix("_w_m2")?;
        Some(part.to_owned())
    };
    let rank = |column: &str| {
        let part = part(column);
        PARTS
            .iter()
            .position(|p| Some(p.0) == part.as_deref())
            .unwrap_or(PARTS.len())
    };
    let columns = table.columns.iter().map(|c| c.name.as_str());
    let mut found: Vec<&str> = columns.filter(|c| part(c).is_some()).collect();
    found.sort_by_key(|c| rank(c));
    let named = |column: &'_ str| PARTS.get(rank(column)).map(|p| p.1);
    found
        .into_iter()
        .map(|c| (c, named(c).unwrap_or(c), 1e-6))
        .collect()
}

/// Radius beyond which heat flux and current are below a hundredth of their peaks \[m\].
pub(super) fn reach(table: &Table, radius: &[f64]) -> f64 {
    let last = radius.last().copied().unwrap_or(0.0);
    let ends = [
        "heat_flux_total_w_m2",
        "current_density_a_m2",
        "arc_pressure_pa",
    ]
    .iter()
    .filter_map(|name| table.values(name).ok())
    .map(|values| {
        let peak = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let place = values.iter().rposition(|v| v.abs() > SHOWN * peak);
        place.and_then(|i| radius.get(i)).copied().unwrap_or(last)
    });
    ends.reduce(f64::max).map_or(last, |r| (1.1 * r).min(last))
}
