//! Materials of the gas and of the bodies.

use props::Table;
use run::property::{Arguments, Curve, Property};
use serde::Deserialize;

use crate::assemble::Faults;
use crate::assemble::granular::conductivity;
use crate::error::Error;
use crate::material::{Enthalpy, Law, Material, Melting, REFERENCE_K};
use crate::scene::{BeyondTable, Body, Gas, Scene, SpecificHeat};

/// Names that a material law may use.
const NAMES: [&str; 3] = ["r", "z", "T"];

/// Temperature to which a table is extended at least \[K\].
const EXTENDED_K: f64 = 60_000.0;
/// Rows of the extension.
const EXTENDED_ROWS: usize = 40;

/// A gas table as its file holds it.
#[derive(Debug, Clone, Deserialize)]
pub struct GasFile {
    columns: Vec<Column>,
}

#[derive(Debug, Clone, Deserialize)]
struct Column {
    name: String,
    #[serde(default)]
    unit: String,
    values: Vec<f64>,
}

/// Columns of a gas table that are above 0, and those that are at least 0.
const ABOVE_ZERO: [&str; 5] = [
    "temperature_k",
    "density_kg_m3",
    "specific_heat_j_kg_k",
    "viscosity_pa_s",
    "thermal_conductivity_w_m_k",
];
const NOT_NEGATIVE: [&str; 1] = ["electric_conductivity_s_m"];

impl GasFile {
    fn column(&self, name: &str) -> Result<&[f64], Error> {
        let found = self.columns.iter().find(|c| c.name == name);
        let found = found.ok_or_else(|| Error::GasTable(format!("has no column {name}")))?;
        Ok(&found.values)
    }

    fn table(&self, name: &str) -> Result<Table, Error> {
        let (t, values) = (self.column("temperature_k")?, self.column(name)?);
        Table::new(t.to_vec(), values.to_vec()).map_err(|e| Error::GasTable(format!("{name}: {e}")))
    }

    /// The rows of `name`, with one more beyond the end where the table is to go on.
    fn rows(&self, name: &str, beyond: BeyondTable) -> Result<Table, Error> {
        let table = self.table(name)?;
        if beyond != BeyondTable::Extend {
            return Ok(table);
        }
        let (mut t, mut y) = (table.nodes().to_vec(), table.values().to_vec());
        let (t_end, y_end) = (t[t.len() - 1], y[y.len() - 1]);
        let slope = table.slope(t_end);
        let last = EXTENDED_K.max(2.0 * t_end);
        // Enough rows for the curve of the density.
        for k in 1..=EXTENDED_ROWS {
            let next = t_end + (last - t_end) * k as f64 / EXTENDED_ROWS as f64;
            t.push(next);
            y.push(match name {
                "density_kg_m3" => y_end * t_end / next,
                "viscosity_pa_s" => y_end,
                _ => (y_end + slope * (next - t_end)).max(0.5 * y_end),
            });
        }
        Table::new(t, y).map_err(|e| Error::GasTable(format!("{name}: {e}")))
    }

    /// The first value that no gas can have, with column, row, temperature, unit and range.
    #[must_use]
    pub fn impossible(&self) -> Option<String> {
        let temperatures = self.column("temperature_k").unwrap_or_default();
        self.columns.iter().find_map(|column| {
            let strict = ABOVE_ZERO.contains(&column.name.as_str());
            if !strict && !NOT_NEGATIVE.contains(&column.name.as_str()) {
                return None;
            }
            let good = |v: &f64| *v > 0.0 || (*v >= 0.0 && !strict);
            let row = column.values.iter().position(|v| !good(v))?;
            let at = match temperatures.get(row) {
                Some(t) if column.name != "temperature_k" => format!(" ({t} K)"),
                _ => String::new(),
            };
            Some(format!(
                "column {}, row {row}{at}: {} {} is out of range: {} 0",
                column.name,
                column.values[row],
                column.unit,
                if strict { "above" } else { "at least" }
            ))
        })
    }

    /// The gas as a material.
    ///
    /// # Errors
    /// When a column is missing or is not a table.
    pub fn material(&self, beyond: BeyondTable) -> Result<Material, Error> {
        let law = |name: &str| self.rows(name, beyond).map(|t| Some(Law::Table(t)));
        let specific_heat = self.rows("specific_heat_j_kg_k", beyond)?;
        let bad = |e: props::Error| Error::GasTable(format!("specific_heat_j_kg_k: {e}"));
        Ok(Material {
            name: "gas".to_owned(),
            density: law("density_kg_m3")?,
            viscosity: law("viscosity_pa_s")?,
            thermal_conductivity: law("thermal_conductivity_w_m_k")?,
            electric_conductivity: law("electric_conductivity_s_m")?,
            net_emission: law("net_emission_w_m3")?,
            melting: None,
            end_k: Some(self.table("temperature_k")?.last()),
            end_is_error: beyond == BeyondTable::Error,
            enthalpy: Some(Enthalpy::new(&specific_heat, None).map_err(bad)?),
        })
    }
}

