//! Matrices of 3 by 3 numbers, by rows.

/// A matrix by rows.
pub type Matrix = [[f64; 3]; 3];

/// The unit matrix.
pub const UNIT: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Determinant.
#[inline(always)]
#[must_use]
pub fn determinant(a: &Matrix) -> f64 {
    let c = cofactor(a);
    a[0][0] * c[0][0] + a[0][1] * c[0][1] + a[0][2] * c[0][2]
}

/// det(A) A^-T.
#[inline(always)]
#[must_use]
pub fn cofactor(a: &Matrix) -> Matrix {
    let minor = |r: usize, c: usize| {
        let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
        a[r1][c1] * a[r2][c2] - a[r1][c2] * a[r2][c1]
    };
    [
        [minor(0, 0), minor(0, 1), minor(0, 2)],
        [minor(1, 0), minor(1, 1), minor(1, 2)],
        [minor(2, 0), minor(2, 1), minor(2, 2)],
    ]
}

/// A B^T.
#[inline(always)]
#[must_use]
pub fn times_transposed(a: &Matrix, b: &Matrix) -> Matrix {
    a.map(|row| b.map(|other| row[0] * other[0] + row[1] * other[1] + row[2] * other[2]))
}

/// A B.
#[inline(always)]
#[must_use]
pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    a.map(|row| std::array::from_fn(|j| row[0] * b[0][j] + row[1] * b[1][j] + row[2] * b[2][j]))
}

/// A^T B.
#[inline(always)]
#[must_use]
pub fn transposed_times(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| a[0][i] * b[0][j] + a[1][i] * b[1][j] + a[2][i] * b[2][j])
    })
}

/// A : B.
#[inline(always)]
#[must_use]
pub fn inner(a: &Matrix, b: &Matrix) -> f64 {
    (0..3)
        .map(|k| a[k][0] * b[k][0] + a[k][1] * b[k][1] + a[k][2] * b[k][2])
        .sum()
}

/// Trace.
#[inline(always)]
#[must_use]
pub fn trace(a: &Matrix) -> f64 {
    a[0][0] + a[1][1] + a[2][2]
}

/// Eigenvalues of a symmetric matrix, in falling order (Smith 1961).
#[must_use]
pub fn eigenvalues(a: &Matrix) -> [f64; 3] {
    let mean = trace(a) / 3.0;
    let off = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
    let square = |k: usize| (a[k][k] - mean) * (a[k][k] - mean);
    let spread = ((square(0) + square(1) + square(2) + 2.0 * off) / 6.0).sqrt();
    if spread <= f64::MIN_POSITIVE {
        return [mean; 3];
    }
    let mut b = *a;
    for (k, row) in b.iter_mut().enumerate() {
        row[k] -= mean;
        row.iter_mut().for_each(|x| *x /= spread);
    }
    let angle = (0.5 * determinant(&b)).clamp(-1.0, 1.0).acos() / 3.0;
    let third = 2.0 * std::f64::consts::FRAC_PI_3;
    let first = mean + 2.0 * spread * angle.cos();
    let last = mean + 2.0 * spread * (angle + third).cos();
    [first, 3.0 * mean - first - last, last]
}

/// Eigenvalues of a symmetric matrix and their axes, as columns (Jacobi's turns).
#[must_use]
pub fn eigenvectors(a: &Matrix) -> ([f64; 3], Matrix) {
    let (mut a, mut axes) = (*a, UNIT);
    let scale = inner(&a, &a);
    for _ in 0..30 {
        let off = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
        if off <= 1e-32 * scale {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q].abs() > 0.0 {
                let ratio = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = ratio.signum() / (ratio.abs() + ratio.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = t * c;
                for row in [&mut a, &mut axes] {
                    for x in row.iter_mut() {
                        (x[p], x[q]) = (c * x[p] - s * x[q], s * x[p] + c * x[q]);
                    }
                }
                let (x, y) = (a[p], a[q]);
                for k in 0..3 {
                    (a[p][k], a[q][k]) = (c * x[k] - s * y[k], s * x[k] + c * y[k]);
                }
            }
        }
    }
    ([a[0][0], a[1][1], a[2][2]], axes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvalues_of_a_turned_diagonal() {
        let (s, c) = 0.7_f64.sin_cos();
        let turn = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]];
        let scaled = [[3.0 * c, -s, 0.0], [3.0 * s, c, 0.0], [0.0, 0.0, -2.0]];
        let found = eigenvalues(&times_transposed(&scaled, &turn));
        for (found, expected) in found.iter().zip([3.0, 1.0, -2.0]) {
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
        assert!(eigenvalues(&UNIT).iter().all(|x| (x - 1.0).abs() < 1e-15));
    }

    #[test]
    fn a_matrix_is_the_sum_of_its_axes() {
        let a = [[2.0, 0.3, -0.1], [0.3, 1.5, 0.4], [-0.1, 0.4, 0.9]];
        let (values, axes) = eigenvectors(&a);
        for i in 0..3 {
            for j in 0..3 {
                let sum: f64 = (0..3).map(|k| values[k] * axes[i][k] * axes[j][k]).sum();
                assert!((sum - a[i][j]).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn the_cofactor_is_the_inverse_times_the_determinant() {
        let a = [[2.0, 0.3, -0.1], [0.2, 1.5, 0.4], [0.0, -0.6, 0.9]];
        let product = times_transposed(&a, &cofactor(&a));
        let det = determinant(&a);
        for (i, row) in product.iter().enumerate() {
            for (j, found) in row.iter().enumerate() {
                let expected = if i == j { det } else { 0.0 };
                assert!((found - expected).abs() < 1e-14);
            }
        }
    }
}
