//! Density, enthalpy and specific heat of the reacting gas, with the exact derivatives of its composition.

use super::composition::Solution;
use super::system::Recipe;
use super::{EquilibriumError, Mixture, State};
use crate::constants::BOLTZMANN;
use nalgebra::DVector;
use std::f64::consts::PI;

/// What a state holds, and how it answers to temperature and iron at constant pressure.
#[derive(Debug, Clone, PartialEq)]
pub struct Thermodynamics {
    /// Density rho, kg/m3.
    pub density: f64,
    /// Enthalpy h above separate neutral atoms in their ground states at rest, J/kg.
    pub enthalpy: f64,
    /// Specific heat at constant pressure of the reacting gas, dh/dT, J/(kg K).
    pub specific_heat: f64,
    /// Specific heat with the composition held: flight and internal modes alone, J/(kg K).
    pub specific_heat_frozen: f64,
    /// d ln n_s / dT at constant pressure and elements, 1/K; in the order of the species, 0 for absent ones.
    pub log_number_by_temperature: Vec<f64>,
    /// d n_s / dT at constant pressure and elements, 1/(m3 K).
    pub number_by_temperature: Vec<f64>,
    /// d n_s / d x_iron at constant pressure and temperature, 1/m3; 0 without iron.
    pub number_by_iron: Vec<f64>,
}

/// So little of an absent component that it changes nothing, and yet its species answer.
const TRACE: f64 = 1e-200;

impl Mixture {
    /// Density, enthalpy, specific heat and derivatives of a state that [`Mixture::equilibrium`] found.
    ///
    /// At x = 0 and x = 1 of a mixture with iron, the derivatives by x are those of the first trace of what is absent.
    ///
    /// # Errors
    /// As [`Mixture::equilibrium`].
    pub fn thermodynamics(&self, state: &State) -> Result<Thermodynamics, EquilibriumError> {
        let least = if self.with_iron { TRACE } else { 0.0 };
        let recipe = Recipe {
            gas: (1.0 - state.iron).max(least),
            iron: state.iron.max(least),
        };
        let complete = !self.with_iron || recipe.iron.min(recipe.gas) > TRACE;
        let found = complete.then(|| self.again(state, recipe)).flatten();
        let solution = match found {
            Some(solution) => solution,
            None => self.solve(state.temperature, state.pressure, recipe)?,
        };
        let singular = || EquilibriumError::Singular {
            temperature: state.temperature,
            pressure: state.pressure,
            iron: state.iron,
        };
        let (unknowns, by_temperature) = solution.by_temperature().ok_or_else(singular)?;
        let by_iron = if self.with_iron {
            solution.by_iron().ok_or_else(singular)?
        } else {
            vec![0.0; by_temperature.len()]
        };
        let mut result = solution.energies(&unknowns, &by_temperature);
        result.log_number_by_temperature = vec![0.0; self.species.len()];
        result.number_by_temperature = vec![0.0; self.species.len()];
        result.number_by_iron = vec![0.0; self.species.len()];
        for (i, member) in solution.system.members.iter().enumerate() {
            let number = solution.evaluation.logarithms[i].exp();
            result.log_number_by_temperature[member.index] = by_temperature[i];
            result.number_by_temperature[member.index] = number * by_temperature[i];
            result.number_by_iron[member.index] = number * by_iron[i];
        }
        Ok(result)
    }
}

impl Solution {
    /// Density, enthalpy and specific heats, from sums per volume: rho = sum m n, and with pressure p and the energy of
    /// screening, rho h = sum n (3/2 kT + e) + p - kT K^3/8 pi, e the energy above neutral atoms without flight.
    fn energies(&self, unknowns: &DVector<f64>, by_temperature: &[f64]) -> Thermodynamics {
        let temperature = self.system.temperature;
        let (mut density, mut content, mut frozen) = (0.0, 0.0, 0.0);
        let (mut density_slope, mut content_slope) = (0.0, 0.0);
        let members = self
            .system
            .members
            .iter()
            .zip(&self.evaluation.logarithms)
            .zip(by_temperature);
        for ((member, log), slope) in members {
            let number = log.exp();
            let energy = 1.5 * BOLTZMANN * temperature + member.energy;
            let capacity = 1.5 * BOLTZMANN + member.heat_capacity;
            density += number * member.mass;
            density_slope += number * slope * member.mass;
            content += number * energy;
            content_slope += number * (slope * energy + capacity);
            frozen += number * (capacity + BOLTZMANN);
        }
        let screening = self.basis.components.len() + 1;
        if let (Some(log), Some(slope)) = (self.unknowns.get(screening), unknowns.get(screening)) {
            let energy = BOLTZMANN * temperature * (3.0 * log).exp() / (8.0 * PI);
            content -= energy;
            content_slope -= energy * (1.0 / temperature + 3.0 * slope);
        }
        let enthalpy = (content + self.pressure) / density;
        Thermodynamics {
            density,
            enthalpy,
            specific_heat: (content_slope - enthalpy * density_slope) / density,
            specific_heat_frozen: frozen / density,
            log_number_by_temperature: Vec::new(),
            number_by_temperature: Vec::new(),
            number_by_iron: Vec::new(),
        }
    }
}
