//! Kernel values of all pairs of the compact copy, row by row.

use kernels::CubicSpline;
use neighbours::{Chunk, Lists, ROWS};
use particles::sweep::wide;
use rayon::prelude::*;
use shapes::frame::{difference, squared};

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
    lists: &Lists,
    pairs: &[PairChunk],
    out: &mut [T],
    each: impl Fn(usize, Row<'_>, &mut T) + Sync,
) {
    out.par_chunks_mut(ROWS)
        .zip(lists.chunks())
        .zip(pairs)
        .for_each(|((out, chunk), pairs)| {
            wide(
                #[inline(always)]
                || {
                    for (k, out) in out.iter_mut().enumerate() {
                        let range = chunk.range(k);
                        let row = Row {
                            index: chunk.row(k),
                            value: &pairs.value[range.clone()],
                            slope: &pairs.slope[range],
                        };
                        each(chunk.first() + k, row, out);
                    }
                },
            );
        });
}

/// What belongs to a chunk of rows.
pub(super) struct Rows<'a> {
    pub(super) pairs: &'a mut PairChunk,
    number: &'a mut [f64],
    gradient: &'a mut [[f64; 3]],
    squares: &'a mut [f64],
}

/// Sums over the rows, `[n]`.
pub(super) struct RowSums<'a> {
    pub(super) number: &'a mut Vec<f64>,
    pub(super) gradient: &'a mut Vec<[f64; 3]>,
    pub(super) squares: &'a mut Vec<f64>,
}

/// All rows by chunks.
pub(super) fn rows<'a>(
    pairs: &'a mut Vec<PairChunk>,
    sums: RowSums<'a>,
    n: usize,
) -> impl IndexedParallelIterator<Item = Rows<'a>> {
    let RowSums {
        number,
        gradient,
        squares,
    } = sums;
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
                *value = squared(difference([x, y, z], [u, v, w]));
            }
        }
    }

    /// Turns squared distances into kernel values, and sums these over the rows.
    pub(super) fn fill(&mut self, chunk: &Chunk, kernel: CubicSpline<3>, marks: &[[f64; 4]]) {
        wide(
            #[inline(always)]
            || {
                self.weigh(chunk, kernel);
                self.sum(chunk, marks, kernel.value(0.0));
            },
        );
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
            let (range, row) = (chunk.range(k), chunk.row(k));
            let (even, odd) = (&mut Sums::default(), &mut Sums::default());
            let (values, slopes) = (&value[range.clone()], &slope[range]);
            let (twos, last) = row.as_chunks::<2>();
            let pairs = values
                .as_chunks::<2>()
                .0
                .iter()
                .zip(slopes.as_chunks::<2>().0);
            for ([b, c], ([v, w], [s, t])) in twos.iter().zip(pairs) {
                even.add(at, marks[*b as usize], *v, *s);
                odd.add(at, marks[*c as usize], *w, *t);
            }
            if let ([b], Some(value), Some(slope)) = (last, values.last(), slopes.last()) {
                even.add(at, marks[*b as usize], *value, *slope);
            }
            let [x, y, z, _]: [f64; 4] =
                std::array::from_fn(|i| even.gradient[i] + odd.gradient[i]);
            let [p, q, r, _]: [f64; 4] = std::array::from_fn(|i| even.squares[i] + odd.squares[i]);
            let (number, squares) = (own + (even.number + odd.number), p + q + r);
            // A row that is not kept is empty, and so is its sum.
            self.number[k] = if row.is_empty() { 0.0 } else { number };
            (self.gradient[k], self.squares[k]) = ([x, y, z], squares);
        }
    }
}

/// Sums over every other neighbour of a row, so that additions need not wait for each other.
#[derive(Default)]
struct Sums {
    number: f64,
    /// Of grad W; the fourth number means nothing.
    gradient: [f64; 4],
    /// Of its squares over liquid neighbours, axis by axis; the fourth number means nothing.
    squares: [f64; 4],
}

impl Sums {
    /// Adds the neighbour `to` of `at` with W and (dW/dr)/r.
    #[inline(always)]
    fn add(&mut self, at: [f64; 4], to: [f64; 4], value: f64, slope: f32) {
        let slope = f64::from(slope);
        for i in 0..4 {
            let pull = slope * (at[i] - to[i]);
            self.gradient[i] += pull;
            self.squares[i] += to[3] * (pull * pull);
        }
        self.number += value;
    }
}
