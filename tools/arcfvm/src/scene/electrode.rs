//! Electrodes: what happens where current crosses the surface of a body.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Electrode that takes up electrons (Komen 2019, eq. 5.16).
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Anode {
    /// Work function.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub work_function_v: f64,
    /// Emissivity.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub emissivity: f64,
    /// Evaporation; absent: none.
    pub evaporation: Option<Evaporation>,
}

/// Electrode that emits electrons (Komen 2019, eqs 5.19 to 5.21).
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cathode {
    /// Work function.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub work_function_v: f64,
    /// Ionisation voltage of the gas.
    #[schemars(range(min = 0.0, max = 30.0))]
    pub ionisation_voltage_v: f64,
    /// Richardson constant of a thermionic cathode (Komen 2019, eq. 5.20); or `fall_v`.
    #[schemars(range(min = 0.0))]
    pub richardson_a_m2_k2: Option<f64>,
    /// What ions give a thermionic cathode; absent: their whole ionisation voltage.
    pub ions: Option<Ions>,
    /// Cathode fall of a metal that does not emit by heat alone: the energy of the layer in front of it
    /// tells electrons from ions (Benilov and Marotta 1995); or `richardson_a_m2_k2`.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub fall_v: Option<f64>,
    /// Emissivity.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub emissivity: f64,
    /// Evaporation; absent: none.
    pub evaporation: Option<Evaporation>,
}

/// What ions give a thermionic cathode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Ions {
    /// Their ionisation voltage (Komen 2019, eq. 5.21). The electron that each takes from the metal is not paid for: the
    /// balance of the arc tells how much that is.
    Whole,
    /// Their ionisation voltage less the work function of that electron (Benilov 2008): voltage times current pays all.
    Net,
}

/// Vapour leaving a surface (Komen 2019, eq. 5.24). Without `vapour` in the scene it leaves into a vacuum;
/// with it, into the gas, which gives it back where it is saturated.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Evaporation {
    /// Boiling point at 1 atm.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub boiling_k: f64,
    /// Latent heat.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub latent_heat_j_kg: f64,
    /// Molar mass.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub molar_mass_kg_mol: f64,
    /// Saturation pressure p0, a scene with `vapour` only; absent: by Clausius and Clapeyron from the
    /// boiling point.
    pub saturation: Option<Saturation>,
}

/// Saturation pressure: log10(p0/atm) = `a` - `b_k`/T.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Saturation {
    /// The constant a.
    pub a: f64,
    /// The constant b.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub b_k: f64,
}

/// Electrode of either polarity: an anode where the driven current leaves it for the gas, a cathode
/// where it enters (Komen 2019, eqs 5.16, 5.19 to 5.21).
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Electrode {
    /// Work function.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub work_function_v: f64,
    /// Work function of what emits, where it is the cathode: its oxide may emit more easily than the
    /// metal; absent: the same.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub emission_work_function_v: Option<f64>,
    /// Ionisation voltage of the gas, where it is the cathode.
    #[schemars(range(min = 0.0, max = 30.0))]
    pub ionisation_voltage_v: f64,
    /// Richardson constant, where it is a thermionic cathode; or `fall_v`.
    #[schemars(range(min = 0.0))]
    pub richardson_a_m2_k2: Option<f64>,
    /// What ions give a thermionic cathode; absent: their whole ionisation voltage.
    pub ions: Option<Ions>,
    /// Cathode fall, where it is a cathode that does not emit by heat alone; or `richardson_a_m2_k2`.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub fall_v: Option<f64>,
    /// Emissivity.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub emissivity: f64,
    /// Evaporation; absent: none.
    pub evaporation: Option<Evaporation>,
}
