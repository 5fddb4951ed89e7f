//! What a scene says of a second liquid (key `slag`).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::state::slag::Slag;

/// A second liquid that does not mix with the metal, such as slag upon a pool: bodies of the material "slag". Its temperature is
/// not followed, so that the scene has no heat.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// rho \[kg/m3\].
    #[schemars(extend("x-unit" = "kg/m3", "exclusiveMinimum" = 0.0))]
    pub density_kg_m3: f64,
    /// Dynamic viscosity mu \[Pa s\].
    #[schemars(range(min = 0.0), extend("x-unit" = "Pa s"))]
    pub viscosity_pa_s: f64,
    /// Tension of the interface between both liquids \[N/m\]; it meets walls at right angles. Absent: none.
    #[serde(default)]
    #[schemars(range(min = 0.0), extend("x-unit" = "N/m"))]
    pub interface_tension_n_m: f64,
    /// Tension of its free surface \[N/m\], where the scene has tension; that of the metal if absent. Along the line where slag, metal and gas
    /// meet the three tensions are not balanced: how far slag spreads on metal is not told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0), extend("x-unit" = "N/m"))]
    pub surface_tension_n_m: Option<f64>,
}

impl Parameters {
    /// What the state knows of it.
    #[must_use]
    pub fn slag(self) -> Slag {
        Slag {
            density: self.density_kg_m3,
            viscosity: self.viscosity_pa_s,
            interface_tension: self.interface_tension_n_m,
            surface_tension: self.surface_tension_n_m,
        }
    }
}
