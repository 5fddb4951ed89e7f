//! Operators on several columns at once: rows, rows with a diagonal of their own.

use crate::columns::dot;
use crate::{Coefficient, Rows, Scalar};

/// A square linear operator on columns of numbers `S`.
pub trait Operator<S: Scalar>: Sync {
    /// Number of unknowns.
    fn len(&self) -> usize;

    /// No unknowns at all.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// `out = A x`, each column alone.
    fn apply<const C: usize>(&self, x: &[[S; C]], out: &mut [[S; C]]);
}

impl<S: Scalar, T: Coefficient<S>> Operator<S> for Rows<T> {
    fn len(&self) -> usize {
        Rows::len(self)
    }

    fn apply<const C: usize>(&self, x: &[[S; C]], out: &mut [[S; C]]) {
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

impl<S: Scalar, T: Coefficient<S>> Operator<S> for Shifted<'_, T, S> {
    fn len(&self) -> usize {
        self.rows.len()
    }

    fn apply<const C: usize>(&self, x: &[[S; C]], out: &mut [[S; C]]) {
        self.rows.product(x, out, |i, sum, out| {
            for c in 0..C {
                out[c] = sum[c] + self.shift[i] * x[i][c];
            }
        });
    }
}

/// An approximate inverse of an operator on several columns at once; linear, the same in each call.
pub trait Inverse<S: Scalar> {
    /// `out` becomes an approximate solution with `rhs` as the right side.
    fn invert<const C: usize>(&mut self, rhs: &[[S; C]], out: &mut [[S; C]]);
}

/// No preconditioner.
#[derive(Debug, Clone, Copy, Default)]
pub struct Identity;

impl<S: Scalar> Inverse<S> for Identity {
    fn invert<const C: usize>(&mut self, rhs: &[[S; C]], out: &mut [[S; C]]) {
        out.copy_from_slice(rhs);
    }
}

/// `r = b - A x`; the norm of each column.
pub(crate) fn residual<S: Scalar, const C: usize>(
    a: &impl Operator<S>,
    rhs: &[[S; C]],
    x: &[[S; C]],
    r: &mut [[S; C]],
) -> [f64; C] {
    a.apply(x, r);
    crate::columns::turn(r, [S::ONE; C], rhs);
    dot(r, r).map(|s| s.real_part().sqrt())
}
