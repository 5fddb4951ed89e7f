//! What the heat sources read.

use crate::case::{Case, HeatCase, VapourCase};
use crate::current::potential::Potential;
use crate::heat::{Contact, Skin};
use crate::properties::Properties;
use crate::vapour::field::Vapour;

/// What the sources read.
#[derive(Debug, Clone, Copy)]
pub struct Reads<'a> {
    /// The problem.
    pub case: &'a Case,
    /// The heat's setup.
    pub heat: &'a HeatCase,
    /// Properties.
    pub properties: &'a Properties,
    /// Currents, where there are any.
    pub potential: Option<&'a Potential>,
    /// Temperature \[K\].
    pub temperature: &'a [f64],
    /// Surfaces of the electrodes; none: the middles of their cells.
    pub skins: &'a [Skin],
    /// Iron vapour, where there is any.
    pub vapour: Option<Vapours<'a>>,
}

impl Reads<'_> {
    /// The surface of contact `n`.
    #[must_use]
    pub fn skin(&self, n: usize, contact: &Contact) -> Skin {
        Skin::of(self.skins, n, contact, self.temperature)
    }
}

/// The vapour that surfaces meet.
#[derive(Debug, Clone, Copy)]
pub struct Vapours<'a> {
    /// The problem.
    pub setup: &'a VapourCase,
    /// Its state.
    pub vapour: &'a Vapour,
}

impl<'a> From<(&'a VapourCase, &'a Vapour)> for Vapours<'a> {
    fn from((setup, vapour): (&'a VapourCase, &'a Vapour)) -> Self {
        Self { setup, vapour }
    }
}
