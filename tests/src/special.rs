//! Special functions for exact solutions, by quadrature that converges faster than any power.

use std::f64::consts::PI;

/// First positive zero of the Bessel function J0.
pub const J0_ZERO: f64 = 2.404_825_557_695_773;

/// Points of the trapezoidal rule; spectrally exact for arguments up to about 30.
const POINTS: u32 = 128;

/// Bessel function of the first kind, `J_n(x) = 1/pi int_0^pi cos(n t - x sin t) dt` (Bessel 1824).
#[must_use]
pub fn bessel_j(n: u32, x: f64) -> f64 {
    let mean: f64 = (0..POINTS)
        .map(|k| {
            let t = PI * (f64::from(k) + 0.5) / f64::from(POINTS);
            (f64::from(n) * t - x * t.sin()).cos()
        })
        .sum();
    mean / f64::from(POINTS)
}

/// Error function, by the trapezoidal rule on the whole line (Chiarella and Reichel 1968), which is
/// exact to double precision; for x of 0 or more.
#[must_use]
pub fn erf(x: f64) -> f64 {
    if x < 0.5 {
        // 2/sqrt(pi) sum (-1)^n x^(2n+1) / (n! (2n+1)).
        let mut term = x;
        let mut sum = x;
        for n in 1..20 {
            term *= -x * x / f64::from(n);
            sum += term / f64::from(2 * n + 1);
        }
        return 2.0 / PI.sqrt() * sum;
    }
    if x > 6.0 {
        return 1.0;
    }
    let step = 0.5;
    let series: f64 = (1..=14)
        .map(|n| {
            let square = (f64::from(n) * step).powi(2);
            (-square).exp() / (square + x * x)
        })
        .sum();
    let tail = step * x / PI * (-x * x).exp() * (1.0 / (x * x) + 2.0 * series);
    let pole = if x < PI / step {
        2.0 / (1.0 - (2.0 * PI * x / step).exp())
    } else {
        0.0
    };
    1.0 - tail - pole
}

/// `exp(x^2) erfc(x)` for x of 0 or more, without overflow; by the rule of [`erf`].
#[must_use]
pub fn erfc_scaled(x: f64) -> f64 {
    if x < 0.5 {
        return (x * x).exp() * (1.0 - erf(x));
    }
    let step = 0.5;
    let series: f64 = (1..=14)
        .map(|n| {
            let square = (f64::from(n) * step).powi(2);
            (-square).exp() / (square + x * x)
        })
        .sum();
    let tail = step * x / PI * (1.0 / (x * x) + 2.0 * series);
    let pole = if x < PI / step {
        2.0 * (x * x).exp() / (1.0 - (2.0 * PI * x / step).exp())
    } else {
        0.0
    };
    tail + pole
}

/// Complementary error function for x of 0 or more, small values to full precision.
#[must_use]
pub fn erfc(x: f64) -> f64 {
    erfc_scaled(x) * (-x * x).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_complement_agrees_with_the_tables() {
        // Abramowitz and Stegun (1964), tables 7.1 and 7.3.
        for (x, value) in [
            (0.3, 0.671_373_240_540_872_6),
            (1.0, 0.157_299_207_050_285_1),
            (3.0, 2.209_049_699_858_544e-5),
            (6.0, 2.151_973_671_249_891e-17),
        ] {
            assert!((erfc(x) / value - 1.0).abs() < 1e-12, "{x}: {}", erfc(x));
        }
        // 1 / (x sqrt pi) (1 - 1/(2 x^2) + 3/(4 x^4) - 15/(8 x^6)), eq. 7.1.23.
        let x: f64 = 50.0;
        let far = (1.0 - 0.5 / x.powi(2) + 0.75 / x.powi(4)) / (x * PI.sqrt());
        assert!((erfc_scaled(x) / far - 1.0).abs() < 1e-9);
    }

    #[test]
    fn values_agree_with_the_tables() {
        // Abramowitz and Stegun (1964), table 9.1.
        assert!((bessel_j(0, 1.0) - 0.765_197_686_557_966_6).abs() < 1e-14);
        assert!((bessel_j(1, 1.0) - 0.440_050_585_744_933_5).abs() < 1e-14);
        assert!((bessel_j(1, 10.0) - 0.043_472_746_168_861_4).abs() < 1e-14);
        assert!(bessel_j(0, J0_ZERO).abs() < 1e-14);
    }

    #[test]
    fn the_error_function_agrees_with_the_tables() {
        // Abramowitz and Stegun (1964), table 7.1.
        for (x, value) in [
            (0.1, 0.112_462_916_018_284_9),
            (0.5, 0.520_499_877_813_046_5),
            (1.0, 0.842_700_792_949_714_9),
            (2.0, 0.995_322_265_018_952_7),
        ] {
            assert!((erf(x) - value).abs() < 1e-14, "{x}: {}", erf(x));
        }
    }
}
