//! Arithmetic of vectors with several columns side by side: entry `[i][c]` is row `i` of column
//! `c`. Sums are made per chunk of rows and the chunks are added in order; the size of a chunk
//! depends on the number of rows alone, so the bits do not depend on the number of threads.

use crate::Scalar;
use rayon::prelude::*;
use std::ops::Range;

/// Most chunks of a vector.
const CHUNKS: usize = 64;
/// Least rows of a chunk.
const LEAST: usize = 2048;
/// A vector of fewer rows is not worth waking a thread.
const WORTH: usize = 3 * LEAST;

/// Rows per chunk.
pub(crate) fn chunk(n: usize) -> usize {
    n.div_ceil(CHUNKS).max(LEAST)
}

/// Sums what `each` returns for the chunks of `0..n`.
pub(crate) fn sum<S: Scalar, const C: usize, const K: usize>(
    n: usize,
    each: impl Fn(Range<usize>) -> [[S; C]; K] + Sync,
) -> [[S; C]; K] {
    let size = chunk(n);
    let mut partial = [[[S::ZERO; C]; K]; CHUNKS];
    let part = |(m, part): (usize, &mut [[S; C]; K])| {
        let (from, to) = ((m * size).min(n), ((m + 1) * size).min(n));
        if from < to {
            *part = each(from..to);
        }
    };
    if n < WORTH {
        partial.iter_mut().enumerate().for_each(part);
    } else {
        partial.par_iter_mut().enumerate().for_each(part);
    }
    let mut total = [[S::ZERO; C]; K];
    for part in partial {
        for (total, part) in total.iter_mut().zip(part) {
            for (total, part) in total.iter_mut().zip(part) {
                *total += part;
            }
        }
    }
    total
}

/// `sum += conj(a) b`, column by column.
pub(crate) fn gather<S: Scalar, const C: usize>(sum: &mut [S; C], a: &[S; C], b: &[S; C]) {
    for c in 0..C {
        sum[c] += a[c].conjugate() * b[c];
    }
}

/// `a* b` of each column.
pub(crate) fn dot<S: Scalar, const C: usize>(a: &[[S; C]], b: &[[S; C]]) -> [S; C] {
    let [sums] = sum(a.len(), |rows| {
        let mut sum = [S::ZERO; C];
        for (a, b) in a[rows.clone()].iter().zip(&b[rows]) {
            gather(&mut sum, a, b);
        }
        [sum]
    });
    sums
}

/// Euclidean norm of each column.
pub(crate) fn norms<S: Scalar, const C: usize>(a: &[[S; C]]) -> [f64; C] {
    dot(a, a).map(|s| s.real_part().sqrt())
}

/// Runs `each` on every chunk of `y` with the rows it holds.
pub(crate) fn update<S: Scalar, const C: usize>(
    y: &mut [[S; C]],
    each: impl Fn(Range<usize>, &mut [[S; C]]) + Sync,
) {
    let (n, size) = (y.len(), chunk(y.len()));
    let part = |(m, y): (usize, &mut [[S; C]])| each(m * size..m * size + y.len(), y);
    if n < WORTH {
        y.chunks_mut(size).enumerate().for_each(part);
    } else {
        y.par_chunks_mut(size).enumerate().for_each(part);
    }
}

/// `y += a x`, a factor for each column.
pub(crate) fn add<S: Scalar, const C: usize>(y: &mut [[S; C]], a: [S; C], x: &[[S; C]]) {
    update(y, |rows, y| {
        for (y, x) in y.iter_mut().zip(&x[rows]) {
            for c in 0..C {
                y[c] += a[c] * x[c];
            }
        }
    });
}

/// `y += a x + b z`.
pub(crate) fn add_two<S: Scalar, const C: usize>(
    y: &mut [[S; C]],
    a: [S; C],
    x: &[[S; C]],
    b: [S; C],
    z: &[[S; C]],
) {
    update(y, |rows, y| {
        for ((y, x), z) in y.iter_mut().zip(&x[rows.clone()]).zip(&z[rows]) {
            for c in 0..C {
                y[c] += a[c] * x[c] + b[c] * z[c];
            }
        }
    });
}

/// `y = x - b y`.
pub(crate) fn turn<S: Scalar, const C: usize>(y: &mut [[S; C]], b: [S; C], x: &[[S; C]]) {
    update(y, |rows, y| {
        for (y, x) in y.iter_mut().zip(&x[rows]) {
            for c in 0..C {
                y[c] = x[c] - b[c] * y[c];
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_complex::Complex;

    #[test]
    fn columns_do_not_mix_and_bits_know_no_threads() {
        let n = 50_000;
        let value = |i: usize, c: usize| {
            Complex::new(((i * 7 + c) % 11) as f64 - 5.0, ((i + 3 * c) % 5) as f64)
        };
        let a: Vec<[Complex<f64>; 3]> = (0..n).map(|i| [0, 1, 2].map(|c| value(i, c))).collect();
        let b: Vec<[Complex<f64>; 3]> = (0..n).map(|i| [5, 1, 0].map(|c| value(i, c))).collect();
        let found = dot(&a, &b);
        for c in 0..3 {
            // Whole numbers: exact in any order.
            let exact: Complex<f64> = a.iter().zip(&b).map(|(a, b)| a[c].conj() * b[c]).sum();
            assert_eq!(found[c], exact);
        }
        let wave: Vec<[f64; 1]> = (0..n).map(|i| [(i as f64).sin()]).collect();
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.unwrap().install(|| dot(&wave, &wave))[0].to_bits()
        };
        assert_eq!(with(1), with(3));
    }
}
