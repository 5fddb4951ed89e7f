//! What the surface is at a particle.

use crate::faces::Turn;
use crate::vector::plus;

/// A wall whose normal points down by this much is out of reach of the arc. It is above zero for the scatter of
/// normals: half of the patches of an upright wall look down a little.
const LEAN: f64 = 0.2;

/// What the surface is at a particle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Patch {
    /// Outward unit normal; zero deep inside.
    pub normal: [f64; 3],
    /// Area that the particle owns \[m2\]; zero off the surface.
    pub area: f64,
    /// Area as seen from above \[m2\].
    pub seen: f64,
    /// Distance to the surface along the normal \[m\].
    pub depth: f64,
    /// grad C \[1/m\].
    pub(crate) gradient: [f64; 3],
}

impl Patch {
    /// The patch of an image.
    #[must_use]
    #[inline]
    pub(crate) fn turned(self, turn: &Turn) -> Self {
        Self {
            normal: turn.vector(self.normal),
            gradient: turn.vector(self.gradient),
            ..self
        }
    }

    /// The place on the surface that belongs to a particle at `x` \[m\]: tables of what acts on the area are read there.
    #[must_use]
    #[inline]
    pub fn foot(&self, x: [f64; 3]) -> [f64; 3] {
        plus(x, self.depth, self.normal)
    }

    /// The part of the area that the arc reaches from above: all of what looks upwards, nothing of what looks down.
    #[must_use]
    #[inline]
    pub fn reached(&self) -> f64 {
        (1.0 + self.normal[2] / LEAN).clamp(0.0, 1.0)
    }

    /// All numbers, for a checkpoint.
    #[must_use]
    pub fn save(&self) -> [f64; 9] {
        let ([a, b, c], [d, e, f]) = (self.normal, self.gradient);
        [a, b, c, self.area, self.seen, self.depth, d, e, f]
    }

    /// The patch of which `saved` are the numbers.
    #[must_use]
    pub fn restored(saved: [f64; 9]) -> Self {
        let [a, b, c, area, seen, depth, d, e, f] = saved;
        Self {
            normal: [a, b, c],
            area,
            seen,
            depth,
            gradient: [d, e, f],
        }
    }
}
