//! `gas-argon`: argon as a perfect gas when cold, as published when hot, and what tables of it cost.

use std::path::Path;

use artefact::Reader;
use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError, read_json};
use crate::plasma;

/// Molar gas constant \[J/(mol K)\], CODATA 2018.
const GAS_CONSTANT: f64 = 8.314_462_618;
/// Molar mass of argon \[kg/mol\] in the data of the program.
const MOLAR_MASS: f64 = 0.039_948;
/// Below this, argon has no electrons that matter \[K\].
const COLD: f64 = 3000.0;
/// Temperatures at which interpolation is judged.
const PROBES: u32 = 331;
/// Part of a column's greatest value below which errors count relative to this part.
const SMALL: f64 = 1e-3;
/// Published columns: what the errors are called, from and to where \[K\], and the greatest that is admitted.
const PUBLISHED: [(&str, &str, [f64; 2], f64); 4] = [
    (
        "specific_heat",
        "specific_heat_j_kg_k",
        [1300.0, 25_000.0],
        0.02,
    ),
    ("viscosity", "viscosity_pa_s", [1300.0, 25_000.0], 0.03),
    (
        "thermal_conductivity",
        "thermal_conductivity_w_m_k",
        [1300.0, 25_000.0],
        0.12,
    ),
    (
        "electric_conductivity",
        "electric_conductivity_s_m",
        [7000.0, 25_000.0],
        0.06,
    ),
];
/// Thermal conductivity, on the mean of its deviations.
const MEAN_CONDUCTION: f64 = 0.04;
/// The method with the levels that lists of spectra hold.
const LISTED: &str = "listed";

/// The case.
pub(super) struct GasArgon;

/// A table of one gas against temperature.
struct Sheet {
    temperatures: Vec<f64>,
    columns: Vec<(String, Vec<f64>)>,
}

impl Sheet {
    fn read(run: &Finished) -> Result<Self, LabError> {
        let table = Reader::open_kind(&run.artefact, "gas-table", 1)?.table("/gas")?;
        Ok(Self {
            temperatures: table.axis("temperature_k")?.to_vec(),
            columns: table
                .columns
                .into_iter()
                .map(|c| (c.name, c.values))
                .collect(),
        })
    }

    fn column(&self, name: &str) -> Result<&[f64], LabError> {
        let found = self.columns.iter().find(|(own, _)| own == name);
        found
            .map(|(_, values)| values.as_slice())
            .ok_or_else(|| LabError::Content {
                path: name.into(),
                what: "the gas table has no such column".to_owned(),
            })
    }

    /// Linear interpolation.
    fn at(&self, values: &[f64], t: f64) -> f64 {
        let after = self
            .temperatures
            .partition_point(|node| *node < t)
            .clamp(1, values.len() - 1);
        let (low, high) = (self.temperatures[after - 1], self.temperatures[after]);
        let share = (t - low) / (high - low);
        values[after - 1] * (1.0 - share) + values[after] * share
    }

    /// Greatest error of interpolation over all columns of `exact`.
    fn interpolation(&self, exact: &Self) -> Result<f64, LabError> {
        let mut worst = 0.0_f64;
        for (name, values) in &exact.columns {
            let own = self.column(name)?;
            let least = SMALL * values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
            for (t, value) in exact.temperatures.iter().zip(values) {
                let error = (self.at(own, *t) - value).abs() / value.abs().max(least);
                worst = worst.max(error);
            }
        }
        Ok(worst)
    }

    /// Greatest deviation of cold argon from a perfect gas of atoms: density, specific heat, conductivity by viscosity.
    fn perfect_gas(&self, pressure: f64) -> Result<f64, LabError> {
        let specific = GAS_CONSTANT / MOLAR_MASS;
        let density = self.column("density_kg_m3")?;
        let heat = self.column("specific_heat_j_kg_k")?;
        let viscosity = self.column("viscosity_pa_s")?;
        let conductivity = self.column("thermal_conductivity_w_m_k")?;
        let mut worst = 0.0_f64;
        for (k, t) in self
            .temperatures
            .iter()
            .enumerate()
            .take_while(|(_, t)| **t <= COLD)
        {
            for ratio in [
                density[k] * specific * t / pressure,
                heat[k] / (2.5 * specific),
                conductivity[k] / (3.75 * specific * viscosity[k]),
            ] {
                worst = worst.max((ratio - 1.0).abs());
            }
        }
        Ok(worst)
    }

    /// Greatest difference between enthalpy and the trapezoidal integral of specific heat, as a part of the rise of
    /// enthalpy over the whole table.
    fn enthalpy(&self) -> Result<f64, LabError> {
        let (enthalpy, heat) = (
            self.column("enthalpy_j_kg")?,
            self.column("specific_heat_j_kg_k")?,
        );
        let last = enthalpy.len() - 1;
        let (mut integral, mut worst) = (enthalpy[0], 0.0_f64);
        for k in 0..last {
            let step = self.temperatures[k + 1] - self.temperatures[k];
            integral += 0.5 * step * (heat[k] + heat[k + 1]);
            worst = worst.max((integral - enthalpy[k + 1]).abs());
        }
        Ok(worst / (enthalpy[last] - enthalpy[0]))
    }

