//! Wendland's kernel of second order in two and three dimensions, with support 2h.
//!
//! ```text
//! W(r) = c_D / h^D (1 - q/2)^4 (2 q + 1),   q = r/h < 2,   c = 7/(4 pi), 21/(16 pi)
//! ```
//!
//! (Wendland 1995; Dehnen and Aly 2012.) Its transform is positive, so that particles do not pair however many there
//! are in its support, which the cubic spline lets happen beyond h = 1.3 d or so.

use crate::{Kernel, Number};

/// Wendland's kernel of second order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wendland<const D: usize> {
    smoothing_length: f64,
    inverse_length: f64,
    value_scale: f64,
    slope_scale: f64,
}

impl<const D: usize> Wendland<D> {
    /// The kernel of smoothing length h \[m\], which must be positive.
    ///
    /// # Panics
    /// When `D` is neither 2 nor 3.
    #[must_use]
    pub fn new(smoothing_length: f64) -> Self {
        let constant = match D {
            2 => 1.75 * std::f64::consts::FRAC_1_PI,
            3 => 1.3125 * std::f64::consts::FRAC_1_PI,
            _ => panic!("this kernel of Wendland's is given in 2 and 3 dimensions, not {D}"),
        };
        let inverse_length = 1.0 / smoothing_length;
        let value_scale = constant * (0..D).fold(1.0, |power, _| power * inverse_length);
        Self {
            smoothing_length,
            inverse_length,
            value_scale,
            slope_scale: -5.0 * value_scale * inverse_length * inverse_length,
        }
    }
}

impl<const D: usize> Kernel for Wendland<D> {
    fn support(&self) -> f64 {
        2.0 * self.smoothing_length
    }

    #[inline(always)]
    fn value(&self, r: f64) -> f64 {
        let q = r * self.inverse_length;
        let rest = (1.0 - 0.5 * q).max(0.0);
        let square = rest * rest;
        self.value_scale * square * square * (2.0 * q + 1.0)
    }

    #[inline(always)]
    fn slope<N: Number>(&self, r: N) -> N {
        let rest = (r.of(1.0) - r.of(0.5) * r * r.of(self.inverse_length)).greatest(r.of(0.0));
        r.of(self.slope_scale) * rest * rest * rest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integral<const D: usize>(kernel: &Wendland<D>) -> f64 {
        let n = 20_000;
        let step = kernel.support() / f64::from(n);
        let area = [0.0, 2.0, 4.0][D - 1] * std::f64::consts::PI;
        let ring = |i: i32| {
            let r = (f64::from(i) + 0.5) * step;
            area * r.powi(D as i32 - 1) * kernel.value(r) * step
        };
        (0..n).map(ring).sum()
    }

    #[test]
    fn the_whole_is_one() {
        assert!((integral(&Wendland::<2>::new(0.7)) - 1.0).abs() < 1e-7);
        assert!((integral(&Wendland::<3>::new(0.7)) - 1.0).abs() < 1e-7);
    }

    #[test]
    fn the_slope_is_that_of_the_value() {
        let kernel = Wendland::<3>::new(0.7);
        for r in [0.1, 0.6, 1.0, 1.3] {
            let slope = (kernel.value(r + 1e-6) - kernel.value(r - 1e-6)) / 2e-6;
            assert!((slope / r - kernel.slope(r)).abs() < 1e-6);
        }
        assert!(kernel.slope(1.5).abs() <= 0.0);
    }
}
