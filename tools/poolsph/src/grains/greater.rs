//! The greater of two numbers, one of which may be none.

/// The greater of two; what is no number is greater.
#[inline]
pub(super) fn greater(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}