    /// Greatest and mean deviation from a published column between two temperatures \[K\].
    fn published(
        &self,
        published: &Value,
        name: &str,
        [from, to]: [f64; 2],
    ) -> Result<[f64; 2], LabError> {
        let own = self.column(name)?;
        let numbers = |name: &str| -> Vec<f64> {
            let columns = published["columns"].as_array().into_iter().flatten();
            let found = columns.filter(|column| column["name"] == name);
            let values = found.flat_map(|column| column["values"].as_array().into_iter().flatten());
            values.filter_map(Value::as_f64).collect()
        };
        let temperatures = numbers("temperature_k");
        let deviations: Vec<f64> = temperatures
            .iter()
            .zip(numbers(name))
            .filter(|(t, _)| (from..=to).contains(*t))
            .map(|(t, value)| (self.at(own, *t) / value - 1.0).abs())
            .collect();
        let worst = deviations.iter().fold(f64::NAN, |most, d| most.max(*d));
        let mean = deviations.iter().sum::<f64>() / deviations.len() as f64;
        Ok([worst, mean])
    }
}

/// Temperatures that are nodes of no table \[K\].
fn probes() -> Vec<f64> {
    let step = (25_000.0 - 300.0) / f64::from(PROBES);
    (0..PROBES)
        .map(|k| 300.0 + (f64::from(k) + 0.618_034) * step)
        .collect()
}

fn reference(root: &Path) -> Result<Value, LabError> {
    Ok(read_json(&root.join("pipelines/gases/reference-argon.json"))?["tables"][0].take())
}

impl Case for GasArgon {
    fn name(&self) -> &'static str {
        "gas-argon"
    }

    fn tool(&self) -> &'static str {
        "gasprop"
    }

    fn reference(&self) -> &'static str {
        "perfect gas of atoms when cold (Chapman and Enskog: k = 15/4 R/M mu), dh = cp dT, published argon at 1.0133 atm"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["even", "chosen", LISTED]
    }

    fn targets(&self) -> Vec<Target> {
        let mut targets = vec![
            Target::error("perfect_gas", 1e-5),
            Target::order("enthalpy", 1.9),
            Target::order("interpolation_linf", 1.8),
            Target::error("interpolation_linf", 2e-3).of("chosen"),
        ];
        for (name, _, _, most) in PUBLISHED {
            let target = || Target::error(format!("published_{name}"), most);
            if name == "specific_heat" {
                // Levels as listed err by more, which this case is to show.
                targets.extend(["even", "chosen"].map(|method| target().of(method)));
            } else {
                targets.push(target());
            }
        }
        targets.push(Target::error(
            "published_thermal_conductivity_mean",
            MEAN_CONDUCTION,
        ));
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let count = 50 * (1 << level);
        let range = json!({"from_k": 300, "to_k": 25_000, "count": count});
        let patch = match method {
            "even" => json!({"temperatures": {"even": range}}),
            LISTED => json!({"temperatures": {"even": range}, "uncertain": {"levels": "listed"}}),
            _ => json!({"temperatures": {"even": null, "chosen": range}}),
        };
        let run = lab.run("gasprop", self.name(), &format!("{method}{level}"), &patch)?;
        let mut probe = json!({"temperatures": {"even": null, "list-k": probes()}});
        probe["uncertain"] = patch["uncertain"].clone();
        let name = if method == LISTED {
            "probe-listed"
        } else {
            "probe"
        };
        let exact = Sheet::read(&lab.run("gasprop", self.name(), name, &probe)?)?;
        let sheet = Sheet::read(&run)?;
        let pressure = plasma::number(&run, "/pressure_pa")?;
        let mut errors = Errors::from([
            (
                "interpolation_linf".to_owned(),
                sheet.interpolation(&exact)?,
            ),
            ("enthalpy".to_owned(), sheet.enthalpy()?),
            ("perfect_gas".to_owned(), sheet.perfect_gas(pressure)?),
        ]);
        let published = reference(&lab.root)?;
        for (name, column, range, _) in PUBLISHED {
            let [worst, mean] = sheet.published(&published, column, range)?;
            errors.insert(format!("published_{name}"), worst);
            if name == "thermal_conductivity" {
                errors.insert(format!("published_{name}_mean"), mean);
            }
        }
        // Spacing is a temperature here [K]: nothing has a place.
        let spacing = (25_000.0 - 300.0) / f64::from(count - 1);
        Ok(Measurement::of(
            run,
            sheet.temperatures.len() as u64,
            spacing,
            errors,
        ))
    }
}
