//! Kernel values of all pairs of the compact copy, row by row.

use kernels::CubicSpline;
use neighbours::{Chunk, Lists, ROWS};
use rayon::prelude::*;

use crate::vector::{minus, squared};

/// Kernel values of the pairs of a chunk of rows, at the offsets of the neighbour lists; buffers may
/// be longer.
#[derive(Debug, Clone, Default)]
pub struct PairChunk {
    /// W \[1/m3\].
    pub value: Vec<f64>,
    /// (dW/dr)/r \[1/m5\]; the same bits seen from both sides, so that pair forces cancel.
    pub slope: Vec<f32>,
}

/// Neighbours of one particle.
#[derive(Debug, Clone, Copy)]
pub struct Row<'a> {
    /// Their numbers in the copy.
    pub index: &'a [u32],
    /// W of the pairs \[1/m3\].
    pub value: &'a [f64],
    /// (dW/dr)/r of the pairs \[1/m5\].
    pub slope: &'a [f32],
}

impl Row<'_> {
    /// Each neighbour with W.
    #[inline]
    pub fn values(&self) -> impl Iterator<Item = (usize, f64)> {
        let index = self.index.iter().map(|b| *b as usize);
        index.zip(self.value.iter().copied())
    }

    /// Each neighbour with (dW/dr)/r.
    #[inline]
    pub fn slopes(&self) -> impl Iterator<Item = (usize, f64)> {
        let index = self.index.iter().map(|b| *b as usize);
        index.zip(self.slope.iter().map(|slope| f64::from(*slope)))
    }
}

/// Calls `each` with every particle, its row and its item of `out`, chunks side by side.
pub(super) fn each_row<T: Send>(
    (lists, pairs): (&Lists, &[PairChunk]),
    out: &mut [T],
    each: impl Fn(usize, Row<'_>, &mut T) + Sync,
) {
    out.par_chunks_mut(ROWS)
        .zip(lists.chunks())
        .zip(pairs)
        .for_each(|((out, chunk), pairs)| {
            for (k, out) in out.iter_mut().enumerate() {
                let range = chunk.range(k);
                let row = Row {
                    index: chunk.row(k),
                    value: &pairs.value[range.clone()],
                    slope: &pairs.slope[range],
                };
                each(chunk.first() + k, row, out);
            }
        });
}

/// What belongs to a chunk of rows.
pub(super) struct Rows<'a> {
    pub(super) pairs: &'a mut PairChunk,
    number: &'a mut [f64],
    gradient: &'a mut [[f64; 3]],
    squares: &'a mut [f64],
}

/// All rows by chunks.
pub(super) fn rows<'a>(
    pairs: &'a mut Vec<PairChunk>,
    (number, gradient, squares): (&'a mut Vec<f64>, &'a mut Vec<[f64; 3]>, &'a mut Vec<f64>),
    n: usize,
) -> impl IndexedParallelIterator<Item = Rows<'a>> {
    pairs.resize_with(n.div_ceil(ROWS), PairChunk::default);
    number.resize(n, 0.0);
    gradient.resize(n, [0.0; 3]);
    squares.resize(n, 0.0);
    pairs
        .par_iter_mut()
        .zip(number.par_chunks_mut(ROWS))
        .zip(gradient.par_chunks_mut(ROWS))
        .zip(squares.par_chunks_mut(ROWS))
        .map(|(((pairs, number), gradient), squares)| Rows {
            pairs,
            number,
            gradient,
            squares,
        })
}

impl Rows<'_> {
    /// Puts squared distances in the place of the kernel values.
    pub(super) fn measure(&mut self, chunk: &Chunk, marks: &[[f64; 4]]) {
        for k in 0..chunk.rows() {
            let [x, y, z, _] = marks[chunk.first() + k];
            let values = &mut self.pairs.value[chunk.range(k)];
            for (&b, value) in chunk.row(k).iter().zip(values) {
                let [u, v, w, _] = marks[b as usize];
                *value = squared(minus([x, y, z], [u, v, w]));
            }
        }
    }

    /// Turns squared distances into kernel values, and sums these over the rows.
    pub(super) fn fill(&mut self, chunk: &Chunk, kernel: CubicSpline<3>, marks: &[[f64; 4]]) {
        pulp::Arch::new().dispatch(Filling {
            rows: self,
            chunk,
            kernel,
            marks,
        });
    }

    /// Turns squared distances into kernel values.
    #[inline(always)]
    fn weigh(&mut self, chunk: &Chunk, kernel: CubicSpline<3>) {
        let PairChunk { value, slope } = &mut *self.pairs;
        let n = chunk.index().len();
        slope.resize(n, 0.0);
        for (value, slope) in value[..n].iter_mut().zip(slope) {
            let sample = kernel.sample(value.sqrt());
            (*value, *slope) = (sample.value, sample.slope as f32);
        }
    }

    /// Sums over the rows; `own` is W at no distance.
    #[inline(always)]
    fn sum(&mut self, chunk: &Chunk, marks: &[[f64; 4]], own: f64) {
        let PairChunk { value, slope } = &*self.pairs;
        for k in 0..chunk.rows() {
            let at = marks[chunk.first() + k];
            let (mut number, mut gradient, mut squares) = (own, [0.0; 4], 0.0);
            let pairs = value[chunk.range(k)].iter().zip(&slope[chunk.range(k)]);
            for (&b, (&value, &slope)) in chunk.row(k).iter().zip(pairs) {
                let to = marks[b as usize];
                let slope = f64::from(slope);
                let pull: [f64; 4] = std::array::from_fn(|i| slope * (at[i] - to[i]));
                gradient = std::array::from_fn(|i| gradient[i] + pull[i]);
                squares += to[3] * squared([pull[0], pull[1], pull[2]]);
                number += value;
            }
            let [x, y, z, _] = gradient;
            // A row that is not kept is empty, and so is its sum.
            self.number[k] = if chunk.row(k).is_empty() { 0.0 } else { number };
            (self.gradient[k], self.squares[k]) = ([x, y, z], squares);
        }
    }
}

/// [`Rows::fill`] in the widest vectors that the machine has. No operation is fused or reordered for it.
struct Filling<'a, 'b> {
    rows: &'a mut Rows<'b>,
    chunk: &'a Chunk,
    kernel: CubicSpline<3>,
    marks: &'a [[f64; 4]],
}

impl pulp::NullaryFnOnce for Filling<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.rows.weigh(self.chunk, self.kernel);
        self.rows
            .sum(self.chunk, self.marks, self.kernel.value(0.0));
    }
}
