//! What a run writes, and when.

use run::scene::FloatWidth;
use schemars::JsonSchema;
use serde::Deserialize;

/// Frames and series; steps end at their times exactly.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// All particles this often \[s\], from the start to the end.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub frames_interval_s: f64,
    /// Masses, momentum and energies this often \[s\]; as often as the frames if absent.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub balance_interval_s: Option<f64>,
    /// Width of the floats.
    #[serde(default)]
    pub precision: FloatWidth,
}

impl Output {
    /// How often balances are written \[s\].
    #[must_use]
    pub fn balance_interval(&self) -> f64 {
        self.balance_interval_s.unwrap_or(self.frames_interval_s)
    }
}
