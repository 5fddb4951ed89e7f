//! Passes of an arc and a pool through files: what each changes.

use std::path::Path;

use artefact::{Reader, Record, Table};
use run::Failure;

use super::balance::readable;
use super::{Named, arc, arcs, lead, runs};
use crate::files::{PassesFiles, save};
use crate::html::{Page, Rows, escape, figure, paragraph, side_by_side};
use crate::plot::{Line, Plot};
use crate::records::{RunRecord, figure as digits};
use crate::weld::Weld;

/// A table of each pass that has one.
type Tables = Vec<(String, Table)>;
/// Something of each pass with the name of the pass.
type Each<T> = Vec<(String, T)>;

/// What is drawn over the radius: column, axis, factor to the unit shown, caption.
const CURVES: [(&str, &str, f64, &str); 5] = [
    (
        "heat_flux_total_w_m2",
        "heat flux [W/mm\u{b2}]",
        1e-6,
        "Heat that enters the base metal, per area as seen from above, with what the metal of the arc's own \
         scene gives off.",
    ),
    (
        "arc_pressure_pa",
        "pressure [Pa]",
        1.0,
        "Pressure of the arc on the surface.",
    ),
    (
        "current_density_a_m2",
        "current density [A/mm\u{b2}]",
        1e-6,
        "Current density, per area as seen from above.",
    ),
    (
        "gas_temperature_k",
        "gas temperature [1000 K]",
        1e-3,
        "Gas just above the surface.",
    ),
    (
        "gas_radial_velocity_m_s",
        "radial velocity of the gas [m/s]",
        1.0,
        "Gas along the surface.",
    ),
];

/// Measures of the bead: name and words.
const MEASURES: [(&str, &str); 4] = [
    ("penetration", "penetration below the original surface"),
    ("fused_width", "greatest width fused below the surface"),
    ("reinforcement", "height above the surface"),
    ("bead_width", "width of the bead above the surface"),
];

/// Writes the page.
pub(crate) fn write(files: &PassesFiles) -> Result<(), Failure> {
    let open = |list: &Each<std::path::PathBuf>, kind| -> Result<Each<Reader>, Failure> {
        let each = list.iter();
        each.map(|(name, path)| Ok((name.clone(), Reader::open_sound(path, kind, 1)?)))
            .collect()
    };
    let arcs = open(&files.arc, "arc-source")?;
    let pools = open(&files.pool, "particle-frames")?;
    let means = open(&files.mean, "mean-fields")?;
    let surfaces = tables(&arcs, "/surface")?;
    let balances = arcs::balances(&arcs)?;
    let records = records(files);
    let mut page = Page::new(&files.study, &lead(&records));
    let profiles = tables(&means, "/profile")?;
    page.section("The surface of the pool", shape(&profiles, &surfaces)?);
    page.section("What the arc does to it", over_radius(&surfaces));
    page.section("What comes of it", pool(&pools)?);
    page.section("The arcs beside each other", arcs::section(&balances));
    page.section("How it was computed", runs::section(&records));
    save(&files.out, &page.render())
}

fn tables(readers: &[(String, Reader)], channel: &str) -> artefact::Result<Tables> {
    let having = readers.iter().filter(|(_, r)| r.has(channel));
    having
        .map(|(name, r)| Ok((name.clone(), r.table(channel)?)))
        .collect()
}

/// The record beside each artefact that has one.
fn records(files: &PassesFiles) -> Vec<Named> {
    let all = files.arc.iter().chain(&files.pool).chain(&files.mean);
    let found = |path: &Path| RunRecord::beside(path);
    all.filter_map(|(name, path)| Some((name.clone(), found(path)?)))
        .collect()
}

/// Points of a column of a table over another one, with a factor to the unit shown each.
fn points(table: &Table, [x, y]: [&str; 2], [fx, fy]: [f64; 2]) -> artefact::Result<Vec<[f64; 2]>> {
    let pairs = table.values(x)?.iter().zip(table.values(y)?);
    Ok(pairs.map(|(a, b)| [fx * a, fy * b]).collect())
}

