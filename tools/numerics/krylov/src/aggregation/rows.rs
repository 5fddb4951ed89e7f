//! One matrix of the hierarchy, compact and ordered for Gauss-Seidel sweeps.
//!
//! Couplings (negated off-diagonals) are single precision. The diagonal is rebuilt from the rounded
//! couplings and from the excess of the row, which is summed in double precision, so that rounding
//! never touches what ties a region to its fixed values, whatever the jump of coefficients.
//!
//! Sweeps run over blocks of fixed size; within a block they are sequential, between blocks they
//! use values from before the sweep. Half the couplings to other blocks are added to the diagonal
//! of a sweep, and taken back as a coupling of the row with itself: this splitting converges however
//! the rows are ordered (Baker, Falgout, Kolev and Yang 2011, SIAM J. Sci. Comput. 33, 2864).

use crate::sums::{WORTH, update};
use crate::{Error, Operator, Sparse};
use rayon::prelude::*;

/// Rows swept in sequence.
pub(crate) const BLOCK: usize = 8192;

/// The rows of a matrix. In each row stand first the columns before it in its block, then those of
/// other blocks (and the row itself), then those after it in its block.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rows {
    starts: Vec<u32>,
    /// End of the columns before the row in its block.
    lower: Vec<u32>,
    /// Begin of the columns after the row in its block.
    upper: Vec<u32>,
    links: Vec<Link>,
    /// Inverse of the diagonal of a sweep.
    inverse: Vec<f64>,
    /// What the diagonal of a sweep has beyond that of the row which is being made.
    beyond: f64,
}

/// A column and the coupling to it.
pub(crate) type Link = (u32, f32);

/// What setting up needs to know of rows, and solving does not.
#[derive(Debug, Clone, Default)]
pub(crate) struct Balance {
    pub(crate) diagonal: Vec<f64>,
    /// Row sum: diagonal less couplings.
    pub(crate) excess: Vec<f64>,
    /// A row of the finest matrix.
    pub(crate) leader: Vec<u32>,
}

/// Couplings of row `i` and what is left of its diagonal. A few last bits are no excess: a row
/// whose couplings add up to its diagonal is insulated.
fn excess(diagonal: f64, values: &[f64]) -> f64 {
    let sum: f64 = values.iter().sum();
    let excess = diagonal + sum;
    let noise = (values.len() + 2) as f64 * f64::EPSILON * diagonal;
    if excess.abs() <= noise { 0.0 } else { excess }
}

impl Rows {
    pub(crate) fn len(&self) -> usize {
        self.inverse.len()
    }

    pub(crate) fn entries(&self) -> usize {
        self.links.len()
    }

    /// Columns and couplings of row `i`; one may be the row itself.
    pub(crate) fn row(&self, i: usize) -> &[Link] {
        self.part(self.starts[i], self.starts[i + 1])
    }

    fn part(&self, from: u32, to: u32) -> &[Link] {
        &self.links[from as usize..to as usize]
    }

    pub(crate) fn bytes(&self) -> usize {
        4 * (self.starts.capacity() + self.lower.capacity() + self.upper.capacity())
            + 8 * (self.links.capacity() + self.inverse.capacity())
    }

    pub(crate) fn clear(&mut self) {
        self.starts.clear();
        self.starts.push(0);
        self.lower.clear();
        self.upper.clear();
        self.links.clear();
        self.inverse.clear();
    }

    /// Appends a row; returns the sum of its couplings as they are stored.
    pub(crate) fn push(&mut self, entries: impl Iterator<Item = (u32, f64)> + Clone) -> f64 {
        let i = self.lower.len();
        let first = (i / BLOCK * BLOCK) as u32;
        let (i, end) = (i as u32, first + BLOCK as u32);
        let mut sum = 0.0;
        for which in [0, 1, 2] {
            let (begin, before) = (self.links.len(), sum);
            for (j, w) in entries.clone() {
                let outside = j < first || j >= end;
                let kind = if outside { 1 } else { 2 * u8::from(j > i) };
                if kind == which {
                    let w = w as f32;
                    self.links.push((j, w));
                    sum += f64::from(w);
                }
            }
            // The row next to this one comes last in a sweep, which has just made its value.
            let part = &mut self.links[begin..];
            if !part.is_sorted_by_key(|link| link.0) {
                part.sort_unstable_by_key(|link| link.0);
            }
            if which == 1 {
                let half = (0.5 * (sum - before)).max(0.0) as f32;
                self.beyond = f64::from(half);
                if half > 0.0 {
                    self.links.push((i, half));
                }
            }
            match which {
                0 => self.lower.push(self.links.len() as u32),
                1 => self.upper.push(self.links.len() as u32),
                _ => self.starts.push(self.links.len() as u32),
            }
        }
        sum
    }

