//! Who belongs to the compact copy.

use particles::POSITION;
use rayon::prelude::*;

use super::{GRAIN, MARGIN, NONE, Near, Role};
use crate::state::{PHASE, State, phase};

impl Near {
    /// Liquid particles, molten ones that are held, and solid ones within two reaches of these.
    pub(super) fn collect(&mut self, state: &State) {
        let (places, phases) = (state.metal.column(&POSITION), state.metal.column(&PHASE));
        for (id, phase) in phases.iter().enumerate() {
            match *phase {
                phase::LIQUID => self.enter(places[id], id, Role::Liquid),
                phase::HELD => self.enter(places[id], id, Role::Wet),
                _ => {}
            }
        }
        let [wet, backing] = [1.0, 2.0].map(|reaches| self.kernel.support() * (reaches + MARGIN));
        let molten = self.places.len();
        self.beyond.place(&state.faces, backing, &mut self.places);
        let (grid, halo) = (&mut self.liquid_grid, &mut self.halo);
        rayon::join(|| grid.bin(&self.places), || halo.mark(&self.places));
        self.places.truncate(molten);
        let (grid, halo) = (&self.liquid_grid, &self.halo);
        let mut solid = std::mem::take(&mut self.solid);
        solid.resize(state.len(), None);
        solid
            .par_iter_mut()
            .zip(phases)
            .zip(places)
            .with_min_len(GRAIN)
            .for_each(|((role, phase), &place)| {
                *role = match *phase {
                    phase::SOLID if !halo.may_touch(place) => None,
                    phase::SOLID if grid.any_within(place, wet) => Some(Role::Wet),
                    phase::SOLID if grid.any_within(place, backing) => Some(Role::Backing),
                    _ => None,
                };
            });
        for (id, role) in solid.iter().enumerate() {
            if let Some(role) = role {
                self.enter(places[id], id, *role);
            }
        }
        self.solid = solid;
    }

    /// Place in the copy of a particle of [`State`], if it is in it.
    #[must_use]
    pub fn member(&self, id: usize) -> Option<usize> {
        let place = self.member.get(id).copied().filter(|place| *place != NONE);
        place.map(|place| place as usize)
    }

    /// Takes a particle in.
    fn enter(&mut self, place: [f64; 3], id: usize, role: Role) {
        self.candidates.push(id as u32);
        self.places.push(place);
        self.roles.push(role);
    }
}
