//! Neumann's solution of melting and freezing (Carslaw and Jaeger 1959, section 11.2).

use std::f64::consts::PI;

use crate::special::erf;

/// The constant l of a front, `behind exp(-l^2)/erf l - beyond k exp(-l^2/a)/(sqrt(a) erfc(l/sqrt a)) = l sqrt(pi)`: Stefan numbers behind and
/// beyond it, and conductivity and diffusivity beyond over those behind.
pub(crate) fn front([behind, beyond]: [f64; 2], k: f64, a: f64) -> f64 {
    let heat = |l: f64| {
        let far = l / a.sqrt();
        let gives = behind * (-l * l).exp() / erf(l);
        let takes = beyond * k * (-far * far).exp() / (a.sqrt() * (1.0 - erf(far)));
        gives - takes - l * PI.sqrt()
    };
    halved(1e-9, 5.0, |l| heat(l) > 0.0)
}

/// Where `above` ceases to hold.
pub(crate) fn halved(mut low: f64, mut high: f64, above: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if above(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_of_equal_halves_has_its_known_constant() {
        // Stefan number 1 without heat beyond: lambda = 0.620063 (Alexiades and Solomon 1993, section 2.1).
        assert!((front([1.0, 0.0], 1.0, 1.0) - 0.620_063).abs() < 1e-6);
        // A medium beyond that conducts nothing takes nothing.
        assert!((front([1.0, 0.7], 1e-12, 1.0) - 0.620_063).abs() < 1e-6);
    }
}