/// The mean surface after each pass, and the one that each arc stood over.
fn shape(profiles: &Tables, surfaces: &Tables) -> Result<String, Failure> {
    let mut plot = Plot::new("radius r [mm]", "height z [mm]").through(0.0);
    let mut spread = Plot::new("radius r [mm]", "standard deviation [mm]").through(0.0);
    let reach = profiles
        .iter()
        .filter_map(|(_, t)| t.values("outer_radius_m").ok()?.last().copied())
        .fold(0.0, f64::max);
    for (name, table) in profiles {
        let of = |column: &str| points(table, ["radius_m", column], [1e3, 1e3]);
        plot.add(Line::new(&format!("pool: {name}"), of("height_m")?).marked());
        let [angle, time] = ["height_spread_angle_m", "height_spread_time_m"];
        spread.add(Line::new(&format!("{name}: around the source"), of(angle)?));
        spread.add(Line::new(&format!("{name}: over time"), of(time)?).marked());
    }
    for (name, table) in surfaces {
        if table.has("surface_height_m") {
            let mut steps = points(table, ["radius_m", "surface_height_m"], [1e3, 1e3])?;
            steps.retain(|p| p[0] <= 1e3 * reach);
            plot.add(Line::new(&format!("cells of the arc: {name}"), steps).dotted());
        }
    }
    let figures = [
        figure(
            &plot.html(),
            "Height of the surface over the distance from the source, averaged over angle and time, as each pool left \
             it. Dots are the tops of the cells of the arc that was computed over it; where there are none the arc stood \
             over a flat plate.",
        ),
        figure(
            &spread.html(),
            "What the average hides: how far the surface differs around the source (the bead is behind it), and \
             over time (each droplet presses it down).",
        ),
    ];
    Ok(side_by_side(&figures) + &volumes(profiles)?)
}

fn volumes(profiles: &Tables) -> Result<String, Failure> {
    let mut table = Rows::new(&[
        "Surface",
        "#On the axis [mm]",
        "#Highest [mm]",
        "#At r = [mm]",
        "#Hollow [mm\u{b3}]",
        "#Net [mm\u{b3}]",
    ]);
    for (name, profile) in profiles {
        let heights = points(profile, ["radius_m", "height_m"], [1e3, 1e3])?;
        let Some(highest) = heights.iter().max_by(|a, b| a[1].total_cmp(&b[1])) else {
            continue;
        };
        table.row([
            escape(name),
            digits(heights[0][1]),
            digits(highest[1]),
            digits(highest[0]),
            digits(1e9 * profile.scalar("depression_m3")?),
            digits(1e9 * profile.scalar("net_volume_m3")?),
        ]);
    }
    Ok(table.render())
}

/// What the arcs do over the radius, a line each.
fn over_radius(surfaces: &Tables) -> String {
    let reach = surfaces
        .iter()
        .filter_map(|(_, t)| Some(arc::reach(t, t.values("radius_m").ok()?)))
        .fold(0.0, f64::max);
    let mut figures = Vec::new();
    for (column, axis, factor, caption) in CURVES {
        let mut plot = Plot::new("radius r [mm]", axis).through(0.0);
        for (name, table) in surfaces {
            if let Ok(mut line) = points(table, ["radius_m", column], [1e3, factor]) {
                line.retain(|p| p[0] <= 1e3 * reach);
                plot.add(Line::new(name, line));
            }
        }
        if !plot.is_empty() {
            figures.push(figure(&plot.html(), caption));
        }
    }
    side_by_side(&figures)
}

/// Bead and heat of each pool.
fn pool(pools: &[(String, Reader)]) -> Result<String, Failure> {
    let mut titles = vec!["Measure".to_owned()];
    titles.extend(pools.iter().map(|(name, _)| format!("#{name}")));
    titles.push("Unit".to_owned());
    let titles: Vec<&str> = titles.iter().map(String::as_str).collect();
    let mut table = Rows::new(&titles);
    let mut welds = Vec::new();
    for (_, reader) in pools {
        welds.push(Weld::last(reader)?);
    }
    let stretches: Vec<_> = welds
        .iter()
        .map(|weld| weld.as_ref().and_then(Weld::bead))
        .collect();
    for (name, words) in MEASURES {
        let value = |k: usize| Some(1e3 * stretches[k].as_ref()?.get(name)?.value);
        row(&mut table, words, "mm", pools.len(), &value);
    }
    let mut series = Vec::new();
    for (name, reader) in pools.iter().filter(|(_, r)| r.has("/balance")) {
        series.push((name.clone(), reader.records("/balance")?));
    }
    for name in energies(&series) {
        let words = format!("{} (second half)", readable(&name));
        let value = |k: usize| power(&series.get(k)?.1, &name);
        row(&mut table, &words, "kW", pools.len(), &value);
    }
    let frozen: Vec<bool> = stretches.iter().flatten().map(|s| s.frozen).collect();
    Ok(paragraph(measured(&frozen)) + &liquid(&series) + &table.render())
}

