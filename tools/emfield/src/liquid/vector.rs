//! Vectors of two or three components.

/// Scalar product.
#[must_use]
pub fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    (0..D).map(|k| a[k] * b[k]).sum()
}

/// `a + factor b`.
#[must_use]
pub fn along<const D: usize>(a: &[f64; D], factor: f64, b: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|k| a[k] + factor * b[k])
}

/// `a - b`.
#[must_use]
pub fn difference<const D: usize>(a: &[f64; D], b: &[f64; D]) -> [f64; D] {
    along(a, -1.0, b)
}

/// Length.
#[must_use]
pub fn length<const D: usize>(a: &[f64; D]) -> f64 {
    dot(a, a).sqrt()
}

/// The unit vector along `a`; `a` itself where it has no length.
#[must_use]
pub fn direction<const D: usize>(a: &[f64; D]) -> [f64; D] {
    let whole = length(a);
    if whole > 0.0 {
        a.map(|x| x / whole)
    } else {
        *a
    }
}

/// The part of `a` across the unit vector `n`.
#[must_use]
pub fn across<const D: usize>(a: &[f64; D], n: &[f64; D]) -> [f64; D] {
    along(a, -dot(a, n), n)
}

/// The place in space of a place of `D` coordinates.
#[must_use]
pub fn spatial<const D: usize>(a: &[f64; D]) -> [f64; 3] {
    std::array::from_fn(|k| if k < D { a[k] } else { 0.0 })
}
