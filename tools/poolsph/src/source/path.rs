//! The moving axis of the arc as a stage.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Place;
use crate::stage::{Stage, StageError};
use crate::state::State;

/// Where the arc stands and moves (key `source`).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Axis of the arc at time 0, on the plate \[m\].
    #[schemars(extend("x-unit" = "m"))]
    pub start_m: [f64; 3],
    /// Welding speed \[m/s\].
    #[schemars(extend("x-unit" = "m/s"))]
    pub velocity_m_s: [f64; 3],
}

impl Parameters {
    /// The axis at a time \[s\].
    #[must_use]
    pub fn position(&self, time: f64) -> [f64; 3] {
        [0, 1, 2].map(|k| self.start_m[k] + self.velocity_m_s[k] * time)
    }

    /// The place at a time \[s\], before any droplet.
    #[must_use]
    pub fn place(&self, time: f64) -> Place {
        Place {
            position: self.position(time),
            way: [0.0; 3],
            phase: 0.0,
            droplets: 0,
        }
    }
}

/// Part of a spacing that an axis goes in a step where steps are adaptive.
const FOLLOWED: f64 = 0.5;

/// The stage that moves the axis.
#[derive(Debug, Clone, Copy)]
pub struct Path(pub Parameters);

impl Stage for Path {
    fn name(&self) -> &'static str {
        "source"
    }

    fn follows(&self, state: &State) -> f64 {
        let [x, y, _] = self.0.velocity_m_s;
        FOLLOWED * state.metal.matter.spacing / x.hypot(y)
    }

    fn advance(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let end = state.end(dt);
        let place = state.source.unwrap_or(self.0.place(end));
        state.source = Some(Place {
            position: self.0.position(end),
            way: self.0.velocity_m_s.map(|u| u * dt),
            ..place
        });
        Ok(())
    }
}
