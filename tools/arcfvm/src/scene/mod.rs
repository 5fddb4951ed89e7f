//! The scene: what a person writes, in SI units. Optional physics is an absent key.

mod edges;
mod electrode;
mod granular;
mod iterate;
mod matter;
mod shape;
mod vapour;

pub use edges::{CurrentEdge, FlowEdge, HeatEdge, Sides};
pub use electrode::{Anode, Cathode, Electrode, Evaporation, Ions, Saturation};
pub use granular::Granular;
pub use iterate::{Continuation, Coupling, Iterate, LinearSolver};
pub use matter::{
    BeyondTable, Body, Feed, Gas, GasTable, GivenGas, Melting, Metal, Moving, SpecificHeat, Swept,
};
pub use shape::{Profile, Ring, Shape};

pub use crate::case::{Conduction, Electrons};
pub use crate::curve::Surface;
pub use crate::heat::{ElectrodeAt, Film};
pub use crate::sample::Sample;
pub use vapour::{Amount, Diffusion, Returns, Vapour, VapourEdge, VapourMass};

use std::collections::BTreeMap;

use run::property::Property;
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

/// Electric current (Komen 2019, eqs 5.10 to 5.15).
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Current {
    /// What the edges are; insulated where nothing is said.
    pub edges: Sides<CurrentEdge>,
    /// Given source of current in r, z; manufactured solutions only \[A/m3\].
    pub source_a_m3: Option<Property>,
    /// Gas within this distance of an electrode conducts as the gas just beyond (Komen 2019, section
    /// 5.2.3); absent: as its own temperature says.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub sheath_m: Option<f64>,
    /// At which electrodes; absent: at both.
    #[serde(default)]
    pub sheath_at: SheathAt,
    /// What gas there has in common with the gas beyond.
    #[serde(default)]
    pub sheath_keeps: SheathKeeps,
}

/// What gas close to an electrode takes from the gas beyond.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SheathKeeps {
    /// Its conductivity.
    #[default]
    Conductivity,
    /// Its electron density (Komen 2019, fig. 5.12): it conducts as gas with its own iron does at the
    /// temperature of as many electrons. Wants a gas table that tells them.
    ElectronDensity,
}

/// Electrodes with a sheath.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SheathAt {
    /// Anode and cathode.
    #[default]
    Electrodes,
    /// The cathode, as Komen (2019), fig. 5.12, has it.
    Cathode,
}

/// Flow of the gas (Komen 2019, eqs 3.3 to 3.5, 5.1, 5.2); the Lorentz force acts if there is current.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlowScene {
    /// What the edges are; at zero radius the axis, else walls where nothing is said.
    #[serde(default)]
    pub edges: Sides<FlowEdge>,
    /// Downward acceleration, acting on the excess over the density at 300 K \[m/s2\]; absent: none.
    #[schemars(range(min = 0.0))]
    pub gravity_m_s2: Option<f64>,
    /// Given radial force in r, z; manufactured solutions only \[N/m3\].
    pub force_radial_n_m3: Option<Property>,
    /// Given axial force in r, z; manufactured solutions only \[N/m3\].
    pub force_axial_n_m3: Option<Property>,
}

/// Heat (Komen 2019, eq. 5.8); Joule heat enters if there is current.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Heat {
    /// What the edges are; insulated where nothing is said.
    #[serde(default)]
    pub edges: Sides<HeatEdge>,
    /// Given source of heat in r, z \[W/m3\].
    pub source_w_m3: Option<Property>,
    /// Part of all radiation of the gas that the base metal, the lowest electrode, takes up; absent:
    /// none.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub absorbed_radiation: Option<f64>,
    /// Temperature of the metal at which electrodes emit, shine and evaporate.
    #[serde(default)]
    pub electrode_at: ElectrodeAt,
    /// Way of the heat from the gas into an electrode.
    #[serde(default)]
    pub film: Film,
    /// Thickness of the film: the gas at this distance from an electrode heats it and, by its iron, tells the
    /// ionisation voltage (Komen 2019: 5e-5 m on its grid); absent: half a gas cell, on any grid.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub film_m: Option<f64>,
    /// Conductivity of the way from one cell to the next, and through a film.
    #[serde(default)]
    pub conduction: Conduction,
    /// What electrons carry through the gas; absent: no heat (Komen 2019, eq. 5.8).
    pub electrons: Option<Electrons>,
}

/// Temperatures at the start, and throughout where heat is not solved.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Start {
    /// Everywhere, in r, z \[K\].
    #[serde(default = "room")]
    pub temperature_k: Property,
    /// Hot gas below and around the tip of the wire, or over the whole height without one; absent:
    /// none.
    pub channel: Option<Channel>,
}

/// Hot gas around the axis.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Channel {
    /// Radius of the channel.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub radius_m: f64,
    /// Temperature within.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub temperature_k: f64,
}

fn room() -> Property {
    Property::Constant(crate::material::REFERENCE_K)
}

impl Default for Start {
    fn default() -> Self {
        Self {
            temperature_k: room(),
            channel: None,
        }
    }
}