    /// Closes a row with its diagonal.
    pub(crate) fn close(&mut self, diagonal: f64) {
        self.inverse.push(1.0 / (diagonal + self.beyond));
    }

    /// Takes the rows of `a` times `scale`.
    pub(crate) fn copy(
        &mut self,
        a: &Sparse,
        scale: f64,
        balance: &mut Balance,
    ) -> Result<(), Error> {
        self.clear();
        let pattern = a.pattern();
        let several = if a.len() > BLOCK { a.len() } else { 0 };
        self.links.reserve_exact(pattern.columns().len() + several);
        balance.clear();
        for (i, &diagonal) in a.diagonal().iter().enumerate() {
            let range = pattern.row(i);
            let (columns, values) = (&pattern.columns()[range.clone()], &a.values()[range]);
            let entries = columns.iter().zip(values);
            let sum = self.push(entries.map(|(&j, v)| (j, -v * scale)));
            if !sum.is_finite() {
                return Err(Error::NotFinite {
                    index: i,
                    what: "a coefficient",
                });
            }
            let excess = scale * excess(diagonal, values);
            self.close(excess + sum);
            balance.push(excess + sum, excess, i as u32);
        }
        debug_assert_eq!(a.len(), self.len());
        Ok(())
    }

    /// Forward sweep from zero: `out = (D - L)^-1 scale rhs`.
    pub(crate) fn forward(&self, scale: f64, rhs: &[f64], out: &mut [f64]) {
        blocks(out, BLOCK, |first, out| {
            for k in 0..out.len() {
                let i = first + k;
                let mut sum = scale * rhs[i];
                for &(j, w) in self.part(self.starts[i], self.lower[i]) {
                    sum += f64::from(w) * out[j as usize - first];
                }
                out[k] = sum * self.inverse[i];
            }
        });
    }

    /// The residual after [`Self::forward`]: what the sweep left out.
    pub(crate) fn left_out(&self, x: &[f64], out: &mut [f64]) {
        blocks(out, BLOCK, |first, out| {
            for (i, out) in (first..).zip(out) {
                *out = gather(self.part(self.lower[i], self.starts[i + 1]), x);
            }
        });
    }

    /// Backward sweep: `out = (D - U)^-1 (scale rhs + (L + O) x)`.
    pub(crate) fn backward(&self, scale: f64, rhs: &[f64], x: &[f64], out: &mut [f64]) {
        blocks(out, BLOCK, |first, out| {
            for k in (0..out.len()).rev() {
                let i = first + k;
                let before = self.part(self.starts[i], self.upper[i]);
                let mut sum = scale * rhs[i] + gather(before, x);
                for &(j, w) in self.part(self.upper[i], self.starts[i + 1]).iter().rev() {
                    sum += f64::from(w) * out[j as usize - first];
                }
                out[k] = sum * self.inverse[i];
            }
        });
    }

    /// `v = A c` for the `c` that [`Self::backward`] made of `rhs` (unscaled) and `x`; overwrites
    /// `x` with `x - c`.
    pub(crate) fn product(&self, rhs: &[f64], c: &[f64], x: &mut [f64], v: &mut [f64]) {
        update(x, c, |x, c| {
            for (x, c) in x.iter_mut().zip(c) {
                *x -= c;
            }
            0.0
        });
        let x = &*x;
        blocks(v, BLOCK, |first, v| {
            for (k, v) in v.iter_mut().enumerate() {
                let i = first + k;
                *v = rhs[i] + gather(self.part(self.starts[i], self.upper[i]), x);
            }
        });
    }
}

impl Balance {
    pub(crate) fn clear(&mut self) {
        self.diagonal.clear();
        self.excess.clear();
        self.leader.clear();
    }

    pub(crate) fn push(&mut self, diagonal: f64, excess: f64, leader: u32) {
        self.diagonal.push(diagonal);
        self.excess.push(excess);
        self.leader.push(leader);
    }
}

/// Sum of couplings times values.
fn gather(links: &[Link], x: &[f64]) -> f64 {
    let mut sum = 0.0;
    for &(j, w) in links {
        sum += f64::from(w) * x[j as usize];
    }
    sum
}

/// Runs `each` on blocks of `size` numbers, with the index of the first of them.
pub(crate) fn blocks(out: &mut [f64], size: usize, each: impl Fn(usize, &mut [f64]) + Sync) {
    let each = |(block, out): (usize, &mut [f64])| each(block * size, out);
    if out.len() < WORTH {
        out.chunks_mut(size).enumerate().for_each(each);
    } else {
        out.par_chunks_mut(size).enumerate().for_each(each);
    }
}
