//! A rectangle at one temperature that cools by convection at x = L and y = H, the sides x = 0 and
//! y = 0 insulated: Rong and Kisu (2010), eqs 8 to 10, after Ozisik (1993), p. 75, with alpha =
//! k / (rho c), which is not said in print.
//!
//! The double series is the product of two: `T - Ts = (T0 - Ts) X(x, t) Y(y, t)`.

use std::f64::consts::PI;

/// A slab from 0 (insulated) to `length` (cooled); its temperature falls from 1 to 0.
#[derive(Debug, Clone)]
pub struct Slab {
    length: f64,
    /// Heat transfer coefficient over conductivity \[1/m\].
    ratio: f64,
    diffusivity: f64,
    roots: Vec<f64>,
}

impl Slab {
    /// The slab of `length` \[m\] with `ratio` = Psi / k \[1/m\] and `diffusivity` \[m2/s\], good for
    /// times from `earliest` \[s\].
    #[must_use]
    pub fn new(length: f64, ratio: f64, diffusivity: f64, earliest: f64) -> Self {
        let mut roots = Vec::new();
        // Terms below exp(-45) are lost in rounding.
        let last = (45.0 / (diffusivity * earliest)).sqrt() * length;
        let biot = ratio * length;
        for m in 0..100_000 {
            let from = PI * f64::from(m);
            if from > last && m > 1 {
                break;
            }
            roots.push(root(biot, from) / length);
        }
        Self {
            length,
            ratio,
            diffusivity,
            roots,
        }
    }

    /// The part of the first temperature that is left at `x` \[m\] and `time` \[s\].
    #[must_use]
    pub fn value(&self, x: f64, time: f64) -> f64 {
        let square = self.ratio * self.ratio;
        let term = |beta: &f64| {
            let decay = (-self.diffusivity * beta * beta * time).exp();
            let norm = self.length * (beta * beta + square) + self.ratio;
            // Psi/k over cos(beta L) is eq. 8; it is (beta^2 + Psi^2/k^2) sin(beta L) / beta, which
            // does not divide a small number by a small one.
            let height = (beta * beta + square) * (beta * self.length).sin() / (beta * norm);
            2.0 * height * (beta * x).cos() * decay
        };
        self.roots.iter().map(term).sum()
    }
}

/// The root of `u tan u = biot` (eq. 10) between `from` and `from + pi/2`, by bisection.
fn root(biot: f64, from: f64) -> f64 {
    let (mut low, mut high) = (from, from + 0.5 * PI);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        let rest = middle - from;
        // u sin u - biot cos u, whose sign does not depend on the period.
        if middle * rest.sin() > biot * rest.cos() {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_roots_are_those_of_the_tables() {
        // Carslaw and Jaeger (1959), appendix IV, table I: C = 1.
        for (m, wanted) in [(0.0, 0.8603), (1.0, 3.4256), (2.0, 6.4373)] {
            assert!((root(1.0, m * PI) - wanted).abs() < 5e-5);
        }
    }

    #[test]
    fn it_starts_at_one_and_keeps_its_equations() {
        let slab = Slab::new(0.1, 10.0, 1e-4, 0.02);
        assert!((slab.value(0.03, 0.02) - 1.0).abs() < 1e-12);
        let (t, h) = (4.0, 1e-5);
        // -dT/dx = (Psi/k) T at x = L, nothing at x = 0, and T_t = alpha T_xx inside.
        let end = [0.0, 1.0, 2.0].map(|i| slab.value(0.1 - i * h, t));
        let slope = (3.0 * end[0] - 4.0 * end[1] + end[2]) / (2.0 * h);
        assert!((slope + 10.0 * end[0]).abs() < 1e-7, "{slope}");
        let x = 0.06;
        let rate = (slab.value(x, t + 1e-3) - slab.value(x, t - 1e-3)) / 2e-3;
        let h = 1e-3;
        let bend = slab.value(x + h, t) - 2.0 * slab.value(x, t) + slab.value(x - h, t);
        assert!((rate - 1e-4 * bend / (h * h)).abs() < 1e-6);
    }

    #[test]
    fn a_good_conductor_cools_as_a_lump() {
        // Biot 1e-4: exp(-Psi t / (rho c L)), to the order of Biot.
        let slab = Slab::new(0.1, 1e-3, 1e-4, 1.0);
        let wanted = (-1e-4_f64 * 1e-3 / 0.1 * 5e4).exp();
        assert!((slab.value(0.05, 5e4) - wanted).abs() < 1e-4);
        // Biot 1e6: the face is at the ambient at once.
        let slab = Slab::new(0.1, 1e7, 1e-4, 1.0);
        assert!(slab.value(0.1, 1.0).abs() < 1e-5);
    }
}
