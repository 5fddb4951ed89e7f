//! What is set up of the heat, and of the bodies that carry it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::edges::Edges;

/// What heat meets at an edge face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HeatEdge {
    /// No conduction; what flows in is as warm as the cell.
    Insulated,
    /// Fixed temperature \[K\].
    Temperature(f64),
    /// Heat flux into the domain \[W/m2\].
    Flux(f64),
}

/// Heat that a moving plate carries away (Komen 2019, eq. 5.22).
#[derive(Debug, Clone, PartialEq)]
pub struct MovingPlate {
    /// Welding speed \[m/s\].
    pub speed: f64,
    /// Distance ahead at which the plate is compared \[m\].
    pub ahead: f64,
    /// Widths of a ring that sweep the plate.
    pub swept: f64,
    /// Material of the plate.
    pub material: usize,
    /// Temperature beyond the edge of the domain, by row \[K\].
    pub beyond: Vec<f64>,
}

/// How fast a wire is fed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FeedRule {
    /// Given speed \[m/s\].
    Speed(f64),
    /// As fast as it melts, the tip being as warm as this in the mean \[K\] (Komen 2019, eq. 5.27).
    Melting(f64),
    /// As fast as lets this part of the wire boil off its tip, whose temperature follows.
    Boiling {
        /// Part of the mass that is fed.
        share: f64,
        /// Heat that it takes \[J/kg\].
        latent_heat: f64,
        /// Enthalpy at the boiling point, of which the first guess of the speed is made \[J/kg\].
        at_most: f64,
    },
}

/// What the drops of a wire take along.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drops {
    /// This part of the enthalpy of the tip: 1 where they are as warm as that. A tip of told temperature needs drops that follow
    /// it: with drops of one enthalpy its feed balances the heat at any temperature.
    Part(f64),
    /// This enthalpy \[J/kg\], or that of the tip where the tip holds less.
    Enthalpy(f64),
}

impl Drops {
    /// Enthalpy of the drops of a tip that holds `tip` \[J/kg\].
    #[must_use]
    pub fn of(self, tip: f64) -> f64 {
        match self {
            Self::Part(part) => part * tip,
            Self::Enthalpy(own) => own.min(tip),
        }
    }
}

/// The wire that is fed down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wire {
    /// Material of the wire.
    pub material: usize,
    /// Columns `0..columns` hold the wire.
    pub columns: usize,
    /// Lowest row of the wire.
    pub tip: usize,
    /// Cross-section \[m2\].
    pub section: f64,
    /// Density of the wire \[kg/m3\].
    pub density: f64,
    /// What its drops take along.
    pub drops: Drops,
    /// Feeding, if there is any.
    pub feed: Option<FeedRule>,
}

/// What electrons carry through the gas.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Electrons {
    /// Their enthalpy, against the current: heat of 5/2 k/e j . grad T (Hsu, Etemadi and Pfender 1983).
    Enthalpy,
}

/// Conductivity of the way from one cell to the next, and through a film.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Conduction {
    /// That of each half at the temperature of its cell, and of a film at the mean of its ends.
    #[default]
    Cells,
    /// The mean over all temperatures between both ends, from the integral of the conductivity (Kirchhoff): where that
    /// jumps within a few kelvin, heat between cells does not.
    Integral,
}

/// Heat, where it is solved.
#[derive(Debug, Clone)]
pub struct HeatCase {
    /// Edges.
    pub edges: Edges<HeatEdge>,
    /// Heat source of each cell \[W\], `[nr nz]`; manufactured solutions only.
    pub source: Option<Vec<f64>>,
    /// Plates and beds of flux that move past the arc.
    pub plates: Vec<MovingPlate>,
    /// What electrons carry through the gas.
    pub electrons: Option<Electrons>,
    /// Conductivity of the way from one cell to the next.
    pub conduction: Conduction,
}
