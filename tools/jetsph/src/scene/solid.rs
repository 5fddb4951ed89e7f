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
    /// How the lattice of the particles is turned or disturbed; along the axes, or along those of a turned box, if absent.
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
    /// Length over which 'fracture' takes the mean of strain or stress, so that the strength is the same on
    /// any spacing up to it, and the energy of a crack within 12 % from four spacings on; by each cell alone if absent, and then both
    /// depend on the spacing.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub fracture_length_m: Option<f64>,
    /// Artificial viscosity (38); none if absent.
    pub artificial_viscosity: Option<ShockViscosity>,
    /// The updated Lagrangian form of the source, eqs 32 to 37, for comparison: only for a free, elastic body; water meets its
    /// particles and not its faces. The total Lagrangian form if absent.
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
    /// Rate of a damping of all velocities, to find states of rest; no damping if absent.
    #[schemars(extend("x-unit" = "1/s", "exclusiveMinimum" = 0.0))]
    pub damping_1_s: Option<f64>,
}

/// The updated form of an elastic solid.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UpdatedForm {
    /// Artificial stress over the tensile stress (Gray, Monaghan and Swift 2001); with 0 the body breaks in tension without reason.
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
    /// Particles are shifted at random by up to this part of the spacing along each axis.
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
    /// Traction along each axis, per area at rest. Either this or `pressure_pa`.
    #[schemars(extend("x-unit" = "Pa"), length(min = 2, max = 3))]
    pub traction_pa: Option<Vec<f64>>,
    /// Pressure into the body, per area at rest, in place of `traction_pa`.
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
    /// Damping ratio zeta: at 0 no energy is lost, at 1 bodies do not bounce.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub damping: f64,
}
