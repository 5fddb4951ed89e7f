//! Algebraic multigrid by aggregation, as a preconditioner.
//!
//! Rows are joined by double pairwise aggregation with a check of quality; on each coarser level
//! one or two steps of a Krylov method, preconditioned by the cycle of that level, correct what
//! the piecewise constant interpolation gets wrong (K-cycle: Notay 2010, Electron. Trans. Numer.
//! Anal. 37, 123; Napov and Notay 2012; Notay 2012). One forward Gauss-Seidel sweep before and one
//! backward sweep after keep the cycle symmetric.

mod coarse;
mod dense;
mod groups;
mod quality;
mod rows;
mod view;

use crate::jacobi::positive;
use crate::sums::{add_norm, dot, update};
use crate::{Error, Inverse, Operator, Sparse};
use coarse::Groups;
use dense::Dense;
use rows::{Balance, Rows};
use view::{Graph, View};

/// A matrix of at most this many rows is factorised.
const COARSEST: usize = 96;
/// A second step on the coarse level is not needed if the first left this share of the residual.
const ENOUGH: f64 = 0.25;
/// Two steps on the coarse level only if it has at most this share of couplings.
const TWICE: f64 = 0.5;

/// One matrix, its groups, and the vectors of the next coarser level.
#[derive(Debug, Clone, Default)]
struct Level {
    rows: Rows,
    groups: Groups,
    x: Vec<f64>,
    twice: bool,
    rhs: Vec<f64>,
    first: [Vec<f64>; 2],
    second: [Vec<f64>; 2],
}

/// A hierarchy of ever coarser matrices.
#[derive(Debug, Clone, Default)]
pub struct Aggregation {
    symmetric: bool,
    n: usize,
    /// Power of two that brings the largest diagonal near one, in reach of single precision.
    scale: f64,
    levels: Vec<Level>,
    /// The coarsest matrix, as it is factorised.
    last: Rows,
    bottom: Dense,
    /// Balances of a fine and of a coarse matrix, for [`Self::renew`].
    balances: [Balance; 2],
}

impl Aggregation {
    /// Builds the hierarchy of `a`. For a matrix that is not `symmetric` the steps on coarse levels
    /// minimise the residual instead of the energy.
    ///
    /// # Errors
    /// When a diagonal is not positive, a coefficient is no number, or rows hang together without
    /// anything that fixes their level.
    pub fn new(a: &Sparse, symmetric: bool) -> Result<Self, Error> {
        let mut new = Self {
            symmetric,
            n: a.len(),
            ..Self::default()
        };
        let (mut rows, mut balance) = (Rows::default(), Balance::default());
        new.take(a, &mut rows, &mut balance)?;
        while rows.len() > COARSEST {
            let (of, count) = if symmetric {
                groups::form(View::Rows(&rows, &balance))
            } else {
                let graph = Graph::of(&rows, &balance);
                groups::form(View::Part(&graph, &balance))
            };
            let mut groups = Groups::new(of, count);
            let (mut coarse, mut sums) = (Rows::default(), Balance::default());
            groups.sum(&rows, &balance, &mut coarse, &mut sums)?;
            let zeros = || vec![0.0; count];
            new.levels.push(Level {
                x: vec![0.0; rows.len()],
                twice: coarse.entries() as f64 <= TWICE * rows.entries() as f64,
                rows,
                groups,
                rhs: zeros(),
                first: [zeros(), zeros()],
                second: [zeros(), zeros()],
            });
            (rows, balance) = (coarse, sums);
        }
        new.bottom.factorise(&rows, &balance)?;
        new.last = rows;
        Ok(new)
    }

    /// Takes new coefficients of a matrix of the same size; groups stay as they are, unless many
    /// rows have lost the strong diagonal that kept them out of all groups (a time step that grew):
    /// then all is built anew, and the answer is true. After other great changes, [`Self::new`] may
    /// save iterations.
    ///
    /// # Errors
    /// As for [`Self::new`], and when the number of rows differs. The hierarchy is then not fit for
    /// use until it has been renewed.
    pub fn renew(&mut self, a: &Sparse) -> Result<bool, Error> {
        if a.len() != self.n {
            return Err(Error::Size {
                expected: self.n,
                found: a.len(),
            });
        }
        let [mut balance, mut sums] = std::mem::take(&mut self.balances);
        let top = self.levels.first_mut().map(|level| &mut level.rows);
        let mut rows = std::mem::take(top.unwrap_or(&mut self.last));
        self.take(a, &mut rows, &mut balance)?;
        for k in 0..self.levels.len() {
            let (fine, rest) = self.levels.split_at_mut(k + 1);
            let level = &mut fine[k];
            if level.groups.outgrown(&balance) {
                *self = Self::new(a, self.symmetric)?;
                return Ok(true);
            }
            let next = rest.first_mut().map(|level| &mut level.rows);
            let mut coarse = std::mem::take(next.unwrap_or(&mut self.last));
            level.groups.sum(&rows, &balance, &mut coarse, &mut sums)?;
            level.rows = rows;
            rows = coarse;
            std::mem::swap(&mut balance, &mut sums);
        }
        self.bottom.factorise(&rows, &balance)?;
        self.last = rows;
        self.balances = [balance, sums];
        Ok(false)
    }

