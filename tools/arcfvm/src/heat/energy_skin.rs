//! Surfaces of electrodes that have a temperature of their own.

use crate::case::Case;
use crate::grid::FaceIndex;
use crate::heat::electrons::Drift;
use crate::heat::energy::Energy;
use crate::heat::reads::Around;
use crate::heat::{Contact, Skin, Surfaces};

impl Energy {
    /// The surface of contact `n`.
    #[must_use]
    pub fn skin(&self, n: usize, contact: &Contact) -> Skin {
        Skin::of(&self.skins, n, contact, &self.temperature)
    }

    /// Temperatures of all surfaces, empty where electrodes answer at the middles of their cells \[K\].
    #[must_use]
    pub fn surface_temperatures(&self) -> Vec<f64> {
        self.skins.iter().map(|skin| skin.temperature).collect()
    }

    /// Takes the temperatures of all surfaces as they were.
    pub fn restore_surfaces(&mut self, temperatures: &[f64]) {
        for (skin, t) in self.skins.iter_mut().zip(temperatures) {
            skin.temperature = *t;
        }
    }

    /// Resistances between surfaces and the middles of their metal; none where the wire melts off.
    pub(crate) fn resist(&mut self, around: Around<'_>, surfaces: &Surfaces) {
        for (skin, contact) in self.skins.iter_mut().zip(&surfaces.contacts) {
            let half = contact.metal_half / around.properties.thermal[contact.metal];
            let melts_off = fed(around, contact) > 0.0;
            skin.resistance = if melts_off { 0.0 } else { half };
        }
    }

    /// Takes out of the gas at surfaces what electrons that carry heat pass those with beyond what they have at the
    /// temperatures of the middles of the metal.
    pub(crate) fn pass_surfaces(&mut self, around: Around<'_>) {
        let mut source = std::mem::take(&mut self.source);
        for (k, electrons) in self.electrons_beyond(around) {
            source[k][0] -= electrons;
        }
        self.source = source;
    }

    /// Heat that electrons take out of each gas cell at a surface beyond what they have at the temperature of the
    /// metal \[W\].
    pub(crate) fn electrons_beyond<'a>(
        &'a self,
        around: Around<'a>,
    ) -> impl Iterator<Item = (usize, f64)> + 'a {
        let with = Drift::of(around).into_iter();
        with.flat_map(move |drift| {
            self.warmer(around.case)
                .map(move |(contact, [surface, middle])| {
                    let [r, z] = contact.normal;
                    let out = -(r + z) * drift.through(contact.face);
                    (contact.gas, out * (surface - middle))
                })
        })
    }

    /// Contacts whose surface has a temperature of its own, with that and the one of the middle of the metal.
    fn warmer<'a>(&'a self, case: &'a Case) -> impl Iterator<Item = (&'a Contact, [f64; 2])> {
        let both = self.skins.iter().zip(case.contacts());
        both.map(|(skin, contact)| {
            let middle = self.temperature[contact.metal];
            (contact, [skin.temperature, middle])
        })
    }
}

/// Mass of the wire that reaches a contact and melts off there \[kg/s\].
fn fed(around: Around<'_>, contact: &Contact) -> f64 {
    let case = around.case;
    let Some(wire) = case.wire else { return 0.0 };
    let own = wire.material == case.material[contact.metal];
    match contact.face {
        FaceIndex::Axial(face) if own && contact.normal[1] < 0.0 => {
            -around.mass(FaceIndex::Axial(face + case.grid.nr))
        }
        _ => 0.0,
    }
}
