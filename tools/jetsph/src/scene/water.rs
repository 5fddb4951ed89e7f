//! Water in a scene.

use run::property::Property;
use schemars::JsonSchema;
use serde::Deserialize;
use shapes::Shape;

use crate::matter::water::diffusion::DensityDiffusion;
use crate::matter::water::friction::ArtificialViscosity;
use crate::matter::water::tait::Tension;

/// Water: one liquid.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaterScene {
    /// Density rho0 at rest.
    #[schemars(extend("x-unit" = "kg/m3", "exclusiveMinimum" = 0.0))]
    pub density_kg_m3: f64,
    /// Spacing d of its particles.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub spacing_m: f64,
    /// How water keeps its volume: with or without sound.
    #[serde(default)]
    pub method: Method,
    /// Smoothing kernel.
    #[serde(default)]
    pub kernel: KernelScene,
    /// Smoothing length over spacing, h/d.
    #[serde(default = "usual_smoothing")]
    #[schemars(range(min = 1.0, max = 2.5), extend("x-unit" = "1"))]
    pub smoothing: f64,
    /// Speed of sound c; ten times the reference speed if absent.
    #[schemars(extend("x-unit" = "m/s", "exclusiveMinimum" = 0.0))]
    pub sound_speed_m_s: Option<f64>,
    /// Reference speed V, with c = 10 V (eq. 18); the greatest speed of the nozzles and bodies at the start if absent.
    #[schemars(extend("x-unit" = "m/s", "exclusiveMinimum" = 0.0))]
    pub reference_speed_m_s: Option<f64>,
    /// Exponent n of the equation of state (eq. 15).
    #[serde(default = "usual_exponent")]
    #[schemars(range(min = 1.5, max = 15.0), extend("x-unit" = "1"))]
    pub exponent: f64,
    /// Pressure of water below its density at rest.
    #[serde(default)]
    pub tension: Tension,
    /// Artificial viscosity (eq. 38); none if absent.
    pub artificial_viscosity: Option<ArtificialViscosity>,
    /// Viscosity mu; none if absent.
    #[schemars(extend("x-unit" = "Pa s", "exclusiveMinimum" = 0.0))]
    pub viscosity_pa_s: Option<f64>,
    /// Diffusion of the density, which smooths the pressure; none if absent.
    pub density_diffusion: Option<DensityDiffusion>,
    /// Water that is there at the start.
    #[serde(default)]
    pub bodies: Vec<WaterBody>,
    /// Nozzles where water comes in.
    #[serde(default)]
    pub nozzles: Vec<NozzleScene>,
    /// Outlets where water leaves.
    #[serde(default)]
    pub outlets: Vec<OutletScene>,
}

/// How water keeps its volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// By its pressure after an equation of state: it has sound, of a speed that the scene may tell.
    #[default]
    WeaklyCompressible,
    /// By a pressure that leaves its velocity without divergence: it has no sound. Solids beside it yield to that pressure.
    DivergenceFree,
}

/// A kernel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum KernelScene {
    /// Wendland's of second order: particles do not pair.
    #[default]
    Wendland,
    /// The cubic spline of the source (6).
    Spline,
}

fn usual_smoothing() -> f64 {
    1.5
}

fn usual_exponent() -> f64 {
    7.0
}

/// Water that is there at the start.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaterBody {
    /// Its shape.
    pub body: Shape,
    /// Its velocity: a number or a formula in x, y, z for each axis; rest if absent.
    #[schemars(extend("x-unit" = "m/s"), length(min = 2, max = 3))]
    pub velocity_m_s: Option<Vec<Property>>,
    /// Its pressure, a number or a formula in x, y, z; 0 if absent.
    #[schemars(extend("x-unit" = "Pa"))]
    pub pressure_pa: Option<Property>,
}

/// A nozzle: a slot in a plane scene, round in space.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NozzleScene {
    /// Name of its figures.
    #[schemars(regex(pattern = "^[a-z][a-z0-9_-]*$"))]
    pub name: String,
    /// Middle of its exit at the start.
    #[schemars(extend("x-unit" = "m"), length(min = 2, max = 3))]
    pub exit_m: Vec<f64>,
    /// Where it points; any length.
    #[schemars(extend("x-unit" = "1"), length(min = 2, max = 3))]
    pub direction: Vec<f64>,
    /// Width of the slot, diameter in space.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub width_m: f64,
    /// Mean speed: a number, or a formula in t for jets that start slowly or pulse.
    #[schemars(extend("x-unit" = "m/s"))]
    pub speed_m_s: Property,
    /// Shape of the speed over r, 0 on the axis and 1 at the edge; it is scaled to the mean speed. Even if absent.
    #[schemars(extend("x-unit" = "1"))]
    pub profile: Option<Property>,
    /// Velocity with which the nozzle itself moves; it rests if absent.
    #[schemars(extend("x-unit" = "m/s"), length(min = 2, max = 3))]
    pub traverse_m_s: Option<Vec<f64>>,
    /// When it begins.
    #[serde(default)]
    #[schemars(range(min = 0.0), extend("x-unit" = "s"))]
    pub start_s: f64,
    /// When it ends; never if absent.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub end_s: Option<f64>,
}

/// An outlet: where water leaves, and is counted.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OutletScene {
    /// Name of its figures.
    #[schemars(regex(pattern = "^[a-z][a-z0-9_-]*$"))]
    pub name: String,
    /// Water inside this shape is removed.
    pub within: Option<Shape>,
    /// Water outside this shape is removed.
    pub beyond: Option<Shape>,
    /// Only water that moves along this vector faster than its length is removed; all water if absent. It removes the backflow of
    /// plane jets (fig. 7).
    #[schemars(extend("x-unit" = "m/s"), length(min = 2, max = 3))]
    pub moving_m_s: Option<Vec<f64>>,
}

/// A rigid wall.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WallScene {
    /// Name of its figures.
    #[schemars(regex(pattern = "^[a-z][a-z0-9_-]*$"))]
    pub name: String,
    /// Its shape.
    pub body: Shape,
    /// Repulsion by the wall (eq. 43); a plain wall if absent.
    pub repulsion: Option<RepulsionScene>,
}

/// The repulsion of (43), from the surface of the wall.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RepulsionScene {
    /// Strength D, of the order of the square of the speed.
    #[schemars(extend("x-unit" = "m2/s2", "exclusiveMinimum" = 0.0))]
    pub strength_m2_s2: f64,
    /// Range d0 within which it acts; the spacing of the particles that come near if absent.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub range_m: Option<f64>,
    /// Exponent n1.
    #[serde(default = "four")]
    #[schemars(range(min = 1.0, max = 20.0), extend("x-unit" = "1"))]
    pub exponent_near: f64,
    /// Exponent n2, less than n1.
    #[serde(default = "two")]
    #[schemars(range(min = 0.5, max = 19.0), extend("x-unit" = "1"))]
    pub exponent_far: f64,
}

fn four() -> f64 {
    4.0
}

fn two() -> f64 {
    2.0
}
