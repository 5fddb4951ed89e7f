//! Inverses of the matrix of the normal equations.

use nalgebra::{DMatrix, DVector};

use crate::basis::TERMS;
use crate::moments::Coefficients;

/// Rounds of inverse iteration that estimate the least singular value.
const ROUNDS: usize = 3;
/// Singular values below this part of the greatest are taken for zero.
const ZERO: f64 = 1e-9;
/// A pivot of a matrix with unit diagonal below this is no pivot.
const LEAST_PIVOT: f64 = 1e-13;

/// A factorisation of G = A^T A, A the weighted matrix of the fit with columns of length 1.
#[derive(Debug, Clone)]
pub(crate) enum Factor {
    /// G = U^T U, rows of U; by Cholesky or by the orthogonal triangularisation of A.
    Triangle(Box<[Coefficients; TERMS]>),
    /// Right singular vectors, by columns, and the inverse squares of the values that are not zero.
    Spectrum(DMatrix<f64>, Vec<f64>),
}

/// Cholesky's factor from the lower triangle of `gram`; none where G is not positive to rounding.
pub(crate) fn cholesky(
    gram: &[Coefficients; TERMS],
    many: usize,
    upper: &mut [Coefficients; TERMS],
) -> bool {
    for i in 0..many {
        for j in i..many {
            upper[i][j] = gram[j][i];
        }
    }
    for k in 0..many {
        let pivot = upper[k][k];
        if pivot.is_nan() || pivot <= LEAST_PIVOT {
            return false;
        }
        let inverse = pivot.sqrt().recip();
        for entry in &mut upper[k][k..many] {
            *entry *= inverse;
        }
        let (above, below) = upper.split_at_mut(k + 1);
        let row = &above[k];
        for (i, other) in below.iter_mut().enumerate().take(many - k - 1) {
            let i = i + k + 1;
            let factor = row[i];
            for (entry, own) in other[i..many].iter_mut().zip(&row[i..many]) {
                *entry -= factor * own;
            }
        }
    }
    true
}

/// R of A = Q R: as Cholesky's factor, without the loss of half the digits.
pub(crate) fn triangular(a: DMatrix<f64>, upper: &mut [Coefficients; TERMS]) -> bool {
    let r = a.qr().r();
    let many = r.ncols();
    if r.nrows() < many {
        return false;
    }
    for i in 0..many {
        if r[(i, i)].is_nan() || r[(i, i)].abs() <= ZERO {
            return false;
        }
        for j in i..many {
            upper[i][j] = r[(i, j)];
        }
    }
    true
}

/// The spectrum of A, zeros left out, and the ratio of the greatest singular value to the least.
pub(crate) fn spectrum(a: DMatrix<f64>) -> Option<(Factor, f64)> {
    let many = a.ncols();
    let a = if a.nrows() < many {
        let missing = many - a.nrows();
        a.insert_rows(many - missing, missing, 0.0)
    } else {
        a
    };
    let svd = a.try_svd(false, true, f64::EPSILON, 1000)?;
    let greatest = svd.singular_values.max();
    let least = svd.singular_values.min();
    let inverse = svd
        .singular_values
        .iter()
        .map(|&s| {
            if s > ZERO * greatest {
                (s * s).recip()
            } else {
                0.0
            }
        })
        .collect();
    let vectors = svd.v_t?.transpose();
    Some((Factor::Spectrum(vectors, inverse), greatest / least))
}

/// Solves U^T U x = x in place.
pub(crate) fn solve(upper: &[Coefficients; TERMS], many: usize, x: &mut Coefficients) {
    for k in 0..many {
        let row = &upper[k];
        let value = x[k] / row[k];
        x[k] = value;
        for (open, u) in x[k + 1..many].iter_mut().zip(&row[k + 1..many]) {
            *open -= u * value;
        }
    }
    for k in (0..many).rev() {
        let row = &upper[k];
        let known: f64 = x[k + 1..many]
            .iter()
            .zip(&row[k + 1..many])
            .map(|(x, u)| x * u)
            .sum();
        x[k] = (x[k] - known) / row[k];
    }
}

