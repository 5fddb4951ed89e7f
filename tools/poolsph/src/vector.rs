//! Vectors in space.

/// a - b.
#[inline(always)]
#[must_use]
pub fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// a . b.
#[inline(always)]
#[must_use]
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a . a.
#[inline(always)]
#[must_use]
pub fn squared(a: [f64; 3]) -> f64 {
    dot(a, a)
}

/// a + s b.
#[inline(always)]
#[must_use]
pub fn plus(a: [f64; 3], s: f64, b: [f64; 3]) -> [f64; 3] {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}
