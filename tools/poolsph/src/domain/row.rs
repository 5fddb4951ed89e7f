//! Rows of places along the axes.

/// Coordinates `anchor + (i + 1/2) d` within `low..high`.
pub(super) fn lattice(anchor: f64, low: f64, high: f64, d: f64) -> Vec<f64> {
    // A billionth of d decides for a point on a face, so that rounding does not.
    let slack = 1e-9;
    let first = ((low - anchor) / d - 0.5 - slack).ceil() as i64;
    let end = ((high - anchor) / d - 0.5 - slack).ceil() as i64;
    (first..end)
        .map(|i| anchor + (i as f64 + 0.5) * d)
        .collect()
}

/// All combinations, x fastest.
pub(super) fn product(axes: &[Vec<f64>; 3]) -> Vec<[f64; 3]> {
    let mut points = Vec::with_capacity(axes.iter().map(Vec::len).product());
    for &z in &axes[2] {
        for &y in &axes[1] {
            points.extend(axes[0].iter().map(|&x| [x, y, z]));
        }
    }
    points
}
