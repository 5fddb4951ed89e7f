//! Elimination of the rows of one slab or wall.

use super::Keep;
use super::piece::{Piece, Triangle};
use crate::{Coefficient, Rows, Scalar};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;

/// A pivot below this share of the mean modulus of its row is enlarged.
const WEAK: f64 = 1e-4;

/// What is to be factorised.
pub(crate) struct Eliminate<'a, T, S> {
    pub(crate) rows: &'a Rows<T>,
    pub(crate) shift: &'a [S],
    pub(crate) keep: Keep,
    /// Number of rows in slabs; walls begin here.
    pub(crate) border: usize,
}

/// The rows of a piece, and the slabs done before (for a wall).
pub(crate) struct Zone<'a, F> {
    pub(crate) range: Range<usize>,
    pub(crate) done: &'a [Piece<F>],
}

/// A row that is being eliminated: values by column, and which columns there are. One serves several pieces, whose rows
/// differ.
pub(crate) struct Work<S> {
    value: Vec<S>,
    /// One more than the row that has this column, or 0.
    stamp: Vec<u32>,
    lower: Vec<u32>,
    upper: Vec<u32>,
    heap: BinaryHeap<Reverse<u32>>,
    /// Entries to be sorted by modulus.
    large: Vec<(f64, u32)>,
    dropped: S,
}

impl<T: Coefficient<S>, S: Scalar> Eliminate<'_, T, S> {
    /// Is column `j` of a row of `range` kept apart from it? Walls must not touch.
    fn apart(&self, range: &Range<usize>, j: usize) -> bool {
        let own = range.contains(&j);
        !own && (j >= self.border) == (range.start >= self.border)
    }

    /// Room for a row.
    pub(crate) fn work(&self) -> Work<S> {
        let n = self.rows.len();
        Work {
            value: vec![S::ZERO; n],
            stamp: vec![0; n],
            lower: Vec::new(),
            upper: Vec::new(),
            heap: BinaryHeap::new(),
            large: Vec::new(),
            dropped: S::ZERO,
        }
    }

    pub(crate) fn run<F: Coefficient<S>>(
        &self,
        work: &mut Work<S>,
        zone: &Zone<'_, F>,
    ) -> Piece<F> {
        let range = &zone.range;
        let half = range.clone().map(|i| self.rows.row(i).len()).sum::<usize>() * 6 / 10;
        let mut piece = Piece {
            first: range.start,
            lower: Triangle::new(range.len(), half),
            upper: Triangle::new(range.len(), half),
            inverse: Vec::with_capacity(range.len()),
            weak: 0,
        };
        for i in range.clone() {
            let size = self.load::<F>(i, range, work);
            match self.keep {
                Keep::Pattern { compensate } => {
                    self.pattern(i, zone, &piece, work);
                    let dropped = work.dropped.times_real(compensate);
                    work.value[i] += dropped;
                }
                Keep::Threshold { drop, fill } => {
                    self.threshold(i, zone, &piece, drop * size, work);
                    let most = |count: usize| (count as f64 * fill).ceil() as usize;
                    let place = self.rows.diagonal_place(i);
                    let after = self.rows.row(i).len() - place - 1;
                    work.thin_lower(drop * size, most(place));
                    work.thin_upper(drop * size, most(after));
                }
            }
            self.store(i, range, size, work, &mut piece);
        }
        piece
    }

    /// Takes row `i`; returns the mean modulus of its entries.
    fn load<F: Coefficient<S>>(&self, i: usize, range: &Range<usize>, work: &mut Work<S>) -> f64 {
        work.lower.clear();
        work.upper.clear();
        work.dropped = S::ZERO;
        let mut sum = 0.0;
        for (j, v) in self.rows.pairs(i) {
            let mut value = v.widened();
            if j == i
                && let Some(shift) = self.shift.get(i)
            {
                // Of a complex shift, real factors take the modulus, with the sign of the diagonal.
                value += if F::IMAGINARY {
                    *shift
                } else {
                    S::real(shift.modulus().copysign(value.real_part()))
                };
            }
            sum += value.modulus();
            if self.apart(range, j) {
                continue;
            }
            work.value[j] = value;
            work.stamp[j] = i as u32 + 1;
            if j < i {
                work.lower.push(j as u32);
            } else if j > i {
                work.upper.push(j as u32);
            }
        }
        sum / self.rows.row(i).len() as f64
    }

    /// Eliminates within the pattern of row `i`.
    fn pattern<F: Coefficient<S>>(
        &self,
        i: usize,
        zone: &Zone<'_, F>,
        piece: &Piece<F>,
        work: &mut Work<S>,
    ) {
        for at in 0..work.lower.len() {
            let column = work.lower[at] as usize;
            let (from, k) = holder(zone, piece, column);
            let factor = from.inverse[k].times(work.value[column]);
            work.value[column] = factor;
            for (j, u) in entries(from, k, self.border) {
                let change = u.times(factor);
                if work.stamp[j] == i as u32 + 1 {
                    work.value[j] -= change;
                } else {
                    work.dropped -= change;
                }
            }
        }
    }

    /// Eliminates with all fill; what is below `least` is dropped at once.
    fn threshold<F: Coefficient<S>>(
        &self,
        i: usize,
        zone: &Zone<'_, F>,
        piece: &Piece<F>,
        least: f64,
        work: &mut Work<S>,
    ) {
        work.heap.clear();
        work.heap.extend(work.lower.drain(..).map(Reverse));
        while let Some(Reverse(k)) = work.heap.pop() {
            let (from, k) = holder(zone, piece, k as usize);
            let column = from.first + k;
            let factor = from.inverse[k].times(work.value[column]);
            if factor.modulus() < least {
                work.stamp[column] = 0;
                continue;
            }
            work.value[column] = factor;
            work.lower.push(column as u32);
            for (j, u) in entries(from, k, self.border) {
                let change = u.times(factor);
                if work.stamp[j] == i as u32 + 1 {
                    work.value[j] -= change;
                } else if change.modulus() >= least && !self.apart(&zone.range, j) {
                    work.stamp[j] = i as u32 + 1;
                    work.value[j] = -change;
                    match j.cmp(&i) {
                        std::cmp::Ordering::Less => work.heap.push(Reverse(j as u32)),
                        std::cmp::Ordering::Equal => {}
                        std::cmp::Ordering::Greater => work.upper.push(j as u32),
                    }
                }
            }
        }
    }

    /// Appends the finished row.
    fn store<F: Coefficient<S>>(
        &self,
        i: usize,
        range: &Range<usize>,
        size: f64,
        work: &Work<S>,
        piece: &mut Piece<F>,
    ) {
        let first = range.start as u32;
        let wall = range.start >= self.border;
        let beyond = |columns: &[u32], triangle: &mut Triangle<F>, base: u32| {
            for &j in columns.iter().filter(|j| !range.contains(&(**j as usize))) {
                triangle.push(j - base, F::narrowed(work.value[j as usize]));
            }
            triangle.middle();
            for &j in columns.iter().filter(|j| range.contains(&(**j as usize))) {
                triangle.push(j - first, F::narrowed(work.value[j as usize]));
            }
            triangle.end();
        };
        beyond(&work.lower, &mut piece.lower, 0);
        beyond(
            &work.upper,
            &mut piece.upper,
            if wall { 0 } else { self.border as u32 },
        );
        let mut pivot = work.value[i];
        let least = WEAK * size;
        if pivot.modulus().is_nan() || pivot.modulus() < least {
            let sign = self.rows.diagonal(i).widened();
            pivot = S::real(if sign.real_part() < 0.0 { -size } else { size });
            piece.weak += 1;
        }
        piece.inverse.push(F::narrowed(S::ONE / pivot));
    }
}

