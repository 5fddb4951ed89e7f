//! Complete elliptic integrals as a circular loop needs them.

use std::f64::consts::{FRAC_PI_2, PI};

/// Complete elliptic integrals of the first and second kind of the parameter `m = k^2`, from its
/// complement `1 - m` in (0, 1], by the arithmetic-geometric mean (Abramowitz and Stegun 1964,
/// section 17.6).
#[must_use]
pub(super) fn complete(complement: f64) -> (f64, f64) {
    let [mut a, mut g] = [1.0, complement.sqrt()];
    let mut sum = 0.5 * (1.0 - complement);
    let mut power = 0.5;
    for _ in 0..40 {
        let c = 0.5 * (a - g);
        let next = 0.5 * (a + g);
        g = (a * g).sqrt();
        a = next;
        power *= 2.0;
        sum += power * c * c;
        if c.abs() <= 1e-17 * a {
            break;
        }
    }
    let first = PI / (2.0 * a);
    (first, first * (1.0 - sum))
}

/// Below this parameter the series are exact to rounding, above it the closed forms lose nothing.
const SMALL: f64 = 0.2;

/// `G(m) = int_0^(pi/2) (2 sin^2 t - 1) / sqrt(1 - m sin^2 t) dt` and `m G'(m)`, both without
/// cancellation where m is small: near the axis of a loop.
///
/// With `q_j = (1/2)_j / j!`, `G = pi/2 sum_{j>=1} q_j^2 m^j j/(j+1)`.
#[must_use]
pub(super) fn loop_integral(m: f64, complement: f64) -> (f64, f64) {
    if m < SMALL {
        return series(m);
    }
    let (k, e) = complete(complement);
    // int sin^2 / sqrt = (K - E) / m.
    let value = 2.0 * (k - e) / m - k;
    // m K' = (E / (1 - m) - K) / 2, m E' = (E - K) / 2.
    let first = 0.5 * (e / complement - k);
    let second = 0.5 * (e - k);
    let slope = 2.0 * (first - second) / m - 2.0 * (k - e) / m - first;
    (value, slope)
}

fn series(m: f64) -> (f64, f64) {
    let mut q = 1.0;
    let mut power = 1.0;
    let [mut value, mut slope] = [0.0, 0.0];
    for j in 1..60 {
        let j = f64::from(j);
        q *= (j - 0.5) / j;
        power *= m;
        let term = q * q * power * j / (j + 1.0);
        value += term;
        slope += j * term;
        if j * term <= 1e-17 * slope {
            break;
        }
    }
    (FRAC_PI_2 * value, FRAC_PI_2 * slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrals_agree_with_the_tables() {
        // Abramowitz and Stegun (1964), tables 17.1 and 17.2.
        for (m, k, e) in [
            (0.0, FRAC_PI_2, FRAC_PI_2),
            (0.5, 1.854_074_677_301_372, 1.350_643_881_047_675),
            (0.99, 3.695_637_362_989_875, 1.015_993_545_025_224),
        ] {
            let found = complete(1.0 - m);
            assert!((found.0 / k - 1.0).abs() < 1e-14, "{found:?}");
            assert!((found.1 / e - 1.0).abs() < 1e-14, "{found:?}");
        }
    }

    #[test]
    fn series_and_closed_form_meet() {
        let m = SMALL;
        let (a, b) = series(m);
        let (c, d) = loop_integral(m, 1.0 - m);
        assert!((a / c - 1.0).abs() < 1e-13 && (b / d - 1.0).abs() < 1e-13);
    }

    #[test]
    fn the_slope_is_that_of_the_value() {
        for m in [0.05, 0.4, 0.9] {
            let h = 1e-6;
            let at = |m: f64| loop_integral(m, 1.0 - m).0;
            let slope = m * (at(m + h) - at(m - h)) / (2.0 * h);
            assert!((slope / loop_integral(m, 1.0 - m).1 - 1.0).abs() < 1e-8);
        }
    }
}
