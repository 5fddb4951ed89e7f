//! Gas tables: what their files hold, and what no gas can have.

use std::path::Path;

use props::Table;
use run::Failure;
use serde::Deserialize;

use crate::error::Error;
use crate::mixture::Molar;

/// Pressure of a table that tells none \[Pa\].
const ATMOSPHERE: f64 = 101_325.0;
/// What a table that comes from no file is called.
const UNNAMED: &str = "gas";

/// A gas table: each column holds a row over temperature for every fraction of iron.
#[derive(Debug, Clone, Deserialize)]
#[serde(from = "Listed")]
pub struct GasFile {
    /// File, for messages.
    pub name: String,
    /// Pressure \[Pa\].
    pub pressure: f64,
    /// Molar masses, where the table holds iron.
    pub molar: Option<Molar>,
    /// Mole fractions of iron.
    pub(super) fractions: Vec<f64>,
    /// Temperatures \[K\].
    pub(super) temperatures: Vec<f64>,
    pub(super) columns: Vec<Column>,
}

/// A gas table as a JSON file lists it, against temperature alone.
#[derive(Debug, Clone, Deserialize)]
struct Listed {
    #[serde(default = "atmosphere")]
    pressure_pa: f64,
    columns: Vec<Column>,
}

fn atmosphere() -> f64 {
    ATMOSPHERE
}

#[derive(Debug, Clone, Deserialize)]
pub(super) struct Column {
    pub(super) name: String,
    #[serde(default)]
    unit: String,
    pub(super) values: Vec<f64>,
}

/// Columns of a gas table that are above 0, and those that are at least 0.
const ABOVE_ZERO: [&str; 5] = [
    "density_kg_m3",
    "specific_heat_j_kg_k",
    "viscosity_pa_s",
    "thermal_conductivity_w_m_k",
    "iron_diffusion_m2_s",
];
const NOT_NEGATIVE: [&str; 2] = ["electric_conductivity_s_m", "electron_density_1_m3"];

impl From<Listed> for GasFile {
    fn from(listed: Listed) -> Self {
        let (axis, columns): (Vec<_>, Vec<_>) = listed
            .columns
            .into_iter()
            .partition(|c| c.name == "temperature_k");
        Self {
            name: UNNAMED.to_owned(),
            pressure: listed.pressure_pa,
            molar: None,
            fractions: vec![0.0],
            temperatures: axis
                .into_iter()
                .next()
                .map(|c| c.values)
                .unwrap_or_default(),
            columns,
        }
    }
}

