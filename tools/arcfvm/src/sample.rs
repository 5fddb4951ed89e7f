//! Where the surface table samples the gas.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Heights above the base metal at which the gas is sampled (Komen 2019, figs 4.1, 4.5).
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sample {
    /// Height at which the velocity of the gas is sampled, for its shear on a pool.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub velocity_height_m: f64,
    /// Height at which the temperature of the gas is sampled, for the heat that it gives to a pool.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub temperature_height_m: f64,
}

impl Default for Sample {
    fn default() -> Self {
        Self {
            velocity_height_m: 3e-5,
            temperature_height_m: 9e-5,
        }
    }
}
