//! Iron vapour in the gas.

use run::property::Property;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Sides;

/// Iron vapour (Komen 2019, eqs 5.23 to 5.25): it comes from electrodes with `evaporation`, and every
/// property of the gas may depend on it.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Vapour {
    /// What the edges are; no iron diffuses through where nothing is said.
    #[serde(default)]
    pub edges: Sides<VapourEdge>,
    /// How iron diffuses.
    #[serde(default)]
    pub diffusion: Diffusion,
    /// What becomes of the mass of the vapour.
    #[serde(default)]
    pub mass: VapourMass,
    /// Temperature with which vapour comes back to metal.
    #[serde(default)]
    pub returns: Returns,
    /// Ionisation voltage of iron: with the fraction of iron in the gas, the ionisation voltage at a cathode changes from the
    /// cathode's own value to this one. Absent: it stays the cathode's own.
    #[schemars(range(min = 0.0, max = 30.0))]
    pub ionisation_voltage_v: Option<f64>,
    /// The fraction of iron that the ionisation voltage follows.
    #[serde(default)]
    pub ionisation_by: Amount,
    /// Mass fraction of iron at the start in r, z.
    #[serde(default = "none")]
    pub start: Property,
    /// Given source of iron in r, z; manufactured solutions only \[kg/(m3 s)\].
    pub source_kg_m3_s: Option<Property>,
}

fn none() -> Property {
    Property::Constant(0.0)
}

/// Vapour at an edge.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VapourEdge {
    /// Part of the side, from and to; absent: all of it. Ends become faces of the grid.
    #[schemars(extend("x-unit" = "m"))]
    pub over_m: Option<[f64; 2]>,
    /// Mass fraction of iron in r, z.
    pub iron_mass_fraction: Property,
}

/// How iron diffuses in the gas.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Diffusion {
    /// As `iron_diffusion_m2_s` of the gas says.
    #[default]
    Given,
    /// By the viscosities of both pure gases (Komen 2019, eq. 5.25); a gas table only.
    Viscosity,
}

/// How warm vapour comes back to metal, which tells how much of it does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Returns {
    /// As warm as the metal: saturated vapour and metal are in equilibrium.
    #[default]
    Metal,
    /// As warm as the gas nearby (Komen 2019, eq. 5.24 as printed): less comes back than from gas as dense
    /// that has cooled, and what hot gas can hold back grows with the root of its temperature.
    Gas,
}

/// A measure of how much iron there is in the gas.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Amount {
    /// Mole fraction.
    #[default]
    Mole,
    /// Mass fraction (Komen 2019, the Y of the text under eq. 5.21).
    Mass,
}

/// What becomes of the mass of the vapour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum VapourMass {
    /// It takes the place of as much gas (Komen 2019: the right side of eq. 3.5 is 0).
    #[default]
    Exchanged,
    /// As `exchanged`; what a boiling metal gives off beyond what the gas can take leaves at once, with its
    /// latent heat (Komen 2019, eq. 5.24 with the Y of eq. 5.23 at most 1).
    Vented,
    /// It adds to the gas, which flows away from where metal evaporates (Stefan 1873).
    Added,
}
