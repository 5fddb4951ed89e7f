//! The five-point equation of every cell, as columns.

use krylov::{Error, Operator};
use rayon::prelude::*;

/// Cells below which a loop stays on one thread.
const PARALLEL_FROM: usize = 4096;

/// Coefficients of `AP x_P = AE x_E + AW x_W + AN x_N + AS x_S + SU`; cell `(i, j)` stands at
/// `j * columns + i`. Neighbours beyond the grid must have a zero coefficient.
#[derive(Debug, Clone, PartialEq)]
pub struct FivePoint {
    /// Cells along a row (radial).
    pub columns: usize,
    /// Rows (axial).
    pub rows: usize,
    /// AP.
    pub centre: Vec<f64>,
    /// AE, toward `i + 1`.
    pub east: Vec<f64>,
    /// AW, toward `i - 1`.
    pub west: Vec<f64>,
    /// AN, toward `j + 1`.
    pub north: Vec<f64>,
    /// AS, toward `j - 1`.
    pub south: Vec<f64>,
    /// SU.
    pub source: Vec<f64>,
}

/// The equation of one cell.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Coefficients {
    /// AP.
    pub centre: f64,
    /// AE.
    pub east: f64,
    /// AW.
    pub west: f64,
    /// AN.
    pub north: f64,
    /// AS.
    pub south: f64,
    /// SU.
    pub source: f64,
}

impl Coefficients {
    /// The equation of a cell that keeps `value`.
    #[must_use]
    pub fn fixed(value: f64) -> Self {
        Self {
            centre: 1.0,
            source: value,
            ..Self::default()
        }
    }
}

/// The coefficients of one row.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row<'a> {
    pub(crate) centre: &'a [f64],
    pub(crate) east: &'a [f64],
    pub(crate) west: &'a [f64],
    pub(crate) north: &'a [f64],
    pub(crate) south: &'a [f64],
}

/// Values of one row and of the rows beside it; beyond the grid the row itself stands in, its
/// coefficient being zero.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Near<'a> {
    pub(crate) here: &'a [f64],
    pub(crate) above: &'a [f64],
    pub(crate) below: &'a [f64],
}

impl FivePoint {
    /// All coefficients zero.
    #[must_use]
    pub fn new(columns: usize, rows: usize) -> Self {
        let zeros = vec![0.0; columns * rows];
        Self {
            columns,
            rows,
            centre: zeros.clone(),
            east: zeros.clone(),
            west: zeros.clone(),
            north: zeros.clone(),
            south: zeros.clone(),
            source: zeros,
        }
    }

    /// Number of cells.
    #[must_use]
    pub fn len(&self) -> usize {
        self.centre.len()
    }

    /// Whether there is no cell.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.centre.is_empty()
    }

    /// Sets the equation of every cell `(i, j)`.
    pub fn fill<F>(&mut self, equation: F)
    where
        F: Fn(usize, usize) -> Coefficients + Sync + Send,
    {
        let (columns, parallel) = (self.columns, self.len() >= PARALLEL_FROM);
        let rows = self.rows_per_task();
        let chunks = (
            self.centre.par_chunks_mut(columns),
            self.east.par_chunks_mut(columns),
            self.west.par_chunks_mut(columns),
            self.north.par_chunks_mut(columns),
            self.south.par_chunks_mut(columns),
            self.source.par_chunks_mut(columns),
        );
        let least = if parallel { rows } else { self.rows };
        chunks
            .into_par_iter()
            .with_min_len(least.max(1))
            .enumerate()
            .for_each(|(j, (centre, east, west, north, south, source))| {
                for i in 0..columns {
                    let c = equation(i, j);
                    centre[i] = c.centre;
                    east[i] = c.east;
                    west[i] = c.west;
                    north[i] = c.north;
                    south[i] = c.south;
                    source[i] = c.source;
                }
            });
    }

    pub(crate) fn row(&self, j: usize) -> Row<'_> {
        let range = j * self.columns..(j + 1) * self.columns;
        Row {
            centre: &self.centre[range.clone()],
            east: &self.east[range.clone()],
            west: &self.west[range.clone()],
            north: &self.north[range.clone()],
            south: &self.south[range],
        }
    }

    pub(crate) fn near<'a>(&self, x: &'a [f64], j: usize) -> Near<'a> {
        let n = self.columns;
        let take = |j: usize| &x[j * n..(j + 1) * n];
        Near {
            here: take(j),
            above: take((j + 1).min(self.rows - 1)),
            below: take(j.saturating_sub(1)),
        }
    }

    /// Rows that one task should take at least.
    pub(crate) fn rows_per_task(&self) -> usize {
        PARALLEL_FROM.div_ceil(2 * self.columns.max(1)).max(1)
    }

    /// `out = AP x_P - sum of neighbours`, the operator without the source.
    pub fn product(&self, x: &[f64], out: &mut [f64]) {
        let work = |(j, out): (usize, &mut [f64])| {
            let (row, near) = (self.row(j), self.near(x, j));
            for (i, o) in out.iter_mut().enumerate() {
                *o = row.centre[i] * near.here[i] - row.gather(near, i);
            }
        };
        self.for_rows(out, work);
    }

    /// `out = SU + sum of neighbours - AP x_P`.
    pub fn residual(&self, x: &[f64], out: &mut [f64]) {
        let work = |(j, out): (usize, &mut [f64])| {
            let (row, near) = (self.row(j), self.near(x, j));
            let source = &self.source[j * self.columns..];
            for (i, o) in out.iter_mut().enumerate() {
                *o = source[i] + row.gather(near, i) - row.centre[i] * near.here[i];
            }
        };
        self.for_rows(out, work);
    }

    /// Runs `work` on every row of `out`.
    pub(crate) fn for_rows<F>(&self, out: &mut [f64], work: F)
    where
        F: Fn((usize, &mut [f64])) + Sync + Send,
    {
        if self.len() < PARALLEL_FROM {
            out.chunks_mut(self.columns).enumerate().for_each(work);
        } else {
            out.par_chunks_mut(self.columns)
                .with_min_len(self.rows_per_task())
                .enumerate()
                .for_each(work);
        }
    }

    /// Divides `AP` by `relaxation` and adds what keeps `x` where the equation already holds
    /// (Patankar's implicit under-relaxation).
    pub fn under_relax(&mut self, x: &[f64], relaxation: f64) {
        for ((centre, source), x) in self.centre.iter_mut().zip(&mut self.source).zip(x) {
            let relaxed = *centre / relaxation;
            *source += (relaxed - *centre) * x;
            *centre = relaxed;
        }
    }

    /// As [`FivePoint::under_relax`], with a factor for every cell.
    pub fn under_relax_each(&mut self, x: &[f64], relaxation: impl Fn(usize) -> f64) {
        let columns = self.centre.iter_mut().zip(&mut self.source).zip(x);
        for (k, ((centre, source), x)) in columns.enumerate() {
            let relaxed = *centre / relaxation(k);
            *source += (relaxed - *centre) * x;
            *centre = relaxed;
        }
    }

    /// Checks that coefficients are finite and central ones positive.
    ///
    /// # Errors
    /// Names the first cell that fails.
    pub fn check(&self) -> Result<(), Error> {
        for index in 0..self.len() {
            let (centre, source) = (self.centre[index], self.source[index]);
            let sides = self.east[index] + self.west[index] + self.north[index] + self.south[index];
            let not_finite = |what| Err(Error::NotFinite { index, what });
            if !(centre + sides).is_finite() {
                return not_finite("a coefficient");
            }
            if !source.is_finite() {
                return not_finite("the source");
            }
            if centre <= 0.0 {
                let value = centre;
                return Err(Error::NotPositive { index, value });
            }
        }
        Ok(())
    }
}

