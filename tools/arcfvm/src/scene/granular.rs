//! Granular flux.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Granular flux that melts into slag and boils into the cavity (Komen 2019, section 5.2.3). It melts
/// as `material/melting` says.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Granular {
    /// Thermal conductivity of slag over that of flux; above 1 to allow for the convection in slag.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub slag_conductivity_ratio: f64,
    /// Boiling point of slag: a cell of the bed that is hotter, and is connected to the gas of the cavity, becomes gas.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub boiling_k: f64,
    /// Part of all radiation of the gas that flux and slag absorb; absent: none.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub absorbed_radiation: Option<f64>,
    /// Absorption length: from the wall of the cavity into the bed the radiation falls by a factor of e over this length, some
    /// grains. Absent: it is absorbed evenly over the volume of the body, as in Komen (2019).
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub absorption_length_m: Option<f64>,
    /// Refractive index of slag that is transparent over the absorption length: molten slag then conducts heat by its own
    /// radiation too (Rosseland 1924). Absent: slag does not conduct heat by radiation.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub refractive_index: Option<f64>,
    /// Mass fraction of iron in the gas at the wall of the cavity: slag takes up iron that diffuses there, and gives off as
    /// much gas. Absent: no iron passes the wall.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub iron_mass_fraction: Option<f64>,
}
