//! The page of tables of gases.

mod compare;
mod curves;
mod inputs;

use artefact::Reader;
use run::Failure;

use super::{Named, lead, runs};
use crate::files::{GasFiles, save};
use crate::gas::Gas;
use crate::gas::reference::Reference;
use crate::html::Page;
use crate::records::RunRecord;

/// A gas with its name.
struct Table {
    name: String,
    gas: Gas,
}

/// Writes the page.
pub(crate) fn write(files: &GasFiles) -> Result<(), Failure> {
    let mut records: Vec<Named> = Vec::new();
    let mut tables = Vec::new();
    for (name, path) in &files.table {
        tables.push(read(name, path)?);
        records.extend(RunRecord::beside(path).map(|record| (name.clone(), record)));
    }
    let find = |name: &str| {
        let table = tables.iter().find(|table| table.name == name);
        table.ok_or_else(|| Failure::Usage(format!("'{name}' is not the name of a --table")))
    };
    let mut variants = Vec::new();
    for (name, path) in &files.variant {
        let wanted = || Failure::Usage(format!("--variant {name}: wanted is NAME/VARIANT=FILE"));
        let (base, variant) = name.split_once('/').ok_or_else(wanted)?;
        variants.push((find(base)?, read(variant, path)?));
    }
    let mut page = Page::new(&files.study, &lead(&records));
    for (name, path) in &files.reference {
        let varied =
            |(base, variant): &&(&Table, Table)| format!("{}/{}", base.name, variant.name) == *name;
        let table = match variants.iter().find(varied) {
            Some((_, variant)) => variant,
            None => find(name)?,
        };
        let body = compare::section(table, &Reference::read(path)?);
        page.section(&format!("{name} against published tables"), body);
    }
    for table in &tables {
        page.section(&table.name, curves::section(&table.gas));
    }
    let compared = |base: &Table, variant: &Table| {
        let name = format!("{}/{}", base.name, variant.name);
        files
            .reference
            .iter()
            .any(|(reference, _)| *reference == name)
    };
    variants.retain(|(base, variant)| !compared(base, variant));
    page.section("What uncertain inputs change", inputs::section(&variants));
    page.section("Where the columns come from", curves::sources(&tables));
    page.section("How it was computed", runs::section(&records));
    save(&files.out, &page.render())
}

fn read(name: &str, path: &std::path::Path) -> Result<Table, Failure> {
    let reader = Reader::open_sound(path, "gas-table", 1)?;
    Ok(Table {
        name: name.to_owned(),
        gas: Gas::read(&reader)?,
    })
}

/// A column's name without its unit, in words.
fn words(column: &str) -> String {
    let known = [
        ("density_kg_m3", "density"),
        ("specific_heat_j_kg_k", "specific heat"),
        ("enthalpy_j_kg", "enthalpy"),
        ("viscosity_pa_s", "viscosity"),
        ("thermal_conductivity_w_m_k", "thermal conductivity"),
        ("electric_conductivity_s_m", "electric conductivity"),
        ("net_emission_w_m3", "net emission"),
        ("electron_density_1_m3", "electron density"),
        ("iron_diffusion_m2_s", "diffusion of iron"),
    ];
    let found = known.iter().find(|(name, _)| *name == column);
    found.map_or(column, |(_, words)| words).to_owned()
}

/// A relative number as per cent.
fn percent(part: f64) -> String {
    let digits = if part.abs() < 0.0995 { 2 } else { 1 };
    format!("{:+.digits$} %", 100.0 * part).replace('-', "\u{2212}")
}
