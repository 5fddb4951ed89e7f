//! Where fields are sought, and the bodies there.

use schemars::JsonSchema;
use serde::Deserialize;
use shapes::Shape;

use super::permeability::Permeability;
pub use crate::geometry::Geometry;

/// A box along the axes.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxDomain {
    /// Lower corner; two numbers unless in space. An axisymmetric box that begins at r = 0 has no wall there.
    #[schemars(extend("x-unit" = "m"), length(min = 2, max = 3))]
    pub min_m: Vec<f64>,
    /// Upper corner.
    #[schemars(extend("x-unit" = "m"), length(min = 2, max = 3))]
    pub max_m: Vec<f64>,
}

/// A ball; a disc in a plane, a half disc about the axis.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SphereDomain {
    /// Centre; on the axis where the scene is axisymmetric.
    #[schemars(extend("x-unit" = "m"), length(min = 2, max = 3))]
    pub centre_m: Vec<f64>,
    /// Radius.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub radius_m: f64,
}

/// The domain.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Domain {
    /// A box; its walls are `x-`, `x+`, `y-`, `y+`, `z-`, `z+` (axisymmetric: `r+`, `z-`, `z+`).
    Box(BoxDomain),
    /// A ball; its wall is `sphere`.
    Sphere(SphereDomain),
}

impl Default for Domain {
    /// No domain at all: a ball without a radius.
    fn default() -> Self {
        Self::Sphere(SphereDomain {
            centre_m: Vec::new(),
            radius_m: 0.0,
        })
    }
}

/// Properties of a medium, constant within it; where it saturates, with its permeability in weak fields.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Medium {
    /// Permittivity over that of vacuum; 1 when it is absent.
    #[serde(default = "one")]
    #[schemars(range(max = 1e12), extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub relative_permittivity: f64,
    /// Permeability over that of vacuum; 1 when it is absent.
    #[serde(default = "one")]
    #[schemars(range(max = 1e7), extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub relative_permeability: f64,
    /// Electric conductivity; 0 when it is absent: it does not conduct.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e12), extend("x-unit" = "S/m"))]
    pub conductivity_s_m: f64,
}

fn one() -> f64 {
    1.0
}

impl Default for Medium {
    fn default() -> Self {
        Self {
            relative_permittivity: 1.0,
            relative_permeability: 1.0,
            conductivity_s_m: 0.0,
        }
    }
}

/// A body.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodyScene {
    /// Name.
    pub name: String,
    /// Its shape; in an axisymmetric scene the section in r and z: a disc on the axis is a ball.
    pub shape: Shape,
    /// Permittivity over that of vacuum; 1 when it is absent.
    #[serde(default = "one")]
    #[schemars(range(max = 1e12), extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub relative_permittivity: f64,
    /// Permeability over that of vacuum: a number, or a curve of magnetisation in a static scene and in a march in time. 1 when it
    /// is absent.
    #[serde(default)]
    #[schemars(extend("x-unit" = "1"))]
    pub relative_permeability: Permeability,
    /// Electric conductivity; 0 when it is absent: it does not conduct.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e12), extend("x-unit" = "S/m"))]
    pub conductivity_s_m: f64,
    /// Potential of the body as an electrode in electrostatics; when it is absent the body is a dielectric.
    #[schemars(extend("x-unit" = "V"))]
    pub potential_v: Option<f64>,
    /// Net current along z of a bar in a plane scene, in a sinusoidal steady state; 0 for a bar that is joined to no other. When it
    /// is absent the ends of the bar are joined to those of the other bars far away.
    #[schemars(extend("x-unit" = "A"))]
    pub net_current_a: Option<f64>,
    /// Phase by which the net current leads; 0 when it is absent.
    pub net_current_phase_deg: Option<f64>,
    /// Distance of points along its surface; that of `points` when it is absent. Near a body with finer points it decreases as the
    /// spacing of the lattice does.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub spacing_m: Option<f64>,
}

impl BodyScene {
    /// Its properties.
    #[must_use]
    pub fn medium(&self) -> Medium {
        Medium {
            relative_permittivity: self.relative_permittivity,
            relative_permeability: self.relative_permeability.initial(),
            conductivity_s_m: self.conductivity_s_m,
        }
    }
}
