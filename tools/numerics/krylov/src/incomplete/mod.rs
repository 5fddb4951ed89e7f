//! Incomplete triangular factors, as a preconditioner.
//!
//! Rows are cut into slabs that do not touch and walls between them ([`Order::cuthill_mckee`]), so
//! that slabs are factorised and solved side by side, and then walls, without any change of the
//! result: the bits do not depend on the number of threads.

mod eliminate;
mod piece;

use crate::{Coefficient, Inverse, Order, Rows, Scalar};
use eliminate::{Eliminate, Zone};
use piece::Piece;
use rayon::prelude::*;

/// Which entries a factor keeps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Keep {
    /// Those of the matrix: ILU(0). The share `compensate` (0 to 1) of what is dropped goes to the
    /// diagonal (modified factors, Gustafsson 1978).
    Pattern {
        /// Share of what is dropped that goes to the diagonal.
        compensate: f64,
    },
    /// Those larger than `drop` times the mean modulus of their row, but no more than `fill` times
    /// as many as the matrix has, on each side of the diagonal: ILUT (Saad 1994).
    Threshold {
        /// Smallest entry kept, relative to the mean modulus of the row.
        drop: f64,
        /// Most entries kept, relative to those of the matrix.
        fill: f64,
    },
}

impl Keep {
    /// ILU(0).
    pub const PATTERN: Self = Self::Pattern { compensate: 0.0 };
}

/// `L U`, about the matrix; `F` is the kind of its coefficients: `f32` or `f64` (a complex diagonal
/// is then taken by its modulus), `Complex<f32>` or `Complex<f64>`.
#[derive(Debug, Clone)]
pub struct Incomplete<F> {
    slabs: Vec<Piece<F>>,
    walls: Vec<Piece<F>>,
    n: usize,
    weak: usize,
}

impl<F: Copy> Incomplete<F> {
    /// Factors of `rows + diag(shift)` (no shift: an empty slice), whose rows stand in the order
    /// `order`, from which only its slabs are taken.
    ///
    /// # Panics
    /// When the order is that of another number of rows.
    #[must_use]
    pub fn new<S: Scalar, T: Coefficient<S>>(
        rows: &Rows<T>,
        shift: &[S],
        order: &Order,
        keep: Keep,
    ) -> Self
    where
        F: Coefficient<S>,
    {
        let n = rows.len();
        assert!(order.len() == n, "an order of {} for {n} rows", order.len());
        let cut = order.slabs();
        let border = cut.slabs.last().map_or(n, |r| r.end);
        let job = Eliminate {
            rows,
            shift,
            keep,
            border,
        };
        let room = || job.work();
        let slabs: Vec<_> = cut.slabs.clone();
        let slabs: Vec<_> = slabs
            .into_par_iter()
            .map_init(room, |work, range| {
                job.run(work, &Zone { range, done: &[] })
            })
            .collect();
        let walls: Vec<_> = cut.walls.clone();
        let walls: Vec<_> = walls
            .into_par_iter()
            .map_init(room, |work, range| {
                let done = &slabs;
                job.run(work, &Zone { range, done })
            })
            .collect();
        let weak = slabs.iter().chain(&walls).map(|p| p.weak).sum();
        Self {
            slabs,
            walls,
            n,
            weak,
        }
    }

    /// Entries of both factors, diagonal included.
    #[must_use]
    pub fn entries(&self) -> usize {
        let pieces = self.slabs.iter().chain(&self.walls);
        self.n + pieces.map(Piece::entries).sum::<usize>()
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let pieces = self.slabs.iter().chain(&self.walls);
        pieces.map(Piece::bytes).sum()
    }

    /// Pivots that were too small and have been enlarged: several tell of a matrix that suits these
    /// factors ill.
    #[must_use]
    pub fn weak_pivots(&self) -> usize {
        self.weak
    }

    /// Largest entry of `(L U)^-1 1`: far above the size of a solution, the factors are unstable.
    #[must_use]
    pub fn growth<S: Scalar>(&self) -> f64
    where
        F: Coefficient<S>,
    {
        let mut out = vec![[S::ZERO; 1]; self.n];
        self.solve(&vec![[S::ONE; 1]; self.n], &mut out);
        out.iter().fold(0.0, |m: f64, v| {
            if v[0].finite() {
                m.max(v[0].modulus())
            } else {
                f64::INFINITY
            }
        })
    }

    /// `out = (L U)^-1 rhs`.
    pub fn solve<S: Scalar, const C: usize>(&self, rhs: &[[S; C]], out: &mut [[S; C]])
    where
        F: Coefficient<S>,
    {
        let border = self.n - self.walls.iter().map(Piece::len).sum::<usize>();
        let (inner, outer) = out.split_at_mut(border);
        let (below, beyond) = rhs.split_at(border);
        each(&self.slabs, inner, below, |piece, out, rhs| {
            piece.forward(rhs, &[], out);
        });
        each(&self.walls, outer, beyond, |piece, out, rhs| {
            piece.forward(rhs, inner, out);
            piece.backward(&[], out);
        });
        each(&self.slabs, inner, below, |piece, out, _| {
            piece.backward(outer, out);
        });
    }
}

/// Runs `work` on every piece with its part of the columns, on all threads.
fn each<F: Copy + Send + Sync, S: Scalar, const C: usize>(
    pieces: &[Piece<F>],
    out: &mut [[S; C]],
    rhs: &[[S; C]],
    work: impl Fn(&Piece<F>, &mut [[S; C]], &[[S; C]]) + Sync,
) {
    fn halve<F: Copy + Send + Sync, S: Scalar, const C: usize>(
        pieces: &[Piece<F>],
        out: &mut [[S; C]],
        rhs: &[[S; C]],
        work: &(impl Fn(&Piece<F>, &mut [[S; C]], &[[S; C]]) + Sync),
    ) {
        match pieces {
            [] => {}
            [piece] => work(piece, out, rhs),
            _ => {
                let (left, right) = pieces.split_at(pieces.len() / 2);
                let at = left.iter().map(Piece::len).sum();
                let (o0, o1) = out.split_at_mut(at);
                let (r0, r1) = rhs.split_at(at);
                rayon::join(|| halve(left, o0, r0, work), || halve(right, o1, r1, work));
            }
        }
    }
    halve(pieces, out, rhs, &work);
}

impl<S: Scalar, F: Coefficient<S>, const C: usize> Inverse<S, C> for Incomplete<F> {
    fn invert(&mut self, rhs: &[[S; C]], out: &mut [[S; C]]) {
        self.solve(rhs, out);
    }
}

#[cfg(test)]
mod tests;