/// The gas, then the bodies in the order of their names.
pub(crate) fn materials(
    scene: &Scene,
    gas: Option<&GasFile>,
    faults: &mut Faults,
) -> Vec<Material> {
    let mut all = vec![gas_material(scene, gas, faults)];
    for (name, body) in &scene.bodies {
        all.push(body_material(scene, name, body, faults));
    }
    all
}

fn gas_material(scene: &Scene, file: Option<&GasFile>, faults: &mut Faults) -> Material {
    match (&scene.gas, file) {
        (Gas::Table(table), Some(file)) => match file.material(table.beyond_table) {
            Ok(material) => material,
            Err(e) => {
                faults.add("/gas/table", e.to_string());
                Material::default()
            }
        },
        (Gas::Table(_), None) => {
            faults.add("/gas/table", "wants the input \"gas\": --input gas=FILE");
            Material::default()
        }
        (Gas::Given(given), _) => {
            let (flow, heat) = (scene.flow.is_some(), scene.heat.is_some());
            let mut law = |property: &Option<Property>, name: &str, needed: bool| {
                read(
                    property.as_ref(),
                    &format!("/gas/given/{name}"),
                    needed,
                    faults,
                )
            };
            Material {
                name: "gas".to_owned(),
                density: law(&given.density_kg_m3, "density_kg_m3", flow),
                viscosity: law(&given.viscosity_pa_s, "viscosity_pa_s", flow),
                thermal_conductivity: law(
                    &given.thermal_conductivity_w_m_k,
                    "thermal_conductivity_w_m_k",
                    heat,
                ),
                electric_conductivity: law(
                    &given.electric_conductivity_s_m,
                    "electric_conductivity_s_m",
                    scene.current.is_some(),
                ),
                net_emission: law(&given.net_emission_w_m3, "net_emission_w_m3", false),
                enthalpy: enthalpy(
                    given.specific_heat_j_kg_k.as_ref(),
                    None,
                    "/gas/given/specific_heat_j_kg_k",
                    heat,
                    faults,
                ),
                melting: None,
                end_k: None,
                end_is_error: false,
            }
        }
    }
}

fn body_material(scene: &Scene, name: &str, body: &Body, faults: &mut Faults) -> Material {
    let (current, heat) = (scene.current.is_some(), scene.heat.is_some());
    let metal = &body.material;
    let at = format!("/bodies/{name}/material");
    let density = metal.density_kg_m3.map(Law::Constant);
    if density.is_none() && body.moving.is_some() && heat {
        faults.add(&at, "a moving body wants density_kg_m3");
    }
    let melting = metal.melting.as_ref().map(|m| Melting {
        point: m.point_k,
        half_range: m.half_range_k,
        latent_heat: m.latent_heat_j_kg,
    });
    let path = format!("{at}/specific_heat_j_kg_k");
    let own = metal.thermal_conductivity_w_m_k.as_ref();
    let thermal = read(
        own,
        &format!("{at}/thermal_conductivity_w_m_k"),
        heat,
        faults,
    );
    let thermal = match &body.granular {
        Some(granular) => thermal.map(|law| conductivity(law, granular, melting)),
        None => thermal,
    };
    Material {
        name: name.to_owned(),
        density,
        viscosity: None,
        thermal_conductivity: thermal,
        electric_conductivity: read(
            metal.electric_conductivity_s_m.as_ref(),
            &format!("{at}/electric_conductivity_s_m"),
            current,
            faults,
        ),
        net_emission: None,
        melting,
        enthalpy: enthalpy(
            metal.specific_heat_j_kg_k.as_ref(),
            melting,
            &path,
            heat,
            faults,
        ),
        end_k: None,
        end_is_error: false,
    }
}

