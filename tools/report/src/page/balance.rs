//! Mass and energy: what came in, what went out, what is there.

use artefact::{Reader, Record};
use run::Failure;

use super::{Named, program};
use crate::html::{Rows, beside, escape, figure, note, side_by_side};
use crate::mirror::Mirror;
use crate::plot::{Line, Plot};
use crate::records::figure as digits;

/// The section; nothing where nothing was balanced.
pub(super) fn section(
    pool: Option<&Reader>,
    arc: Option<&Reader>,
    records: &[Named],
) -> Result<String, Failure> {
    let mut out = String::new();
    if let Some(reader) = pool.filter(|r| r.has("/balance")) {
        if Mirror::read(reader)?.is_some() {
            out += &note(
                "Half of the weld was computed: its masses and energies are those of the half.",
            );
        }
        out += &series(&reader.records("/balance")?);
    }
    if let Some(reader) = arc.filter(|r| r.has("/balance")) {
        out += &heads(&reader.record("/balance")?);
    }
    out += &closing(records);
    Ok(out)
}

/// Balances of the pool over time.
fn series(records: &[(f64, Record)]) -> String {
    let Some((_, first)) = records.first() else {
        return String::new();
    };
    let line = |name: &str, label: &str, factor: f64| {
        let at = |(t, r): &(f64, Record)| r.get(name).ok().map(|v| [*t, factor * v]);
        Line::new(label, records.iter().filter_map(at).collect())
    };
    let of_unit = |unit: &str| -> Vec<&str> {
        let entries = first.values.iter().filter(|e| e.unit == unit);
        entries.map(|e| e.name.as_str()).collect()
    };
    let mut figures = Vec::new();
    let mut energy = Plot::new("time [s]", "energy [kJ]").through(0.0);
    for name in of_unit("J")
        .into_iter()
        .filter(|n| n.contains("energy") && !n.contains("kinetic"))
    {
        energy.add(line(name, &readable(name), 1e-3));
    }
    push(
        &mut figures,
        &energy,
        "Energy that came in, went out and is stored since the start. What is stored must be \
          what came in less what went out.",
    );
    let mut mass = Plot::new("time [s]", "mass [g]").through(0.0);
    let start = first.get("mass_kg").unwrap_or(0.0);
    let grown = |(t, r): &(f64, Record)| r.get("mass_kg").ok().map(|m| [*t, 1e3 * (m - start)]);
    mass.add(Line::new(
        "growth of all metal",
        records.iter().filter_map(grown).collect(),
    ));
    mass.add(line("mass_droplets_kg", "droplets", 1e3).guide());
    push(
        &mut figures,
        &mass,
        "How much metal there is more than at the start. Where it comes from the droplets alone, and none \
          leaves the plate, the two lines are one.",
    );
    let mut liquid = Plot::new("time [s]", "liquid particles").through(0.0);
    liquid.add(line("liquid_particles", "", 1.0));
    push(
        &mut figures,
        &liquid,
        "Particles that are liquid: level where melting and freezing are in balance.",
    );
    let mut closure = Plot::new("time [s]", "closure of energy [%]").through(0.0);
    closure.add(line("closure", "", 100.0));
    push(
        &mut figures,
        &closure,
        "What is missing in the balance of energy, as a share of what came in. Zero is perfect.",
    );
    side_by_side(&figures)
}

fn push(figures: &mut Vec<String>, plot: &Plot, caption: &str) {
    if !plot.is_empty() {
        figures.push(figure(&plot.html(), caption));
    }
}

/// `energy_in_arc_j` reads "in: arc".
pub(super) fn readable(name: &str) -> String {
    let bare = name
        .trim_end_matches("_j")
        .trim_end_matches("_kg")
        .trim_start_matches("energy_");
    let words = bare.replace('_', " ");
    for (prefix, side) in [("in ", "in: "), ("out ", "out: ")] {
        if let Some(rest) = words.strip_prefix(prefix) {
            return format!("{side}{rest}");
        }
    }
    words
}

/// The balance of the arc: one table for each family of names.
fn heads(record: &Record) -> String {
    let mut families: Vec<(&str, Rows)> = Vec::new();
    for (prefix, title) in [
        ("", "Arc"),
        ("heat_", "Heat in the gas"),
        ("base_", "Base metal"),
        ("wire_", "Wire"),
    ] {
        families.push((prefix, Rows::new(&[title, "#Value", "Unit"])));
    }
    for entry in &record.values {
        let name = bare(&entry.name, &entry.unit);
        let own = |f: &&mut (&str, Rows)| !f.0.is_empty() && name.starts_with(f.0);
        let family = match families.iter_mut().find(own) {
            Some(family) => family,
            None => &mut families[0],
        };
        let words = name
            .strip_prefix(family.0)
            .unwrap_or(&name)
            .replace('_', " ");
        let unit = if entry.unit == "1" { "" } else { &entry.unit };
        family
            .1
            .row([escape(&words), digits(entry.value), escape(unit)]);
    }
    let tables: Vec<String> = families.iter().map(|f| f.1.render()).collect();
    heading("Balance of the arc", beside(&tables))
}

/// A name without the unit at its end: `wire_feed_m_s` in m/s is `wire_feed`.
pub(super) fn bare(name: &str, unit: &str) -> String {
    let ending = format!("_{}", unit.to_lowercase().replace(['/', ' ', '*'], "_"));
    name.strip_suffix(&ending).unwrap_or(name).to_owned()
}

/// Conserved totals of every program.
fn closing(records: &[Named]) -> String {
    let mut table = Rows::new(&["Program", "Total", "#Value", "Unit"]);
    for (name, record) in records {
        let tool = program(records, name, record);
        for total in &record.closing {
            let unit = if total.unit == "1" { "" } else { &total.unit };
            table.row([
                escape(&tool),
                escape(&bare(&total.name, &total.unit).replace('_', " ")),
                digits(total.value),
                escape(unit),
            ]);
        }
    }
    heading("Totals at the end", table.render())
}

fn heading(title: &str, body: String) -> String {
    if body.is_empty() {
        return body;
    }
    format!("<h3>{}</h3>\n{body}", escape(title))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_energies_read_as_words() {
        assert_eq!(readable("energy_in_arc_j"), "in: arc");
        assert_eq!(readable("energy_out_radiation_j"), "out: radiation");
        assert_eq!(readable("energy_stored_j"), "stored");
    }

    #[test]
    fn units_at_the_end_of_names_are_not_said_twice() {
        assert_eq!(bare("wire_feed_m_s", "m/s"), "wire_feed");
        assert_eq!(bare("power_w", "W"), "power");
        assert_eq!(bare("closure", "1"), "closure");
        let html = heads(
            &Record::new()
                .with("base_total_w", "W", 1.0)
                .with("current_a", "A", 2.0),
        );
        assert!(html.contains("Base metal") && html.contains(">total<") && !html.contains("Wire"));
    }

    #[test]
    fn a_balance_without_closure_has_no_plot_of_it() {
        let record = |m: f64| Record::new().with("mass_kg", "kg", m);
        let html = series(&[(0.0, record(1.0)), (1.0, record(2.0))]);
        assert!(html.contains("mass [g]") && !html.contains("closure"));
    }
}
