//! An endless straight wire along z, for plane scenes.

use std::f64::consts::PI;

use super::{C, MU0};

/// An endless wire along z. Within `wire_radius` of its core the field falls linearly to zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wire {
    /// Place in the plane \[m\].
    pub place: [f64; 2],
    /// Radius of the wire \[m\].
    pub wire_radius: f64,
    /// Current along z \[A\], rms.
    pub current: C,
}

impl Wire {
    fn off(&self, p: [f64; 3]) -> ([f64; 2], f64) {
        let d = [p[0] - self.place[0], p[1] - self.place[1]];
        (d, d[0].hypot(d[1]).max(self.wire_radius))
    }

    /// Vector potential of 1 A \[V s/(m A)\]: `-mu0/(2 pi) ln(d / 1 m)` along z.
    #[must_use]
    pub fn potential(&self, p: [f64; 3]) -> [f64; 3] {
        let (_, distance) = self.off(p);
        [0.0, 0.0, -MU0 / (2.0 * PI) * distance.ln()]
    }

    /// Flux density of 1 A \[T/A\]: `mu0/(2 pi d)` around the wire (Ampere).
    #[must_use]
    pub fn flux(&self, p: [f64; 3]) -> [f64; 3] {
        let (d, distance) = self.off(p);
        let size = MU0 / (2.0 * PI * distance * distance);
        [-d[1] * size, d[0] * size, 0.0]
    }
}
