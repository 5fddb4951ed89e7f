//! Shapes of bodies.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::curve::Surface;

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

impl Profile {
    fn holds(&self, r: f64, z: f64) -> bool {
        let top = self.top.as_ref().is_some_and(|top| z < top.height(r));
        top && z > self.bottom_m && r > self.r_m[0] && r < self.r_m[1]
    }
}
