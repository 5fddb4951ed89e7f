//! Temperatures at the start.

use run::property::Property;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::material::REFERENCE_K;

/// Temperatures at the start, and throughout where heat is not solved.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Start {
    /// Everywhere, in r, z \[K\].
    #[serde(default = "room")]
    pub temperature_k: Property,
    /// Hot gas below and around the tip of the wire, or over the whole height without one; absent:
    /// none.
    pub channel: Option<Channel>,
}

/// Hot gas around the axis.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Channel {
    /// Radius of the channel.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub radius_m: f64,
    /// Temperature within.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub temperature_k: f64,
}

fn room() -> Property {
    Property::Constant(REFERENCE_K)
}

impl Default for Start {
    fn default() -> Self {
        Self {
            temperature_k: room(),
            channel: None,
        }
    }
}