/// A law that may be absent unless the physics needs it; its constants are not negative.
fn read(property: Option<&Property>, at: &str, needed: bool, faults: &mut Faults) -> Option<Law> {
    let Some(property) = property else {
        if needed {
            faults.add(at, "is missing; the physics of this scene needs it");
        }
        return None;
    };
    match faults.keep(property.compile(at, &NAMES))? {
        Curve::Constant(value) if value < 0.0 => {
            faults.add(at, format!("{value} is below 0"));
            None
        }
        Curve::Constant(value) => Some(Law::Constant(value)),
        Curve::Table(rows) => {
            if let Some(n) = rows.values().iter().position(|v| *v < 0.0) {
                faults.add(
                    &format!("{at}/value/{n}"),
                    format!("{} is below 0", rows.values()[n]),
                );
                return None;
            }
            match Table::new(rows.temperatures().to_vec(), rows.values().to_vec()) {
                Ok(table) => Some(Law::Table(table)),
                Err(e) => {
                    faults.add(at, e.to_string());
                    None
                }
            }
        }
        Curve::Formula(formula) => Some(Law::formula(move |r, z, t| {
            let at = Arguments {
                x: r,
                r,
                z,
                temperature: t,
                ..Arguments::default()
            };
            formula.value(&at)
        })),
    }
}

fn enthalpy(
    heat: Option<&SpecificHeat>,
    melting: Option<Melting>,
    at: &str,
    needed: bool,
    faults: &mut Faults,
) -> Option<Enthalpy> {
    let Some(heat) = heat else {
        if needed {
            faults.add(at, "is missing; heat needs it");
        }
        return None;
    };
    let table = match (heat, melting) {
        (SpecificHeat::Constant(value), None) => return Some(Enthalpy::Linear(*value)),
        (SpecificHeat::Constant(value), Some(_)) => {
            Table::new(vec![REFERENCE_K, 2.0 * REFERENCE_K], vec![*value; 2])
        }
        (SpecificHeat::Table(t), _) => Table::new(t.t_k.clone(), t.value.clone()),
    };
    match table.and_then(|t| Enthalpy::new(&t, melting)) {
        Ok(enthalpy) => Some(enthalpy),
        Err(e) => {
            faults.add(at, e.to_string());
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file() -> GasFile {
        let names = [
            ("temperature_k", [300.0, 10_000.0, 20_000.0]),
            ("density_kg_m3", [1.6, 0.04, 0.01]),
            ("viscosity_pa_s", [2e-5, 2e-4, 1e-4]),
            ("specific_heat_j_kg_k", [520.0, 1500.0, 9000.0]),
            ("thermal_conductivity_w_m_k", [0.02, 1.0, 3.0]),
            ("electric_conductivity_s_m", [1e-5, 3000.0, 9000.0]),
            ("net_emission_w_m3", [0.0, 1e9, 3e10]),
        ];
        let column = |(name, values): (&str, [f64; 3])| Column {
            name: name.to_owned(),
            unit: "u".to_owned(),
            values: values.to_vec(),
        };
        GasFile {
            columns: names.into_iter().map(column).collect(),
        }
    }

    #[test]
    fn what_no_gas_can_have_is_told_with_its_row() {
        assert_eq!(file().impossible(), None);
        let spoilt = |column: usize, value: f64| {
            let mut file = file();
            file.columns[column].values[1] = value;
            file.impossible()
        };
        let told = spoilt(1, -0.04).unwrap();
        assert!(
            told.contains("density_kg_m3, row 1 (10000 K): -0.04 u"),
            "{told}"
        );
        assert!(spoilt(4, 0.0).is_some() && spoilt(0, -1.0).is_some());
        // A cold gas does not conduct, and a gas may absorb more than it emits.
        assert!(spoilt(5, 0.0).is_none() && spoilt(5, -1.0).is_some());
        assert!(spoilt(6, -1.0).is_none());
    }

    #[test]
    fn an_extended_table_goes_on_and_a_held_one_does_not() {
        let extended = file().material(BeyondTable::Extend).unwrap();
        let at = |law: &Option<Law>, t: f64| law.as_ref().unwrap().at(0.0, 0.0, t);
        assert!((at(&extended.density, 40_000.0) - 0.005).abs() < 1e-5);
        assert!((at(&extended.net_emission, 25_000.0) - 4.45e10).abs() < 1.0);
        assert!((at(&extended.viscosity, 50_000.0) - 1e-4).abs() < 1e-15);
        let held = file().material(BeyondTable::Hold).unwrap();
        assert!((at(&held.net_emission, 25_000.0) - 3e10).abs() < 1.0);
        let strict = file().material(BeyondTable::Error).unwrap();
        assert!(strict.end_is_error && strict.end_k == Some(20_000.0));
        assert!(!held.end_is_error && !extended.end_is_error);
    }
}
