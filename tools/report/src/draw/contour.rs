//! Contour lines of a grid by marching squares.

/// Values on a rectangular grid, row-major with the second axis fastest.
#[derive(Debug, Clone)]
pub(crate) struct Grid<'a> {
    /// First axis \[n0\], ascending.
    pub(crate) first: &'a [f64],
    /// Second axis \[n1\], ascending.
    pub(crate) second: &'a [f64],
    /// Values \[n0 * n1\].
    pub(crate) values: &'a [f64],
}

impl Grid<'_> {
    /// Value at indices `i` and `k`.
    pub(crate) fn at(&self, i: usize, k: usize) -> f64 {
        self.values[i * self.second.len() + k]
    }

    /// Value at `a` on the first axis and `b` on the second, linear in each cell;
    /// `None` outside the grid.
    pub(crate) fn sample(&self, a: f64, b: f64) -> Option<f64> {
        let (i, s) = place(self.first, a)?;
        let (k, t) = place(self.second, b)?;
        let low = self.at(i, k) * (1.0 - t) + self.at(i, k + 1) * t;
        let high = self.at(i + 1, k) * (1.0 - t) + self.at(i + 1, k + 1) * t;
        Some(low * (1.0 - s) + high * s)
    }

    /// Line segments, in axis coordinates, along which the value is `level`.
    pub(crate) fn contour(&self, level: f64) -> Vec<[[f64; 2]; 2]> {
        let mut segments = Vec::new();
        for i in 0..self.first.len().saturating_sub(1) {
            for k in 0..self.second.len().saturating_sub(1) {
                self.cell(i, k, level, &mut segments);
            }
        }
        segments
    }

    fn cell(&self, i: usize, k: usize, level: f64, segments: &mut Vec<[[f64; 2]; 2]>) {
        let corners = [(i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1)];
        let value = corners.map(|(a, b)| self.at(a, b) - level);
        if value.iter().any(|v| !v.is_finite()) {
            return;
        }
        let mut cuts = Vec::with_capacity(4);
        for edge in 0..4 {
            let (p, q) = (value[edge], value[(edge + 1) % 4]);
            if (p < 0.0) != (q < 0.0) {
                let (a, b) = (corners[edge], corners[(edge + 1) % 4]);
                let t = p / (p - q);
                let x = self.first[a.0] + (self.first[b.0] - self.first[a.0]) * t;
                let y = self.second[a.1] + (self.second[b.1] - self.second[a.1]) * t;
                cuts.push([x, y]);
            }
        }
        for pair in cuts.chunks_exact(2) {
            segments.push([pair[0], pair[1]]);
        }
    }
}

/// Cell of an ascending axis that holds `x`, and the place in it (0..1).
fn place(axis: &[f64], x: f64) -> Option<(usize, f64)> {
    let last = axis.len().checked_sub(2)?;
    if !(x >= axis[0] && x <= axis[last + 1]) {
        return None;
    }
    let i = axis
        .partition_point(|a| *a <= x)
        .saturating_sub(1)
        .min(last);
    let width = axis[i + 1] - axis[i];
    Some((
        i,
        if width > 0.0 {
            (x - axis[i]) / width
        } else {
            0.0
        },
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_is_sampled_and_cut_exactly() {
        let first = [0.0, 1.0, 3.0];
        let second = [-1.0, 0.0, 2.0, 3.0];
        let values: Vec<f64> = first
            .iter()
            .flat_map(|a| second.iter().map(move |b| 2.0 * a - b))
            .collect();
        let grid = Grid {
            first: &first,
            second: &second,
            values: &values,
        };
        assert!((grid.sample(1.7, 0.3).unwrap() - 3.1).abs() < 1e-12);
        assert!(grid.sample(3.1, 0.0).is_none());
        let cut = grid.contour(1.5);
        assert!(!cut.is_empty());
        for point in cut.iter().flatten() {
            assert!((2.0 * point[0] - point[1] - 1.5).abs() < 1e-12);
        }
    }
}
