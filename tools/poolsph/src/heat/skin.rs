//! What heat upon the metal reads of it, fetched once.

use particles::{POSITION, Set};

use crate::patch::Patches;
use crate::state::slag::SLAG;
use crate::state::{ENTHALPY, PHASE, TEMPERATURE, WALL, marked, phase};

/// Columns of the metal.
pub(super) struct Skin<'a> {
    /// \[m\]
    pub(super) position: &'a [[f64; 3]],
    /// \[J/kg\]
    pub(super) enthalpy: &'a [f64],
    /// \[K\]
    pub(super) temperature: &'a [f64],
    pub(super) surface: Patches<'a>,
    phase: &'a [u8],
    slag: &'a [bool],
    wall: &'a [bool],
}

impl<'a> Skin<'a> {
    pub(super) fn of(metal: &'a Set) -> Self {
        Self {
            position: metal.column(&POSITION),
            enthalpy: metal.column(&ENTHALPY),
            temperature: metal.column(&TEMPERATURE),
            surface: Patches::of(metal),
            phase: metal.column(&PHASE),
            slag: metal.column(&SLAG),
            wall: metal.column(&WALL),
        }
    }

    /// Whether particle `a` is slag.
    #[inline]
    pub(super) fn slag(&self, a: usize) -> bool {
        marked(self.slag, a)
    }

    /// Whether particle `a` is metal that can be heated.
    #[inline]
    pub(super) fn takes(&self, a: usize) -> bool {
        !marked(self.wall, a) && self.phase[a] != phase::FLYING
    }
}
