//! Fixed points by Anderson's method.

use crate::sums::dot;

/// Length of what is left of a difference over its own below which the others make it already.
const ALIKE: f64 = 1e-8;

/// Accelerates `x <- g(x)` (Anderson 1965, J. ACM 12, 547; Walker and Ni 2011, SIAM J. Numer. Anal. 49, 1715): of the last
/// steps those combinations are taken back whose residuals add up to the least, by least squares. Where `g` is linear this
/// is a Krylov method, which needs no derivative.
#[derive(Debug, Clone)]
pub struct Anderson {
    window: usize,
    last: Option<(Vec<f64>, Vec<f64>)>,
    /// Differences of `g(x)` and of residuals, the oldest first.
    steps: Vec<(Vec<f64>, Vec<f64>)>,
}

impl Anderson {
    /// With so many steps kept.
    #[must_use]
    pub fn new(window: usize) -> Self {
        Self {
            window,
            last: None,
            steps: Vec::new(),
        }
    }

    /// Forgets all steps.
    pub fn clear(&mut self) {
        self.last = None;
        self.steps.clear();
    }

    /// The next `x`, from `g(x)`, in place, and the residual of x in whatever measure it should become small.
    pub fn next(&mut self, g: &mut [f64], residual: &[f64]) {
        let minus = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect();
        if let Some((from, before)) = &self.last {
            self.steps.push((minus(g, from), minus(residual, before)));
            if self.steps.len() > self.window {
                self.steps.remove(0);
            }
        }
        self.last = Some((g.to_vec(), residual.to_vec()));
        for (share, number) in self.shares(residual) {
            for (g, step) in g.iter_mut().zip(&self.steps[number].0) {
                *g -= share * step;
            }
        }
    }

    /// How much of which steps is taken back: the least squares of `residual - sum(share step)`, by Gram and Schmidt's
    /// method from the newest step to the oldest; those which others make already are left out.
    fn shares(&self, residual: &[f64]) -> Vec<(f64, usize)> {
        let mut bases: Vec<Vec<f64>> = Vec::new();
        let mut triangle: Vec<Vec<f64>> = Vec::new();
        let mut numbers = Vec::new();
        for (number, (_, step)) in self.steps.iter().enumerate().rev() {
            let whole = dot(step, step).sqrt();
            let mut left = step.clone();
            let mut column = vec![0.0; bases.len()];
            // Twice is enough.
            for _ in 0..2 {
                for (basis, share) in bases.iter().zip(&mut column) {
                    let along = dot(basis, &left);
                    *share += along;
                    for (l, b) in left.iter_mut().zip(basis) {
                        *l -= along * b;
                    }
                }
            }
            let size = dot(&left, &left).sqrt();
            if size > ALIKE * whole {
                left.iter_mut().for_each(|l| *l /= size);
                column.push(size);
                bases.push(left);
                triangle.push(column);
                numbers.push(number);
            }
        }
        let mut wanted: Vec<f64> = bases.iter().map(|basis| dot(basis, residual)).collect();
        for k in (0..wanted.len()).rev() {
            wanted[k] /= triangle[k][k];
            for l in 0..k {
                wanted[l] -= triangle[k][l] * wanted[k];
            }
        }
        wanted.into_iter().zip(numbers).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Iterations of `g` until the residual is small.
    fn count(window: usize, g: impl Fn(&[f64]) -> Vec<f64>, n: usize) -> usize {
        let mut anderson = Anderson::new(window);
        let mut x = vec![0.0; n];
        for number in 0..2000 {
            let mut next = g(&x);
            let residual: Vec<f64> = next.iter().zip(&x).map(|(a, b)| a - b).collect();
            if dot(&residual, &residual).sqrt() < 1e-10 {
                return number;
            }
            anderson.next(&mut next, &residual);
            x = next;
        }
        usize::MAX
    }

    /// A linear map that shrinks by up to 0.999: alone it takes thousands of steps, with as many as there are numbers it is
    /// exact.
    #[test]
    fn a_linear_map_ends_as_a_krylov_method_does() {
        let map = |x: &[f64]| -> Vec<f64> {
            let each = x.iter().enumerate();
            each.map(|(k, x)| 1.0 + x * (0.999 - 0.2 * k as f64))
                .collect()
        };
        assert_eq!(count(0, map, 8), usize::MAX);
        assert!(count(8, map, 8) <= 11);
    }

    #[test]
    fn maps_that_overshoot_and_bend_are_solved() {
        // x = cos(4 x) / 2 has a slope of -1.7 at its solution.
        let map = |x: &[f64]| -> Vec<f64> { x.iter().map(|x| 0.5 * (4.0 * x).cos()).collect() };
        assert_eq!(count(0, map, 1), usize::MAX);
        assert!(count(3, map, 1) < 20);
    }

    #[test]
    fn a_map_that_stands_still_is_left_as_it_is() {
        let mut anderson = Anderson::new(4);
        for _ in 0..3 {
            let mut g = [1.0, 2.0];
            anderson.next(&mut g, &[0.0, 0.0]);
            assert_eq!(g, [1.0, 2.0]);
        }
    }
}
