//! Rules of Gauss and Legendre: `n` places and weights that integrate polynomials of degree `2 n - 1` exactly
//! (Abramowitz and Stegun 1964, eq. 25.4.29 and table 25.4).
//!
//! ```
//! let cube = |x: f64| x * x * x;
//! let sum: f64 = quadrature::TWO.iter().map(|(x, weight)| weight * cube(*x)).sum();
//! assert!((sum - 0.25).abs() < 1e-15);
//! ```

use std::f64::consts::PI;

/// Distance of both places of the rule of two points from the middle of \[-1, 1\], `1/sqrt(3)`; their weights are 1.
pub const HALF_SPREAD: f64 = 0.577_350_269_189_625_8;

/// Places on \[0, 1\] and weights, two points.
pub const TWO: [(f64, f64); 2] = [
    (0.211_324_865_405_187_13, 0.5),
    (0.788_675_134_594_812_9, 0.5),
];

/// Places on \[0, 1\] and weights, three points.
pub const THREE: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// Places on \[-1, 1\] and weights, six points.
pub const SIX: [(f64, f64); 6] = [
    (-0.932_469_514_203_152, 0.171_324_492_379_170_35),
    (-0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (-0.238_619_186_083_196_9, 0.467_913_934_572_691),
    (0.238_619_186_083_196_9, 0.467_913_934_572_691),
    (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (0.932_469_514_203_152, 0.171_324_492_379_170_35),
];

/// Places on \[-1, 1\] and weights of `count` points: `w = 2 / ((1 - x^2) P_n'(x)^2)` at the zeros of `P_n`, by Newton's
/// iteration.
///
/// ```
/// let sum: f64 = quadrature::gauss(3).iter().map(|(x, weight)| weight * x.powi(4)).sum();
/// assert!((sum - 0.4).abs() < 1e-15);
/// ```
#[must_use]
pub fn gauss(count: usize) -> Vec<(f64, f64)> {
    let n = count as f64;
    let node = |k: usize| {
        let mut x = -(PI * (k as f64 + 0.75) / (n + 0.5)).cos();
        // The guess is near enough for six doublings of its digits.
        for _ in 0..6 {
            let (value, slope) = legendre(count, x);
            x -= value / slope;
        }
        let (_, slope) = legendre(count, x);
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(node).collect()
}

/// `P_n` and its slope, from `n P_n = (2n-1) x P_(n-1) - (n-1) P_(n-2)`.
fn legendre(count: usize, x: f64) -> (f64, f64) {
    let (mut before, mut now) = (1.0, x);
    for k in 2..=count {
        let n = k as f64;
        (before, now) = (now, ((2.0 * n - 1.0) * x * now - (n - 1.0) * before) / n);
    }
    let n = count as f64;
    (now, n * (x * now - before) / (x * x - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fails unless a rule on `[from, to]` is exact for all powers up to the degree of Gauss and Legendre's.
    fn hold(rule: &[(f64, f64)], from: f64, to: f64) {
        for power in 0..2 * rule.len() as i32 {
            let sum: f64 = rule.iter().map(|(x, w)| w * x.powi(power)).sum();
            let end = power + 1;
            let exact = (to.powi(end) - from.powi(end)) / f64::from(end);
            assert!((sum - exact).abs() < 1e-14, "{} {power}: {sum}", rule.len());
        }
    }

    #[test]
    fn every_rule_is_exact_to_its_degree() {
        hold(&[(-HALF_SPREAD, 1.0), (HALF_SPREAD, 1.0)], -1.0, 1.0);
        hold(&TWO, 0.0, 1.0);
        hold(&THREE, 0.0, 1.0);
        hold(&SIX, -1.0, 1.0);
        for count in [1, 2, 7, 40] {
            hold(&gauss(count), -1.0, 1.0);
        }
    }

    #[test]
    fn no_rule_is_exact_beyond_its_degree() {
        for rule in [gauss(2), gauss(6), SIX.to_vec()] {
            let power = 2 * rule.len() as i32;
            let sum: f64 = rule.iter().map(|(x, w)| w * x.powi(power)).sum();
            assert!((sum - 2.0 / f64::from(power + 1)).abs() > 1e-6, "{sum}");
        }
    }
}
