//! Red-black successive over-relaxation (Komen 2019, eqs 3.58 to 3.63).

use krylov::{Rule, Solved, Watch};

use crate::FivePoint;

/// The colour of a cell, `(i + j) mod 2`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colour {
    /// `(i + j)` even.
    Red,
    /// `(i + j)` odd.
    Black,
}

/// Red-black SOR. A step is four sweeps, each of both colours, and a look at the residual.
#[derive(Debug, Clone, Copy)]
pub struct Sor {
    /// The factor psi of eq. 3.60, in (0, 2).
    pub relaxation: f64,
    /// When to stop; a sweep counts as a product.
    pub rule: Rule<'static>,
}

/// Sweeps of a step.
const EACH: usize = 4;

impl Sor {
    /// Stops when the residual has fallen to the part `decrease` of its first value, or after so many sweeps, in full steps.
    #[must_use]
    pub const fn new(relaxation: f64, sweeps: usize, decrease: f64) -> Self {
        let products = 1 + sweeps.div_ceil(EACH) * (EACH + 1);
        let rule = Rule::to(0.0, products);
        let rule = Rule { decrease, ..rule };
        Self { relaxation, rule }
    }

    /// Sweeps `x` toward the solution of a usable `equation`, in memory that the caller keeps from one call to the next.
    pub fn solve(&self, equation: &FivePoint, x: &mut [f64], scratch: &mut Vec<f64>) -> Solved {
        scratch.resize(x.len(), 0.0);
        let right = equation.source.iter().map(|b| b * b).sum::<f64>().sqrt();
        let mut watch = Watch::new(&self.rule, [right], [norm(equation, x, scratch)]);
        let mut products = 1;
        loop {
            if let Some(ending) = watch.ended(&self.rule, products, watch.all_done()) {
                return watch.solved(ending, products);
            }
            for _ in 0..EACH {
                sweep(equation, x, self.relaxation, Colour::Red, scratch);
                sweep(equation, x, self.relaxation, Colour::Black, scratch);
            }
            products += EACH + 1;
            watch.step([norm(equation, x, scratch)], products);
        }
    }
}

/// Euclidean norm of the residual.
fn norm(equation: &FivePoint, x: &[f64], scratch: &mut [f64]) -> f64 {
    equation.residual(x, scratch);
    scratch.iter().map(|r| r * r).sum::<f64>().sqrt()
}

/// Updates the cells of one colour. They read only the other colour, whose values stand in
/// `scratch`, so rows can be taken in any order.
pub fn sweep(
    equation: &FivePoint,
    x: &mut [f64],
    relaxation: f64,
    colour: Colour,
    scratch: &mut [f64],
) {
    scratch.copy_from_slice(x);
    let old = &*scratch;
    let odd = usize::from(colour == Colour::Black);
    equation.for_rows(x, |(j, out)| {
        let (row, near) = (equation.row(j), equation.near(old, j));
        let source = &equation.source[j * equation.columns..];
        let mut i = (j + odd) % 2;
        while i < out.len() {
            let full = (row.gather(near, i) + source[i]) / row.centre[i];
            out[i] += relaxation * (full - out[i]);
            i += 2;
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `-laplace x = 1` on a square of even side, walls at half distance.
    fn poisson(n: usize) -> FivePoint {
        let mut a = FivePoint::new(n, n);
        for k in 0..n * n {
            let (i, j) = (k % n, k / n);
            a.east[k] = f64::from(u8::from(i + 1 < n));
            a.west[k] = f64::from(u8::from(i > 0));
            a.north[k] = f64::from(u8::from(j + 1 < n));
            a.south[k] = f64::from(u8::from(j > 0));
            let inner = a.east[k] + a.west[k] + a.north[k] + a.south[k];
            a.centre[k] = inner + 2.0 * (4.0 - inner);
            a.source[k] = 1.0;
        }
        a
    }

    #[test]
    fn converges_on_an_even_and_an_odd_grid() {
        for n in [16, 17] {
            let a = poisson(n);
            let mut x = vec![0.0; n * n];
            let solved = Sor::new(1.7, 400, 1e-10).solve(&a, &mut x, &mut Vec::new());
            assert!(solved.converged(), "{n}: {solved:?}");
            // The solution has the symmetry of the square.
            assert!((x[1] - x[n]).abs() < 1e-8);
        }
    }

    #[test]
    fn one_colour_reads_only_the_other() {
        let a = poisson(6);
        let mut x: Vec<f64> = (0..36).map(|k| (k as f64).sin()).collect();
        let before = x.clone();
        let mut scratch = vec![0.0; 36];
        sweep(&a, &mut x, 1.0, Colour::Red, &mut scratch);
        for k in 0..36 {
            let red = (k % 6 + k / 6) % 2 == 0;
            assert_eq!(red, x[k].to_bits() != before[k].to_bits(), "cell {k}");
        }
    }

    #[test]
    fn threads_do_not_change_a_bit() {
        let a = poisson(128);
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            let mut x = vec![0.0; 128 * 128];
            let sor = Sor::new(1.9, 48, 0.0);
            pool.install(|| sor.solve(&a, &mut x, &mut Vec::new()));
            x.iter().map(|v| v.to_bits()).collect::<Vec<_>>()
        };
        assert_eq!(run(1), run(3));
    }
}