/// What the measures of beads are, by whether each has frozen.
fn measured(frozen: &[bool]) -> &'static str {
    match (frozen.contains(&true), frozen.contains(&false)) {
        (true, false) => "Measures are medians of the frozen stretch.",
        (true, true) => {
            "Measures of welds that have frozen are medians of the frozen stretch; of the others they are the greatest ones \
             so far, and not to be compared with medians."
        }
        (false, _) => {
            "Nothing of these welds has frozen beyond its run-in: the measures are the greatest ones so far. \
                  Powers are those of the second half of the time."
        }
    }
}

fn row(
    table: &mut Rows,
    words: &str,
    unit: &str,
    count: usize,
    value: &dyn Fn(usize) -> Option<f64>,
) {
    let found: Vec<Option<f64>> = (0..count).map(value).collect();
    if found.iter().all(Option::is_none) {
        return;
    }
    let mut cells = vec![escape(words)];
    cells.extend(
        found
            .into_iter()
            .map(|v| v.map_or_else(|| "\u{2013}".to_owned(), digits)),
    );
    cells.push(escape(unit));
    table.row(cells);
}

/// Names of the energies that came in and went out, each once.
fn energies(series: &[(String, Vec<(f64, Record)>)]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let firsts = series.iter().filter_map(|(_, records)| records.first());
    for entry in firsts.flat_map(|(_, record)| &record.values) {
        let flows = ["energy_in_", "energy_out_"];
        let flow = flows.iter().any(|flow| entry.name.starts_with(flow));
        if flow && entry.unit == "J" && !names.contains(&entry.name) {
            names.push(entry.name.clone());
        }
    }
    names
}

/// Mean power of the second half of a series \[kW\].
fn power(records: &[(f64, Record)], name: &str) -> Option<f64> {
    let (end, last) = records.last()?;
    let (begin, first) = records.get(records.len() / 2)?;
    let energy = last.get(name).ok()? - first.get(name).ok()?;
    (end > begin).then(|| 1e-3 * energy / (end - begin))
}

/// Liquid particles over time.
fn liquid(series: &[(String, Vec<(f64, Record)>)]) -> String {
    let mut plot = Plot::new("time [s]", "liquid particles").through(0.0);
    for (pass, records) in series {
        let at = |(t, r): &(f64, Record)| r.get("liquid_particles").ok().map(|v| [*t, v]);
        plot.add(Line::new(pass, records.iter().filter_map(at).collect()));
    }
    if plot.is_empty() {
        return String::new();
    }
    figure(&plot.html(), "How large each pool is, in particles.")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_and_greatest_values_are_told_apart() {
        assert!(measured(&[true, true]).starts_with("Measures are medians"));
        assert!(measured(&[true, false]).contains("not to be compared"));
        assert!(measured(&[false]).starts_with("Nothing") && measured(&[]).starts_with("Nothing"));
    }

    #[test]
    fn the_power_is_that_of_the_second_half() {
        let record = |e: f64| Record::new().with("energy_in_arc_j", "J", e);
        let series = [
            (0.0, record(0.0)),
            (1.0, record(9e3)),
            (2.0, record(1e4)),
            (3.0, record(1.2e4)),
            (4.0, record(1.6e4)),
        ];
        let found = power(&series, "energy_in_arc_j").unwrap();
        assert!((found - 3.0).abs() < 1e-12, "{found}");
        assert!(power(&series[..1], "energy_in_arc_j").is_none());
        assert!(power(&series, "energy_in_wire_j").is_none());
    }
}
