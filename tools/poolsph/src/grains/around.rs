//! The grains around places of the metal: those that may be near any of them, sorted to be looked up.

use neighbours::{Grid, Halo};
use particles::POSITION;
use rayon::prelude::*;

use super::{Mirrors, RADIUS};
use crate::state::State;

/// Grains within a reach of places of the metal, with what finds them.
pub(super) struct Around {
    /// Beyond this no grain matters \[m\].
    reach: f64,
    halo: Halo,
    grid: Grid,
    metal: Vec<[f64; 3]>,
    places: Vec<[f64; 3]>,
    radii: Vec<f64>,
    mirrors: Mirrors,
}

impl Around {
    /// Grains whose middles are at most `reach` \[m\] away.
    pub(super) fn new(reach: f64) -> Self {
        Self {
            reach,
            halo: Halo::new(reach),
            grid: Grid::new(reach),
            metal: Vec::new(),
            places: Vec::new(),
            radii: Vec::new(),
            mirrors: Mirrors::default(),
        }
    }

    /// With the images of grains in `mirrors`.
    pub(super) fn beside(self, mirrors: Mirrors) -> Self {
        Self { mirrors, ..self }
    }

    /// Takes the grains of `state` that are near one of the places `metal` \[m\].
    pub(super) fn look(&mut self, state: &State, metal: impl Iterator<Item = [f64; 3]>) {
        let Some(set) = &state.grains else {
            self.places.clear();
            self.radii.clear();
            return;
        };
        self.metal.clear();
        self.metal.extend(metal);
        self.halo.mark(&self.metal);
        let (halo, all) = (&self.halo, set.column(&POSITION).par_iter());
        let near = all.zip(set.column(&RADIUS)).with_min_len(4096);
        let near = near.filter(|(x, _)| halo.may_touch(**x));
        (self.places, self.radii) = near.map(|(x, r)| (*x, *r)).unzip();
        self.mirrors
            .complete(&mut self.places, &mut self.radii, self.reach);
        self.grid.bin(&self.places);
    }

    /// Whether there is none.
    pub(super) fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Calls `each` with the square of the distance \[m2\] and the radius \[m\] of grains around a place, in the grid's order.
    pub(super) fn each(&self, place: [f64; 3], mut each: impl FnMut(f64, f64)) {
        self.grid.runs(place, self.reach, |run| {
            let (sorted, order) = (self.grid.sorted(), self.grid.order());
            for (x, k) in sorted[run.clone()].iter().zip(&order[run]) {
                let square: f64 = (0..3).map(|i| (x[i] - place[i]).powi(2)).sum();
                each(square, self.radii[*k as usize]);
            }
        });
    }
}
