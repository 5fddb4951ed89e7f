//! A sparse matrix: rows over a shared pattern, the diagonal apart.

use crate::Operator;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// Rows that one task of a product gathers.
const ROWS: usize = 2048;
/// A product of fewer coefficients is not worth waking a thread.
const WORTH: usize = 100_000;

/// Which columns the rows of a matrix hold, in any order; the diagonal is not among them.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Pattern {
    offsets: Vec<usize>,
    columns: Vec<u32>,
}

impl Pattern {
    /// Row `i` holds `columns[offsets[i]..offsets[i + 1]]`.
    ///
    /// # Panics
    /// When offsets do not rise from 0 to the number of columns, or a column is no row, or is the
    /// row itself.
    #[must_use]
    pub fn new(offsets: Vec<usize>, columns: Vec<u32>) -> Self {
        let offsets = if offsets.is_empty() { vec![0] } else { offsets };
        assert!(
            offsets[0] == 0 && offsets.is_sorted() && offsets[offsets.len() - 1] == columns.len(),
            "the offsets must rise from 0 to the number of columns, {}",
            columns.len()
        );
        let pattern = Self { offsets, columns };
        let n = pattern.rows();
        for i in 0..n {
            for &j in &pattern.columns[pattern.row(i)] {
                let j = j as usize;
                assert!(j < n && j != i, "row {i} of {n} holds column {j}");
            }
        }
        pattern
    }

    /// Number of rows.
    #[inline]
    #[must_use]
    pub fn rows(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// Where row `i` stands in the columns and values.
    #[inline]
    #[must_use]
    pub fn row(&self, i: usize) -> Range<usize> {
        self.offsets[i]..self.offsets[i + 1]
    }

    /// Begin of each row, and the end of the last.
    #[inline]
    #[must_use]
    pub fn offsets(&self) -> &[usize] {
        &self.offsets
    }

    /// Columns of all rows.
    #[inline]
    #[must_use]
    pub fn columns(&self) -> &[u32] {
        &self.columns
    }
}

/// A square matrix: `values[k]` belongs to column `pattern.columns()[k]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Sparse {
    pattern: Arc<Pattern>,
    diagonal: Vec<f64>,
    values: Vec<f64>,
}

impl Sparse {
    /// All coefficients zero.
    #[must_use]
    pub fn zeros(pattern: Arc<Pattern>) -> Self {
        Self {
            diagonal: vec![0.0; pattern.rows()],
            values: vec![0.0; pattern.columns().len()],
            pattern,
        }
    }

    /// The columns of the rows.
    #[must_use]
    pub fn pattern(&self) -> &Arc<Pattern> {
        &self.pattern
    }

    /// Diagonal of each row.
    #[inline]
    #[must_use]
    pub fn diagonal(&self) -> &[f64] {
        &self.diagonal
    }

    /// Diagonal of each row.
    pub fn diagonal_mut(&mut self) -> &mut [f64] {
        &mut self.diagonal
    }

    /// Off-diagonal coefficients.
    #[inline]
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Off-diagonal coefficients.
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Diagonal and off-diagonal coefficients at once.
    pub fn parts_mut(&mut self) -> (&mut [f64], &mut [f64]) {
        (&mut self.diagonal, &mut self.values)
    }

    /// Fills all rows, on all threads: `each(i, columns, values)` writes the values of row `i` and
    /// returns its diagonal.
    pub fn fill(&mut self, each: impl Fn(usize, &[u32], &mut [f64]) -> f64 + Sync) {
        let pattern = &self.pattern;
        fill(pattern, 0, &mut self.diagonal, &mut self.values, &each);
    }

    /// `out = A x`.
    pub fn apply(&self, x: &[f64], out: &mut [f64]) {
        let product = |(block, out): (usize, &mut [f64])| {
            for (i, out) in (block * ROWS..).zip(out) {
                let mut sum = self.diagonal[i] * x[i];
                for (&j, v) in self.entries(i) {
                    sum += v * x[j as usize];
                }
                *out = sum;
            }
        };
        if self.values.len() < WORTH {
            out.chunks_mut(ROWS).enumerate().for_each(product);
        } else {
            out.par_chunks_mut(ROWS).enumerate().for_each(product);
        }
    }

