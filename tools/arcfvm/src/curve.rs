//! A curve of heights over the radius.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Height over radius, straight between the points and level beyond them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Surface {
    /// Radii, rising.
    #[schemars(extend("x-unit" = "m"), length(min = 1))]
    pub r_m: Vec<f64>,
    /// Height at each radius.
    #[schemars(extend("x-unit" = "m"), length(min = 1))]
    pub z_m: Vec<f64>,
}

impl Surface {
    /// What makes it no surface.
    #[must_use]
    pub fn fault(&self) -> Option<&'static str> {
        if self.r_m.is_empty() || self.r_m.len() != self.z_m.len() {
            Some("wants as many radii as heights, one or more")
        } else if self.r_m.windows(2).any(|w| w[1] <= w[0]) {
            Some("has radii that do not rise")
        } else {
            None
        }
    }

    /// Height at radius `r` \[m\].
    #[must_use]
    pub fn height(&self, r: f64) -> f64 {
        let after = self.r_m.partition_point(|at| *at <= r);
        if after == 0 {
            return self.z_m[0];
        }
        if after == self.r_m.len() {
            return self.z_m[after - 1];
        }
        let part = (r - self.r_m[after - 1]) / (self.r_m[after] - self.r_m[after - 1]);
        self.z_m[after - 1] + part * (self.z_m[after] - self.z_m[after - 1])
    }
}
