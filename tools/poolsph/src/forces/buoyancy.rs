//! Buoyancy (Komen 2019, eq. 4.1, last term): F = -(T - T_ref) beta rho g.
//!
//! Print takes T_0 = 1/beta, which makes the term the whole weight; here gravity acts by itself and
//! the term is what the temperature adds to it.

use particles::Matter;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use shapes::frame::along;

use crate::near::Role;
use crate::stage::{Stage, StageError};
use crate::state::{State, TEMPERATURE};

/// Expansion of the liquid (key `buoyancy`).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// beta \[1/K\].
    #[schemars(extend("x-unit" = "1/K"), range(min = 0.0, max = 0.1))]
    pub expansion_1_k: f64,
    /// T_ref \[K\]: at this temperature the liquid has the density of the scene, and no buoyancy acts.
    #[schemars(extend("x-unit" = "K"), range(min = 0.0, max = 1e4))]
    pub reference_k: f64,
}

/// The stage that lets warm liquid rise.
pub struct Buoyancy {
    parameters: Parameters,
    /// rho g \[N/m3\].
    weight: [f64; 3],
}

impl Buoyancy {
    /// Buoyancy of `metal` under `gravity` \[m/s2\].
    #[must_use]
    pub fn new(parameters: Parameters, gravity: [f64; 3], metal: Matter) -> Self {
        Self {
            parameters,
            weight: gravity.map(|g| metal.density * g),
        }
    }
}

impl Stage for Buoyancy {
    fn name(&self) -> &'static str {
        "buoyancy"
    }

    fn declare(&self, state: &mut State) {
        state.metal.declare(&TEMPERATURE);
    }

    fn advance(&mut self, state: &mut State, _dt: f64) -> Result<(), StageError> {
        let Parameters {
            expansion_1_k: expansion,
            reference_k: reference,
        } = self.parameters;
        let (near, temperature) = (&mut state.near, state.metal.column(&TEMPERATURE));
        let rows = near.force.iter_mut().zip(&near.role).zip(&near.id);
        for ((force, _), &id) in rows.filter(|((_, role), _)| **role == Role::Liquid) {
            let lighter = -(temperature[id as usize] - reference) * expansion;
            *force = along(*force, lighter, self.weight);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forces::tests::pool;

    #[test]
    fn warm_liquid_rises_by_its_expansion() {
        let mut state = pool(|x| 1750.0 + 1e5 * x[0]);
        let parameters = Parameters {
            expansion_1_k: 5.54e-5,
            reference_k: 1750.0,
        };
        let metal = state.metal.matter;
        let mut stage = Buoyancy::new(parameters, [0.0, 0.0, -9.8], metal);
        stage.advance(&mut state, 1e-4).unwrap();
        for (k, force) in state.near.force.iter().enumerate() {
            let x = state.near.position[k][0];
            let expected = match state.near.role[k] {
                Role::Liquid => 7850.0 * 9.8 * 5.54e-5 * 1e5 * x,
                _ => 0.0,
            };
            assert!((force[2] - expected).abs() < 1e-9 * 7850.0 * 9.8);
            assert_eq!((force[0].abs(), force[1].abs()), (0.0, 0.0));
        }
    }
}