    /// Columns and values of row `i`.
    fn entries(&self, i: usize) -> impl Iterator<Item = (&u32, &f64)> {
        let row = self.pattern.row(i);
        self.pattern.columns[row.clone()]
            .iter()
            .zip(&self.values[row])
    }
}

/// Halves the rows until a task is small; the values are cut where the rows are.
fn fill(
    pattern: &Pattern,
    first: usize,
    diagonal: &mut [f64],
    values: &mut [f64],
    each: &(impl Fn(usize, &[u32], &mut [f64]) -> f64 + Sync),
) {
    let begin = pattern.offsets[first];
    if diagonal.len() > ROWS {
        let half = diagonal.len() / 2;
        let (d0, d1) = diagonal.split_at_mut(half);
        let (v0, v1) = values.split_at_mut(pattern.offsets[first + half] - begin);
        rayon::join(
            || fill(pattern, first, d0, v0, each),
            || fill(pattern, first + half, d1, v1, each),
        );
        return;
    }
    for (k, diagonal) in diagonal.iter_mut().enumerate() {
        let row = pattern.row(first + k);
        let values = &mut values[row.start - begin..row.end - begin];
        *diagonal = each(first + k, &pattern.columns[row], values);
    }
}

impl Operator<f64> for Sparse {
    fn len(&self) -> usize {
        self.diagonal.len()
    }

    fn apply(&self, x: &[[f64; 1]], out: &mut [[f64; 1]]) {
        Sparse::apply(self, x.as_flattened(), out.as_flattened_mut());
    }

    fn rounding(&self, x: &[[f64; 1]]) -> f64 {
        // Each of the terms of a row rounds; about as large as the diagonal one, they add up like
        // a random walk.
        let terms = 1 + self.values.len() / self.diagonal.len().max(1);
        let rounding = f64::EPSILON * (terms as f64).sqrt();
        rounding * crate::sums::products(&self.diagonal, x.as_flattened()).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a ring, each with its two neighbours.
    fn ring(n: usize) -> Arc<Pattern> {
        let columns = (0..n).flat_map(|i| [((i + 1) % n) as u32, ((i + n - 1) % n) as u32]);
        Arc::new(Pattern::new(
            (0..=n).map(|i| 2 * i).collect(),
            columns.collect(),
        ))
    }

    #[test]
    fn product_equals_the_sum_of_its_rows() {
        for n in [3, 5000] {
            let mut a = Sparse::zeros(ring(n));
            a.fill(|i, columns, values| {
                for (v, &j) in values.iter_mut().zip(columns) {
                    *v = -f64::from(j) - 1.0;
                }
                i as f64
            });
            let x: Vec<f64> = (0..n).map(|i| (i % 11) as f64).collect();
            let mut y = vec![0.0; n];
            a.apply(&x, &mut y);
            for i in 0..n {
                let (e, w) = ((i + 1) % n, (i + n - 1) % n);
                let exact = i as f64 * x[i] - (e + 1) as f64 * x[e] - (w + 1) as f64 * x[w];
                assert_eq!(y[i], exact);
            }
        }
    }

    #[test]
    fn parts_are_the_same_as_fill() {
        let mut a = Sparse::zeros(ring(7));
        let mut b = a.clone();
        a.fill(|i, _, values| {
            values.fill(-1.0);
            2.0 + i as f64
        });
        let (diagonal, values) = b.parts_mut();
        values.fill(-1.0);
        for (i, d) in diagonal.iter_mut().enumerate() {
            *d = 2.0 + i as f64;
        }
        assert_eq!(a, b);
    }

    #[test]
    #[should_panic(expected = "row 0 of 2 holds column 2")]
    fn a_column_beyond_the_rows_is_refused() {
        let _ = Pattern::new(vec![0, 1, 1], vec![2]);
    }

    #[test]
    #[should_panic(expected = "row 1 of 2 holds column 1")]
    fn the_diagonal_is_no_column() {
        let _ = Pattern::new(vec![0, 1, 2], vec![1, 1]);
    }
}
