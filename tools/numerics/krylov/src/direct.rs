//! Sparse triangular factors of a small system, by faer.

use crate::{Coefficient, Error, Inverse, Rows, Scalar};
use faer::MatMut;
use faer::linalg::solvers::SolveCore;
use faer::sparse::linalg::LuError;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};

/// `P A Q = L U` with partial pivoting and a column order that limits fill. faer runs it on one
/// thread: this crate builds it without threads, so the bits do not depend on their number.
#[derive(Debug, Clone)]
pub struct Direct<S> {
    factors: Lu<u32, S>,
    column: Vec<S>,
    n: usize,
}

impl<S: Scalar> Direct<S> {
    /// Factors of `rows + diag(shift)` (no shift: an empty slice).
    ///
    /// # Errors
    /// When the matrix is singular by its pattern, or memory does not suffice.
    pub fn new<T: Coefficient<S>>(rows: &Rows<T>, shift: &[S]) -> Result<Self, Error> {
        let n = rows.len();
        // Columns: those of the transpose are the rows, and faer wants columns.
        let mut starts = vec![0_u32; n + 1];
        for i in 0..n {
            for &j in rows.columns(i) {
                starts[j as usize + 1] += 1;
            }
        }
        for j in 0..n {
            starts[j + 1] += starts[j];
        }
        let mut next = starts.clone();
        let mut places = vec![0_u32; rows.entries()];
        let mut values = vec![S::ZERO; rows.entries()];
        for i in 0..n {
            for (j, v) in rows.pairs(i) {
                let at = next[j] as usize;
                next[j] += 1;
                places[at] = i as u32;
                values[at] = v.widened();
                if i == j
                    && let Some(shift) = shift.get(i)
                {
                    values[at] += *shift;
                }
            }
        }
        let pattern = SymbolicSparseColMat::new_checked(n, n, starts, None, places);
        let matrix = SparseColMat::new(pattern, values);
        let symbolic = SymbolicLu::try_new(matrix.symbolic()).map_err(|_| Error::Memory)?;
        let factors = Lu::try_new_with_symbolic(symbolic, matrix.as_ref());
        let factors = factors.map_err(|e| match e {
            LuError::SymbolicSingular { index } => Error::Singular { index },
            LuError::Generic(_) => Error::Memory,
        })?;
        Ok(Self {
            factors,
            column: vec![S::ZERO; n],
            n,
        })
    }
}

impl<S: Scalar, const C: usize> Inverse<S, C> for Direct<S> {
    fn invert(&mut self, rhs: &[[S; C]], out: &mut [[S; C]]) {
        for c in 0..C {
            for (column, rhs) in self.column.iter_mut().zip(rhs) {
                *column = rhs[c];
            }
            let column = MatMut::from_column_major_slice_mut(&mut self.column, self.n, 1);
            self.factors
                .solve_in_place_with_conj(faer::Conj::No, column);
            for (column, out) in self.column.iter().zip(&mut *out) {
                out[c] = *column;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_complex::Complex;

    #[test]
    fn complex_rows_are_solved_to_rounding_whatever_the_threads() {
        let n = 400;
        let rows = Rows::gathered(n, 0.0, |i, row| {
            row.push((i as u32, 0.1));
            row.extend([1, 20, 57].map(|k| (((i + k) % n) as u32, -1.0 - 0.3 * k as f64)));
        });
        let shift: Vec<Complex<f64>> = (0..n).map(|i| Complex::new(0.0, i as f64)).collect();
        let x: Vec<[Complex<f64>; 2]> = (0..n)
            .map(|i| {
                [
                    Complex::new(i as f64, 1.0),
                    Complex::new(0.0, (i % 3) as f64),
                ]
            })
            .collect();
        let mut rhs = x.clone();
        rows.product(&x, &mut rhs, |i, sum, out| {
            *out = [sum[0] + shift[i] * x[i][0], sum[1] + shift[i] * x[i][1]];
        });
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.unwrap().install(|| {
                let mut y = rhs.clone();
                Direct::new(&rows, &shift).unwrap().invert(&rhs, &mut y);
                y
            })
        };
        let y = with(1);
        for (x, y) in x.iter().zip(&y) {
            assert!((x[0] - y[0]).norm() + (x[1] - y[1]).norm() < 1e-9 * n as f64);
        }
        assert_eq!(y, with(3));
    }

    #[test]
    fn an_empty_column_is_singular() {
        let rows = Rows::gathered(3, 0.0, |i, row| row.push((0, 1.0 + i as f64)));
        let solved = Direct::<f64>::new(&rows, &[]).map(|mut d| {
            let mut out = [[0.0]; 3];
            d.invert(&[[1.0]; 3], &mut out);
            out
        });
        assert!(solved.is_err() || solved.unwrap().iter().any(|v| !v[0].is_finite()));
    }
}
