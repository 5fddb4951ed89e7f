//! The flow of the gas.

use run::property::Property;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Sides;

/// Flow of the gas (Komen 2019, eqs 3.3 to 3.5, 5.1, 5.2); the Lorentz force acts if there is current.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlowScene {
    /// What the edges are; at zero radius the axis, else walls where nothing is said.
    #[serde(default)]
    pub edges: Sides<FlowEdge>,
    /// Downward acceleration, acting on the excess over the density at 300 K \[m/s2\]; absent: none.
    #[schemars(range(min = 0.0))]
    pub gravity_m_s2: Option<f64>,
    /// Given radial force in r, z; manufactured solutions only \[N/m3\].
    pub force_radial_n_m3: Option<Property>,
    /// Given axial force in r, z; manufactured solutions only \[N/m3\].
    pub force_axial_n_m3: Option<Property>,
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
