//! The Voigt function: a Doppler core with Lorentz wings.
//!
//! `H(a, x) = Re w(x + i a)` with the complex error function w by the rational series of Weideman (1994, SIAM J.
//! Numer. Anal. 31, 1497), and its continued fraction far out, where the series loses the small real part.
//! `h = H / sqrt(pi)` has the integral 1 over x, the distance from the line's centre in Doppler widths.

use std::f64::consts::{FRAC_1_SQRT_2, PI};
use std::sync::LazyLock;

/// Terms of the series.
const TERMS: usize = 32;
/// Distance squared beyond which the continued fraction is exact to 1e-9.
const FAR: f64 = 400.0;

static SERIES: LazyLock<Series> = LazyLock::new(Series::new);

struct Series {
    scale: f64,
    coefficients: [f64; TERMS],
}

impl Series {
    fn new() -> Self {
        let half = 2 * TERMS;
        let scale = (TERMS as f64 * FRAC_1_SQRT_2).sqrt();
        let mut coefficients = [0.0; TERMS];
        for k in 1..2 * half {
            let angle = (k as f64 - half as f64) * PI / half as f64;
            let t = scale * (0.5 * angle).tan();
            let f = (-t * t).exp() * (scale * scale + t * t);
            for (n, coefficient) in coefficients.iter_mut().enumerate() {
                *coefficient += f * ((n + 1) as f64 * angle).cos() / (2 * half) as f64;
            }
        }
        Self {
            scale,
            coefficients,
        }
    }
}

type Complex = (f64, f64);

fn times(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

fn over(a: Complex, b: Complex) -> Complex {
    let norm = b.0 * b.0 + b.1 * b.1;
    (
        (a.0 * b.0 + a.1 * b.1) / norm,
        (a.1 * b.0 - a.0 * b.1) / norm,
    )
}

/// `h(a, x)` of integral 1 over all x; `a` is the Lorentz half width at half maximum over the Doppler width, above 0.
#[must_use]
pub fn profile(a: f64, x: f64) -> f64 {
    if x * x + a * a > FAR {
        let square = times((x, a), (x, a));
        let above = times((-a, x), (square.0 - 2.5, square.1));
        let inner = times((square.0 - 3.0, square.1), square);
        return over(above, (inner.0 + 0.75, inner.1)).0 / PI;
    }
    let Series {
        scale,
        coefficients,
    } = &*SERIES;
    // L - i z and L + i z with z = x + i a.
    let minus = (scale + a, -x);
    let ratio = over((scale - a, x), minus);
    let sum = coefficients.iter().rev().fold((0.0, 0.0), |sum, c| {
        let (re, im) = times(sum, ratio);
        (re + c, im)
    });
    let series = over(sum, times(minus, minus)).0;
    let tail = over((1.0, 0.0), minus).0 / PI.sqrt();
    (2.0 * series + tail) / PI.sqrt()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]

    use super::profile;
    use std::f64::consts::PI;

    #[test]
    fn the_limits_are_a_gaussian_and_a_lorentzian() {
        for x in [0.0, 0.5, 1.0, 2.0, 3.0_f64] {
            let gauss = (-x * x).exp() / PI.sqrt();
            assert!((profile(1e-12, x) - gauss).abs() < 1e-11, "{x}");
        }
        for x in [0.0, 1e3, 1e5] {
            let a = 1e3;
            let lorentz = a / PI / (x * x + a * a);
            assert!((profile(a, x) / lorentz - 1.0).abs() < 2e-6, "{x}");
        }
    }

    /// `w(i) = e erfc(1)`; `Re w(1 + i)` and `Re w(2 + i/2)` after Abramowitz and Stegun (1964), table 7.9.
    #[test]
    fn tabulated_values_are_met() {
        let of = |a: f64, x: f64| profile(a, x) * PI.sqrt();
        assert!((of(1.0, 0.0) - 0.427_583_576_155_807).abs() < 1e-12);
        assert!((of(1.0, 1.0) - 0.304_744_2).abs() < 1e-7);
    }

    #[test]
    fn the_series_meets_the_continued_fraction() {
        for a in [1e-4, 1e-2, 1.0] {
            let edge = (400.0_f64 - a * a).sqrt();
            let (inside, outside) = (
                profile(a, edge * (1.0 - 1e-9)),
                profile(a, edge * (1.0 + 1e-9)),
            );
            assert!(
                (inside / outside - 1.0).abs() < 1e-6,
                "{a}: {inside} {outside}"
            );
        }
    }
}
