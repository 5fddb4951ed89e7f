//! The gas and the bodies.

use run::property::{Property, TemperatureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::electrode::{Anode, Cathode, Electrode};
use super::granular::Granular;
use super::shape::Shape;

/// The gas: a table named on the command line, or properties given here.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Gas {
    /// The gas table of the input `gas`.
    Table(GasTable),
    /// Properties given here.
    Given(Box<GivenGas>),
}

/// How the gas table is used.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GasTable {
    /// What happens where the converged gas is hotter than the end of the table.
    #[serde(default)]
    pub beyond_table: BeyondTable,
}

/// What a temperature above the end of the gas table means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BeyondTable {
    /// The run fails.
    #[default]
    Error,
    /// The values at the end are kept.
    Hold,
    /// The table goes on: density as 1/T, viscosity as it ends, all else along its last two rows.
    Extend,
}

/// Properties of the gas in r, z (m), T (K) and Y (mass fraction of iron, 0 without `vapour`); those of
/// physics that is absent may be absent.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GivenGas {
    /// Density.
    pub density_kg_m3: Option<Property>,
    /// Dynamic viscosity.
    pub viscosity_pa_s: Option<Property>,
    /// Specific heat.
    pub specific_heat_j_kg_k: Option<SpecificHeat>,
    /// Thermal conductivity.
    pub thermal_conductivity_w_m_k: Option<Property>,
    /// Electric conductivity.
    pub electric_conductivity_s_m: Option<Property>,
    /// Net emission: power that a volume radiates; absent: none.
    pub net_emission_w_m3: Option<Property>,
    /// Diffusion coefficient of iron.
    pub iron_diffusion_m2_s: Option<Property>,
    /// Molar mass of the gas without iron; vapour needs it.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub molar_mass_kg_mol: Option<f64>,
    /// Pressure; absent: 1 atm. Surfaces that evaporate need it.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub pressure_pa: Option<f64>,
}

/// A specific heat: a number, or a table over temperature.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum SpecificHeat {
    /// The same everywhere \[J/(kg K)\].
    Constant(#[schemars(extend("exclusiveMinimum" = 0.0))] f64),
    /// Over temperature.
    Table(TemperatureTable),
}

/// A body.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Where it is.
    pub shape: Shape,
    /// What it is made of.
    pub material: Metal,
    /// Electrode that takes up electrons.
    pub anode: Option<Anode>,
    /// Electrode that emits electrons.
    pub cathode: Option<Cathode>,
    /// Electrode that the sign of the driven current makes an anode or a cathode.
    pub electrode: Option<Electrode>,
    /// Fed down along the axis, as a wire; one body at most.
    pub feed: Option<Feed>,
    /// A plate or a bed moving past the arc.
    pub moving: Option<Moving>,
    /// A bed of granular flux; one body at most.
    pub granular: Option<Granular>,
}

/// Properties of a body in r, z (m), T (K); those of physics that is absent may be absent.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Metal {
    /// Density.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub density_kg_m3: Option<f64>,
    /// Specific heat.
    pub specific_heat_j_kg_k: Option<SpecificHeat>,
    /// Thermal conductivity.
    pub thermal_conductivity_w_m_k: Option<Property>,
    /// Electric conductivity.
    pub electric_conductivity_s_m: Option<Property>,
    /// Melting.
    pub melting: Option<Melting>,
}

/// Latent heat spread over a range of temperature.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Melting {
    /// Middle of the range of temperature in which it melts.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub point_k: f64,
    /// Half of the width of this range: it melts from `point_k` less this to `point_k` plus this.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub half_range_k: f64,
    /// Latent heat.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub latent_heat_j_kg: f64,
}

/// How a wire is fed: at a speed, or as fast as it melts, by the temperature of its tip or by how much of it boils off.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Feed {
    /// Given speed.
    #[schemars(range(min = 0.0))]
    pub speed_m_s: Option<f64>,
    /// As fast as it melts into drops of this temperature (Komen 2019, eq. 5.27).
    #[schemars(extend("exclusiveMinimum" = 300.0))]
    pub drop_temperature_k: Option<f64>,
    /// As fast as it melts while this part of its mass boils off its tip; the temperature of the tip follows.
    #[schemars(extend("exclusiveMinimum" = 0.0, "exclusiveMaximum" = 1.0))]
    pub vapour_share: Option<f64>,
    /// Enthalpy of the drops over that at 300 K, where it is less than that of the tip: `drop_temperature_k` is then the
    /// mean temperature of the tip alone.
    #[schemars(extend("exclusiveMinimum" = 0.0, "x-unit" = "J/kg"))]
    pub drop_enthalpy_j_kg: Option<f64>,
}

/// A plate moving past the arc (Komen 2019, eq. 5.22).
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Moving {
    /// Welding speed.
    #[schemars(range(min = 0.0))]
    pub speed_m_s: f64,
    /// How far ahead the metal comes from: it enters a ring with the temperature of the body this much farther from the axis.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub ahead_m: f64,
    /// How much of the body a ring of the grid sweeps in its motion.
    #[serde(default)]
    pub swept: Swept,
}

/// How much of a moving plate a ring of the grid sweeps. A section `dr dz` that moves by D sweeps
/// `dr dz D`; the source does not tell whether that goes with the whole ring or with one radian of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Swept {
    /// The section of a ring on both sides of the axis.
    #[default]
    Sides,
    /// One section for each radian, as control volumes in cylindrical coordinates are counted: pi times as
    /// much.
    Radian,
}

impl Swept {
    /// Sections that a ring sweeps.
    #[must_use]
    pub fn widths(self) -> f64 {
        match self {
            Self::Sides => 2.0,
            Self::Radian => std::f64::consts::TAU,
        }
    }
}
