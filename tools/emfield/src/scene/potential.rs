//! Electrostatics in a scene.

use run::property::Property;
use schemars::JsonSchema;
use serde::Deserialize;

/// What holds at walls of the domain.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OuterPotential {
    /// Names of walls; every wall when they are absent.
    pub faces: Option<Vec<String>>,
    /// Potential, a function of x, y, z, r; no field passes through the wall when it is absent.
    #[schemars(extend("x-unit" = "V"))]
    pub potential_v: Option<Property>,
}

/// The electric field of charges and electrodes: div(eps grad V) = 0 (Matsuzawa 2017, eq. 2.60).
#[derive(Debug, Clone, PartialEq, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Electrostatics {
    /// What holds at the walls: the first entry that names a wall counts; a wall that none names lets no field
    /// through.
    #[serde(default)]
    pub outer: Vec<OuterPotential>,
    /// A uniform field E0 that acts from far away; the potential at the walls is then that given in `outer` beside
    /// `- E0 . x`.
    #[schemars(extend("x-unit" = "V/m"), length(min = 2, max = 3))]
    pub applied_field_v_m: Option<Vec<f64>>,
}