impl Operator<f64> for FivePoint {
    fn len(&self) -> usize {
        self.centre.len()
    }

    fn apply(&self, x: &[[f64; 1]], out: &mut [[f64; 1]]) {
        self.product(x.as_flattened(), out.as_flattened_mut());
    }

    fn rounding(&self, x: &[[f64; 1]]) -> f64 {
        // Each of the five terms of a cell rounds, about as large as the central one.
        let squares = self.centre.iter().zip(x).map(|(c, [x])| (c * x) * (c * x));
        f64::EPSILON * (5.0 * squares.sum::<f64>()).sqrt()
    }
}

impl Row<'_> {
    /// Sum of the four neighbours of cell `i` of the row.
    #[inline]
    pub(crate) fn gather(&self, near: Near<'_>, i: usize) -> f64 {
        let last = near.here.len() - 1;
        let east = self.east[i] * near.here[(i + 1).min(last)];
        let west = self.west[i] * near.here[i.saturating_sub(1)];
        (east + west) + (self.north[i] * near.above[i] + self.south[i] * near.below[i])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn apply_and_residual_agree_with_a_dense_product() {
        let mut a = FivePoint::new(3, 2);
        for k in 0..6 {
            let (i, j) = (k % 3, k / 3);
            a.centre[k] = 10.0 + k as f64;
            a.source[k] = 0.5 * k as f64;
            if i < 2 {
                a.east[k] = 1.0 + k as f64;
            }
            if i > 0 {
                a.west[k] = 2.0 + k as f64;
            }
            if j < 1 {
                a.north[k] = 3.0 + k as f64;
            } else {
                a.south[k] = 4.0 + k as f64;
            }
        }
        let x = [1.0, -2.0, 3.0, 0.5, 4.0, -1.0];
        let (mut ax, mut r) = ([0.0; 6], [0.0; 6]);
        a.product(&x, &mut ax);
        a.residual(&x, &mut r);
        let dense = |k: usize| {
            let at = |on: bool, c: f64, m: usize| if on { c * x[m.min(5)] } else { 0.0 };
            let (i, j) = (k % 3, k / 3);
            a.centre[k] * x[k]
                - at(i < 2, a.east[k], k + 1)
                - at(i > 0, a.west[k], k.wrapping_sub(1))
                - at(j < 1, a.north[k], k + 3)
                - at(j > 0, a.south[k], k.wrapping_sub(3))
        };
        for k in 0..6 {
            assert!((ax[k] - dense(k)).abs() < 1e-13);
            assert!((r[k] - (a.source[k] - dense(k))).abs() < 1e-13);
        }
    }

    #[test]
    fn a_negative_centre_is_named() {
        let mut a = FivePoint::new(2, 2);
        a.centre.fill(1.0);
        a.centre[3] = -1.0;
        assert_eq!(
            a.check(),
            Err(Error::NotPositive {
                index: 3,
                value: -1.0
            })
        );
    }
}
