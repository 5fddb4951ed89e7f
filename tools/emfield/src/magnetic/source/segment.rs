//! A straight piece of wire.

use std::f64::consts::PI;

use shapes::frame::{cross, difference, dot};

use super::{C, MU0};

/// A straight piece of wire. Within `wire_radius` of its core the field falls linearly to zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Where the current enters \[m\].
    pub from: [f64; 3],
    /// Where it leaves \[m\].
    pub to: [f64; 3],
    /// Radius of the wire \[m\].
    pub wire_radius: f64,
    /// Current \[A\], rms.
    pub current: C,
}

impl Segment {
    /// Unit vector along the wire, and its length \[m\].
    fn along(&self) -> ([f64; 3], f64) {
        let d = difference(self.to, self.from);
        let length = dot(d, d).sqrt();
        (d.map(|x| x / length), length)
    }

    /// Vector potential of 1 A \[V s/(m A)\]: `mu0/(4 pi) ln((r1 + r2 + L) / (r1 + r2 - L))` along the
    /// wire (Biot and Savart, integrated).
    #[must_use]
    pub fn potential(&self, p: [f64; 3]) -> [f64; 3] {
        let (t, length) = self.along();
        let [a, b] = [difference(p, self.from), difference(p, self.to)];
        let [x, y] = [dot(a, t), dot(b, t)];
        let square = (dot(a, a) - x * x).max(self.wire_radius * self.wire_radius);
        let sum = (square + x * x).sqrt() + (square + y * y).sqrt();
        let size = MU0 / (4.0 * PI) * (2.0 * length / (sum - length)).ln_1p();
        t.map(|c| c * size)
    }

    /// Flux density of 1 A \[T/A\]: `mu0/(4 pi d) (x1/r1 - x2/r2)` around the wire.
    #[must_use]
    pub fn flux(&self, p: [f64; 3]) -> [f64; 3] {
        let (t, _) = self.along();
        let [a, b] = [difference(p, self.from), difference(p, self.to)];
        let [x, y] = [dot(a, t), dot(b, t)];
        let around = cross(t, a);
        let least = self.wire_radius * self.wire_radius;
        let square = dot(around, around).max(least);
        let difference = x / (square + x * x).sqrt() - y / (square + y * y).sqrt();
        around.map(|c| c * MU0 / (4.0 * PI) * difference / square)
    }

    /// Middles of `count` equal pieces with the tangent times their length \[m\].
    #[must_use]
    pub fn pieces(&self, count: usize) -> Vec<([f64; 3], [f64; 3])> {
        let d = difference(self.to, self.from);
        (0..count)
            .map(|k| {
                let s = (k as f64 + 0.5) / count as f64;
                let place = [0, 1, 2].map(|i| self.from[i] + s * d[i]);
                (place, d.map(|x| x / count as f64))
            })
            .collect()
    }
}