/// The piece that holds row `k`, and its place there.
fn holder<'a, F: Copy>(zone: &Zone<'a, F>, piece: &'a Piece<F>, k: usize) -> (&'a Piece<F>, usize) {
    if k >= zone.range.start {
        return (piece, k - zone.range.start);
    }
    let at = zone.done.partition_point(|p| p.first + p.len() <= k);
    (&zone.done[at], k - zone.done[at].first)
}

/// Columns and values of row `k` of `U`.
fn entries<F: Copy>(
    piece: &Piece<F>,
    k: usize,
    border: usize,
) -> impl Iterator<Item = (usize, F)> + '_ {
    let base = if piece.first >= border { 0 } else { border };
    let (far, near) = (piece.upper.beyond(k), piece.upper.own(k));
    let beyond = far.columns.iter().map(move |j| *j as usize + base);
    let own = near.columns.iter().map(|j| *j as usize + piece.first);
    let (far, near) = (beyond.zip(far.values), own.zip(near.values));
    far.chain(near).map(|(j, v)| (j, *v))
}

impl<S: Scalar> Work<S> {
    /// Keeps the largest of the lower entries.
    fn thin_lower(&mut self, least: f64, most: usize) {
        let mut columns = std::mem::take(&mut self.lower);
        self.thin(&mut columns, least, most);
        self.lower = columns;
    }

    /// Keeps the largest of the upper entries.
    fn thin_upper(&mut self, least: f64, most: usize) {
        let mut columns = std::mem::take(&mut self.upper);
        self.thin(&mut columns, least, most);
        self.upper = columns;
    }

    fn thin(&mut self, columns: &mut Vec<u32>, least: f64, most: usize) {
        columns.retain(|j| self.value[*j as usize].modulus() >= least);
        if columns.len() > most {
            self.large.clear();
            let sizes = columns
                .iter()
                .map(|j| (self.value[*j as usize].modulus(), *j));
            self.large.extend(sizes);
            let order = |a: &(f64, u32), b: &(f64, u32)| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1));
            if most > 0 {
                self.large.select_nth_unstable_by(most - 1, order);
            }
            columns.clear();
            columns.extend(self.large[..most].iter().map(|e| e.1));
        }
        columns.sort_unstable();
    }
}
