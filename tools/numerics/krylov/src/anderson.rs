//! Fixed points by Anderson's method.

use crate::sums::dot;

/// Length of what is left of a difference over its own below which the others make it already.
const ALIKE: f64 = 1e-8;

/// Accelerates `x <- g(x)` (Anderson 1965, J. ACM 12, 547; Walker and Ni 2011, SIAM J. Numer. Anal. 49, 1715): of the last
/// steps those combinations are taken back whose residuals add up to the least, by least squares. Where `g` is linear this
/// is a Krylov method, which needs no derivative: modes that circle or grow are damped as well as those that creep.
///
/// Of the numbers of `x` some may only follow, without a residual. What obeys the same linear conditions in every `g(x)`,
/// as mass fluxes that balance do, obeys them in the next `x`, since the shares of all add up to 1.
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

    /// Steps that are kept.
    #[must_use]
    pub fn kept(&self) -> usize {
        self.steps.len()
    }

    /// What is kept, in a row for a checkpoint: `g(x)` and the residual of the last step, then the steps of both.
    #[must_use]
    pub fn memory(&self) -> Vec<f64> {
        let pairs = self.last.iter().chain(&self.steps);
        pairs
            .flat_map(|(g, residual)| g.iter().chain(residual).copied())
            .collect()
    }

    /// Takes what [`Self::memory`] gave, with so many steps [kept](Self::kept) and so many numbers in a residual.
    pub fn restore(&mut self, memory: &[f64], kept: usize, residuals: usize) {
        let each = (memory.len() / (kept + 1)).max(residuals).max(1);
        let mut pairs = memory.chunks_exact(each).map(|pair| {
            let (g, residual) = pair.split_at(each - residuals);
            (g.to_vec(), residual.to_vec())
        });
        self.last = pairs.next();
        self.steps = pairs.collect();
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

    /// A linear map that turns and stretches pairs of numbers about `GOAL`; the ninth is the sum of the others plus one.
    fn turned(x: &[f64]) -> Vec<f64> {
        const PAIRS: [[f64; 2]; 4] = [[1.05, 0.11], [0.999, 0.0], [0.9, 2.0], [0.3, 0.0]];
        let mut out = Vec::new();
        for ((stretch, angle), at) in PAIRS.map(|[a, b]| (a, b)).into_iter().zip([0, 2, 4, 6]) {
            let d = [x[at] - GOAL[at], x[at + 1] - GOAL[at + 1]];
            let (s, c) = f64::sin_cos(angle);
            out.push(GOAL[at] + stretch * (c * d[0] - s * d[1]));
            out.push(GOAL[at + 1] + stretch * (s * d[0] + c * d[1]));
        }
        out.push(1.0 + out.iter().sum::<f64>());
        out
    }

    const GOAL: [f64; 8] = [3.0, -1.0, 0.5, 7.0, 2.0, 2.0, -4.0, 1.0];

    /// One step of `turned`, of whose numbers the first eight are asked what they lack.
    fn mix(anderson: &mut Anderson, x: &mut Vec<f64>) {
        let mut g = turned(x);
        let residual: Vec<f64> = g[..8].iter().zip(&*x).map(|(g, x)| g - x).collect();
        anderson.next(&mut g, &residual);
        *x = g;
    }

    #[test]
    fn a_map_that_circles_away_comes_to_rest() {
        let (mut plain, mut mixed) = (vec![0.0; 9], vec![0.0; 9]);
        let mut anderson = Anderson::new(8);
        for _ in 0..10 {
            plain = turned(&plain);
            mix(&mut anderson, &mut mixed);
        }
        let far = |x: &[f64]| -> f64 {
            let each = x.iter().zip(GOAL).map(|(x, g)| (x - g).abs());
            each.fold(0.0, f64::max)
        };
        assert!(far(&plain) > 3.0 && far(&mixed) < 1e-8, "{mixed:?}");
    }

    #[test]
    fn numbers_that_follow_keep_the_linear_conditions_of_all_results() {
        let (mut x, mut anderson) = (vec![0.0; 9], Anderson::new(3));
        for _ in 0..12 {
            mix(&mut anderson, &mut x);
            assert!((x[8] - 1.0 - x[..8].iter().sum::<f64>()).abs() < 1e-10);
        }
    }

    #[test]
    fn what_is_kept_goes_on_to_the_same_bits() {
        let run = |cut: Option<usize>| {
            let (mut x, mut anderson) = (vec![0.0; 9], Anderson::new(3));
            for k in 0..9 {
                if cut == Some(k) {
                    let (memory, kept) = (anderson.memory(), anderson.kept());
                    anderson = Anderson::new(3);
                    anderson.restore(&memory, kept, 8);
                }
                mix(&mut anderson, &mut x);
            }
            x.into_iter().map(f64::to_bits).collect::<Vec<_>>()
        };
        for cut in 0..9 {
            assert_eq!(run(Some(cut)), run(None), "{cut}");
        }
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
