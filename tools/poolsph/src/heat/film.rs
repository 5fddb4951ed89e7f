//! Heat from the gas above the metal (Komen 2019, second term of eq. 4.10).
//!
//! Gas and metal meet half a diameter from the particle and at the height dz' below the point of
//! which the gas temperature is known; with one flux across both layers
//!
//! ```text
//! q = k_gas k_a (T_gas - T_a) / (k_gas d/2 + k_a dz')
//! ```
//!
//! k_gas is that of T_gas, as the viscosity of the gas is in its shear. Where it rises steeply, as in
//! an ionised gas, that is far above the mean over the layer, and so is the heat; a table of that
//! mean over T_gas may be given in its place.

use std::sync::Arc;

use props::Table;
use run::Fault;
use run::property::{Curve, Property};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::caloric::Caloric;
use super::flux::column;
use crate::stage::StageError;

/// The gas of the arc input that heats the metal (key `arc.gas`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GasFilm {
    /// k_gas(T) of the gas, taken at the gas temperature of the arc input.
    #[schemars(extend("x-unit" = "W/(m K)"))]
    pub thermal_conductivity_w_m_k: Property,
}

/// Layers of gas and metal that heat passes.
#[derive(Debug, Clone)]
pub(super) struct Film {
    /// T_gas over the distance from the axis \[K\].
    temperature: Table,
    conductivity: Curve,
    /// dz' \[m\].
    height: f64,
    /// d/2 \[m\].
    half: f64,
    caloric: Arc<Caloric>,
    /// Greatest k_gas of the table's rows \[W/(m K)\].
    most: f64,
}

impl Film {
    /// # Errors
    /// A fault at the key `gas`: the input lacks the gas temperature or its height, or the
    /// conductivity is not positive.
    pub(super) fn new(
        gas: &GasFilm,
        surface: &artefact::Table,
        spacing: f64,
        caloric: Arc<Caloric>,
    ) -> Result<Self, Fault> {
        let at = |what| Fault::at("/gas", what);
        let temperature = column(surface, "gas_temperature_k", |t| t).map_err(at)?;
        let height = surface
            .scalar("gas_temperature_height_m")
            .map_err(|fault| at(format!("arc input: {fault}")))?;
        if height.is_nan() || height <= 0.0 {
            let what = format!("arc input: gas_temperature_height_m is {height} m, not above 0 m");
            return Err(at(what));
        }
        let key = "/gas/thermal_conductivity_w_m_k";
        let law = &gas.thermal_conductivity_w_m_k;
        let conductivity = law.compile_positive(key, &["T"], "W/(m K)")?;
        let mut most = 0.0_f64;
        for t in temperature.values() {
            let found = conductivity.at_temperature(*t);
            let value = found.map_err(|fault| Fault::at(key, fault.to_string()))?;
            if value <= 0.0 {
                return Err(Fault::at(
                    key,
                    format!("{value} W/(m K) at {t} K, not above 0"),
                ));
            }
            most = most.max(value);
        }
        Ok(Self {
            temperature,
            conductivity,
            height,
            half: 0.5 * spacing,
            caloric,
            most,
        })
    }

    /// Distance beyond which nothing is known of the gas \[m\].
    pub(super) fn reach(&self) -> f64 {
        self.temperature.last()
    }

    /// Heat at the distance `r` \[m\] into metal of `t` \[K\] \[W/m2\].
    pub(super) fn heat(&self, r: f64, t: f64) -> Result<f64, StageError> {
        let gas = self.temperature.held(r);
        let k_gas = self.conductivity.at_temperature(gas).map_err(|fault| {
            StageError::Data(format!("thermal conductivity of the gas: {fault}"))
        })?;
        let k = self.caloric.conductivity(t);
        Ok(k_gas * k * (gas - t) / (k_gas * self.half + k * self.height))
    }

    /// Greatest fall of the heat with the temperature of the metal \[W/(m2 K)\]: that of the gas alone.
    pub(super) fn steepest(&self) -> f64 {
        self.most / self.height
    }
}

#[cfg(test)]
mod tests {
    use run::property::TemperatureTable;

    use super::super::caloric::tests::plain;
    use super::*;

    fn film(metal: f64, gas: Property) -> Result<Film, Fault> {
        let surface = artefact::Table::new(3)
            .column("radius_m", "m", [0.0, 0.005, 0.01])
            .column("gas_temperature_k", "K", [14e3, 8e3, 1e3])
            .attribute("gas_temperature_height_m", "m", 9e-5);
        let gas = GasFilm {
            thermal_conductivity_w_m_k: gas,
        };
        Film::new(&gas, &surface, 5e-4, Arc::new(plain(metal, 600.0, None)))
    }

    #[test]
    fn one_flux_crosses_both_layers() {
        let q = film(30.0, Property::Constant(0.6))
            .unwrap()
            .heat(0.0025, 1900.0)
            .unwrap();
        let surface = 11e3 - q * 9e-5 / 0.6;
        assert!(
            (surface - q * 2.5e-4 / 30.0 - 1900.0).abs() < 1e-9,
            "{surface}"
        );
    }

    #[test]
    fn metal_that_conducts_well_leaves_the_resistance_to_the_gas() {
        let film = film(1e9, Property::Constant(0.6)).unwrap();
        let q = film.heat(0.005, 2000.0).unwrap();
        assert!((q / (0.6 * 6e3 / 9e-5) - 1.0).abs() < 1e-8);
        let slope = film.heat(0.005, 2000.0).unwrap() - film.heat(0.005, 2001.0).unwrap();
        assert!((slope / film.steepest() - 1.0).abs() < 1e-8);
    }

    #[test]
    fn gas_that_conducts_well_leaves_the_resistance_to_the_metal() {
        let q = film(30.0, Property::Constant(1e9))
            .unwrap()
            .heat(0.005, 2000.0)
            .unwrap();
        assert!((q / (30.0 * 6e3 / 2.5e-4) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn gas_cools_metal_that_is_hotter() {
        let film = film(30.0, Property::Constant(0.05)).unwrap();
        assert!(film.heat(0.01, 1500.0).unwrap() < 0.0);
        assert!(film.heat(0.01, 1000.0).unwrap().abs() <= 0.0);
    }

    #[test]
    fn conductivities_that_end_or_are_not_positive_are_refused() {
        let short = Property::Table(TemperatureTable {
            t_k: vec![300.0, 10e3],
            value: vec![0.02, 0.6],
            extrapolate: run::property::Extrapolate::Error,
        });
        for (gas, word) in [(short, "14000"), (Property::Constant(-1.0), "-1")] {
            let fault = film(30.0, gas).unwrap_err().to_string();
            assert!(fault.contains("/gas/thermal_conductivity_w_m_k"), "{fault}");
            assert!(fault.contains(word), "{fault}");
        }
    }
}
