//! How far grains have gone in a step, and since neighbours were listed.

use contact::Grain;
use shapes::frame::{Vector, difference, dot};

use super::greater::greater;

/// How far grains have gone \[m\]; no number where one is none.
#[derive(Debug, Clone, Copy, Default)]
pub struct Gone {
    /// Since neighbours were listed, the farthest.
    pub far: f64,
    /// In the step, the farthest.
    pub way: f64,
}

impl Gone {
    /// Takes down squares of the way of a grain since it was `listed`, and of that in the step.
    #[inline(always)]
    pub(super) fn note(&mut self, grain: &Grain, listed: &Vector, square: f64) {
        let way = difference(grain.position, *listed);
        self.far = greater(self.far, dot(way, way));
        self.way = greater(self.way, square);
    }

    /// The greater of both.
    pub(super) fn farther(self, other: Self) -> Self {
        Self {
            far: greater(self.far, other.far),
            way: greater(self.way, other.way),
        }
    }

    /// Roots of squares.
    pub(super) fn rooted(self) -> Self {
        Self {
            far: self.far.sqrt(),
            way: self.way.sqrt(),
        }
    }
}
