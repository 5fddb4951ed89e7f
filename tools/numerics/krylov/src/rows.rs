//! Compressed rows of a matrix that need not be symmetric.

use crate::Coefficient;
use rayon::prelude::*;
use std::ops::Range;

/// Rows that one task gathers.
const ROWS: usize = 1024;
/// Rows that one task makes.
const TASK: usize = 4096;
/// A product of fewer coefficients is not worth waking a thread.
const WORTH: usize = 50_000;

/// Compressed rows: the columns of each rise, the diagonal is among them.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows<T> {
    offsets: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<T>,
}

impl<T> Default for Rows<T> {
    fn default() -> Self {
        Self {
            offsets: vec![0],
            columns: Vec::new(),
            values: Vec::new(),
        }
    }
}

impl<T: Copy> Rows<T> {
    /// Row `i` holds `columns[offsets[i]..offsets[i + 1]]` and as many values.
    ///
    /// # Panics
    /// When offsets do not rise from 0 to the number of columns and values, or the columns of a row
    /// do not rise or lie beyond the rows, or a row lacks its diagonal.
    #[must_use]
    pub fn new(offsets: Vec<usize>, columns: Vec<u32>, values: Vec<T>) -> Self {
        let rows = Self {
            offsets,
            columns,
            values,
        };
        let (offsets, n) = (&rows.offsets, rows.len());
        assert!(
            offsets.first() == Some(&0)
                && offsets.is_sorted()
                && offsets.last() == Some(&rows.columns.len())
                && rows.values.len() == rows.columns.len(),
            "the offsets must rise from 0 to the number of columns and values"
        );
        for i in 0..n {
            let columns = rows.columns(i);
            assert!(
                columns.is_sorted_by(|a, b| a < b)
                    && columns.last().is_none_or(|j| (*j as usize) < n)
                    && columns.binary_search(&(i as u32)).is_ok(),
                "row {i} of {n}: columns must rise, lie within the rows and hold the diagonal"
            );
        }
        rows
    }

    /// Rows from a function that appends the columns and values of row `i`, in any order; those
    /// that occur several times are added up, and a missing diagonal becomes `zero`. Rows are made
    /// side by side.
    #[must_use]
    pub fn gathered(n: usize, zero: T, each: impl Fn(usize, &mut Vec<(u32, T)>) + Sync) -> Self
    where
        T: std::ops::AddAssign + Default + Send + Sync,
    {
        Self::made(n, Vec::new, |i, row, columns, values| {
            row.clear();
            row.push((i as u32, zero));
            each(i, row);
            append(i, n, row, columns, values);
        })
    }

    /// Rows made side by side: `each(i, scratch, columns, values)` appends those of row `i`. There
    /// may be other columns than rows.
    pub(crate) fn made<W>(
        n: usize,
        scratch: impl Fn() -> W + Sync,
        each: impl Fn(usize, &mut W, &mut Vec<u32>, &mut Vec<T>) + Sync,
    ) -> Self
    where
        T: Default + Send + Sync,
    {
        let part = |scratch: &mut W, m: usize| {
            let (mut ends, mut columns, mut values) = (Vec::new(), Vec::new(), Vec::new());
            for i in m * TASK..((m + 1) * TASK).min(n) {
                each(i, scratch, &mut columns, &mut values);
                ends.push(columns.len());
            }
            (ends, columns, values)
        };
        let tasks = (0..n.div_ceil(TASK)).into_par_iter();
        let parts: Vec<_> = tasks.map_init(&scratch, part).collect();
        let mut offsets = Vec::with_capacity(n + 1);
        offsets.push(0);
        let mut begin = 0;
        for (ends, ..) in &parts {
            offsets.extend(ends.iter().map(|end| begin + end));
            begin += ends.last().copied().unwrap_or(0);
        }
        let parts = parts.into_par_iter();
        Self::filled(offsets, parts, |(_, c, v), columns, values| {
            columns.copy_from_slice(&c);
            values.copy_from_slice(&v);
        })
    }

