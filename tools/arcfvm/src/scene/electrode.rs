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
    /// Richardson constant of a thermionic cathode (Komen 2019, eq. 5.20). Exactly one of it and `fall_v` is given.
    #[schemars(range(min = 0.0))]
    pub richardson_a_m2_k2: Option<f64>,
    /// What ions give a thermionic cathode; absent: their whole ionisation voltage.
    pub ions: Option<Ions>,
    /// Cathode fall of a metal that does not emit by heat alone: the energy balance of the layer in front of it gives the
    /// shares of electrons and ions in the current (Benilov and Marotta 1995). Exactly one of `fall_v` and
    /// `richardson_a_m2_k2` is given.
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
    /// Saturation pressure p0, only in a scene with `vapour`; absent: by Clausius and Clapeyron's equation from the
    /// boiling point.
    pub saturation: Option<Saturation>,
}

/// Saturation pressure: log10(p0/atm) = `a` - `b_k`/T.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Saturation {
    /// a in log10(p0/atm) = a - b/T.
    pub a: f64,
    /// b in log10(p0/atm) = a - b/T.
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
    /// Work function of the emitting surface, used where this is the cathode: an oxide may emit more easily than the metal.
    /// Absent: that of the metal.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub emission_work_function_v: Option<f64>,
    /// Ionisation voltage of the gas, used where this is the cathode.
    #[schemars(range(min = 0.0, max = 30.0))]
    pub ionisation_voltage_v: f64,
    /// Richardson constant, used where this is a thermionic cathode. Exactly one of it and `fall_v` is given.
    #[schemars(range(min = 0.0))]
    pub richardson_a_m2_k2: Option<f64>,
    /// What ions give a thermionic cathode; absent: their whole ionisation voltage.
    pub ions: Option<Ions>,
    /// Cathode fall, used where this is a cathode that does not emit by heat alone. Exactly one of it and
    /// `richardson_a_m2_k2` is given.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub fall_v: Option<f64>,
    /// Emissivity.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub emissivity: f64,
    /// Evaporation; absent: none.
    pub evaporation: Option<Evaporation>,
}
