//! Density, enthalpy and specific heat of the reacting gas, with the exact derivatives of its composition.

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
