//! Piecewise linear interpolation.

use crate::Error;

/// Buckets per node of the look-up.
const BUCKETS: usize = 4;

/// Distance of two places that are one, as part of either.
const SAME: f64 = 1e-9;

/// `y(x)`, piecewise linear between strictly increasing nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    x: Vec<f64>,
    y: Vec<f64>,
    /// For each bucket of equal width, and for the end, the last interval that begins at or before it.
    start: Vec<usize>,
    per_x: f64,
}

/// A node beyond the ends of a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outside {
    /// What was asked for.
    pub x: f64,
    /// First node.
    pub first: f64,
    /// Last node.
    pub last: f64,
}

impl Table {
    /// Checks and keeps the nodes.
    ///
    /// # Errors
    /// When columns differ in length, have fewer than two rows, are not finite, or `x` does not
    /// increase.
    pub fn new(x: Vec<f64>, y: Vec<f64>) -> Result<Self, Error> {
        if x.len() < 2 || x.len() != y.len() {
            return Err(Error::Length {
                x: x.len(),
                y: y.len(),
            });
        }
        for (row, value) in x.iter().enumerate().chain(y.iter().enumerate()) {
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
        let buckets = BUCKETS * x.len();
        let (first, last) = (x[0], x[x.len() - 1]);
        let per_x = buckets as f64 / (last - first);
        let start = (0..=buckets)
            .map(|b| {
                let begin = first + b as f64 / per_x;
                x.partition_point(|node| *node <= begin)
                    .clamp(1, x.len() - 1)
                    - 1
            })
            .collect();
        Ok(Self { x, y, start, per_x })
    }

    /// Nodes.
    #[must_use]
    pub fn nodes(&self) -> &[f64] {
        &self.x
    }

    /// Values at the nodes.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.y
    }

    /// First node.
    #[must_use]
    pub fn first(&self) -> f64 {
        self.x[0]
    }

    /// Last node.
    #[must_use]
    pub fn last(&self) -> f64 {
        self.x[self.x.len() - 1]
    }

    /// The interval `[x_k, x_k+1]` that holds `x`; the first or last one beyond the ends.
    #[must_use]
    #[inline]
    pub fn interval(&self, x: f64) -> usize {
        // A negative or NaN offset becomes bucket 0.
        let bucket = (((x - self.x[0]) * self.per_x) as usize).min(self.start.len() - 2);
        let (first, last) = (self.start[bucket], self.start[bucket + 1]);
        // Nodes that crowd in one bucket are halved; rounding may be off by one.
        let mut k = first + self.x[first + 1..=last].partition_point(|node| *node <= x);
        let last = self.x.len() - 2;
        while k < last && self.x[k + 1] <= x {
            k += 1;
        }
        while k > 0 && self.x[k] > x {
            k -= 1;
        }
        k
    }

    /// The value at `x`.
    ///
    /// # Errors
    /// When `x` is beyond the ends or not a number.
    pub fn at(&self, x: f64) -> Result<f64, Outside> {
        if x >= self.first() && x <= self.last() {
            Ok(self.held(x))
        } else {
            Err(Outside {
                x,
                first: self.first(),
                last: self.last(),
            })
        }
    }

    /// The value at `x`; beyond the ends, the value at the end.
    #[must_use]
    #[inline]
    pub fn held(&self, x: f64) -> f64 {
        if x <= self.x[0] {
            return self.y[0];
        }
        if x >= self.last() {
            return self.y[self.y.len() - 1];
        }
        let k = self.interval(x);
        let part = (x - self.x[k]) / (self.x[k + 1] - self.x[k]);
        self.y[k] + part * (self.y[k + 1] - self.y[k])
    }

    /// Mean of [`Self::held`] between two places, exact; the value where they are one.
    #[must_use]
    pub fn mean(&self, a: f64, b: f64) -> f64 {
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        if high - low <= SAME * high.abs() {
            return self.held(0.5 * (low + high));
        }
        let mut from = (low, self.held(low));
        let mut sum = 0.0;
        let first = self.x.partition_point(|node| *node <= low);
        for (x, y) in self.x.iter().zip(&self.y).skip(first) {
            if *x >= high {
                break;
            }
            sum += 0.5 * (from.1 + y) * (x - from.0);
            from = (*x, *y);
        }
        sum += 0.5 * (from.1 + self.held(high)) * (high - from.0);
        sum / (high - low)
    }

