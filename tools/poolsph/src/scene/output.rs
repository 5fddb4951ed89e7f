//! What a run writes, and when.

use run::scene::FloatWidth;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use steps::instants::next_due;

use crate::probes::Probe;

/// Frames and series. A frame stands at the step nearest to its time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// All particles this often \[s\], and at the start and the end.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub particles_interval_s: f64,
    /// Grains this often \[s\], and at the start and the end; as often as the particles if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub grains_interval_s: Option<f64>,
    /// Masses, momentum and energies this often \[s\], and at the start and the end; as often as the particles if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub balance_interval_s: Option<f64>,
    /// Width of the floats.
    #[serde(default)]
    pub precision: FloatWidth,
    /// Thermocouples: places in the metal whose temperature is written; absent: none. They need heat.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub probes: Vec<Probe>,
    /// Readings of the probes this often \[s\], and at the start and the end; as often as the balance if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub probes_interval_s: Option<f64>,
    /// Whether frames have columns of the heat that each particle of metal has received since the start, from arcs, torches, powder
    /// and slag, and of what it has lost. It needs heat.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub heat_received: bool,
    /// Frequent frames around the moving source, for averages; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pool: Option<PoolOutput>,
}

impl Output {
    /// Interval of the balance \[s\].
    #[must_use]
    pub fn balance_interval(&self) -> f64 {
        self.balance_interval_s.unwrap_or(self.particles_interval_s)
    }

    /// Interval of the readings of probes \[s\].
    #[must_use]
    pub fn probes_interval(&self) -> f64 {
        self.probes_interval_s.unwrap_or(self.balance_interval())
    }

    /// Interval of the frames of grains \[s\].
    #[must_use]
    pub fn grains_interval(&self) -> f64 {
        self.grains_interval_s.unwrap_or(self.particles_interval_s)
    }

    /// The first step of length `dt` \[s\] after `step` at which anything is due.
    #[must_use]
    pub fn next(&self, step: u64, dt: f64) -> u64 {
        let often = [
            self.particles_interval_s,
            self.balance_interval(),
            self.grains_interval(),
        ];
        let probes = (!self.probes.is_empty()).then(|| self.probes_interval());
        let often = often.into_iter().chain(probes);
        let next = often.map(|interval| next_due(step, dt, interval));
        // Frames of the pool begin late.
        let pool = self.pool.map(|pool| {
            let begin = (pool.from_s / dt).floor() as u64;
            if step < begin {
                begin
            } else {
                next_due(step, dt, pool.interval_s)
            }
        });
        next.chain(pool).fold(u64::MAX, u64::min)
    }
}

/// Frequent frames of the particles in a box that moves with the source; all heights.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PoolOutput {
    /// Time before which no frame is written \[s\].
    #[schemars(range(min = 0.0), extend("x-unit" = "s"))]
    pub from_s: f64,
    /// This often \[s\].
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub interval_s: f64,
    /// Half width of the box across the weld \[m\].
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub beside_m: f64,
    /// Reach of the box behind the source \[m\].
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub behind_m: f64,
    /// Reach of the box ahead of the source \[m\].
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub ahead_m: f64,
}
