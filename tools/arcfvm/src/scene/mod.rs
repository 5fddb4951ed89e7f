//! The scene: what a person writes, in SI units. Optional physics is an absent key.

mod current;
mod edges;
mod electrode;
mod flow;
mod granular;
mod heat;
mod iterate;
mod matter;
mod shape;
mod start;
mod vapour;

pub use current::{Current, CurrentEdge, SheathAt, SheathKeeps};
pub use edges::Sides;
pub use electrode::{Anode, Cathode, Electrode, Evaporation, Ions, Saturation};
pub use flow::{FlowEdge, FlowScene};
pub use granular::Granular;
pub use heat::{Heat, HeatEdge};
pub use iterate::{Continuation, Coupling, Iterate, LinearSolver};
pub use matter::{
    BeyondTable, Body, Feed, Gas, GasTable, GivenGas, Melting, Metal, Moving, SpecificHeat, Swept,
};
pub use shape::{Profile, Ring, Shape};
pub use start::{Channel, Start};

pub use crate::case::{Conduction, Electrons};
pub use crate::curve::Surface;
pub use crate::heat::{ElectrodeAt, Film};
pub use crate::sample::Sample;
pub use vapour::{Amount, Diffusion, Returns, Vapour, VapourEdge, VapourMass};

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A steady axisymmetric conductor, flow or arc between bodies in a gas.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// One line for people.
    pub title: String,
    /// Rectangle in radius and height.
    pub domain: Domain,
    /// Size of the cells.
    pub grid: GridScene,
    /// The gas that fills what no body fills.
    pub gas: Gas,
    /// Solid or molten bodies by name.
    #[serde(default)]
    pub bodies: BTreeMap<String, Body>,
    /// Electric current; absent: none.
    pub current: Option<Current>,
    /// Flow of the gas; absent: it rests.
    pub flow: Option<FlowScene>,
    /// Heat; absent: temperatures stay as they start.
    pub heat: Option<Heat>,
    /// Iron vapour; absent: the gas holds none.
    pub vapour: Option<Vapour>,
    /// Temperatures at the start.
    #[serde(default)]
    pub start: Start,
    /// How the equations are iterated.
    #[serde(default)]
    pub iterate: Iterate,
    /// Heights above the base metal at which the surface table samples the gas.
    #[serde(default)]
    pub sample: Sample,
}

/// Rectangle in radius and height.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Domain {
    /// Smallest and largest radius; 0 is the axis.
    #[schemars(extend("x-unit" = "m"))]
    pub r_m: [f64; 2],
    /// Lowest and greatest height.
    #[schemars(extend("x-unit" = "m"))]
    pub z_m: [f64; 2],
}

/// Size of the cells in both directions.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GridScene {
    /// Along the radius.
    pub r: SpacingScene,
    /// Along the height.
    pub z: SpacingScene,
}

/// Upper bound of the size of the cells: one value, or linear between positions. Edges of the domain
/// and of every shape are always faces.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum SpacingScene {
    /// The same everywhere \[m\].
    Uniform(#[schemars(extend("exclusiveMinimum" = 0.0))] f64),
    /// Against position.
    Graded(Graded),
}

/// Spacing against position, held beyond the ends.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Graded {
    /// Positions, rising.
    #[schemars(extend("x-unit" = "m"), length(min = 1))]
    pub at_m: Vec<f64>,
    /// Spacing at each position.
    #[schemars(extend("x-unit" = "m"), length(min = 1))]
    pub spacing_m: Vec<f64>,
}
