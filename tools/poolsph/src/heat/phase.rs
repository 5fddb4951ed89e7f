//! Melting and solidification (Komen 2019, fig. 4.7): a particle is liquid from half of the
//! latent heat on, and the flow starts with enough liquid particles (section 4.3).
//!
//! What a particle has held of its latent heat at most is kept, liquid or not: it tells how far into
//! the particle the front of melting has come, and so the fusion line to a part of a particle.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::caloric::Caloric;
use crate::stage::{Figure, Stage, StageError};
use crate::state::{self, Column, LIQUID, State};

/// When the flow starts (key `flow_start`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlowStart {
    /// Number of liquid particles with which it starts; 120 in Komen (2019), section 4.3.
    #[schemars(range(min = 1))]
    pub liquid_particles: usize,
}

/// The change of phase as a stage.
pub struct Phase {
    caloric: Arc<Caloric>,
    start: Option<usize>,
    liquid: usize,
}

impl Phase {
    /// Phases of the metal; with `start`, sets [`State::flowing`] once enough of it is liquid.
    #[must_use]
    pub fn new(caloric: Arc<Caloric>, start: Option<FlowStart>) -> Self {
        Self {
            caloric,
            start: start.map(|s| s.liquid_particles),
            liquid: 0,
        }
    }
}

impl Stage for Phase {
    fn name(&self) -> &'static str {
        "phase"
    }

    fn needs(&self) -> &'static [Column] {
        &[Column::Temperature, Column::Enthalpy]
    }

    fn advance(&mut self, state: &mut State, _dt: f64) -> Result<(), StageError> {
        self.liquid = 0;
        for a in 0..state.len() {
            if state.wall[a] || state.phase[a] == state::Phase::Flying {
                continue;
            }
            let molten = self.caloric.molten(state.enthalpy[a]);
            state.fused[a] = state.fused[a].max(molten);
            let liquid = molten >= LIQUID;
            self.liquid += usize::from(liquid);
            match (state.phase[a], liquid) {
                (state::Phase::Solid, true) => {
                    state.phase[a] = state::Phase::Liquid;
                }
                (state::Phase::Liquid, false) => {
                    state.phase[a] = state::Phase::Solid;
                    state.velocity[a] = [0.0; 3];
                }
                _ => {}
            }
        }
        if self.start.is_some_and(|start| self.liquid >= start) {
            state.flowing = true;
        }
        Ok(())
    }

    fn figures(&self) -> Vec<Figure> {
        vec![Figure {
            name: "liquid_particles",
            unit: "1",
            value: self.liquid as f64,
        }]
    }
}
