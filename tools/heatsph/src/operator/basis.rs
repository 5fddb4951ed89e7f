//! Linear and quadratic functions that weights are to be exact for.
//!
//! `K = D`: the coordinates of a displacement. `K = 4` of two and `K = 8` of three coordinates: beside them the
//! quadratic functions without a Laplacian, `x^2 - y^2`, `2xy` and so on. Seen from the other end of a link the
//! linear ones change sign.

use shapes::frame::Vector;

/// Values at displacement `d`.
#[inline]
pub(super) fn values<const D: usize, const K: usize>(d: Vector) -> [f64; K] {
    let [x, y, z] = d;
    let all = match (D, K) {
        (2, 4) => [x, y, x * x - y * y, 2.0 * x * y, 0.0, 0.0, 0.0, 0.0],
        (3, 8) => [
            x,
            y,
            z,
            x * x - y * y,
            (2.0 * z * z - x * x - y * y) / 3.0_f64.sqrt(),
            2.0 * x * y,
            2.0 * x * z,
            2.0 * y * z,
        ],
        _ => [x, y, z, 0.0, 0.0, 0.0, 0.0, 0.0],
    };
    std::array::from_fn(|k| all[k])
}

/// Slopes along `n` at displacement `d`.
pub(super) fn slopes<const D: usize, const K: usize>(n: Vector, d: Vector) -> [f64; K] {
    let ([a, b, c], [x, y, z]) = (n, d);
    let all = match (D, K) {
        (2, 4) => [
            a,
            b,
            2.0 * (a * x - b * y),
            2.0 * (a * y + b * x),
            0.0,
            0.0,
            0.0,
            0.0,
        ],
        (3, 8) => [
            a,
            b,
            c,
            2.0 * (a * x - b * y),
            (4.0 * c * z - 2.0 * a * x - 2.0 * b * y) / 3.0_f64.sqrt(),
            2.0 * (a * y + b * x),
            2.0 * (a * z + c * x),
            2.0 * (b * z + c * y),
        ],
        _ => [a, b, c, 0.0, 0.0, 0.0, 0.0, 0.0],
    };
    std::array::from_fn(|k| all[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checked<const D: usize, const K: usize>() {
        let (d, step) = ([0.3, -0.7, if D == 3 { 0.4 } else { 0.0 }], 1e-4);
        let mut laplacian = [0.0; K];
        for k in 0..D {
            let (mut n, mut low, mut high) = ([0.0; 3], d, d);
            n[k] = 1.0;
            low[k] -= step;
            high[k] += step;
            let (a, m, b) = (values::<D, K>(low), values::<D, K>(d), values::<D, K>(high));
            let slopes = slopes::<D, K>(n, d);
            for f in 0..K {
                assert!(((b[f] - a[f]) / (2.0 * step) - slopes[f]).abs() < 1e-9);
                laplacian[f] += (a[f] - 2.0 * m[f] + b[f]) / (step * step);
            }
        }
        assert!(laplacian.iter().all(|l| l.abs() < 1e-6), "{laplacian:?}");
    }

    #[test]
    fn slopes_are_derivatives_and_the_functions_are_harmonic() {
        checked::<2, 2>();
        checked::<2, 4>();
        checked::<3, 3>();
        checked::<3, 8>();
    }
}
