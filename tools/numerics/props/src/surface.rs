//! Tables over two variables: one row of values per node of the first.

use crate::{Error, Table};

/// `z(x, y)` on nodes of x and y, linear in each between them; held beyond the ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    x: Vec<f64>,
    rows: Vec<Table>,
}

impl Surface {
    /// From the nodes `x` and one table against y for each of them.
    ///
    /// # Errors
    /// When there is no row, or as many rows as nodes there are not, or the nodes do not increase, or
    /// the rows do not share their nodes.
    pub fn new(x: Vec<f64>, rows: Vec<Table>) -> Result<Self, Error> {
        if x.is_empty() || x.len() != rows.len() {
            return Err(Error::Length {
                x: x.len(),
                y: rows.len(),
            });
        }
        for (row, value) in x.iter().enumerate() {
            if !value.is_finite() {
                return Err(Error::NotFinite { row, value: *value });
            }
        }
        for (row, pair) in x.windows(2).enumerate() {
            if pair[1] <= pair[0] {
                return Err(Error::NotIncreasing {
                    row: row + 1,
                    value: pair[1],
                    before: pair[0],
                });
            }
        }
        let nodes = rows[0].nodes();
        if let Some(other) = rows.iter().find(|r| r.nodes() != nodes) {
            return Err(Error::Length {
                x: nodes.len(),
                y: other.nodes().len(),
            });
        }
        Ok(Self { x, rows })
    }

    /// Nodes of x.
    #[must_use]
    pub fn nodes(&self) -> &[f64] {
        &self.x
    }

    /// The table at each node of x.
    #[must_use]
    pub fn rows(&self) -> &[Table] {
        &self.rows
    }

    /// The row below `x`, the row above it, and the weight of the latter.
    #[must_use]
    #[inline]
    pub fn between(&self, x: f64) -> (usize, usize, f64) {
        let last = self.x.len() - 1;
        let above = self.x.partition_point(|node| *node <= x);
        if above == 0 {
            return (0, 0, 0.0);
        }
        if above > last {
            return (last, last, 0.0);
        }
        let (low, high) = (self.x[above - 1], self.x[above]);
        (above - 1, above, (x - low) / (high - low))
    }

    /// The value at `(x, y)`; beyond the ends, that at the end.
    #[must_use]
    #[inline]
    pub fn held(&self, x: f64, y: f64) -> f64 {
        self.blend(x, |row| row.held(y))
    }

    /// Mean of [`Surface::held`] over y between `a` and `b`.
    #[must_use]
    pub fn mean(&self, x: f64, a: f64, b: f64) -> f64 {
        self.blend(x, |row| row.mean(a, b))
    }

    /// Slope with y at `(x, y)`, that of the last interval beyond the ends.
    #[must_use]
    #[inline]
    pub fn slope(&self, x: f64, y: f64) -> f64 {
        self.blend(x, |row| row.slope(y.clamp(row.first(), row.last())))
    }

    /// The value at `(x, y)`; beyond the ends of y, along its first or last interval.
    #[must_use]
    #[inline]
    pub fn extended(&self, x: f64, y: f64) -> f64 {
        self.blend(x, |row| extended(row, y))
    }

    /// The y at which [`Surface::extended`] is `z`, every row rising with y.
    #[must_use]
    pub fn inverse(&self, x: f64, z: f64) -> f64 {
        let (low, high, part) = self.between(x);
        let at = |row: &Table, k: usize| row.values()[k];
        let node = |k: usize| {
            let (a, b) = (at(&self.rows[low], k), at(&self.rows[high], k));
            a + part * (b - a)
        };
        let y = self.rows[low].nodes();
        let (mut first, mut last) = (0, y.len() - 1);
        while last - first > 1 {
            let middle = usize::midpoint(first, last);
            if node(middle) <= z {
                first = middle;
            } else {
                last = middle;
            }
        }
        let (a, b) = (node(first), node(last));
        y[first] + (z - a) / (b - a) * (y[last] - y[first])
    }

    #[inline]
    fn blend(&self, x: f64, value: impl Fn(&Table) -> f64) -> f64 {
        let (low, high, part) = self.between(x);
        let a = value(&self.rows[low]);
        if part == 0.0 {
            return a;
        }
        a + part * (value(&self.rows[high]) - a)
    }
}

fn extended(row: &Table, y: f64) -> f64 {
    let k = row.interval(y);
    let (nodes, values) = (row.nodes(), row.values());
    let part = (y - nodes[k]) / (nodes[k + 1] - nodes[k]);
    values[k] + part * (values[k + 1] - values[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surface() -> Surface {
        let y = vec![300.0, 1000.0, 4000.0];
        let row = |a: f64, b: f64| {
            let values = y.iter().map(|y| a + b * y).collect();
            Table::new(y.clone(), values).unwrap()
        };
        // z = 1 + x + (2 + 4 x) y on three nodes of x.
        let x = vec![0.0, 0.3, 1.0];
        let rows = x.iter().map(|x| row(1.0 + x, 2.0 + 4.0 * x)).collect();
        Surface::new(x, rows).unwrap()
    }

    #[test]
    fn what_is_linear_in_each_is_reproduced() {
        let s = surface();
        for (x, y) in [(0.0, 300.0), (0.2, 777.0), (0.9, 3999.0), (1.0, 4000.0)] {
            let want = 1.0 + x + (2.0 + 4.0 * x) * y;
            assert!((s.held(x, y) - want).abs() < 1e-9, "{x} {y}");
            assert!((s.slope(x, y) - (2.0 + 4.0 * x)).abs() < 1e-12);
        }
    }

    #[test]
    fn ends_are_held_or_gone_along() {
        let s = surface();
        assert!((s.held(1.5, 5000.0) - s.held(1.0, 4000.0)).abs() < 1e-12);
        assert!((s.held(-1.0, 10.0) - s.held(0.0, 300.0)).abs() < 1e-12);
        assert!((s.extended(0.5, 5000.0) - (1.5 + 4.0 * 5000.0)).abs() < 1e-9);
        assert!((s.extended(0.5, 0.0) - 1.5).abs() < 1e-9);
        assert!((s.slope(0.5, 9000.0) - 4.0).abs() < 1e-12);
    }

    #[test]
    fn the_inverse_undoes_the_value_also_beyond_the_ends() {
        let s = surface();
        for x in [-0.5, 0.0, 0.11, 0.3, 0.77, 1.0] {
            for y in [-50.0, 300.0, 301.0, 1000.0, 2500.0, 4000.0, 9000.0] {
                let found = s.inverse(x, s.extended(x, y));
                assert!(
                    (found - y).abs() < 1e-9 * (1.0 + y.abs()),
                    "{x} {y} {found}"
                );
            }
        }
    }

    #[test]
    fn rows_that_do_not_fit_are_refused() {
        let table = |y: Vec<f64>| Table::new(y.clone(), y).unwrap();
        let good = table(vec![0.0, 1.0]);
        assert!(Surface::new(vec![0.0, 1.0], vec![good.clone()]).is_err());
        assert!(Surface::new(vec![1.0, 0.0], vec![good.clone(); 2]).is_err());
        assert!(Surface::new(vec![], vec![]).is_err());
        let other = table(vec![0.0, 2.0]);
        assert!(Surface::new(vec![0.0, 1.0], vec![good, other]).is_err());
    }
}
