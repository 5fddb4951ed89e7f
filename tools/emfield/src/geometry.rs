//! How many coordinates places have, and what of a vector is seen.

use schemars::JsonSchema;
use serde::Deserialize;

/// Kinds of geometry.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Geometry {
    /// Nothing changes along z; places have x and y.
    Plane,
    /// Nothing changes about the z axis; places have r and z, shapes are their sections with r >= 0.
    Axisymmetric,
    /// Places have x, y and z.
    Space,
}

/// Name of the wall of a ball.
pub const BALL: &str = "sphere";

impl Geometry {
    /// Names of the walls of a box.
    #[must_use]
    pub fn walls(self) -> Vec<&'static str> {
        match self {
            Self::Axisymmetric => vec!["r-", "r+", "z-", "z+"],
            Self::Plane => vec!["x-", "x+", "y-", "y+"],
            Self::Space => vec!["x-", "x+", "y-", "y+", "z-", "z+"],
        }
    }

    /// Coordinates of a place: 2 or 3.
    #[must_use]
    pub fn dimensions(self) -> usize {
        match self {
            Self::Plane | Self::Axisymmetric => 2,
            Self::Space => 3,
        }
    }

    /// The two coordinates of a place of a plane (x, y) or axisymmetric (r, z) cloud \[m\].
    #[must_use]
    pub fn flat(self, x: [f64; 3]) -> [f64; 2] {
        match self {
            Self::Axisymmetric => [x[0], x[2]],
            Self::Plane | Self::Space => [x[0], x[1]],
        }
    }

    /// The place in space of coordinates of the scene: (r, z) stands in the half plane y = 0 \[m\].
    #[must_use]
    pub fn place(self, x: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Axisymmetric => [x[0], 0.0, x[1]],
            Self::Plane | Self::Space => x,
        }
    }

    /// Coordinates of the scene of a place in space; the inverse of [`Geometry::place`] \[m\].
    #[must_use]
    pub fn coordinates(self, x: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Axisymmetric => [x[0], x[2], 0.0],
            Self::Plane | Self::Space => x,
        }
    }

    /// The unit of a force.
    #[must_use]
    pub fn unit_of_force(self) -> &'static str {
        match self {
            Self::Plane => "N/m",
            Self::Axisymmetric | Self::Space => "N",
        }
    }

    /// The unit of a power.
    #[must_use]
    pub fn unit_of_power(self) -> &'static str {
        match self {
            Self::Plane => "W/m",
            Self::Axisymmetric | Self::Space => "W",
        }
    }

    /// The components of a force that there are: nothing pulls along an endless bar, and those across an axis cancel.
    #[must_use]
    pub fn pulled(self) -> &'static [usize] {
        match self {
            Self::Plane => &[0, 1],
            Self::Axisymmetric => &[2],
            Self::Space => &[0, 1, 2],
        }
    }

    /// A force by these alone.
    #[must_use]
    pub fn seen(self, force: [f64; 3]) -> [f64; 3] {
        let has = |k| self.pulled().contains(&k);
        std::array::from_fn(|k| if has(k) { force[k] } else { 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shapes::frame::length;

    #[test]
    fn what_a_scene_does_not_have_is_not_seen() {
        let force = [1.0, 2.0, 4.0];
        assert!((length(Geometry::Axisymmetric.seen(force)) - 4.0).abs() < 1e-15);
        assert!((length(Geometry::Plane.seen(force)) - 5.0_f64.sqrt()).abs() < 1e-15);
    }
}
