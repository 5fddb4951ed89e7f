//! Step and end of a run.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Step and end of the run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// Longest step dt \[s\]. All steps are slightly shorter where that lets them end exactly at `end_s`. A stage whose limit is
    /// shorter divides the step within itself.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub step_s: f64,
    /// End of the run \[s\].
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub end_s: f64,
    /// Steps that grow where the flow allows; absent: all steps have one length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub adaptive: Option<Adaptive>,
}

/// Steps of 1, 2, 4, 8 ... times `step_s`: the longest that no limit of a stage divides, from one step to the next at most twice as
/// long. Frames, droplets and the end keep their times. Grains divide
/// each of them by limits of their own.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Adaptive {
    /// Longest step to which they may grow \[s\].
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub greatest_s: f64,
}

impl Time {
    /// Number of steps: as few as reach the end.
    #[must_use]
    pub fn steps(&self) -> u64 {
        let steps = self.end_s / self.step_s;
        // A billionth of all steps decides, not the rounding of the quotient.
        let whole = (steps - steps.round()).abs() <= 1e-9 * steps;
        (if whole { steps.round() } else { steps.ceil() }) as u64
    }

    /// Step dt \[s\] that is taken: `step_s` where whole ones end at the end, else the next shorter one that does.
    #[must_use]
    pub fn step(&self) -> f64 {
        let steps = self.steps() as f64;
        let whole = (self.end_s / self.step_s - steps).abs() <= 1e-9 * steps;
        if whole {
            self.step_s
        } else {
            self.end_s / steps
        }
    }

    /// Most steps of the scene's length that one may hold: a power of two.
    #[must_use]
    pub fn greatest_stride(&self) -> u64 {
        let longest = self.adaptive.map_or(0.0, |adaptive| adaptive.greatest_s);
        let whole = (longest / self.step() * (1.0 + 1e-9)) as u64;
        1 << whole.max(1).ilog2()
    }
}
