//! Linear and quadratic functions that weights are to be exact for.

use crate::body::frame::Vector;

/// Most functions: three linear and five quadratic ones.
pub(super) const MOST: usize = 8;

/// Functions of a displacement, in the unit of the spacing: its components, and, where second moments are asked
/// for, the quadratic ones without a Laplacian (x^2 - y^2, 2xy, ...).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Basis {
    /// 2 or 3.
    pub(super) dimensions: usize,
    /// Whether the quadratic functions belong to it.
    pub(super) moments: bool,
}

impl Basis {
    /// Number of functions.
    pub(super) fn size(self) -> usize {
        match (self.dimensions, self.moments) {
            (d, false) => d,
            (2, true) => 4,
            (_, true) => 8,
        }
    }

    /// Values at displacement `d`. Seen from the other end of a link the linear ones change sign.
    #[inline]
    pub(super) fn values(self, d: Vector) -> [f64; MOST] {
        let [x, y, z] = d;
        match (self.dimensions, self.moments) {
            (2, false) => [x, y, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            (2, true) => [x, y, x * x - y * y, 2.0 * x * y, 0.0, 0.0, 0.0, 0.0],
            (_, false) => [x, y, z, 0.0, 0.0, 0.0, 0.0, 0.0],
            (_, true) => [
                x,
                y,
                z,
                x * x - y * y,
                (2.0 * z * z - x * x - y * y) / 3.0_f64.sqrt(),
                2.0 * x * y,
                2.0 * x * z,
                2.0 * y * z,
            ],
        }
    }

    /// Slopes along `n` at displacement `d`.
    pub(super) fn slopes(self, n: Vector, d: Vector) -> [f64; MOST] {
        let ([a, b, c], [x, y, z]) = (n, d);
        match (self.dimensions, self.moments) {
            (2, false) => [a, b, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            (2, true) => [
                a,
                b,
                2.0 * (a * x - b * y),
                2.0 * (a * y + b * x),
                0.0,
                0.0,
                0.0,
                0.0,
            ],
            (_, false) => [a, b, c, 0.0, 0.0, 0.0, 0.0, 0.0],
            (_, true) => [
                a,
                b,
                c,
                2.0 * (a * x - b * y),
                (4.0 * c * z - 2.0 * a * x - 2.0 * b * y) / 3.0_f64.sqrt(),
                2.0 * (a * y + b * x),
                2.0 * (a * z + c * x),
                2.0 * (b * z + c * y),
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_derivatives_and_the_functions_are_harmonic() {
        for basis in [2, 3].map(|dimensions| Basis {
            dimensions,
            moments: true,
        }) {
            let (d, step) = (
                [0.3, -0.7, if basis.dimensions == 3 { 0.4 } else { 0.0 }],
                1e-4,
            );
            let mut laplacian = [0.0; MOST];
            for k in 0..basis.dimensions {
                let (mut n, mut low, mut high) = ([0.0; 3], d, d);
                n[k] = 1.0;
                low[k] -= step;
                high[k] += step;
                let (a, m, b) = (basis.values(low), basis.values(d), basis.values(high));
                let slopes = basis.slopes(n, d);
                for f in 0..basis.size() {
                    assert!(((b[f] - a[f]) / (2.0 * step) - slopes[f]).abs() < 1e-9);
                    laplacian[f] += (a[f] - 2.0 * m[f] + b[f]) / (step * step);
                }
            }
            assert!(laplacian.iter().all(|l| l.abs() < 1e-6), "{laplacian:?}");
        }
    }
}
