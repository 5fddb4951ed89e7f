//! What the fields meet at the four sides of the domain.

use run::property::Property;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Conditions of the four sides; of several that cover a face the last counts.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "Sides_{T}")]
pub struct Sides<T> {
    /// Smallest radius.
    pub inner: Vec<T>,
    /// Largest radius.
    pub outer: Vec<T>,
    /// Lowest height.
    pub bottom: Vec<T>,
    /// Greatest height.
    pub top: Vec<T>,
}

impl<T> Default for Sides<T> {
    fn default() -> Self {
        Self {
            inner: Vec::new(),
            outer: Vec::new(),
            bottom: Vec::new(),
            top: Vec::new(),
        }
    }
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

/// Flow at an edge: exactly one condition.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlowEdge {
    /// Part of the side, from and to; absent: all of it. Ends become faces of the grid.
    #[schemars(extend("x-unit" = "m"))]
    pub over_m: Option<[f64; 2]>,
    /// Radial and axial velocity in r, z: an inlet, or a moving wall.
    #[schemars(extend("x-unit" = "m/s"))]
    pub velocity_m_s: Option<[Property; 2]>,
    /// Volume per time that enters evenly over this part.
    pub flow_rate_m3_s: Option<f64>,
    /// Fixed pressure in r, z, above that of the gas at rest; gas drawn in comes from rest.
    pub pressure_pa: Option<Property>,
    /// `true`: nothing flows through, nothing drags: a plane of symmetry.
    pub slip: Option<bool>,
}

/// Heat at an edge: exactly one condition.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeatEdge {
    /// Part of the side, from and to; absent: all of it. Ends become faces of the grid.
    #[schemars(extend("x-unit" = "m"))]
    pub over_m: Option<[f64; 2]>,
    /// Fixed temperature in r, z.
    pub temperature_k: Option<Property>,
    /// Heat flux into the domain in r, z.
    pub flux_w_m2: Option<Property>,
}