impl GasFile {
    /// Reads a gas table: an artefact (`.mcap`) over iron and temperature, or a JSON file.
    ///
    /// # Errors
    /// When the file cannot be read, is of another kind, or holds what no gas can have.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let mut file = if path.extension().is_some_and(|e| e == "mcap") {
            let reader = artefact::Reader::open_kind(path, "gas-table", 1)?;
            Self::from_table(&reader.table("/gas")?)?
        } else {
            artefact::json_artefact::<Listed>(path, "gas-table", 1)?.into()
        };
        path.display().to_string().clone_into(&mut file.name);
        match file.impossible() {
            Some(what) => Err(Failure::Other(format!("{}: {what}", path.display()))),
            None => Ok(file),
        }
    }

    /// From the channel `/gas` of an artefact.
    ///
    /// # Errors
    /// When an axis or an attribute is missing.
    pub fn from_table(table: &artefact::Table) -> artefact::Result<Self> {
        let fractions = table.axis("iron_mole_fraction")?.to_vec();
        let column = |c: &artefact::Series| Column {
            name: c.name.clone(),
            unit: c.unit.clone(),
            values: c.values.clone(),
        };
        let molar = if fractions.len() > 1 {
            Some(Molar {
                gas: table.scalar("gas_molar_mass_kg_mol")?,
                iron: table.scalar("iron_molar_mass_kg_mol")?,
            })
        } else {
            None
        };
        Ok(Self {
            name: UNNAMED.to_owned(),
            pressure: table.scalar("pressure_pa")?,
            molar,
            fractions,
            temperatures: table.axis("temperature_k")?.to_vec(),
            columns: table.columns.iter().map(column).collect(),
        })
    }

    /// The first value that no gas can have, with column, row, temperature, unit and range.
    #[must_use]
    pub fn impossible(&self) -> Option<String> {
        let wrong = |name: &str, row: usize, found: String, range: &str| {
            Some(format!(
                "column {name}, row {row}{found} is out of range: {range} 0"
            ))
        };
        if let Some(row) = self.temperatures.iter().position(|t| *t <= 0.0) {
            let found = format!(": {} K", self.temperatures[row]);
            return wrong("temperature_k", row, found, "above");
        }
        let width = self.temperatures.len().max(1);
        self.columns.iter().find_map(|column| {
            let strict = ABOVE_ZERO.contains(&column.name.as_str());
            if !strict && !NOT_NEGATIVE.contains(&column.name.as_str()) {
                return None;
            }
            let good = |v: &f64| *v > 0.0 || (*v >= 0.0 && !strict);
            let at = column.values.iter().position(|v| !good(v))?;
            let (iron, row) = (at / width, at % width);
            let mut place = self
                .temperatures
                .get(row)
                .map_or(String::new(), |t| format!("{t} K"));
            if self.fractions.len() > 1 {
                place = format!("{place}, iron {}", self.fractions[iron]);
            }
            let found = format!(" ({place}): {} {}", column.values[at], column.unit);
            let range = if strict { "above" } else { "at least" };
            wrong(&column.name, row, found, range)
        })
    }

    pub(super) fn column(&self, name: &str) -> Result<&[f64], Error> {
        let found = self.columns.iter().find(|c| c.name == name);
        let found = found.ok_or_else(|| Error::GasTable(format!("has no column {name}")))?;
        Ok(&found.values)
    }

    /// The row of `name` at the fraction of iron with index `iron`.
    pub(super) fn table(&self, name: &str, iron: usize) -> Result<Table, Error> {
        if self.temperatures.is_empty() {
            return Err(Error::GasTable("has no column temperature_k".to_owned()));
        }
        let (values, width) = (self.column(name)?, self.temperatures.len());
        let row = if self.fractions.len() > 1 {
            values.get(iron * width..(iron + 1) * width)
        } else {
            Some(values)
        };
        let row = row.ok_or_else(|| Error::GasTable(format!("{name}: has too few values")))?;
        Table::new(self.temperatures.clone(), row.to_vec())
            .map_err(|e| Error::GasTable(format!("{name}: {e}")))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    const NAMES: [(&str, [f64; 3]); 6] = [
        ("density_kg_m3", [1.6, 0.04, 0.01]),
        ("viscosity_pa_s", [2e-5, 2e-4, 1e-4]),
        ("specific_heat_j_kg_k", [520.0, 1500.0, 9000.0]),
        ("thermal_conductivity_w_m_k", [0.02, 1.0, 3.0]),
        ("electric_conductivity_s_m", [1e-5, 3000.0, 9000.0]),
        ("net_emission_w_m3", [0.0, 1e9, 3e10]),
    ];

    fn column(name: &str, values: &[f64]) -> Column {
        Column {
            name: name.to_owned(),
            unit: "u".to_owned(),
            values: values.to_vec(),
        }
    }

    pub(crate) fn file() -> GasFile {
        let mut columns = vec![column("temperature_k", &[300.0, 10_000.0, 20_000.0])];
        columns.extend(NAMES.iter().map(|(name, values)| column(name, values)));
        let pressure_pa = ATMOSPHERE;
        Listed {
            pressure_pa,
            columns,
        }
        .into()
    }

    /// Two rows: the gas, and one whose every property is twice as large.
    pub(crate) fn mixed() -> artefact::Table {
        let t = [300.0, 10_000.0, 20_000.0];
        let axes: [(&str, &str, &[f64]); 2] = [
            ("iron_mole_fraction", "1", &[0.0, 1.0]),
            ("temperature_k", "K", &t),
        ];
        let both = |values: &[f64]| -> Vec<f64> {
            values
                .iter()
                .copied()
                .chain(values.iter().map(|v| 2.0 * v))
                .collect()
        };
        let mut table = artefact::Table::grid(&axes);
        for (name, values) in NAMES {
            table = table.column(name, "u", both(&values));
        }
        let cp = NAMES[2].1;
        let first = 0.5 * 9700.0 * (cp[0] + cp[1]);
        let heat = [0.0, first, first + 5000.0 * (cp[1] + cp[2])];
        table
            .column("enthalpy_j_kg", "J/kg", both(&heat))
            .column("iron_diffusion_m2_s", "m2/s", both(&[1e-5, 1e-2, 3e-2]))
            .column("electron_density_1_m3", "1/m3", both(&[0.0, 1e22, 1e23]))
            .attribute("pressure_pa", "Pa", 2e5)
            .attribute("gas_molar_mass_kg_mol", "kg/mol", 0.04)
            .attribute("iron_molar_mass_kg_mol", "kg/mol", 0.06)
    }

    #[test]
    fn what_no_gas_can_have_is_told_with_its_row() {
        assert_eq!(file().impossible(), None);
        let spoilt = |column: usize, value: f64| {
            let mut file = file();
            file.columns[column].values[1] = value;
            file.impossible()
        };
        let told = spoilt(0, -0.04).unwrap();
        let want = "density_kg_m3, row 1 (10000 K): -0.04 u is out of range: above 0";
        assert!(told.contains(want), "{told}");
        // A cold gas does not conduct, and a gas may absorb more than it emits.
        assert!(spoilt(3, 0.0).is_some());
        assert!(spoilt(4, 0.0).is_none() && spoilt(4, -1.0).is_some());
        assert!(spoilt(5, -1.0).is_none());
        let mut cold = file();
        cold.temperatures[0] = -1.0;
        let told = cold.impossible().unwrap();
        assert!(told.contains("temperature_k, row 0: -1 K"), "{told}");
        let mut iron = GasFile::from_table(&mixed()).unwrap();
        iron.columns[1].values[4] = 0.0;
        let told = iron.impossible().unwrap();
        assert!(
            told.contains("viscosity_pa_s, row 1 (10000 K, iron 1): 0 u"),
            "{told}"
        );
    }
}
