//! The heat.

use run::property::Property;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Sides;
use crate::case::{Conduction, Electrons};
use crate::heat::{ElectrodeAt, Film};

/// Heat (Komen 2019, eq. 5.8); Joule heat enters if there is current.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Heat {
    /// What the edges are; insulated where nothing is said.
    #[serde(default)]
    pub edges: Sides<HeatEdge>,
    /// Given source of heat in r, z \[W/m3\].
    pub source_w_m3: Option<Property>,
    /// Part of all radiation of the gas that the base metal, the lowest electrode, absorbs; absent:
    /// none.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub absorbed_radiation: Option<f64>,
    /// Temperature of the metal at which electrodes emit electrons, radiate and evaporate.
    #[serde(default)]
    pub electrode_at: ElectrodeAt,
    /// Length of the path by which heat is conducted from the gas into an electrode.
    #[serde(default)]
    pub film: Film,
    /// Thickness of the film: the gas at this distance from an electrode heats it, and its iron fraction gives the
    /// ionisation voltage (Komen 2019: 5e-5 m on its grid); absent: half a gas cell, on any grid.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub film_m: Option<f64>,
    /// Thermal conductivity between one cell and the next, and of a film.
    #[serde(default)]
    pub conduction: Conduction,
    /// Heat that electrons carry with the current through the gas; absent: none (Komen 2019, eq. 5.8).
    pub electrons: Option<Electrons>,
}

/// Heat at an edge: exactly one condition.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeatEdge {
    /// Part of the side, from and to; absent: all of it. Ends become faces of the grid.
    #[schemars(extend("x-unit" = "m"))]
    pub over_m: Option<[f64; 2]>,
    /// Fixed temperature in r, z.
    pub temperature_k: Option<Property>,
    /// Heat flux into the domain in r, z.
    pub flux_w_m2: Option<Property>,
}
