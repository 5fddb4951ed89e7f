//! A sparse operator and conditions that tie few rows to many, such as that of multipoles on walls.

use crate::columns::{sum, update};
use crate::grouping::NONE;
use crate::{Operator, Order, Scalar};
use std::ops::Range;

/// Pairs that are taken together: the columns are read once for all of them.
const TOGETHER: usize = 8;

/// Numbers by the rows where they are not zero.
#[derive(Debug, Clone, Default)]
struct Few<S> {
    rows: Vec<u32>,
    values: Vec<S>,
}

/// `u v^T`, not conjugated: the rows where `u` is not zero take the sum over those where `v` is not.
#[derive(Debug, Clone)]
pub struct Pair<S> {
    u: Few<S>,
    v: Few<S>,
}

impl<S: Scalar> Pair<S> {
    /// From two whole columns, of which only what is not zero is kept.
    pub fn new(u: impl IntoIterator<Item = S>, v: impl IntoIterator<Item = S>) -> Self {
        Self {
            u: Few::new(u),
            v: Few::new(v),
        }
    }
}

impl<S: Scalar> Few<S> {
    fn new(whole: impl IntoIterator<Item = S>) -> Self {
        let mut few = Self {
            rows: Vec::new(),
            values: Vec::new(),
        };
        for (i, value) in whole.into_iter().enumerate() {
            if value != S::ZERO {
                few.rows.push(i as u32);
                few.values.push(value);
            }
        }
        few
    }
}

/// Columns side by side, by the rows where one of them is not zero; rows rise.
#[derive(Debug, Clone)]
struct Tall<S> {
    rows: Vec<u32>,
    values: Vec<[S; TOGETHER]>,
}

impl<S: Scalar> Tall<S> {
    /// Columns in the order `order`, row `i` times `scale(i)`.
    fn new(columns: &[&Few<S>], order: &Order, scale: impl Fn(usize) -> f64) -> Self {
        let mut place = vec![NONE; order.len()];
        for &row in columns.iter().flat_map(|few| &few.rows) {
            place[order.new_of(row as usize)] = 0;
        }
        let mut rows = Vec::new();
        for (i, place) in place.iter_mut().enumerate().filter(|(_, p)| **p != NONE) {
            *place = rows.len() as u32;
            rows.push(i as u32);
        }
        let mut values = vec![[S::ZERO; TOGETHER]; rows.len()];
        for (p, few) in columns.iter().enumerate() {
            for (&row, value) in few.rows.iter().zip(&few.values) {
                let new = order.new_of(row as usize);
                values[place[new] as usize][p] = value.times_real(scale(new));
            }
        }
        Self { rows, values }
    }

    /// Those among the rows of a range, and what they hold.
    fn within(&self, range: &Range<usize>) -> impl Iterator<Item = (usize, &[S; TOGETHER])> {
        let place = |row: usize| self.rows.partition_point(|r| (*r as usize) < row);
        let (from, to) = (place(range.start), place(range.end));
        let rows = self.rows[from..to].iter().map(|r| *r as usize);
        rows.zip(&self.values[from..to])
    }
}

/// Pairs ready for products, in an order of rows and with rows scaled.
#[derive(Debug, Clone)]
pub(crate) struct Ties<S> {
    groups: Vec<(Tall<S>, Tall<S>)>,
}

impl<S: Scalar> Ties<S> {
    pub(crate) fn new(pairs: &[Pair<S>], order: &Order, scale: &[f64]) -> Self {
        let group = |pairs: &[Pair<S>]| {
            let us: Vec<_> = pairs.iter().map(|p| &p.u).collect();
            let vs: Vec<_> = pairs.iter().map(|p| &p.v).collect();
            (
                Tall::new(&us, order, |i| scale[i]),
                Tall::new(&vs, order, |_| 1.0),
            )
        };
        Self {
            groups: pairs.chunks(TOGETHER).map(group).collect(),
        }
    }

