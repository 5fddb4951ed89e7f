//! A point on a surface, and how the surface bends there.

use shapes::frame::{Vector, cross, direction};

/// Parallel surfaces shrink to this at most, in lengths.
const SHRUNK: f64 = 0.6;

/// A point on a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Seed {
    pub(crate) place: Vector,
    /// Out of the body.
    pub(crate) normal: Vector,
    /// Area \[m2\]; length \[m\] in two dimensions.
    pub(crate) area: f64,
    /// Distance of its neighbours, about \[m\].
    pub(crate) spacing: f64,
    pub(crate) curvature: Curvature,
}

/// How a surface bends at a place.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Curvature {
    /// Unit direction along the surface, that of the first curvature.
    pub along: Vector,
    /// Principal curvatures \[1/m\], positive where the body is convex.
    pub principal: [f64; 2],
}

impl Curvature {
    /// Sum of the principal curvatures \[1/m\].
    pub(crate) fn sum(&self) -> f64 {
        self.principal[0] + self.principal[1]
    }

    /// How far the surface leaves its tangent plane within a distance \[m\].
    pub(crate) fn bow(&self, spacing: f64) -> f64 {
        let most = self.principal.iter().fold(0.0, |m: f64, k| m.max(k.abs()));
        0.5 * most * spacing * spacing
    }

    /// How areas change with the signed distance from the surface, over the area on it.
    pub(crate) fn widening(&self, away: f64) -> f64 {
        let [a, b] = self.principal;
        ((1.0 + away * a) * (1.0 + away * b)).max(0.0)
    }

    /// That of the parallel surface at a signed distance \[m\].
    pub(crate) fn beside(&self, away: f64) -> Self {
        Self {
            principal: self.principal.map(|k| k / (1.0 + away * k).max(SHRUNK)),
            ..*self
        }
    }
}

/// A direction across another.
pub(crate) fn aside(normal: Vector) -> Vector {
    let least = (0..3).fold(0, |m, k| {
        if normal[k].abs() < normal[m].abs() {
            k
        } else {
            m
        }
    });
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    direction(cross(axis, normal))
}
