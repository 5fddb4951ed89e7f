//! Operators and approximate inverses, for all methods: rows, rows with a diagonal of their own.

use crate::columns::{add, dot};
use crate::{Coefficient, Rows, Scalar};

/// A square linear operator on `C` columns of numbers `S`; one that knows a single column alone is an `Operator<S>`.
pub trait Operator<S: Scalar, const C: usize = 1>: Sync {
    /// Number of unknowns.
    fn len(&self) -> usize;

    /// No unknowns at all.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// `out = A x`, each column alone.
    fn apply(&self, x: &[[S; C]], out: &mut [[S; C]]);

    /// Euclidean norm of the rounding errors of [`Self::apply`], about: no residual can be made
    /// smaller. Zero where it is not known.
    fn rounding(&self, _x: &[[S; C]]) -> f64 {
        0.0
    }
}

/// The equations `A x = b`.
pub(crate) struct Equations<'a, A, S, const C: usize> {
    pub(crate) a: &'a A,
    pub(crate) b: &'a [[S; C]],
}

/// The operator after the approximate inverse: `A M^-1`.
pub(crate) struct Preconditioned<'a, A, M, S, const C: usize> {
    pub(crate) a: &'a A,
    pub(crate) inverse: &'a mut M,
    /// What the inverse makes of a vector.
    pub(crate) z: &'a mut [[S; C]],
}

impl<A, M, S: Scalar, const C: usize> Preconditioned<'_, A, M, S, C>
where
    A: Operator<S, C>,
    M: Inverse<S, C>,
{
    /// `out = A M^-1 v`.
    pub(crate) fn apply(&mut self, v: &[[S; C]], out: &mut [[S; C]]) {
        self.inverse.invert(v, self.z);
        self.a.apply(self.z, out);
    }

    /// `x += M^-1 y`.
    pub(crate) fn correct(&mut self, x: &mut [[S; C]], y: &[[S; C]]) {
        self.inverse.invert(y, self.z);
        add(x, [S::ONE; C], self.z);
    }
}

/// Numbers as one column.
pub(crate) fn column(x: &[f64]) -> &[[f64; 1]] {
    x.as_chunks().0
}

/// Numbers as one column.
pub(crate) fn column_mut(x: &mut [f64]) -> &mut [[f64; 1]] {
    x.as_chunks_mut().0
}

impl<S: Scalar, T: Coefficient<S>, const C: usize> Operator<S, C> for Rows<T> {
    fn len(&self) -> usize {
        Rows::len(self)
    }

    fn apply(&self, x: &[[S; C]], out: &mut [[S; C]]) {
        self.product(x, out, |_, sum, out| *out = sum);
    }
}

/// Rows and a diagonal beside them: a real Laplacian less `j omega mu sigma`.
#[derive(Debug, Clone, Copy)]
pub struct Shifted<'a, T, S> {
    /// The rows.
    pub rows: &'a Rows<T>,
    /// Added to the diagonal.
    pub shift: &'a [S],
}

impl<S: Scalar, T: Coefficient<S>, const C: usize> Operator<S, C> for Shifted<'_, T, S> {
    fn len(&self) -> usize {
        self.rows.len()
    }

    fn apply(&self, x: &[[S; C]], out: &mut [[S; C]]) {
        self.rows.product(x, out, |i, sum, out| {
            for c in 0..C {
                out[c] = sum[c] + self.shift[i] * x[i][c];
            }
        });
    }
}

/// An approximate inverse of an operator on `C` columns; linear and the same in each call, but where a method is flexible.
pub trait Inverse<S: Scalar, const C: usize = 1> {
    /// `out` becomes an approximate solution with `rhs` as the right side.
    fn invert(&mut self, rhs: &[[S; C]], out: &mut [[S; C]]);
}

/// No preconditioner.
#[derive(Debug, Clone, Copy, Default)]
pub struct Identity;

impl<S: Scalar, const C: usize> Inverse<S, C> for Identity {
    fn invert(&mut self, rhs: &[[S; C]], out: &mut [[S; C]]) {
        out.copy_from_slice(rhs);
    }
}

/// `r = b - A x`; the norm of each column.
pub(crate) fn residual<S: Scalar, const C: usize>(
    a: &impl Operator<S, C>,
    rhs: &[[S; C]],
    x: &[[S; C]],
    r: &mut [[S; C]],
) -> [f64; C] {
    a.apply(x, r);
    crate::columns::turn(r, [S::ONE; C], rhs);
    dot(r, r).map(|s| s.real_part().sqrt())
}
