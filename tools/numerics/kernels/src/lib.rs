//! The cubic spline kernel in one to three dimensions, and Wendland's of second order.
//!
//! With q = r / h and support 2h (Komen 2019, eq. 3.86; Monaghan and Lattanzio 1985):
//!
//! ```text
//! W(r) = c_D / h^D * { 1 - 3/2 q^2 + 3/4 q^3      0 <= q < 1
//!                    { 1/4 (2 - q)^3              1 <= q < 2
//!                    { 0                          2 <= q
//! ```
//!
//! The constants 2/3, 10/(7 pi) and 1/pi make the integral over the whole space exactly one in
//! one, two and three dimensions. [`CubicSpline::slope`] is dW/dr divided by r (eq. 3.88), so
//! that grad W = slope * dx costs no division and is finite at r = 0.
//!
//! ```
//! let kernel = kernels::CubicSpline::<3>::new(0.5e-3);
//! assert!(kernel.value(0.0) > 0.0 && kernel.value(1.0e-3) == 0.0);
//! ```

pub mod moments;
mod number;
mod wendland;

pub use number::Number;
pub use wendland::Wendland;

/// A kernel of compact support.
pub trait Kernel: Send + Sync {
    /// Radius beyond which it is zero \[m\].
    fn support(&self) -> f64;
    /// W at distance r \[1/m^D\].
    fn value(&self, r: f64) -> f64;
    /// (dW/dr) / r \[1/m^(D+2)\] at one distance or at several; never positive.
    fn slope<N: Number>(&self, r: N) -> N;
}

impl<const D: usize> Kernel for CubicSpline<D> {
    fn support(&self) -> f64 {
        Self::support(self)
    }

    #[inline(always)]
    fn value(&self, r: f64) -> f64 {
        Self::value(self, r)
    }

    #[inline(always)]
    fn slope<N: Number>(&self, r: N) -> N {
        Self::slope(self, r)
    }
}

/// The cubic spline in `D` dimensions with one smoothing length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CubicSpline<const D: usize> {
    smoothing_length: f64,
    inverse_length: f64,
    value_scale: f64,
    slope_scale: f64,
}

/// Value and slope of a kernel at one distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// W \[1/m^D\].
    pub value: f64,
    /// (dW/dr) / r \[1/m^(D+2)\]; never positive.
    pub slope: f64,
}

impl<const D: usize> CubicSpline<D> {
    /// The kernel of smoothing length h \[m\], which must be positive.
    ///
    /// # Panics
    /// When `D` is not 1, 2 or 3.
    #[must_use]
    pub fn new(smoothing_length: f64) -> Self {
        let constant = match D {
            1 => 2.0 / 3.0,
            2 => 10.0 / (7.0 * std::f64::consts::PI),
            3 => std::f64::consts::FRAC_1_PI,
            _ => panic!("the cubic spline is given in 1, 2 and 3 dimensions, not {D}"),
        };
        let inverse_length = 1.0 / smoothing_length;
        let value_scale = constant * (0..D).fold(1.0, |power, _| power * inverse_length);
        let slope_scale = value_scale * inverse_length * inverse_length;
        Self {
            smoothing_length,
            inverse_length,
            value_scale,
            slope_scale,
        }
    }

    /// Smoothing length h \[m\].
    #[must_use]
    pub fn smoothing_length(&self) -> f64 {
        self.smoothing_length
    }

    /// Radius beyond which the kernel is zero, 2h \[m\].
    #[must_use]
    pub fn support(&self) -> f64 {
        2.0 * self.smoothing_length
    }

    /// W at distance r \[1/m^D\] (eq. 3.86).
    ///
    /// Both branches follow from 1/4 (2-q)+^3 - (1-q)+^3, which needs no comparison of branches.
    #[inline]
    #[must_use]
    pub fn value(&self, r: f64) -> f64 {
        let q = r * self.inverse_length;
        let outer = (2.0 - q).max(0.0);
        let inner = (1.0 - q).max(0.0);
        self.value_scale * (0.25 * outer * outer * outer - inner * inner * inner)
    }

