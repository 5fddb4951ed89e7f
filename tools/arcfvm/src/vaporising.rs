//! Iron vapour and what it is made with.

use crate::case::VapourCase;
use crate::fields::vapour::Vapour;
use crate::heat::reads::Vapours;
use crate::heat::{Contact, Surfaces};

/// Iron vapour and its setup.
#[derive(Debug, Clone)]
pub struct Vaporising {
    pub(crate) setup: VapourCase,
    /// Mass fractions and evaporation.
    pub vapour: Vapour,
}

impl Vaporising {
    /// The vapour as the heat reads it.
    pub(crate) fn read(&self) -> Vapours<'_> {
        Vapours {
            setup: &self.setup,
            vapour: &self.vapour,
        }
    }

    /// Faces of electrodes to the gas: those of the heat, which follow the cavity, where it is solved.
    pub(crate) fn contacts<'a>(&'a self, heat: Option<&'a Surfaces>) -> &'a [Contact] {
        heat.map_or(&self.setup.contacts, |s| &s.contacts)
    }
}
