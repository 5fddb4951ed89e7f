//! The factors of the rows of one slab or wall.

use std::ops::Range;

use crate::{Coefficient, Scalar};

/// Rows of a triangular factor: first the columns beyond the piece, then its own, counted from its
/// first row.
#[derive(Debug, Clone)]
pub(crate) struct Triangle<F> {
    starts: Vec<u32>,
    middles: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<F>,
}

impl<F: Copy> Triangle<F> {
    pub(crate) fn new(rows: usize, entries: usize) -> Self {
        let mut starts = Vec::with_capacity(rows + 1);
        starts.push(0);
        Self {
            starts,
            middles: Vec::with_capacity(rows),
            columns: Vec::with_capacity(entries),
            values: Vec::with_capacity(entries),
        }
    }

    pub(crate) fn push(&mut self, column: u32, value: F) {
        self.columns.push(column);
        self.values.push(value);
    }

    /// What has been pushed since the last row are columns beyond the piece.
    pub(crate) fn middle(&mut self) {
        self.middles.push(self.columns.len() as u32);
    }

    /// Ends a row.
    pub(crate) fn end(&mut self) {
        self.starts.push(self.columns.len() as u32);
    }

    /// Entries of row `k` beyond the piece.
    pub(crate) fn beyond(&self, k: usize) -> Entries<'_, F> {
        let row = self.starts[k] as usize..self.middles[k] as usize;
        self.entries_at(row)
    }

    /// Entries of row `k` within the piece.
    pub(crate) fn own(&self, k: usize) -> Entries<'_, F> {
        let row = self.middles[k] as usize..self.starts[k + 1] as usize;
        self.entries_at(row)
    }

    fn entries_at(&self, row: Range<usize>) -> Entries<'_, F> {
        Entries {
            columns: &self.columns[row.clone()],
            values: &self.values[row],
        }
    }

    fn bytes(&self) -> usize {
        4 * (self.starts.capacity() + self.middles.capacity() + self.columns.capacity())
            + size_of::<F>() * self.values.capacity()
    }
}

/// Entries of a part of a row.
pub(crate) struct Entries<'a, F> {
    pub(crate) columns: &'a [u32],
    pub(crate) values: &'a [F],
}

impl<F: Copy> Entries<'_, F> {
    /// `sum -= values x[columns]`.
    fn subtract<S: Scalar, const C: usize>(&self, sum: &mut [S; C], x: &[[S; C]])
    where
        F: Coefficient<S>,
    {
        for (&j, &v) in self.columns.iter().zip(self.values) {
            let x = &x[j as usize];
            for c in 0..C {
                sum[c] -= v.times(x[c]);
            }
        }
    }
}

/// `L` (ones on the diagonal, which are left out), `U` and the inverse of its diagonal.
#[derive(Debug, Clone)]
pub(crate) struct Piece<F> {
    pub(crate) first: usize,
    pub(crate) lower: Triangle<F>,
    pub(crate) upper: Triangle<F>,
    pub(crate) inverse: Vec<F>,
    pub(crate) weak: usize,
}

impl<F: Copy> Piece<F> {
    pub(crate) fn len(&self) -> usize {
        self.inverse.len()
    }

    pub(crate) fn entries(&self) -> usize {
        self.lower.columns.len() + self.upper.columns.len()
    }

    pub(crate) fn bytes(&self) -> usize {
        self.lower.bytes() + self.upper.bytes() + size_of::<F>() * self.inverse.capacity()
    }

    /// `out = L^-1 (rhs - L' beyond)`.
    pub(crate) fn forward<S: Scalar, const C: usize>(
        &self,
        rhs: &[[S; C]],
        beyond: &[[S; C]],
        out: &mut [[S; C]],
    ) where
        F: Coefficient<S>,
    {
        for (k, rhs) in rhs.iter().enumerate() {
            let mut sum = *rhs;
            self.lower.beyond(k).subtract(&mut sum, beyond);
            self.lower.own(k).subtract(&mut sum, out);
            out[k] = sum;
        }
    }

    /// `out = U^-1 (out - U' beyond)`.
    pub(crate) fn backward<S: Scalar, const C: usize>(&self, beyond: &[[S; C]], out: &mut [[S; C]])
    where
        F: Coefficient<S>,
    {
        for (k, inverse) in self.inverse.iter().enumerate().rev() {
            let mut sum = out[k];
            self.upper.beyond(k).subtract(&mut sum, beyond);
            self.upper.own(k).subtract(&mut sum, out);
            out[k] = sum.map(|s| inverse.times(s));
        }
    }
}
