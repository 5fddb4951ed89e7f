//! Surface tension where the flow is without divergence ([`crate::motion::divergence_free`]): a pressure at the surface, its
//! curvature times gamma.
//!
//! Waves of the surface bound the step: the shortest that particles carry, of two spacings, goes half of its length in
//! `sqrt(rho d^3/(2 pi gamma))` (Brackbill, Kothe and Zemach 1992). The motion divides longer steps.

use particles::Matter;
use steps::Limit;

use crate::near::{Near, Role};
use crate::stage::{Stage, StageError};
use crate::state::State;

use super::tension::Parameters;

/// The stage that says what tension the surface has.
pub struct Capillary {
    tension: f64,
}

impl Capillary {
    /// The tension of a surface.
    #[must_use]
    pub fn new(parameters: Parameters) -> Self {
        Self {
            tension: parameters.surface_tension_n_m,
        }
    }
}

/// Longest step for waves of the surface of `near` \[s\]; infinite without tension.
#[must_use]
pub fn limit(near: &Near, metal: Matter) -> f64 {
    let greatest = near.tension.iter().fold(0.0, |most: f64, x| most.max(*x));
    longest(metal, greatest)
}

/// sqrt(rho d^3/(2 pi gamma)) \[s\].
fn longest(metal: Matter, tension: f64) -> f64 {
    (metal.mass() / (2.0 * std::f64::consts::PI * tension)).sqrt()
}

impl Stage for Capillary {
    fn name(&self) -> &'static str {
        "tension"
    }

    fn limit(&self, state: &State) -> Option<Limit> {
        // The motion divides the step by it.
        let liquid = state.near.liquid_count() > 0;
        liquid.then(|| Limit::dividing("capillary", longest(state.metal.matter, self.tension)))
    }

    fn advance(&mut self, state: &mut State, _dt: f64) -> Result<(), StageError> {
        let near = &mut state.near;
        let of = |role: &Role| {
            if *role == Role::Liquid {
                self.tension
            } else {
                0.0
            }
        };
        near.tension.clear();
        near.tension
            .extend(near.role[..near.force.len()].iter().map(of));
        Ok(())
    }
}