    /// The slope at `x`, zero beyond the ends.
    #[must_use]
    pub fn slope(&self, x: f64) -> f64 {
        if x < self.first() || x > self.last() {
            return 0.0;
        }
        let k = self.interval(x);
        (self.y[k + 1] - self.y[k]) / (self.x[k + 1] - self.x[k])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_mean_is_that_of_the_integral() {
        let t = Table::new(vec![1.0, 2.0, 2.001, 4.0], vec![1.0, 1.0, 5.0, 9.0]).unwrap();
        // By hand: 0.5 of 1, a ramp of 0.001 up to 5, then 1 of a line of slope 4/1.999.
        let line = 5.0 + 0.5 * 4.0 / 1.999;
        let want = (0.5 + 0.003 + line) / 1.501;
        for (a, b) in [(1.5, 3.001), (3.001, 1.5)] {
            assert!((t.mean(a, b) - want).abs() < 1e-14);
        }
        // Held beyond the ends, and the value where there is nothing between.
        assert!((t.mean(-1.0, 1.0) - 1.0).abs() < 1e-15);
        assert!((t.mean(3.0, 6.0) - (0.5 * (t.held(3.0) + 9.0) + 18.0) / 3.0).abs() < 1e-14);
        assert!((t.mean(3.0, 3.0) - t.held(3.0)).abs() < 1e-15);
        assert!((t.mean(3.0, 3.0 + 1e-6) - t.held(3.0)).abs() < 1e-5);
    }

    #[test]
    fn a_straight_line_is_exact_and_ends_are_held_or_refused() {
        let t = Table::new(vec![0.0, 1.0, 5.0, 5.5], vec![1.0, 3.0, 11.0, 12.0]).unwrap();
        for x in [0.0, 0.3, 1.0, 4.9, 5.0, 5.2, 5.5] {
            assert!((t.at(x).unwrap() - (1.0 + 2.0 * x)).abs() < 1e-14);
            assert!((t.slope(x) - 2.0).abs() < 1e-14);
        }
        assert!((t.held(-1.0) - 1.0).abs() < 1e-15);
        assert!((t.held(9.0) - 12.0).abs() < 1e-15);
        assert_eq!(
            t.at(9.0),
            Err(Outside {
                x: 9.0,
                first: 0.0,
                last: 5.5
            })
        );
        assert!(t.at(f64::NAN).is_err());
    }

    #[test]
    fn faulty_columns_are_named() {
        assert_eq!(
            Table::new(vec![1.0], vec![1.0]),
            Err(Error::Length { x: 1, y: 1 })
        );
        let stuck = Table::new(vec![1.0, 2.0, 2.0], vec![0.0; 3]);
        assert_eq!(
            stuck,
            Err(Error::NotIncreasing {
                row: 2,
                value: 2.0,
                before: 2.0
            })
        );
        let hole = Table::new(vec![1.0, 2.0], vec![0.0, f64::INFINITY]);
        assert_eq!(
            hole,
            Err(Error::NotFinite {
                row: 1,
                value: f64::INFINITY
            })
        );
    }

    proptest! {
        #[test]
        fn the_interval_is_the_one_a_plain_search_finds(
            steps in prop::collection::vec(1e-3..1e3_f64, 2..60),
            part in -0.1..1.1_f64,
        ) {
            let mut x = vec![0.0];
            for s in &steps {
                x.push(x[x.len() - 1] + s);
            }
            let t = Table::new(x.clone(), vec![0.0; x.len()]).unwrap();
            let at = part * x[x.len() - 1];
            let naive = (0..x.len() - 1).rev().find(|k| x[*k] <= at).unwrap_or(0);
            prop_assert_eq!(t.interval(at), naive);
        }
    }
}
