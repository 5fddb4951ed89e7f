//! Tables of the properties of a gas.

pub(crate) mod deviation;
pub(crate) mod reference;

use artefact::{Reader, Table};
use serde::Deserialize;

/// Channels of a gas table.
const GAS: &str = "/gas";
const COMPOSITION: &str = "/composition";
const PARTS: &str = "/parts";
const SOURCES: &str = "/sources";
const IRON: &str = "iron_mole_fraction";
const TEMPERATURE: &str = "temperature_k";
/// Lines that one plot holds before they cannot be told apart.
const LINES: usize = 6;

/// What a column is and whose numbers it rests on.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Source {
    pub(crate) name: String,
    pub(crate) unit: String,
    pub(crate) what: String,
    pub(crate) sources: Vec<String>,
}

/// Where a table comes from.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Sources {
    pub(crate) columns: Vec<Source>,
    pub(crate) left_out: Vec<String>,
}

/// A gas table with what lies beside it.
#[derive(Debug, Clone)]
pub(crate) struct Gas {
    /// Moles of iron per mole of iron and cold gas.
    pub(crate) iron: Vec<f64>,
    /// Temperatures \[K\].
    pub(crate) temperatures: Vec<f64>,
    /// The table.
    pub(crate) table: Table,
    /// Mole fractions of species, if the file holds them.
    pub(crate) composition: Option<Table>,
    /// What carries heat, if the file holds it.
    pub(crate) parts: Option<Table>,
    /// Sources, if the file holds them.
    pub(crate) sources: Option<Sources>,
}

impl Gas {
    /// Reads a gas table.
    ///
    /// # Errors
    /// When a message cannot be read or an axis is absent.
    pub(crate) fn read(reader: &Reader) -> artefact::Result<Self> {
        let table = reader.table(GAS)?;
        let optional = |channel: &str| match reader.has(channel) {
            true => reader.table(channel).map(Some),
            false => Ok(None),
        };
        Ok(Self {
            iron: table.axis(IRON)?.to_vec(),
            temperatures: table.axis(TEMPERATURE)?.to_vec(),
            composition: optional(COMPOSITION)?,
            parts: optional(PARTS)?,
            sources: match reader.has(SOURCES) {
                true => Some(reader.json_at(SOURCES, 0)?),
                false => None,
            },
            table,
        })
    }

    /// Values of a column of `table` against temperature, at a place of iron.
    pub(crate) fn row<'a>(&self, table: &'a Table, name: &str, iron: usize) -> Option<&'a [f64]> {
        let n = self.temperatures.len();
        let values = table.values(name).ok()?;
        values.get(iron * n..(iron + 1) * n)
    }

    /// Points of a line of `table`, where they are above `least`.
    pub(crate) fn line(&self, table: &Table, name: &str, iron: usize, least: f64) -> Vec<[f64; 2]> {
        let values = self.row(table, name, iron).unwrap_or_default();
        let pairs = self.temperatures.iter().zip(values);
        pairs
            .filter(|(_, y)| **y > least)
            .map(|(t, y)| [*t, *y])
            .collect()
    }

    /// Linear interpolation of a column at `t` K, at a place of iron.
    pub(crate) fn at(&self, name: &str, iron: usize, t: f64) -> Option<f64> {
        let row = self.row(&self.table, name, iron)?;
        let after = self.temperatures.iter().position(|node| *node >= t)?;
        if after == 0 {
            return (self.temperatures[0] <= t).then(|| row[0]);
        }
        let (low, high) = (self.temperatures[after - 1], self.temperatures[after]);
        let share = (t - low) / (high - low);
        Some(row[after - 1] + share * (row[after] - row[after - 1]))
    }

    /// Places of iron to draw: all, or as many as a plot holds, with the first and the last.
    pub(crate) fn drawn(&self) -> Vec<usize> {
        let n = self.iron.len();
        if n <= LINES {
            return (0..n).collect();
        }
        (0..LINES)
            .map(|k| (k * (n - 1) + (LINES - 1) / 2) / (LINES - 1))
            .collect()
    }

    /// What a line at a place of iron is called; nothing where there is one only.
    pub(crate) fn called(&self, iron: usize) -> String {
        if self.iron.len() == 1 {
            String::new()
        } else {
            format!("x(Fe) = {}", self.iron[iron])
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]

    use super::*;

    /// A gas of one column, `value(temperature, iron)`.
    pub(crate) fn gas(name: &str, iron: &[f64], value: impl Fn(f64, f64) -> f64) -> Gas {
        let temperatures: Vec<f64> = (0..31).map(|k| 1000.0 * f64::from(k)).collect();
        let values = iron
            .iter()
            .flat_map(|x| temperatures.iter().map(|t| value(*t, *x)));
        let values: Vec<f64> = values.collect();
        let table = Table::grid(&[(IRON, "1", iron), (TEMPERATURE, "K", &temperatures)]);
        Gas {
            iron: iron.to_vec(),
            temperatures,
            table: table.column(name, "1", values),
            composition: None,
            parts: None,
            sources: None,
        }
    }

    #[test]
    fn a_row_is_that_of_its_iron_and_lines_between_are_straight() {
        let gas = gas("v", &[0.0, 0.5, 1.0], |t, x| 2.0 * t + 1e6 * x);
        assert!((gas.at("v", 1, 1234.5).unwrap() - 2469.0 - 5e5).abs() < 1e-6);
        assert!((gas.at("v", 0, 0.0).unwrap()).abs() < 1e-9);
        assert_eq!(gas.at("v", 0, 4e4), None);
        assert_eq!(gas.at("absent", 0, 1e4), None);
        assert_eq!(gas.row(&gas.table, "v", 3), None);
    }

    #[test]
    fn a_plot_holds_the_first_and_the_last_of_many() {
        let many: Vec<f64> = (0..12).map(|k| f64::from(k) / 11.0).collect();
        let drawn = gas("v", &many, |t, _| t).drawn();
        assert_eq!((drawn[0], drawn[5], drawn.len()), (0, 11, 6));
        assert!(drawn.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!(gas("v", &[0.0], |t, _| t).drawn(), [0]);
    }
}
