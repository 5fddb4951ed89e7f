//! The scene: a body, its points and materials, what happens at its surface, and how it is solved.

pub mod boundary;
mod faults;

pub mod material;
pub mod method;

use run::property::Property;
use schemars::JsonSchema;
use serde::Deserialize;
use torch::Torch;

pub use boundary::Boundary;
pub use material::{Constituent, Contact, Material};
pub use method::{Output, Time};
pub use shapes::Shape;

use crate::cloud::points::Points;
use crate::operator::Operator;
use crate::steady::Steady;

/// Heat conduction in a body.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Title of reports.
    pub title: Option<String>,
    /// 2: a plane body, per metre of depth; 3: a body in space.
    #[schemars(range(min = 2, max = 3))]
    pub dimensions: usize,
    /// The body.
    pub body: Shape,
    /// How points fill it.
    pub points: Points,
    /// Materials.
    #[schemars(length(min = 1))]
    pub materials: Vec<Material>,
    /// Resistances between materials.
    #[serde(default)]
    pub contacts: Vec<Contact>,
    /// Temperature at the start, a function of x, y, z, r. A steady solve takes it as its first guess.
    #[schemars(extend("x-unit" = "K"))]
    pub initial_temperature_k: Property,
    /// Heat source in the volume, a function of x, y, z, r, T, t; none when it is absent.
    #[schemars(extend("x-unit" = "W/m3"))]
    pub source_w_m3: Option<Property>,
    /// Torches of welding that move along paths; in space, with a march in time.
    #[serde(default)]
    pub torches: Vec<Torch>,
    /// What happens at the surface; insulated where nothing is said.
    #[serde(default)]
    pub boundaries: Vec<Boundary>,
    /// How the divergence of the heat flux is formed.
    #[serde(default)]
    pub operator: Operator,
    /// March in time. Exactly one of `time` and `steady` is given.
    pub time: Option<Time>,
    /// Steady state. Exactly one of `time` and `steady` is given.
    pub steady: Option<Steady>,
    /// What is written.
    #[serde(default)]
    pub output: Output,
}
