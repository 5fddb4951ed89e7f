//! Curves of a gas: every column, composition, what carries heat.

use super::{Table, words};
use crate::gas::Gas;
use crate::html::{Rows, escape, figure, paragraph, side_by_side};
use crate::plot::{Line, Plot};

/// Columns that span decades.
const LOGARITHMIC: [&str; 4] = [
    "density_kg_m3",
    "electric_conductivity_s_m",
    "net_emission_w_m3",
    "electron_density_1_m3",
];
/// Part of the greatest value below which a logarithmic plot ends.
const FLOOR: f64 = 1e-7;
/// A species that never reaches this mole fraction is not drawn.
const RARE: f64 = 1e-3;
/// Lowest mole fraction drawn.
const TRACE: f64 = 1e-6;
const T: &str = "temperature [K]";

/// The section of a gas.
pub(super) fn section(gas: &Gas) -> String {
    let mut out = facts(gas);
    let plots = gas.table.columns.iter().map(|column| {
        let logarithmic = LOGARITHMIC.contains(&column.name.as_str());
        let title = format!("{} [{}]", words(&column.name), column.unit);
        let mut plot = Plot::new(T, &title);
        let mut least = f64::NEG_INFINITY;
        if logarithmic {
            plot = plot.log_y();
            least = FLOOR * column.values.iter().fold(0.0_f64, |most, v| most.max(*v));
        }
        for x in gas.drawn() {
            plot.add(Line::new(
                &gas.called(x),
                gas.line(&gas.table, &column.name, x, least),
            ));
        }
        figure(&plot.html(), &caption(&column.name))
    });
    out += &side_by_side(&plots.collect::<Vec<_>>());
    out += &composition(gas);
    out += &parts(gas);
    out += &errors(gas);
    out
}

/// The words of a column as a sentence.
pub(super) fn caption(column: &str) -> String {
    let words = words(column);
    let (first, rest) = words.split_at(words.chars().next().map_or(0, char::len_utf8));
    format!("{}{rest} against temperature.", first.to_uppercase())
}

fn facts(gas: &Gas) -> String {
    let pressure = gas.table.scalar("pressure_pa").ok();
    let species = gas.composition.as_ref().map(|table| table.columns.len());
    let mut facts = vec![
        (
            gas.temperatures.len().to_string(),
            "temperatures".to_owned(),
        ),
        (gas.iron.len().to_string(), "iron fractions".to_owned()),
    ];
    if let Some(pressure) = pressure {
        facts.insert(
            0,
            (format!("{} kPa", pressure / 1e3), "pressure".to_owned()),
        );
    }
    if let Some(species) = species {
        facts.push((species.to_string(), "species".to_owned()));
    }
    super::super::tiles(&facts)
}

/// Places of iron that stand for all where one plot shows one of them: none, and the middle of the rest.
fn shown(gas: &Gas) -> Vec<usize> {
    match gas.iron.len() {
        1 => vec![0],
        n => vec![0, n / 2 + n / 6],
    }
}

fn composition(gas: &Gas) -> String {
    let Some(table) = &gas.composition else {
        return String::new();
    };
    let mut figures = Vec::new();
    for x in shown(gas) {
        let mut plot = Plot::new(T, "mole fraction").log_y();
        for species in &table.columns {
            let most = gas.row(table, &species.name, x).unwrap_or_default();
            if most.iter().any(|share| *share > RARE) {
                plot.add(Line::new(
                    &species.name,
                    gas.line(table, &species.name, x, TRACE),
                ));
            }
        }
        let caption = format!(
            "Composition{}: species that reach a mole fraction of 0.001.",
            with_iron(gas, x)
        );
        figures.push(figure(&plot.html(), &caption));
    }
    side_by_side(&figures)
}

fn with_iron(gas: &Gas, x: usize) -> String {
    match gas.called(x) {
        called if called.is_empty() => called,
        called => format!(" at {called}"),
    }
}

fn parts(gas: &Gas) -> String {
    let Some(table) = &gas.parts else {
        return String::new();
    };
    let mut figures = Vec::new();
    for x in shown(gas) {
        let mut plot = Plot::new(T, "thermal conductivity [W/(m K)]");
        let all = gas.line(
            &gas.table,
            "thermal_conductivity_w_m_k",
            x,
            f64::NEG_INFINITY,
        );
        for part in &table.columns {
            let name = part.name.trim_start_matches("thermal_conductivity_");
            let name = name.trim_end_matches("_w_m_k");
            plot.add(Line::new(
                name,
                gas.line(table, &part.name, x, f64::NEG_INFINITY),
            ));
        }
        plot.add(Line::new("all", all).guide());
        let caption = format!("What carries heat{}.", with_iron(gas, x));
        figures.push(figure(&plot.html(), &caption));
    }
    side_by_side(&figures)
}

/// What linear interpolation in the table costs.
fn errors(gas: &Gas) -> String {
    let mut rows = Rows::new(&["Column", "#Along temperature", "#Along iron"]);
    for column in &gas.table.columns {
        let error = |along: &str| {
            let name = format!("interpolation_error_{along}_{}", column.name);
            let error = gas.table.scalar(&name).ok();
            error.map(|error| format!("{:.2} %", 100.0 * error))
        };
        if let Some(temperature) = error("temperature") {
            let iron = error("iron").unwrap_or_else(|| "\u{2013}".to_owned());
            rows.row([escape(&words(&column.name)), temperature, iron]);
        }
    }
    let table = rows.render();
    if table.is_empty() {
        return table;
    }
    let text = "Greatest error of linear interpolation, measured in the middle of every cell, relative to the value or, \
                where that is small, to a thousandth of the column's greatest.";
    format!("<h3>Interpolation</h3>\n{}{table}", paragraph(text))
}

/// Sources of the columns of all tables, each once.
pub(super) fn sources(tables: &[Table]) -> String {
    let mut rows = Rows::new(&["Column", "Unit", "What it is", "Numbers from"]);
    let mut said: Vec<&str> = Vec::new();
    let mut left_out: Vec<&str> = Vec::new();
    for sources in tables.iter().filter_map(|table| table.gas.sources.as_ref()) {
        for column in sources.columns.iter().filter(|c| !c.name.is_empty()) {
            if said.contains(&column.name.as_str()) {
                continue;
            }
            said.push(&column.name);
            let from: Vec<String> = column.sources.iter().map(|text| escape(text)).collect();
            rows.row([
                escape(&words(&column.name)),
                escape(&column.unit),
                escape(&column.what),
                from.join("<br>"),
            ]);
        }
        for text in &sources.left_out {
            if !left_out.contains(&text.as_str()) {
                left_out.push(text);
            }
        }
    }
    let mut out = rows.render();
    if !left_out.is_empty() {
        out += &paragraph(&format!("Left out: {}.", left_out.join("; ")));
    }
    out
}
