//! What the heat reads.

use crate::case::{Case, HeatCase, VapourCase};
use crate::current::potential::Potential;
use crate::flow::field::Flow;
use crate::grid::FaceIndex;
use crate::heat::{Contact, Skin};
use crate::properties::Properties;
use crate::vapour::field::Vapour;

/// What the heat reads beside its own state.
#[derive(Debug, Clone, Copy)]
pub struct Around<'a> {
    /// The problem.
    pub case: &'a Case,
    /// The heat's setup.
    pub heat: &'a HeatCase,
    /// Properties.
    pub properties: &'a Properties,
    /// Currents, where there are any.
    pub potential: Option<&'a Potential>,
    /// Flow of the gas, where there is any.
    pub flow: Option<&'a Flow>,
    /// Iron vapour, where there is any.
    pub vapour: Option<Vapours<'a>>,
    /// Speed of the wire \[m/s\].
    pub feed: f64,
}

impl Around<'_> {
    /// Mass flux of gas and of wire through a face, outward or upward \[kg/s\].
    #[inline]
    pub(crate) fn mass(&self, face: FaceIndex) -> f64 {
        let wire = match face {
            FaceIndex::Radial(_) => None,
            FaceIndex::Axial(at) => {
                let wire = self.case.wire.as_ref();
                wire.and_then(|wire| wire.carried(&self.case.grid, self.feed, at))
            }
        };
        wire.unwrap_or_else(|| self.flow.map_or(0.0, |flow| flow.mass(face)))
    }
}

/// What the sources of heat read.
#[derive(Debug, Clone, Copy)]
pub struct Reads<'a> {
    /// All beside the heat.
    pub around: Around<'a>,
    /// Temperature \[K\].
    pub temperature: &'a [f64],
    /// Surfaces of the electrodes; none: the middles of their cells.
    pub skins: &'a [Skin],
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
