//! Heat from the gas above the metal (Komen 2019, second term of eq. 4.10).
//!
//! Gas and metal meet, at the temperature T_s, half a diameter from the particle and at the height
//! dz' below the point of which the gas temperature is known. One flux crosses both layers:
//!
//! ```text
//! q = (Phi(T_gas) - Phi(T_s)) / dz' = k_a (T_s - T_a) / (d/2),    Phi(T) = integral of k_gas up to T
//! ```
//!
//! Eq. 4.10 has k_gas (T_gas - T_s) with k_gas at one temperature in place of the integral. The
//! conductivity of an ionised gas rises so steeply that what it is at T_gas is several times its mean
//! over the layer, and so would be the heat.

use std::sync::Arc;

use props::{Integral, Table};
use run::Fault;
use run::property::Property;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::caloric::Caloric;
use super::parameters::table;
use super::radial::column;

/// Most turns of the search for the temperature of the surface.
const TURNS: usize = 60;
/// Change of the temperature of the surface, relative, that ends the search.
const CLOSE: f64 = 1e-12;

/// The gas of the arc input that heats the metal (key `arc.gas`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GasFilm {
    /// k_gas(T) of the gas, from the metal's temperature to that of the gas of the arc input.
    #[schemars(extend("x-unit" = "W/(m K)"))]
    pub thermal_conductivity_w_m_k: Property,
}

/// Layers of gas and metal that heat passes.
#[derive(Debug, Clone)]
pub(super) struct Film {
    /// T_gas over the distance from the axis \[K\].
    temperature: Table,
    /// Phi, and k_gas as its slope.
    conducted: Integral,
    /// dz' \[m\].
    height: f64,
    /// d/2 \[m\].
    half: f64,
    caloric: Arc<Caloric>,
    /// Greatest k_gas of the table's rows \[W/(m K)\].
    most: f64,
    /// T from which on k_gas is known \[K\].
    lowest: f64,
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
        law.compile_positive(key, &["T"], "W/(m K)")?;
        let hottest = temperature.values().iter().copied().fold(0.0, f64::max);
        let (conductivity, range) = table(law, key, (0.0, hottest.max(1.0)))?;
        if range.1 < hottest {
            let what = format!(
                "ends at {} K; the gas of the arc input has {hottest} K",
                range.1
            );
            return Err(Fault::at(key, what));
        }
        let most = conductivity.values().iter().copied().fold(0.0, f64::max);
        let conducted = Integral::new(&conductivity);
        Ok(Self {
            temperature,
            conducted: conducted.map_err(|fault| Fault::at(key, fault.to_string()))?,
            height,
            half: 0.5 * spacing,
            caloric,
            most,
            lowest: range.0,
        })
    }

    /// T from which on k_gas is known \[K\]; below, that of there is held.
    pub(super) fn lowest(&self) -> f64 {
        self.lowest
    }

    /// Distance beyond which nothing is known of the gas \[m\].
    pub(super) fn reach(&self) -> f64 {
        self.temperature.last()
    }

    /// Heat at the distance `r` \[m\] into metal of `t` \[K\] \[W/m2\].
    pub(super) fn heat(&self, r: f64, t: f64) -> f64 {
        let gas = self.temperature.held(r);
        let through_metal = self.caloric.conductivity(t) / self.half;
        let at_gas = self.conducted.value(gas);
        // Newton's method for T_s, held between what is known to be too cold and too hot.
        let (mut cold, mut hot) = (t.min(gas), t.max(gas));
        let mut surface = t;
        for _ in 0..TURNS {
            let through_gas = (at_gas - self.conducted.value(surface)) / self.height;
            let excess = through_gas - through_metal * (surface - t);
            if excess > 0.0 {
                cold = surface;
            } else {
                hot = surface;
            }
            let slope = self.conducted.slope(surface) / self.height + through_metal;
            let next = surface + excess / slope;
            let next = if (cold..=hot).contains(&next) {
                next
            } else {
                0.5 * (cold + hot)
            };
            let change = (next - surface).abs();
            surface = next;
            if change <= CLOSE * surface {
                break;
            }
        }
        through_metal * (surface - t)
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
            .heat(0.0025, 1900.0);
        let surface = 11e3 - q * 9e-5 / 0.6;
        assert!(
            (surface - q * 2.5e-4 / 30.0 - 1900.0).abs() < 1e-6,
            "{surface}"
        );
    }

    #[test]
    fn a_conductivity_that_rises_counts_by_its_mean() {
        // k = a T: Phi = a T^2/2, and T_s solves a quadratic equation.
        let (a, gas, t) = (1e-4, 11e3, 1900.0);
        let rising = Property::Table(TemperatureTable {
            t_k: vec![1.0, 20e3],
            value: vec![a, 20e3 * a],
            extrapolate: run::property::Extrapolate::Error,
        });
        let q = film(30.0, rising).unwrap().heat(0.0025, t);
        let (p, g) = (0.5 * a / 9e-5, 30.0 / 2.5e-4);
        let surface = (-g + (g * g + 4.0 * p * (p * gas * gas + g * t)).sqrt()) / (2.0 * p);
        assert!((q / (g * (surface - t)) - 1.0).abs() < 1e-9, "{q}");
        assert!(q < 0.6 * a * gas * (gas - t) / 9e-5);
    }

    #[test]
    fn metal_that_conducts_well_leaves_the_resistance_to_the_gas() {
        let film = film(1e9, Property::Constant(0.6)).unwrap();
        let q = film.heat(0.005, 2000.0);
        assert!((q / (0.6 * 6e3 / 9e-5) - 1.0).abs() < 1e-7);
        let slope = film.heat(0.005, 2000.0) - film.heat(0.005, 2010.0);
        assert!((slope / (10.0 * film.steepest()) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn gas_that_conducts_well_leaves_the_resistance_to_the_metal() {
        let q = film(30.0, Property::Constant(1e9))
            .unwrap()
            .heat(0.005, 2000.0);
        assert!((q / (30.0 * 6e3 / 2.5e-4) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn gas_cools_metal_that_is_hotter() {
        let film = film(30.0, Property::Constant(0.05)).unwrap();
        assert!(film.heat(0.01, 1500.0) < 0.0);
        assert!(film.heat(0.01, 1000.0).abs() <= 0.0);
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