    /// The finest matrix.
    fn take(&mut self, a: &Sparse, rows: &mut Rows, balance: &mut Balance) -> Result<(), Error> {
        positive(a.diagonal())?;
        let largest = a.diagonal().iter().fold(0.0, |m, d| f64::max(m, *d));
        self.scale = (-largest.max(f64::MIN_POSITIVE).log2().round()).exp2();
        rows.copy(a, self.scale, balance)
    }

    /// Number of matrices, the given one included.
    #[must_use]
    pub fn levels(&self) -> usize {
        self.levels.len() + 1
    }

    /// Couplings on all levels per coupling of the given matrix.
    #[must_use]
    pub fn complexity(&self) -> f64 {
        let entries = |level: &Level| level.rows.entries() as f64;
        let all: f64 = self.levels.iter().map(entries).sum();
        all / self.levels.first().map_or(1.0, entries).max(1.0)
    }

    /// Memory held \[B\].
    #[must_use]
    pub fn bytes(&self) -> usize {
        let of = |level: &Level| {
            let vectors = [&level.first, &level.second].into_iter().flatten();
            let numbers: usize = vectors.map(Vec::capacity).sum();
            let numbers = numbers + level.x.capacity() + level.rhs.capacity();
            8 * numbers + level.rows.bytes() + level.groups.bytes()
        };
        self.levels.iter().map(of).sum::<usize>() + self.last.bytes() + self.bottom.bytes()
    }
}

impl Inverse<f64> for Aggregation {
    /// One cycle.
    fn invert(&mut self, rhs: &[[f64; 1]], out: &mut [[f64; 1]]) {
        let (rhs, out) = (rhs.as_flattened(), out.as_flattened_mut());
        let cycle = Cycle {
            symmetric: self.symmetric,
            bottom: &self.bottom,
        };
        cycle.run(&mut self.levels, self.scale, rhs, out);
        if self.levels.is_empty() {
            out.iter_mut().for_each(|x| *x *= self.scale);
        }
    }
}

struct Cycle<'a> {
    symmetric: bool,
    bottom: &'a Dense,
}

impl Cycle<'_> {
    fn run(&self, levels: &mut [Level], scale: f64, rhs: &[f64], out: &mut [f64]) {
        let Some((level, rest)) = levels.split_first_mut() else {
            self.bottom.solve(rhs, out);
            return;
        };
        level.rows.forward(scale, rhs, &mut level.x);
        if level.groups.len() > 0 {
            // The result's place serves as scratch.
            level.rows.left_out(&level.x, out);
            level.groups.restrict(out, &mut level.rhs);
            self.correct(level, rest);
            level.groups.prolong(&level.first[0], &mut level.x);
        }
        level.rows.backward(scale, rhs, &level.x, out);
    }

    /// Solves the equation of the next level, roughly, into `first[0]`: at most two steps
    /// (Notay 2010, algorithm 3.2).
    fn correct(&self, level: &mut Level, rest: &mut [Level]) {
        let Level {
            rhs: r,
            first: [c, v],
            second: [d, w],
            ..
        } = level;
        self.run(rest, 1.0, r, c);
        let Some(next) = rest.first_mut() else {
            return;
        };
        next.rows.product(r, c, &mut next.x, v);
        let symmetric = self.symmetric;
        let against = |c: &[f64], v: &[f64], with: &[f64]| dot(if symmetric { c } else { v }, with);
        let size = dot(r, r);
        let rho = against(c, v, v);
        if rho.is_nan() || rho <= 0.0 {
            return;
        }
        let t = against(c, v, r) / rho;
        let left = add_norm(r, -t, v);
        if !level.twice || left <= ENOUGH * ENOUGH * size {
            c.iter_mut().for_each(|c| *c *= t);
            return;
        }
        self.run(rest, 1.0, r, d);
        if let Some(next) = rest.first_mut() {
            next.rows.product(r, d, &mut next.x, w);
        }
        let gamma = against(d, w, v);
        let rho2 = against(d, w, w) - gamma * gamma / rho;
        let t2 = if rho2 > 0.0 {
            against(d, w, r) / rho2
        } else {
            0.0
        };
        let t1 = t - t2 * gamma / rho;
        update(c, d, |c, d| {
            for (c, d) in c.iter_mut().zip(d) {
                *c = t1 * *c + t2 * d;
            }
            0.0
        });
    }
}