    /// (dW/dr) / r \[1/m^(D+2)\] (eq. 3.88), at one distance or at several; -3 c_D / h^(D+2) at r = 0.
    #[inline(always)]
    #[must_use]
    pub fn slope<N: Number>(&self, r: N) -> N {
        let q = r * r.of(self.inverse_length);
        let one = r.of(1.0);
        let outer = (r.of(2.0) - q).greatest(r.of(0.0));
        let near = r.of(2.25) * q - r.of(3.0);
        let far = r.of(-0.75) * outer * outer / q.greatest(one);
        r.of(self.slope_scale) * q.below(one, near, far)
    }

    /// Value and slope together, sharing q.
    #[inline]
    #[must_use]
    pub fn sample(&self, r: f64) -> Sample {
        Sample {
            value: self.value(r),
            slope: self.slope(r),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    /// Five-point Gauss-Legendre, exact for the polynomials of degree 3 + D - 1 of each branch.
    fn radial_integral<const D: usize>(h: f64) -> f64 {
        let kernel = CubicSpline::<D>::new(h);
        let area = [2.0, 2.0 * PI, 4.0 * PI][D - 1];
        let nodes = [0.0, 0.538_469_310_105_683_1, 0.906_179_845_938_664];
        let weights = [
            0.568_888_888_888_888_9,
            0.478_628_670_499_366_47,
            0.236_926_885_056_189_08,
        ];
        let mut sum = 0.0;
        for branch in 0..2 {
            let middle = h * (f64::from(branch) + 0.5);
            for (k, node) in nodes.iter().enumerate() {
                for sign in [-1.0, 1.0] {
                    let r = middle + sign * node * 0.5 * h;
                    let share = if k == 0 { 0.5 } else { 1.0 };
                    let shell = (1..D).fold(1.0, |power, _| power * r);
                    sum += share * weights[k] * 0.5 * h * area * shell * kernel.value(r);
                }
            }
        }
        sum
    }

    #[test]
    fn integral_is_one() {
        for h in [0.5e-3, 1.0, 7.3] {
            assert!((radial_integral::<1>(h) - 1.0).abs() < 1e-12);
            assert!((radial_integral::<2>(h) - 1.0).abs() < 1e-12);
            assert!((radial_integral::<3>(h) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn support_is_compact_and_slope_is_finite_at_zero() {
        let kernel = CubicSpline::<3>::new(2.0);
        assert!(kernel.value(4.0).abs() < 1e-300 && kernel.slope(4.0).abs() < 1e-300);
        assert!(kernel.value(5.0).abs() < 1e-300 && kernel.slope(5.0).abs() < 1e-300);
        assert!((kernel.slope(0.0) + 3.0 / (PI * 32.0)).abs() < 1e-15);
    }

    fn derivative_matches<const D: usize>(h: f64, q: f64) {
        let kernel = CubicSpline::<D>::new(h);
        let r = q * h;
        let step = 1e-5 * h;
        let quotient = (kernel.value(r + step) - kernel.value(r - step)) / (2.0 * step);
        let scale = kernel.value(0.0) / h;
        assert!(
            (quotient - r * kernel.slope(r)).abs() < 1e-8 * scale,
            "D {D}, q {q}"
        );
    }

    proptest! {
        #[test]
        fn slope_is_the_derivative(h in 1e-4..10.0_f64, q in 1e-3..2.1_f64) {
            derivative_matches::<1>(h, q);
            derivative_matches::<2>(h, q);
            derivative_matches::<3>(h, q);
        }

        #[test]
        fn value_is_the_printed_piecewise_polynomial(q in 0.0..2.5_f64) {
            let printed = if q < 1.0 {
                1.0 - 1.5 * q * q + 0.75 * q * q * q
            } else if q < 2.0 {
                2.0 - 3.0 * q + 1.5 * q * q - 0.25 * q * q * q
            } else {
                0.0
            };
            let kernel = CubicSpline::<3>::new(1.0);
            prop_assert!((kernel.value(q) * PI - printed).abs() < 1e-14);
        }
    }
}
