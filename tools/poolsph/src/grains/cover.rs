//! What of the metal's surface lies under grains: there gas neither heats nor cools it, and it neither takes light nor shines.
//!
//! A particle of the surface is covered where a grain is nearer to it than touching and the grain's own radius: no gas
//! film fits between. What is covered is taken out of the particles with a bare area, which arc and losses go over
//! (Komen 2019, eq. 5.33: the last term is that of metal in gas; `a in Flux` has the first).

use particles::POSITION;
use steps::Figure;

use super::around::Around;
use crate::stage::{Stage, StageError};
use crate::state::State;

/// The cover of grains as a stage.
pub struct Cover {
    /// Radius of a particle of metal \[m\].
    own: f64,
    around: Around,
    covered: f64,
}

impl Cover {
    /// The cover of metal of the spacing `spacing` \[m\] by grains that are at most `widest` \[m\] in radius.
    #[must_use]
    pub fn new(spacing: f64, widest: f64) -> Self {
        let own = 0.5 * spacing;
        Self {
            own,
            around: Around::new(own + 2.0 * widest),
            covered: 0.0,
        }
    }

    /// Whether a grain lies on a place of the surface.
    fn covers(&self, place: [f64; 3]) -> bool {
        let mut covered = false;
        self.around.each(place, |square, radius| {
            let reach = self.own + 2.0 * radius;
            covered |= square < reach * reach;
        });
        covered
    }
}

impl Stage for Cover {
    fn name(&self) -> &'static str {
        "cover"
    }

    fn advance(&mut self, state: &mut State, _dt: f64) -> Result<(), StageError> {
        let places = state.metal.column(&POSITION);
        let bare = state.exposed.iter().map(|a| places[*a as usize]);
        self.around.look(state, bare);
        let mut exposed = std::mem::take(&mut state.exposed);
        let all = exposed.len();
        if !self.around.is_empty() {
            exposed.retain(|a| !self.covers(places[*a as usize]));
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
