//! What this crate compiles a system for.

use crate::{Error, Options, Pair, Rows, Rule, Scalar, Solved, System};
use num_complex::Complex;

/// Unknowns that a [`System`] with coefficients `T` can be solved for. This crate compiles the
/// solvers for each of them, so that crates that use a system need not.
pub trait Unknown<T: Scalar>: Scalar {
    #[doc(hidden)]
    fn made(
        rows: Rows<T>,
        shift: Vec<Self>,
        low: Option<Rows<T>>,
        options: Options,
    ) -> Result<System<T, Self>, Error>;

    #[doc(hidden)]
    fn one(system: &mut System<T, Self>, sides: Sides<Self, 1>, rule: Rule) -> Solved;

    #[doc(hidden)]
    fn three(system: &mut System<T, Self>, sides: Sides<Self, 3>, rule: Rule) -> Solved;
}

/// What a solve adds to the matrix, its right sides, and its guesses, which become solutions.
#[derive(Debug)]
pub struct Sides<'a, S, const C: usize> {
    pub(crate) pairs: &'a [Pair<S>],
    pub(crate) right: &'a [[S; C]],
    pub(crate) solution: &'a mut [[S; C]],
}

impl<'a, S, const C: usize> Sides<'a, S, C> {
    /// From sides whose columns follow each other row by row.
    pub(crate) fn new(pairs: &'a [Pair<S>], right: &'a [S], x: &'a mut [S]) -> Self {
        Self {
            pairs,
            right: right.as_chunks().0,
            solution: x.as_chunks_mut().0,
        }
    }
}

/// Compiles the solvers.
macro_rules! unknowns {
    ($(($coefficient:ty, $unknown:ty)),*) => {$(
        impl Unknown<$coefficient> for $unknown {
            fn made(
                rows: Rows<$coefficient>,
                shift: Vec<Self>,
                low: Option<Rows<$coefficient>>,
                options: Options,
            ) -> Result<System<$coefficient, Self>, Error> {
                System::build(rows, shift, low, options)
            }

            fn one(
                system: &mut System<$coefficient, Self>,
                sides: Sides<Self, 1>,
                rule: Rule,
            ) -> Solved {
                system.solve_columns(sides, rule)
            }

            fn three(
                system: &mut System<$coefficient, Self>,
                sides: Sides<Self, 3>,
                rule: Rule,
            ) -> Solved {
                system.solve_columns(sides, rule)
            }
        }
    )*};
}

unknowns!(
    (f64, f64),
    (f64, Complex<f64>),
    (Complex<f64>, Complex<f64>)
);
