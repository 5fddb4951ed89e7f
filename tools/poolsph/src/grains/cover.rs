//! What of the metal's surface lies under grains: there gas neither heats nor cools it, and it neither takes light nor shines.
//!
//! A particle of the surface is covered where a grain is nearer to it than touching and the grain's own radius: no gas
//! film fits between. What is covered is taken out of the particles with a bare area, which arc and losses go over
//! (Komen 2019, eq. 5.33: the last term is that of metal in gas; `a in Flux` has the first).

use neighbours::{Grid, Halo};
use particles::POSITION;

use super::RADIUS;
use crate::stage::{Figure, Stage, StageError};
use crate::state::State;

/// The cover of grains as a stage.
pub struct Cover {
    /// Radius of a particle of metal \[m\].
    own: f64,
    /// Where a grain may cover \[m\]: beyond this none does.
    reach: f64,
    halo: Halo,
    grid: Grid,
    bare: Vec<[f64; 3]>,
    places: Vec<[f64; 3]>,
    radii: Vec<f64>,
    covered: f64,
}

impl Cover {
    /// The cover of metal of the spacing `spacing` \[m\] by grains that are at most `widest` \[m\] in radius.
    #[must_use]
    pub fn new(spacing: f64, widest: f64) -> Self {
        let own = 0.5 * spacing;
        let reach = own + 2.0 * widest;
        Self {
            own,
            reach,
            halo: Halo::new(reach),
            grid: Grid::new(reach),
            bare: Vec::new(),
            places: Vec::new(),
            radii: Vec::new(),
            covered: 0.0,
        }
    }

    /// The grains that are near the surface.
    fn look(&mut self, state: &State) {
        self.bare.clear();
        let exposed = state.exposed.iter();
        self.bare
            .extend(exposed.map(|a| state.position[*a as usize]));
        self.halo.mark(&self.bare);
        self.places.clear();
        self.radii.clear();
        let Some(set) = &state.grains else { return };
        let grains = set.column(&POSITION).iter().zip(set.column(&RADIUS));
        for (x, r) in grains.filter(|(x, _)| self.halo.may_touch(**x)) {
            self.places.push(*x);
            self.radii.push(*r);
        }
        self.grid.bin(&self.places);
    }

    /// Whether a grain lies on a place of the surface.
    fn covers(&self, place: [f64; 3]) -> bool {
        let mut covered = false;
        let grid = &self.grid;
        grid.runs(place, self.reach, |run| {
            for (x, k) in grid.sorted()[run.clone()].iter().zip(&grid.order()[run]) {
                let reach = self.own + 2.0 * self.radii[*k as usize];
                let square: f64 = (0..3).map(|i| (x[i] - place[i]).powi(2)).sum();
                covered |= square < reach * reach;
            }
        });
        covered
    }
}

impl Stage for Cover {
    fn name(&self) -> &'static str {
        "cover"
    }

    fn advance(&mut self, state: &mut State, _dt: f64) -> Result<(), StageError> {
        self.look(state);
        let mut exposed = std::mem::take(&mut state.exposed);
        let all = exposed.len();
        if !self.places.is_empty() {
            exposed.retain(|a| !self.covers(state.position[*a as usize]));
        }
        self.covered = (all - exposed.len()) as f64;
        state.exposed = exposed;
        Ok(())
    }

    fn figures(&self) -> Vec<Figure> {
        vec![Figure {
            name: "covered_particles",
            unit: "1",
            value: self.covered,
        }]
    }
}
