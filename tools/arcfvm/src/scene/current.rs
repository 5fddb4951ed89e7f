//! The electric current.

use run::property::Property;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Sides;

/// Electric current (Komen 2019, eqs 5.10 to 5.15).
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Current {
    /// What the edges are; insulated where nothing is said.
    pub edges: Sides<CurrentEdge>,
    /// Given source of current in r, z; manufactured solutions only \[A/m3\].
    pub source_a_m3: Option<Property>,
    /// Sheath: gas within this distance of an electrode has the electric conductivity of the gas just beyond (Komen 2019,
    /// section 5.2.3). Absent: no sheath, the conductivity follows the temperature of the gas itself.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub sheath_m: Option<f64>,
    /// Electrodes that have a sheath.
    #[serde(default)]
    pub sheath_at: SheathAt,
    /// Quantity in which the gas of the sheath equals the gas just beyond.
    #[serde(default)]
    pub sheath_keeps: SheathKeeps,
}

/// What gas close to an electrode takes from the gas beyond.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SheathKeeps {
    /// Its conductivity.
    #[default]
    Conductivity,
    /// Its electron density (Komen 2019, fig. 5.12): it conducts as gas with its own iron does at the
    /// temperature of as many electrons. Wants a gas table that tells them.
    ElectronDensity,
}

/// Electrodes with a sheath.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SheathAt {
    /// Anode and cathode.
    #[default]
    Electrodes,
    /// The cathode, as Komen (2019), fig. 5.12, has it.
    Cathode,
}

/// Current at an edge: exactly one condition.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CurrentEdge {
    /// Part of the side, from and to; absent: all of it. Ends become faces of the grid.
    #[schemars(extend("x-unit" = "m"))]
    pub over_m: Option<[f64; 2]>,
    /// Fixed potential in r, z.
    pub voltage_v: Option<Property>,
    /// Current density into the domain in r, z.
    pub current_density_a_m2: Option<Property>,
    /// Current into the domain through an equipotential face; at one place of the scene only.
    pub total_current_a: Option<f64>,
}
