//! What is written: the table of the gas, its composition, the parts of its conduction of heat, its sources.

use artefact::Table;
use serde::Serialize;

use crate::grid::Worst;
use crate::properties::{Gas, PARTS, Point, ZERO};

/// Rows of the table: `points[temperature][fraction]`.
#[derive(Debug, Clone, Copy)]
pub struct Rows<'a> {
    /// Iron fractions.
    pub iron: &'a [f64],
    /// Temperatures, K.
    pub temperatures: &'a [f64],
    /// The points.
    pub points: &'a [Vec<Point>],
}

/// Errors of interpolation, column by column.
#[derive(Debug, Clone, Copy)]
pub struct Errors<'a> {
    /// Along the temperatures.
    pub temperature: &'a [Worst],
    /// Along the iron fractions; empty with one fraction.
    pub iron: &'a [Worst],
}

impl Rows<'_> {
    fn empty(&self) -> Table {
        Table::grid(&[
            ("iron_mole_fraction", "1", self.iron),
            ("temperature_k", "K", self.temperatures),
        ])
    }

    /// Values in the order of a table: temperatures run fastest.
    fn values(&self, of: impl Fn(&Point) -> f64) -> Vec<f64> {
        let mut values = Vec::with_capacity(self.iron.len() * self.points.len());
        for x in 0..self.iron.len() {
            values.extend(self.points.iter().map(|at| of(&at[x])));
        }
        values
    }

    /// Channel `/gas`.
    #[must_use]
    pub fn gas(&self, gas: &Gas, errors: &Errors<'_>) -> Table {
        let columns = gas.columns();
        let mut table = self.empty();
        for (c, column) in columns.iter().enumerate() {
            table = table.column(
                column.name,
                column.unit,
                self.values(|point| point.values[c]),
            );
        }
        for (along, worst) in [("temperature", errors.temperature), ("iron", errors.iron)] {
            for (column, worst) in columns.iter().zip(worst) {
                let name = format!("interpolation_error_{along}_{}", column.name);
                table = table.attribute(&name, "1", worst.error);
            }
        }
        table = table
            .attribute("pressure_pa", "Pa", gas.pressure())
            .attribute("gas_molar_mass_kg_mol", "kg/mol", gas.molar_mass())
            .attribute("enthalpy_zero_temperature_k", "K", ZERO);
        match gas.iron_molar_mass() {
            Some(mass) => table.attribute("iron_molar_mass_kg_mol", "kg/mol", mass),
            None => table,
        }
    }

    /// Channel `/composition`: mole fraction of each species.
    #[must_use]
    pub fn composition(&self, gas: &Gas) -> Table {
        let species = gas.mixture().species.iter().enumerate();
        species.fold(self.empty(), |table, (s, species)| {
            table.column(&species.name, "1", self.values(|point| point.fractions[s]))
        })
    }

    /// Channel `/parts`: what carries heat, W/(m K).
    #[must_use]
    pub fn parts(&self) -> Table {
        PARTS
            .iter()
            .enumerate()
            .fold(self.empty(), |table, (k, name)| {
                let name = format!("thermal_conductivity_{name}_w_m_k");
                table.column(&name, "W/(m K)", self.values(|point| point.parts[k]))
            })
    }
}

/// Schema of channel `/sources`.
pub const SOURCES: (&str, &str) = ("gasprop.sources.v1", include_str!("sources.schema.json"));

/// Where a column comes from.
#[derive(Debug, Clone, Serialize)]
pub struct Source {
    name: &'static str,
    unit: &'static str,
    what: &'static str,
    sources: Vec<String>,
}

/// Channel `/sources`.
#[derive(Debug, Clone, Serialize)]
pub struct Sources {
    columns: Vec<Source>,
    left_out: Vec<String>,
}

/// Sources of the columns of `gas`, from the data of the species.
#[must_use]
pub fn sources(gas: &Gas, left_out: Vec<String>) -> Sources {
    let data = gas.library().data();
    let text = |key: &&str| data["sources"][key].as_str().map(ToOwned::to_owned);
    let columns = gas.columns();
    Sources {
        columns: columns
            .iter()
            .map(|column| Source {
                name: column.name,
                unit: column.unit,
                what: column.what,
                sources: column.sources.iter().filter_map(text).collect(),
            })
            .collect(),
        left_out,
    }
}
