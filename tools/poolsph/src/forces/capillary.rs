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
use crate::state::slag::Slag;

use super::tension::Parameters;

/// The stage that says what tension the surface has.
pub struct Capillary {
    tension: f64,
    /// That of slag beside the metal.
    slag: Option<f64>,
}

impl Capillary {
    /// The tension of the surface of metal.
    #[must_use]
    pub fn new(parameters: Parameters) -> Self {
        Self {
            tension: parameters.surface_tension_n_m,
            slag: None,
        }
    }

    /// The same with slag beside the metal.
    #[must_use]
    pub fn beside(mut self, slag: Slag) -> Self {
        self.slag = Some(slag.surface_tension.unwrap_or(self.tension));
        self
    }
}

/// Longest step for waves of the surface of `near` \[s\]; infinite without tension.
#[must_use]
pub fn limit(near: &Near, metal: Matter) -> f64 {
    let each = near.tension.iter().enumerate();
    // By the tension that metal would need for waves as fast.
    let greatest = each.fold(0.0, |most: f64, (a, x)| most.max(*x / near.heaviness(a)));
    let between = near.liquids.as_ref().map_or(0.0, |liquids| {
        let [metal, slag] = liquids.densities();
        liquids.tension * metal / (metal + slag)
    });
    longest(metal, greatest.max(between))
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
        let metal = longest(state.metal.matter, self.tension);
        let slag = self.slag.zip(state.slag).map(|(tension, slag)| {
            let lighter = slag.density / state.metal.matter.density;
            longest(state.metal.matter, tension / lighter)
        });
        let least = slag.map_or(metal, |slag| slag.min(metal));
        liquid.then(|| Limit::dividing("capillary", least))
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
        if let (Some(tension), Some(liquids)) = (self.slag, &near.liquids) {
            for (a, each) in near.tension.iter_mut().enumerate() {
                if liquids.is_slag(a) {
                    *each = tension;
                }
            }
        }
        Ok(())
    }
}
