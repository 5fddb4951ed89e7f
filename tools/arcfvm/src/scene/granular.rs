//! Granular flux.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Granular flux that melts into slag and boils into the cavity (Komen 2019, section 5.2.3). It melts
/// as `material/melting` says.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Granular {
    /// How many times as well as flux slag conducts heat, for the convection within it.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub slag_conductivity_ratio: f64,
    /// What is hotter, and joins the gas, is gas.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub boiling_k: f64,
    /// Part of all radiation of the gas that flux and slag take up; absent: none.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub absorbed_radiation: Option<f64>,
    /// Length within which it falls by a factor of e from the wall of the cavity inward, some grains; absent: it is taken up
    /// evenly over the volume of the body, as Komen (2019) has it.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub absorption_length_m: Option<f64>,
    /// Refractive index of slag: molten, it lets light through for the length of absorption, and conducts heat by its own
    /// radiation too (Rosseland 1924). Absent: it does not.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub refractive_index: Option<f64>,
    /// Mass fraction of iron in the gas at the wall of the cavity, where slag takes up iron and gives off
    /// as much gas; absent: neither.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub iron_mass_fraction: Option<f64>,
}
