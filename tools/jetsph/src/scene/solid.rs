//! Solids in a scene.

use run::property::Property;
use schemars::JsonSchema;
use serde::Deserialize;
use shapes::Shape;

use crate::matter::solid::fracture::Criterion;
use crate::matter::solid::law::Elastic;
use crate::matter::solid::plastic::Plasticity;
use crate::matter::solid::shocks::ShockViscosity;

/// A solid body.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Solid {
    /// Name, which its channel carries.
    #[schemars(regex(pattern = "^[a-z][a-z0-9_-]*$"))]
    pub name: String,
    /// Its shape at rest.
    pub body: Shape,
    /// Spacing d of its particles; cells fit a box exactly.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub spacing_m: f64,
    /// How the particles stand; along the axes, or along those of a turned box, if absent.
    pub lattice: Option<LatticeScene>,
    /// rho at rest.
    #[schemars(extend("x-unit" = "kg/m3", "exclusiveMinimum" = 0.0))]
    pub density_kg_m3: f64,
    /// Elastic constants: E and nu, or K and G.
    pub elastic: Elastic,
    /// Plastic flow of metals; none if absent.
    pub plasticity: Option<Plasticity>,
    /// When it breaks; never if absent.
    pub fracture: Option<Criterion>,
    /// Artificial viscosity (38); none if absent.
    pub artificial_viscosity: Option<ShockViscosity>,
    /// By the rates of its present state (32)-(37), as in the source, for comparison: a free, elastic body, whose particles water sees
    /// as they stand. By its deformation since rest (total Lagrangian) if absent.
    pub updated_form: Option<UpdatedForm>,
    /// Velocity at the start: a number or a formula in x, y, z for each axis; rest if absent.
    #[schemars(extend("x-unit" = "m/s"), length(min = 2, max = 3))]
    pub velocity_m_s: Option<Vec<Property>>,
    /// Faces that are held.
    #[serde(default)]
    pub clamps: Vec<Clamp>,
    /// Faces that are loaded.
    #[serde(default)]
    pub loads: Vec<LoadScene>,
    /// Rate at which velocities die away, to find states of rest; nothing damps them if absent.
    #[schemars(extend("x-unit" = "1/s", "exclusiveMinimum" = 0.0))]
    pub damping_1_s: Option<f64>,
}

/// The updated form of an elastic solid.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UpdatedForm {
    /// s: the artificial stress over that which pulls (Gray, Monaghan and Swift 2001); with 0 it breaks where nothing should.
    #[serde(default = "usual_artificial_stress")]
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub artificial_stress: f64,
}

fn usual_artificial_stress() -> f64 {
    0.3
}

/// How the particles of a body stand.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LatticeScene {
    /// Angle of the lattice about z; the body does not turn with it.
    #[serde(default)]
    pub turned_deg: f64,
    /// Particles are shaken by up to this part of the spacing along each axis.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 0.4), extend("x-unit" = "1"))]
    pub jitter: f64,
}

/// Faces that are held where they are, or moved.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Clamp {
    /// Names of faces: `x-`, or `NAME.x-` of a named shape.
    #[schemars(length(min = 1))]
    pub on: Vec<String>,
    /// Only the part of the faces within this shape.
    pub within: Option<Shape>,
    /// Velocity with which they are moved; they rest if absent.
    #[schemars(extend("x-unit" = "m/s"), length(min = 2, max = 3))]
    pub velocity_m_s: Option<Vec<f64>>,
}

/// A traction on faces, the same at all times and in all deformations.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadScene {
    /// Names of faces: `x+`, or `NAME.x+` of a named shape.
    #[schemars(length(min = 1))]
    pub on: Vec<String>,
    /// Only the part of the faces within this shape.
    pub within: Option<Shape>,
    /// Force on the area at rest, along each axis.
    #[schemars(extend("x-unit" = "Pa"), length(min = 2, max = 3))]
    pub traction_pa: Option<Vec<f64>>,
    /// In place of it a pressure on the area at rest, into the body.
    #[schemars(extend("x-unit" = "Pa"))]
    pub pressure_pa: Option<f64>,
    /// Time in which it rises from nothing; it is there from the start if absent.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub rise_s: Option<f64>,
}

/// Contact of solids with each other and with plain walls.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactScene {
    /// zeta: 0 loses nothing, 1 does not bounce.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub damping: f64,
}