    /// Rows whose places are known, from one part for each [`TASK`] of them: `each(part, columns, values)` fills in the
    /// rows of a part. All threads take their share of the memory that is fresh.
    fn filled<P: Send>(
        offsets: Vec<usize>,
        parts: impl IndexedParallelIterator<Item = P>,
        each: impl Fn(P, &mut [u32], &mut [T]) + Sync + Send,
    ) -> Self
    where
        T: Default + Send,
    {
        let (n, entries) = (offsets.len() - 1, offsets.last().copied().unwrap_or(0));
        let mut columns = vec![0; entries];
        let mut values = vec![T::default(); entries];
        let (mut c, mut v) = (columns.as_mut_slice(), values.as_mut_slice());
        let mut slots = Vec::with_capacity(n.div_ceil(TASK));
        for from in (0..n).step_by(TASK) {
            let size = offsets[(from + TASK).min(n)] - offsets[from];
            let ((c0, c1), (v0, v1)) = (c.split_at_mut(size), v.split_at_mut(size));
            slots.push((c0, v0));
            (c, v) = (c1, v1);
        }
        let each = |(part, (c, v))| each(part, c, v);
        parts.zip(slots).for_each(each);
        Self {
            offsets,
            columns,
            values,
        }
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// No rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of coefficients.
    #[must_use]
    pub fn entries(&self) -> usize {
        self.columns.len()
    }

    /// Where row `i` stands.
    #[must_use]
    pub fn row(&self, i: usize) -> Range<usize> {
        self.offsets[i]..self.offsets[i + 1]
    }

    /// Columns of row `i`.
    #[must_use]
    pub fn columns(&self, i: usize) -> &[u32] {
        &self.columns[self.row(i)]
    }

    /// Coefficients of row `i`.
    #[must_use]
    pub fn values(&self, i: usize) -> &[T] {
        &self.values[self.row(i)]
    }

    /// Coefficients of row `i`.
    pub fn values_mut(&mut self, i: usize) -> &mut [T] {
        let row = self.row(i);
        &mut self.values[row]
    }

    /// Columns and coefficients of row `i`.
    pub fn pairs(&self, i: usize) -> impl Iterator<Item = (usize, T)> + '_ {
        let columns = self.columns(i).iter().map(|j| *j as usize);
        columns.zip(self.values(i).iter().copied())
    }

    /// Place of the diagonal among the columns of row `i`.
    #[must_use]
    pub fn diagonal_place(&self, i: usize) -> usize {
        self.columns(i).partition_point(|j| (*j as usize) < i)
    }

    /// Diagonal of row `i`.
    #[must_use]
    pub fn diagonal(&self, i: usize) -> T {
        self.values(i)[self.diagonal_place(i)]
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        8 * self.offsets.capacity()
            + 4 * self.columns.capacity()
            + size_of::<T>() * self.values.capacity()
    }

    /// The same coefficients as another kind of number.
    #[must_use]
    pub fn map<U: Copy>(&self, each: impl Fn(T) -> U) -> Rows<U> {
        Rows {
            offsets: self.offsets.clone(),
            columns: self.columns.clone(),
            values: self.values.iter().map(|v| each(*v)).collect(),
        }
    }

    /// The same equations in another order: row `i` becomes row `order.new_of(i)`.
    #[must_use]
    pub fn permuted(&self, order: &crate::Order) -> Self
    where
        T: Default + Send + Sync,
    {
        let n = self.len();
        let mut offsets = Vec::with_capacity(n + 1);
        offsets.push(0);
        let mut end = 0;
        for new in 0..n {
            end += self.row(order.old_of(new)).len();
            offsets.push(end);
        }
        let starts = (0..n.div_ceil(TASK)).into_par_iter();
        Self::filled(offsets, starts, |m, columns, values| {
            let (mut row, mut at): (Vec<(u32, T)>, _) = (Vec::new(), 0);
            for new in m * TASK..((m + 1) * TASK).min(n) {
                row.clear();
                let pairs = self.pairs(order.old_of(new));
                row.extend(pairs.map(|(j, v)| (order.new_of(j) as u32, v)));
                row.sort_unstable_by_key(|e| e.0);
                let (columns, values) = (&mut columns[at..], &mut values[at..]);
                for ((&(j, v), column), value) in row.iter().zip(columns).zip(values) {
                    (*column, *value) = (j, v);
                }
                at += row.len();
            }
        })
    }

    /// [`Rows::permuted`], letting go of the old rows.
    pub(crate) fn into_order(self, order: &crate::Order) -> Self
    where
        T: Default + Send + Sync,
    {
        self.permuted(order)
    }

