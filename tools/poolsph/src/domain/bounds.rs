//! The box in which metal is followed: spatter that leaves it is caught and kept where it left.
//!
//! A particle thrown off would fall for ever, and the search for neighbours would follow it. What is
//! caught meets nobody any more, but keeps its mass and heat in the balances.

use particles::{Matter, POSITION};
use run::Fault;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use steps::Figure;

use crate::stage::{Stage, StageError};
use crate::state::slag::SLAG;
use crate::state::{PHASE, State, VELOCITY, marked, phase};

/// The box in which metal is followed (key `bounds`).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Lower corner \[m\].
    #[schemars(extend("x-unit" = "m"))]
    pub min_m: [f64; 3],
    /// Upper corner \[m\].
    #[schemars(extend("x-unit" = "m"))]
    pub max_m: [f64; 3],
}

/// Name of the mass that has been caught.
pub const SPATTER: &str = "spatter_kg";

/// The stage that catches spatter.
#[derive(Debug, Clone)]
pub struct Bounds {
    parameters: Parameters,
    mass: f64,
    caught: u64,
    /// Mass of particles of slag that were caught, in those of metal.
    slag: f64,
}

impl Bounds {
    /// A box for `metal`.
    ///
    /// # Errors
    /// A fault at the corner that is on the wrong side of the other.
    pub fn new(parameters: Parameters, metal: Matter) -> Result<Self, Fault> {
        match (0..3).find(|k| parameters.max_m[*k] <= parameters.min_m[*k]) {
            Some(k) => Err(Fault::at(
                &format!("/max_m/{k}"),
                format!(
                    "{} m is not above {} m of min_m",
                    parameters.max_m[k], parameters.min_m[k]
                ),
            )),
            None => Ok(Self {
                parameters,
                mass: metal.mass(),
                caught: 0,
                slag: 0.0,
            }),
        }
    }
}

impl Stage for Bounds {
    fn name(&self) -> &'static str {
        "bounds"
    }

    fn advance(&mut self, state: &mut State, _dt: f64) -> Result<(), StageError> {
        let Parameters { min_m, max_m } = self.parameters;
        let (density, own) = (state.metal.matter.density, state.slag);
        let marks = state.metal.column(&SLAG).to_vec();
        let (places, phases, velocities) =
            (state.metal).columns_mut((&POSITION, &PHASE, &VELOCITY));
        let each = places.iter().zip(phases.iter_mut().zip(velocities));
        for (a, (x, (phase, u))) in each.enumerate() {
            let outside = (0..3).any(|k| x[k] < min_m[k] || x[k] > max_m[k]);
            if outside && *phase == phase::LIQUID {
                (*phase, *u) = (phase::FLYING, [0.0; 3]);
                match own {
                    Some(slag) if marked(&marks, a) => self.slag += slag.density / density,
                    _ => self.caught += 1,
                }
            }
        }
        Ok(())
    }

    fn figures(&self) -> Vec<Figure> {
        vec![Figure {
            name: SPATTER,
            unit: "kg",
            value: self.mass * (self.caught as f64 + self.slag),
        }]
    }

    fn save(&self) -> Vec<f64> {
        let slag = (self.slag > 0.0).then_some(self.slag);
        std::iter::once(self.caught as f64).chain(slag).collect()
    }

    fn restore(&mut self, saved: &[f64]) {
        self.caught = saved.first().map_or(0, |n| *n as u64);
        self.slag = saved.get(1).copied().unwrap_or(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Particle;

    #[test]
    fn only_liquid_that_leaves_is_caught() {
        let metal = Matter {
            density: 1000.0,
            spacing: 1e-3,
            smoothing_length: 1e-3,
        };
        let mut state = State::new(metal);
        for (x, phase) in [
            (0.5, phase::LIQUID),
            (1.5, phase::LIQUID),
            (1.5, phase::SOLID),
            (-0.5, phase::LIQUID),
        ] {
            state.push(Particle {
                position: [0.5, x, 0.5],
                velocity: [1.0; 3],
                phase,
                droplet: false,
                wall: false,
                temperature: 300.0,
                enthalpy: 0.0,
            });
        }
        let unit = Parameters {
            min_m: [0.0; 3],
            max_m: [1.0; 3],
        };
        let mut stage = Bounds::new(unit, metal).unwrap();
        for _ in 0..2 {
            stage.advance(&mut state, 1e-4).unwrap();
        }
        let phases = [phase::LIQUID, phase::FLYING, phase::SOLID, phase::FLYING];
        assert_eq!(state.metal.column(&PHASE), phases);
        assert_eq!(
            (
                state.metal.column(&VELOCITY)[1],
                state.metal.column(&VELOCITY)[0]
            ),
            ([0.0; 3], [1.0; 3])
        );
        assert!((stage.figures()[0].value - 2e-6).abs() < 1e-18);
        let wrong = Parameters {
            max_m: [1.0, 0.0, 1.0],
            ..unit
        };
        let fault = Bounds::new(wrong, metal).unwrap_err();
        assert_eq!(fault.path(), "/max_m/1");
    }

    #[test]
    fn slag_that_is_caught_has_its_own_mass() {
        let metal = Matter {
            density: 1000.0,
            spacing: 1e-3,
            smoothing_length: 1e-3,
        };
        let mut state = State::new(metal);
        state.metal.declare(&SLAG);
        state.slag = Some(crate::state::slag::Slag {
            density: 400.0,
            viscosity: 0.0,
            interface_tension: 0.0,
            surface_tension: None,
        });
        for slag in [false, true] {
            state.push(Particle {
                position: [2.0; 3],
                velocity: [0.0; 3],
                phase: phase::LIQUID,
                droplet: false,
                wall: false,
                temperature: 300.0,
                enthalpy: 0.0,
            });
            let row = state.len() - 1;
            state.metal.set(&SLAG, row, slag);
        }
        let unit = Parameters {
            min_m: [0.0; 3],
            max_m: [1.0; 3],
        };
        let mut stage = Bounds::new(unit, metal).unwrap();
        stage.advance(&mut state, 1e-4).unwrap();
        let caught = |stage: &Bounds| stage.figures()[0].value;
        assert!((caught(&stage) - 1.4e-6).abs() < 1e-18);
        let mut resumed = Bounds::new(unit, metal).unwrap();
        resumed.restore(&stage.save());
        assert!((caught(&resumed) - 1.4e-6).abs() < 1e-18);
    }
}
