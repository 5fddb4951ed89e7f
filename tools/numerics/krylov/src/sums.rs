//! Vector arithmetic. Sums are made per chunk and the chunks are added in order; the size of a
//! chunk depends on the length alone, so the bits do not depend on the number of threads.

use rayon::prelude::*;

/// Most chunks of a vector; their sums live on the stack.
const CHUNKS: usize = 64;
/// Least numbers of a chunk.
const LEAST: usize = 4096;
/// A vector of fewer numbers is not worth waking a thread.
pub(crate) const WORTH: usize = 4 * LEAST;

/// Numbers per chunk.
pub(crate) fn chunk(n: usize) -> usize {
    n.div_ceil(CHUNKS).max(LEAST)
}

/// Sum over four running sums: fixed order, and the compiler keeps them in one register.
fn four(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (a4, b4) = (a.chunks_exact(4), b.chunks_exact(4));
    let ends = a4.remainder().iter().zip(b4.remainder());
    let tail: f64 = ends.map(|(x, y)| x * y).sum();
    for (x, y) in a4.zip(b4) {
        for m in 0..4 {
            sums[m] += x[m] * y[m];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + tail
}

/// `a . b`.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (n, size) = (a.len(), chunk(a.len()));
    let mut partial = [0.0; CHUNKS];
    if n < WORTH {
        for (s, (a, b)) in partial.iter_mut().zip(a.chunks(size).zip(b.chunks(size))) {
            *s = four(a, b);
        }
    } else {
        partial
            .par_iter_mut()
            .zip(a.par_chunks(size).zip(b.par_chunks(size)))
            .for_each(|(s, (a, b))| *s = four(a, b));
    }
    partial.iter().sum()
}

/// Runs `each` on every chunk of `y` beside the same chunk of `x` and sums what it returns.
pub(crate) fn update(
    y: &mut [f64],
    x: &[f64],
    each: impl Fn(&mut [f64], &[f64]) -> f64 + Sync,
) -> f64 {
    let (n, size) = (y.len(), chunk(y.len()));
    let mut partial = [0.0; CHUNKS];
    if n < WORTH {
        for (s, (y, x)) in partial
            .iter_mut()
            .zip(y.chunks_mut(size).zip(x.chunks(size)))
        {
            *s = each(y, x);
        }
    } else {
        partial
            .par_iter_mut()
            .zip(y.par_chunks_mut(size).zip(x.par_chunks(size)))
            .for_each(|(s, (y, x))| *s = each(y, x));
    }
    partial.iter().sum()
}

/// Sum of the squares of the products of `a` and `b`.
pub(crate) fn products(a: &[f64], b: &[f64]) -> f64 {
    let square = |(a, b): (&f64, &f64)| (a * b) * (a * b);
    let size = chunk(a.len());
    let parts = a.chunks(size).zip(b.chunks(size));
    parts
        .map(|(a, b)| a.iter().zip(b).map(square).sum::<f64>())
        .sum()
}

/// `y += a x`.
pub(crate) fn add(y: &mut [f64], a: f64, x: &[f64]) {
    update(y, x, |y, x| {
        for (y, x) in y.iter_mut().zip(x) {
            *y += a * x;
        }
        0.0
    });
}

/// `y += a x`; returns `y . y`.
pub(crate) fn add_norm(y: &mut [f64], a: f64, x: &[f64]) -> f64 {
    update(y, x, |y, x| {
        for (y, x) in y.iter_mut().zip(x) {
            *y += a * x;
        }
        four(y, y)
    })
}

/// `y = x + b y`.
pub(crate) fn turn(y: &mut [f64], b: f64, x: &[f64]) {
    update(y, x, |y, x| {
        for (y, x) in y.iter_mut().zip(x) {
            *y = x + b * *y;
        }
        0.0
    });
}

/// `y = x - y`; returns `y . y`.
pub(crate) fn subtract_from(x: &[f64], y: &mut [f64]) -> f64 {
    update(y, x, |y, x| {
        for (y, x) in y.iter_mut().zip(x) {
            *y = x - *y;
        }
        four(y, y)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_those_of_whole_numbers_and_know_no_threads() {
        for n in [0, 1, 3, 4096, 20_000, 300_001] {
            let a: Vec<f64> = (0..n).map(|k| (k % 7) as f64).collect();
            let b: Vec<f64> = (0..n).map(|k| (k % 5) as f64 - 2.0).collect();
            let exact: i64 = (0..n as i64).map(|k| (k % 7) * (k % 5 - 2)).sum();
            assert_eq!(dot(&a, &b), exact as f64);
            let mut y = b.clone();
            let norm = add_norm(&mut y, 2.0, &a);
            let sum: i64 = (0..n as i64)
                .map(|k| (k % 5 - 2 + 2 * (k % 7)).pow(2))
                .sum();
            assert_eq!(norm, sum as f64);
        }
        let a: Vec<f64> = (0..100_000).map(|k| f64::from(k).sin()).collect();
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.unwrap().install(|| dot(&a, &a)).to_bits()
        };
        assert_eq!(with(1), with(2));
    }
}
