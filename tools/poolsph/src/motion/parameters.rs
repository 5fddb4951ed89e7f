//! What a scene says of the motion of the liquid (key `flow`).

use run::property::Property;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the liquid is kept incompressible.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// [`super::divergence_free`]: no divergence of the velocity, on particles that are kept even. Flows as a liquid does
    /// where the others bear a stress.
    #[default]
    DivergenceFree,
    /// [`super::projection`]: no compression at the end of the step. Holds splashes of few particles together best.
    Projection,
    /// [`super::homogenising`]: Komen (2019), section 3.3.4.
    Homogenising,
}

/// What liquid does on metal so cold that it freezes there at once.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum OnColdMetal {
    /// It slides until it is frozen as a whole.
    #[default]
    Slides,
    /// The particle that touches is held where the contact, halfway between both temperatures, is below the melting point, and
    /// bare cold metal does not draw the liquid on: the edge of a pool and drops on a cold plate are arrested.
    Sticks,
}

impl OnColdMetal {
    fn slides(&self) -> bool {
        *self == Self::Slides
    }
}

/// How the liquid moves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Dynamic viscosity mu \[Pa s\], a number or that of the temperature T.
    #[schemars(extend("x-unit" = "Pa s"))]
    pub viscosity_pa_s: Property,
    /// Acceleration of gravity \[m/s2\]; z points up.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "m/s2"))]
    pub gravity_m_s2: Option<[f64; 3]>,
    /// How the density is kept.
    #[serde(default)]
    pub method: Method,
    /// What liquid does on metal so cold that it freezes there at once; needs metal that melts.
    #[serde(default, skip_serializing_if = "OnColdMetal::slides")]
    pub on_cold_metal: OnColdMetal,
    /// Mean relative density error at which the pressure is good enough.
    #[serde(default = "default_tolerance")]
    #[schemars(range(min = 1e-9, max = 0.1))]
    pub density_tolerance: f64,
    /// Fewest pressure sweeps per substep.
    #[serde(default = "default_sweeps_min")]
    #[schemars(range(min = 1, max = 1000))]
    pub sweeps_min: u32,
    /// Most pressure sweeps per substep.
    #[serde(default = "default_sweeps_max")]
    #[schemars(range(min = 1, max = 100_000))]
    pub sweeps_max: u32,
}

fn default_tolerance() -> f64 {
    5e-5
}

fn default_sweeps_min() -> u32 {
    2
}

fn default_sweeps_max() -> u32 {
    100
}