    /// Does a pair add to this row?
    pub(crate) fn reach(&self, row: usize) -> bool {
        let there = |(u, _): &(Tall<S>, Tall<S>)| u.rows.binary_search(&(row as u32)).is_ok();
        self.groups.iter().any(there)
    }
}

/// `A + U V^T`.
#[derive(Debug, Clone)]
pub(crate) struct LowRank<'a, A, S> {
    /// The sparse part.
    pub(crate) sparse: &'a A,
    /// The pairs.
    pub(crate) ties: &'a Ties<S>,
}

impl<S: Scalar, A: Operator<S, C>, const C: usize> Operator<S, C> for LowRank<'_, A, S> {
    fn len(&self) -> usize {
        self.sparse.len()
    }

    fn apply(&self, x: &[[S; C]], out: &mut [[S; C]]) {
        self.sparse.apply(x, out);
        for (u, v) in &self.ties.groups {
            let factors: [[S; C]; TOGETHER] = sum(x.len(), |rows| {
                let mut sums = [[S::ZERO; C]; TOGETHER];
                for (i, v) in v.within(&rows) {
                    for (sum, v) in sums.iter_mut().zip(v) {
                        for c in 0..C {
                            sum[c] += *v * x[i][c];
                        }
                    }
                }
                sums
            });
            update(out, |rows, out| {
                for (i, u) in u.within(&rows) {
                    let out = &mut out[i - rows.start];
                    for (factor, u) in factors.iter().zip(u) {
                        for c in 0..C {
                            out[c] += *u * factor[c];
                        }
                    }
                }
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Rows, Shifted};

    /// Columns of which few rows are not zero, more than are taken together.
    fn columns(n: usize, first: usize) -> Vec<Vec<f64>> {
        let value = |p: usize, i: usize| ((i * 7 + p * 3) % 11) as f64 - 5.0;
        let column = |p| {
            (0..n).map(move |i| {
                if i % 5 == (first + p) % 2 {
                    value(p, i)
                } else {
                    0.0
                }
            })
        };
        (0..TOGETHER + 3).map(|p| column(p).collect()).collect()
    }

    #[test]
    fn products_are_those_of_whole_columns_in_another_order() {
        let n = 20_000;
        let (us, vs) = (columns(n, 0), columns(n, 1));
        let whole = us.iter().zip(&vs);
        let pairs: Vec<Pair<f64>> = whole
            .map(|(u, v)| Pair::new(u.iter().copied(), v.iter().copied()))
            .collect();
        assert!(pairs.iter().all(|p| p.u.rows.len() + p.v.rows.len() < n));
        let order = Order::from_old((0..n).map(|i| ((i * 123 + 7) % n) as u32).collect());
        let scale: Vec<f64> = (0..n).map(|i| (1 + i % 2) as f64).collect();
        let ties = Ties::new(&pairs, &order, &scale);
        let (rows, shift) = (Rows::gathered(n, 1.0, |_, _| {}), vec![0.0; n]);
        let sparse = Shifted {
            rows: &rows,
            shift: &shift,
        };
        let x: Vec<[f64; 2]> = (0..n).map(|i| [(i % 13) as f64, (i % 17) as f64]).collect();
        let mut y = vec![[0.0; 2]; n];
        LowRank {
            sparse: &sparse,
            ties: &ties,
        }
        .apply(&x, &mut y);
        // Whole numbers: exact in any order.
        let mut exact = x.clone();
        for (u, v) in us.iter().zip(&vs) {
            let mut sums = [0.0; 2];
            for (k, x) in x.iter().enumerate() {
                let v = v[order.old_of(k)];
                sums = [sums[0] + v * x[0], sums[1] + v * x[1]];
            }
            for (k, exact) in exact.iter_mut().enumerate() {
                let u = u[order.old_of(k)] * scale[k];
                *exact = [exact[0] + u * sums[0], exact[1] + u * sums[1]];
            }
        }
        assert_eq!(y, exact);
        for k in 0..n {
            let there = us.iter().any(|u| u[order.old_of(k)] != 0.0);
            assert_eq!(ties.reach(k), there);
        }
    }
}
