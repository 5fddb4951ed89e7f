//! Real and complex numbers, and what may stand in a matrix that multiplies them.

use num_complex::Complex;
use std::fmt::Debug;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// A number that vectors hold: `f64` or `Complex<f64>`.
pub trait Scalar:
    Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + Sum
    + Coefficient<Self>
    + faer::traits::ComplexField
{
    /// The same kind of number in single precision, for factors.
    type Single: Coefficient<Self>;
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;

    /// A real number as this kind.
    fn real(value: f64) -> Self;
    /// Real part.
    fn real_part(self) -> f64;
    /// Complex conjugate.
    #[must_use]
    fn conjugate(self) -> Self;
    /// Times a real number.
    #[must_use]
    fn times_real(self, factor: f64) -> Self;
    /// Square of the modulus.
    fn square(self) -> f64;
    /// Modulus.
    fn modulus(self) -> f64;
    /// Neither infinite nor NaN.
    fn finite(self) -> bool;
}

impl Scalar for f64 {
    type Single = f32;
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;

    fn real(value: f64) -> Self {
        value
    }
    fn real_part(self) -> f64 {
        self
    }
    fn conjugate(self) -> Self {
        self
    }
    fn times_real(self, factor: f64) -> Self {
        self * factor
    }
    fn square(self) -> f64 {
        self * self
    }
    fn modulus(self) -> f64 {
        self.abs()
    }
    fn finite(self) -> bool {
        self.is_finite()
    }
}

impl Scalar for Complex<f64> {
    type Single = Complex<f32>;
    const ZERO: Self = Complex::new(0.0, 0.0);
    const ONE: Self = Complex::new(1.0, 0.0);

    fn real(value: f64) -> Self {
        Complex::new(value, 0.0)
    }
    fn real_part(self) -> f64 {
        self.re
    }
    fn conjugate(self) -> Self {
        self.conj()
    }
    fn times_real(self, factor: f64) -> Self {
        Complex::new(self.re * factor, self.im * factor)
    }
    fn square(self) -> f64 {
        self.re * self.re + self.im * self.im
    }
    fn modulus(self) -> f64 {
        self.re.hypot(self.im)
    }
    fn finite(self) -> bool {
        self.re.is_finite() && self.im.is_finite()
    }
}

/// A coefficient of a matrix or factor that multiplies numbers of kind `S`.
pub trait Coefficient<S>: Copy + Debug + Default + PartialEq + Send + Sync + 'static {
    /// May it hold all that a number of kind `S` holds?
    const IMAGINARY: bool;

    /// `self x`.
    fn times(self, x: S) -> S;
    /// Rounded to this kind; what does not fit in it (an imaginary part) is left out.
    fn narrowed(value: S) -> Self;
    /// As a number of kind `S`.
    fn widened(self) -> S;
}

impl Coefficient<f64> for f64 {
    const IMAGINARY: bool = true;

    fn times(self, x: f64) -> f64 {
        self * x
    }
    fn narrowed(value: f64) -> Self {
        value
    }
    fn widened(self) -> f64 {
        self
    }
}

impl Coefficient<f64> for f32 {
    const IMAGINARY: bool = true;

    fn times(self, x: f64) -> f64 {
        f64::from(self) * x
    }
    fn narrowed(value: f64) -> Self {
        value as f32
    }
    fn widened(self) -> f64 {
        f64::from(self)
    }
}

impl Coefficient<Complex<f64>> for f64 {
    const IMAGINARY: bool = false;

    fn times(self, x: Complex<f64>) -> Complex<f64> {
        x.times_real(self)
    }
    fn narrowed(value: Complex<f64>) -> Self {
        value.re
    }
    fn widened(self) -> Complex<f64> {
        Complex::new(self, 0.0)
    }
}

impl Coefficient<Complex<f64>> for f32 {
    const IMAGINARY: bool = false;

    fn times(self, x: Complex<f64>) -> Complex<f64> {
        x.times_real(f64::from(self))
    }
    fn narrowed(value: Complex<f64>) -> Self {
        value.re as f32
    }
    fn widened(self) -> Complex<f64> {
        Complex::new(f64::from(self), 0.0)
    }
}

impl Coefficient<Complex<f64>> for Complex<f64> {
    const IMAGINARY: bool = true;

    fn times(self, x: Complex<f64>) -> Complex<f64> {
        Complex::new(
            self.re * x.re - self.im * x.im,
            self.re * x.im + self.im * x.re,
        )
    }
    fn narrowed(value: Complex<f64>) -> Self {
        value
    }
    fn widened(self) -> Complex<f64> {
        self
    }
}

impl Coefficient<Complex<f64>> for Complex<f32> {
    const IMAGINARY: bool = true;

    fn times(self, x: Complex<f64>) -> Complex<f64> {
        self.widened().times(x)
    }
    fn narrowed(value: Complex<f64>) -> Self {
        Complex::new(value.re as f32, value.im as f32)
    }
    fn widened(self) -> Complex<f64> {
        Complex::new(f64::from(self.re), f64::from(self.im))
    }
}