impl Factor {
    /// G^-1 x, in place.
    pub(crate) fn solve(&self, many: usize, x: &mut Coefficients) {
        match self {
            Self::Triangle(upper) => solve(upper, many, x),
            Self::Spectrum(vectors, inverse) => {
                let right = DVector::from_column_slice(&x[..many]);
                let mut parts = vectors.tr_mul(&right);
                for (part, factor) in parts.iter_mut().zip(inverse) {
                    *part *= factor;
                }
                x[..many].copy_from_slice((vectors * parts).as_slice());
            }
        }
    }
}

/// Condition number of A from its triangle, by inverse iteration from the column of the least
/// pivot: a little low, as every such estimate. Columns of A have length 1.
pub(crate) fn condition(upper: &[Coefficients; TERMS], many: usize) -> f64 {
    let mut least = 0;
    for k in 1..many {
        if upper[k][k].abs() < upper[least][least].abs() {
            least = k;
        }
    }
    let mut x = [0.0; TERMS];
    x[least] = 1.0;
    let mut growth = 1.0;
    for _ in 0..ROUNDS {
        solve(upper, many, &mut x);
        growth = x[..many].iter().map(|v| v * v).sum::<f64>().sqrt();
        for v in &mut x[..many] {
            *v /= growth;
        }
    }
    // The greatest eigenvalue of G lies between 1 and its trace.
    (growth * (many as f64).sqrt()).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(epsilon: f64) -> DMatrix<f64> {
        let mut a = DMatrix::from_fn(12, 5, |i, j| ((1 + i * (j + 2)) as f64).sin());
        for i in 0..12 {
            a[(i, 4)] = a[(i, 3)] + epsilon * (i as f64).cos();
        }
        for mut column in a.column_iter_mut() {
            let length = column.norm();
            column /= length;
        }
        a
    }

    fn gram(a: &DMatrix<f64>) -> Box<[Coefficients; TERMS]> {
        let product = a.tr_mul(a);
        let mut gram = Box::new([[0.0; TERMS]; TERMS]);
        for i in 0..5 {
            for j in 0..5 {
                gram[i][j] = product[(i, j)];
            }
        }
        gram
    }

    #[test]
    fn all_three_factors_give_one_solution() {
        let a = matrix(0.1);
        let gram = gram(&a);
        let mut upper = Box::new([[0.0; TERMS]; TERMS]);
        assert!(cholesky(&gram, 5, &mut upper));
        let exact = a.clone().svd(false, false).singular_values;
        let ratio = exact.max() / exact.min();
        let found = condition(&upper, 5);
        assert!(
            found > 0.5 * ratio && found < 3.0 * ratio,
            "{found} {ratio}"
        );
        let mut right = [0.0; TERMS];
        right[..5].copy_from_slice(&[1.0, -2.0, 0.5, 3.0, 0.1]);
        let mut first = right;
        solve(&upper, 5, &mut first);
        assert!(triangular(a.clone(), &mut upper));
        let mut second = right;
        Factor::Triangle(upper).solve(5, &mut second);
        let mut third = right;
        spectrum(a).unwrap().0.solve(5, &mut third);
        for k in 0..5 {
            assert!((first[k] - second[k]).abs() < 1e-9 * first[k].abs());
            assert!((first[k] - third[k]).abs() < 1e-9 * first[k].abs());
        }
    }

    #[test]
    fn dependent_columns_are_told() {
        let a = matrix(0.0);
        let mut upper = Box::new([[0.0; TERMS]; TERMS]);
        assert!(!cholesky(&gram(&a), 5, &mut upper));
        let (factor, ratio) = spectrum(a).unwrap();
        assert!(ratio > 1e12);
        let Factor::Spectrum(_, inverse) = factor else {
            panic!("a spectrum was asked for");
        };
        assert_eq!(inverse.iter().filter(|v| **v == 0.0).count(), 1);
    }
}
