//! The weight of a point in a fit.

/// The quartic of (2.4), Matsuzawa (2017), at `q` = distance / radius: 1 - 6 q^2 + 8 q^3 - 3 q^4
/// = (1 - q)^3 (1 + 3 q); 0 from the radius on.
///
/// ```
/// assert_eq!(wls::quartic(0.0), 1.0);
/// assert_eq!(wls::quartic(0.5), 0.3125);
/// assert_eq!(wls::quartic(1.5), 0.0);
/// ```
#[inline]
#[must_use]
pub fn quartic(q: f64) -> f64 {
    let rest = (1.0 - q).max(0.0);
    rest * rest * rest * (1.0 + 3.0 * q)
}
