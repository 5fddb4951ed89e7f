//! Shapes of bodies.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where a body is.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// Between two radii and two heights.
    Ring(Ring),
    /// Several of these together.
    Rings(Vec<Ring>),
    /// Below a curved surface.
    Profile(Profile),
}

impl Shape {
    /// All rings of the shape.
    #[must_use]
    pub fn rings(&self) -> &[Ring] {
        match self {
            Self::Ring(ring) => std::slice::from_ref(ring),
            Self::Rings(rings) => rings,
            Self::Profile(_) => &[],
        }
    }

    /// Whether a point is inside.
    #[must_use]
    pub fn holds(&self, r: f64, z: f64) -> bool {
        match self {
            Self::Profile(profile) => profile.holds(r, z),
            _ => self.rings().iter().any(|ring| ring.holds(r, z)),
        }
    }
}

/// Between two radii and two heights.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ring {
    /// Inner and outer radius; an inner radius of 0 makes a cylinder.
    #[schemars(extend("x-unit" = "m"))]
    pub r_m: [f64; 2],
    /// Lower and upper height.
    #[schemars(extend("x-unit" = "m"))]
    pub z_m: [f64; 2],
}

impl Ring {
    /// Whether a point is inside.
    #[must_use]
    pub fn holds(&self, r: f64, z: f64) -> bool {
        r > self.r_m[0] && r < self.r_m[1] && z > self.z_m[0] && z < self.z_m[1]
    }
}

/// Below a curved surface, such as that of a molten pool.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// Inner and outer radius.
    #[schemars(extend("x-unit" = "m"))]
    pub r_m: [f64; 2],
    /// Lower height.
    #[schemars(extend("x-unit" = "m"))]
    pub bottom_m: f64,
    /// The surface; absent: that of the input `surface`.
    pub top: Option<Surface>,
}

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

impl Profile {
    fn holds(&self, r: f64, z: f64) -> bool {
        let top = self.top.as_ref().is_some_and(|top| z < top.height(r));
        top && z > self.bottom_m && r > self.r_m[0] && r < self.r_m[1]
    }
}
