//! Terms of a quadratic in the plane and in space.

/// Number of an axis pair among the terms of a quadratic.
#[must_use]
pub const fn second(dimensions: usize, k: usize, l: usize) -> usize {
    let (k, l) = if k < l { (k, l) } else { (l, k) };
    dimensions + k * dimensions - (k * (k + 1)) / 2 + l
}

/// Terms of a quadratic at an offset: x, y, (z), x^2/2, xy, ...
#[inline]
#[must_use]
pub fn terms<const T: usize>(offset: [f64; 3]) -> [f64; T] {
    let dimensions = if T == 5 { 2 } else { 3 };
    let mut all = [0.0; T];
    for k in 0..dimensions {
        all[k] = offset[k];
        for l in k..dimensions {
            let half = if k == l { 0.5 } else { 1.0 };
            all[second(dimensions, k, l)] = half * offset[k] * offset[l];
        }
    }
    all
}

/// From weights in cells to weights in metres.
pub(super) fn scale<const T: usize>(cell: [f64; 3]) -> [f64; T] {
    let unit: [f64; T] = terms(cell.map(|c| 1.0 / c));
    // x^2/2 counts d^2 x, not its half.
    std::array::from_fn(|m| {
        let dimensions = if T == 5 { 2 } else { 3 };
        let square = (0..dimensions).any(|k| m == second(dimensions, k, k));
        if square { 2.0 * unit[m] } else { unit[m] }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_are_numbered_one_after_another() {
        assert_eq!(
            [second(2, 0, 0), second(2, 1, 0), second(2, 1, 1)],
            [2, 3, 4]
        );
        let all = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
        assert_eq!(all.map(|(k, l)| second(3, k, l)), [3, 4, 5, 6, 7, 8]);
    }
}
