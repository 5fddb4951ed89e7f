//! The scene: what a person writes, typed. Optional physics is an absent key.

mod faults;
mod output;
mod solid;
mod water;

use schemars::JsonSchema;
use serde::Deserialize;

pub use output::Output;
pub use solid::{Clamp, ContactScene, LatticeScene, LoadScene, Solid, UpdatedForm};

pub use water::{
    KernelScene, Method, NozzleScene, OutletScene, RepulsionScene, WallScene, WaterBody, WaterScene,
};

use crate::matter::solid::law::Plane;

/// Kind and version of the scenes that this tool reads.
pub const KIND: (&str, u32) = ("jetsph.scene", 1);

/// Solids and water, or any part of them.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// What it shows, in a line.
    pub title: Option<String>,
    /// 2: a plane scene, per metre of depth; 3: in space.
    #[schemars(range(min = 2, max = 3))]
    pub dimensions: usize,
    /// Plane strain or plane stress of the solids of a plane scene; plane strain if absent.
    pub plane: Option<Plane>,
    /// Length of the steps, and end of the run.
    pub time: Time,
    /// Solid bodies.
    #[serde(default)]
    pub solids: Vec<Solid>,
    /// Water.
    pub water: Option<WaterScene>,
    /// Rigid walls.
    #[serde(default)]
    pub walls: Vec<WallScene>,
    /// Contact of solids with each other and with plain walls; without loss of energy if absent.
    pub contact: Option<ContactScene>,
    /// Gravity g; none if absent.
    #[schemars(extend("x-unit" = "m/s2"), length(min = 2, max = 3))]
    pub gravity_m_s2: Option<Vec<f64>>,
    /// What is written, and when.
    pub output: Output,
}

/// Step and end of the run.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// End of the run \[s\].
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub end_s: f64,
    /// Longest step \[s\]; as long as all limits allow if absent.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub step_s: Option<f64>,
}