    /// Without the entries below `least` times the largest of their row, and, if `wrong`, without
    /// those of the sign of the diagonal; what is left out goes to the diagonal, so that row sums
    /// stay.
    pub(crate) fn thinned(&self, least: f64, wrong: bool) -> Self
    where
        T: crate::Scalar,
    {
        let scratch = || ();
        Self::made(self.len(), scratch, |i, (), columns, values| {
            let diagonal = self.diagonal(i);
            let off = self.pairs(i).filter(|(j, _)| *j != i);
            let least = least * off.map(|(_, v)| v.modulus()).fold(0.0, f64::max);
            let (mut dropped, mut place) = (T::ZERO, 0);
            for (j, v) in self.pairs(i) {
                let same = v.real_part() * diagonal.real_part() > 0.0;
                if j == i {
                    place = values.len();
                } else if v.modulus() < least || (wrong && same) {
                    dropped += v;
                    continue;
                }
                columns.push(j as u32);
                values.push(v);
            }
            values[place] += dropped;
        })
    }

    /// `each(i, A x of row i, out[i])` for all rows, on all threads.
    pub(crate) fn product<S: crate::Scalar, const C: usize>(
        &self,
        x: &[[S; C]],
        out: &mut [[S; C]],
        each: impl Fn(usize, [S; C], &mut [S; C]) + Sync,
    ) where
        T: Coefficient<S>,
    {
        let part = |(block, out): (usize, &mut [[S; C]])| {
            for (i, out) in (block * ROWS..).zip(out) {
                let row = self.row(i);
                let sum = gather(&self.columns[row.clone()], &self.values[row], x);
                each(i, sum, out);
            }
        };
        if self.entries() < WORTH {
            out.chunks_mut(ROWS).enumerate().for_each(part);
        } else {
            out.par_chunks_mut(ROWS).enumerate().for_each(part);
        }
    }
}

/// Appends the entries of row `i` of `n`, columns rising, equal ones added up in the order they
/// stand in.
fn append<T: Copy + std::ops::AddAssign>(
    i: usize,
    n: usize,
    row: &mut [(u32, T)],
    columns: &mut Vec<u32>,
    values: &mut Vec<T>,
) {
    row.sort_by_key(|e| e.0);
    let begin = columns.len();
    for &(j, v) in &*row {
        if columns.len() > begin && columns.last() == Some(&j) {
            if let Some(last) = values.last_mut() {
                *last += v;
            }
        } else {
            assert!((j as usize) < n, "row {i} of {n} holds column {j}");
            columns.push(j);
            values.push(v);
        }
    }
}

/// Sum of coefficients times rows of `x`.
pub(crate) fn gather<S: crate::Scalar, T: Coefficient<S>, const C: usize>(
    columns: &[u32],
    values: &[T],
    x: &[[S; C]],
) -> [S; C] {
    let mut sum = [S::ZERO; C];
    for (&j, &v) in columns.iter().zip(values) {
        let x = &x[j as usize];
        for c in 0..C {
            sum[c] += v.times(x[c]);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Order;

    #[test]
    fn gathered_rows_are_sorted_and_added_up() {
        let a = Rows::gathered(3, 0.0, |i, row| {
            if i == 1 {
                row.extend([(2, 4.0), (0, 1.0), (2, 0.5)]);
            }
        });
        assert_eq!(a.columns(1), &[0, 1, 2]);
        assert_eq!(a.values(1), &[1.0, 0.0, 4.5]);
        assert_eq!(a.values(0), &[0.0]);
        assert_eq!(a.diagonal_place(1), 1);
    }

    #[test]
    fn a_permuted_product_is_the_permuted_product() {
        let n = 500;
        let a = Rows::gathered(n, 1.0, |i, row| {
            row.extend((1..6).map(|k| (((i * 37 + k * 91) % n) as u32, (i + k) as f64)));
        });
        let order = Order::from_old((0..n).map(|i| ((i * 123 + 7) % n) as u32).collect());
        let b = a.permuted(&order);
        let x: Vec<[f64; 2]> = (0..n).map(|i| [(i % 13) as f64, i as f64]).collect();
        let mut y = vec![[0.0; 2]; n];
        a.product(&x, &mut y, |_, sum, out| *out = sum);
        let mut mixed = vec![[0.0; 2]; n];
        order.forth(&x, &mut mixed);
        let mut z = vec![[0.0; 2]; n];
        b.product(&mixed, &mut z, |_, sum, out| *out = sum);
        let mut back = vec![[0.0; 2]; n];
        order.back(&z, &mut back);
        assert_eq!(y, back);
    }

    #[test]
    #[should_panic(expected = "row 1 of 2")]
    fn a_missing_diagonal_is_refused() {
        let _ = Rows::new(vec![0, 1, 2], vec![0, 0], vec![1.0, 1.0]);
    }
}
