//! Anderson's recombination of the last results of a fixed-point iteration (Anderson 1965; Walker and Ni 2011).
//!
//! With `g(x)` what an iteration makes of `x` and `f = g - x` what it lacks, the next start is
//!
//! ```text
//! x' = g - sum_j c_j dg_j,    c = argmin | W (f - sum_j c_j df_j) |
//! ```
//!
//! `dg_j` and `df_j` being the differences of consecutive results and lacks, W a diagonal of weights. On a linear
//! iteration these are the steps of GMRES: modes that circle or grow are damped as well as those that creep, so that a
//! steady state that an iteration is carried away from can be reached. What obeys the same linear conditions in all
//! results, such as mass fluxes that balance, obeys them in the next start, as the coefficients of all results sum to 1.

/// Part of its own square that a difference must keep beside newer ones, to count.
const INDEPENDENT: f64 = 1e-10;

/// The last differences of an iteration.
#[derive(Debug, Clone, Default)]
pub struct Anderson {
    /// Most differences kept.
    depth: usize,
    /// Weights of the values that are asked what they lack; those beyond follow.
    weights: Vec<f64>,
    /// Result of the iteration before; empty before the first.
    result: Vec<f64>,
    /// What it lacked, weighed.
    lack: Vec<f64>,
    /// What the present one lacks, weighed.
    next: Vec<f64>,
    /// Differences of results, oldest first.
    results: Vec<Vec<f64>>,
    /// Differences of what they lacked, weighed.
    lacks: Vec<Vec<f64>>,
    /// Products of the differences of what they lacked, newest first, and then their factors `L`.
    factors: Vec<f64>,
    coefficients: Vec<f64>,
}

impl Anderson {
    /// Keeps up to `depth` differences; `weights` belong to the first of the values.
    #[must_use]
    pub fn new(depth: usize, weights: Vec<f64>) -> Self {
        Self {
            depth,
            next: vec![0.0; weights.len()],
            factors: vec![0.0; depth * depth],
            coefficients: vec![0.0; depth],
            weights,
            ..Self::default()
        }
    }

    /// Forgets what came before.
    pub fn forget(&mut self) {
        self.result.clear();
        self.results.clear();
        self.lacks.clear();
    }

    /// Weights of the values that are asked.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Differences that are kept.
    #[must_use]
    pub fn kept(&self) -> usize {
        self.results.len()
    }

    /// Takes what an iteration has made of `start`; gives what is to be added to `result` for the next start to `step`.
    pub fn step(&mut self, start: &[f64], result: &[f64], step: &mut Vec<f64>) {
        step.clear();
        step.resize(result.len(), 0.0);
        let values = self.weights.iter().zip(result).zip(start);
        for (next, ((w, g), x)) in self.next.iter_mut().zip(values) {
            *next = w * (g - x);
        }
        if self.result.len() == result.len() {
            self.take(result);
        } else {
            self.forget();
            self.result.extend_from_slice(result);
        }
        self.lack.clone_from(&self.next);
        self.solve();
        for (c, dg) in self.coefficients.iter().zip(self.results.iter().rev()) {
            step.iter_mut().zip(dg).for_each(|(s, d)| *s -= c * d);
        }
    }

    /// Adds the newest difference in the place of the oldest.
    fn take(&mut self, result: &[f64]) {
        if self.results.len() < self.depth {
            self.results.push(vec![0.0; result.len()]);
            self.lacks.push(vec![0.0; self.next.len()]);
        } else {
            self.results.rotate_left(1);
            self.lacks.rotate_left(1);
        }
        if let (Some(dg), Some(df)) = (self.results.last_mut(), self.lacks.last_mut()) {
            difference(dg, result, &self.result);
            difference(df, &self.next, &self.lack);
        }
        self.result.copy_from_slice(result);
    }

    /// The least squares by Cholesky, from the newest difference on; those that add nothing are left out.
    fn solve(&mut self) {
        let (n, m) = (self.lacks.len(), self.depth);
        let of = |k: usize| &self.lacks[n - 1 - k];
        for k in 0..n {
            for l in 0..=k {
                let mut left = dot(of(k), of(l));
                let whole = left;
                for i in 0..l {
                    left -= self.factors[k * m + i] * self.factors[l * m + i];
                }
                self.factors[k * m + l] = if k == l {
                    // Zero: left out.
                    left.max(0.0).sqrt() * f64::from(u8::from(left > INDEPENDENT * whole))
                } else if self.factors[l * m + l] > 0.0 {
                    left / self.factors[l * m + l]
                } else {
                    0.0
                };
            }
        }
        let through = |value: f64, pivot: f64| if pivot > 0.0 { value / pivot } else { 0.0 };
        for k in 0..n {
            let mut value = dot(of(k), &self.lack);
            for i in 0..k {
                value -= self.factors[k * m + i] * self.coefficients[i];
            }
            self.coefficients[k] = through(value, self.factors[k * m + k]);
        }
        for k in (0..n).rev() {
            let mut value = self.coefficients[k];
            for i in k + 1..n {
                value -= self.factors[i * m + k] * self.coefficients[i];
            }
            self.coefficients[k] = through(value, self.factors[k * m + k]);
        }
        self.coefficients[n..].fill(0.0);
    }

    /// What the next step needs to know: the last result and what it lacked, and the differences of both.
    #[must_use]
    pub fn memory(&self) -> Vec<f64> {
        let parts = [&self.result, &self.lack].into_iter();
        let parts = parts.chain(&self.results).chain(&self.lacks);
        parts.flat_map(|part| part.iter().copied()).collect()
    }

    /// Takes what [`Self::memory`] gave, `kept` differences being among it.
    pub fn restore(&mut self, memory: &[f64], kept: usize) {
        self.forget();
        let led = self.weights.len();
        let values = (memory.len() / (kept + 1)).saturating_sub(led);
        let (result, rest) = memory.split_at(values.min(memory.len()));
        let (lack, rest) = rest.split_at(led.min(rest.len()));
        let (results, lacks) = rest.split_at((kept * values).min(rest.len()));
        (self.result, self.lack) = (result.to_vec(), lack.to_vec());
        let columns = |all: &[f64], each: usize| {
            let parts = all.chunks_exact(each.max(1));
            parts.take(kept).map(<[f64]>::to_vec).collect()
        };
        (self.results, self.lacks) = (columns(results, values), columns(lacks, led));
    }
}

fn difference(out: &mut [f64], a: &[f64], b: &[f64]) {
    for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
        *out = a - b;
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A linear iteration whose pairs of values are turned and stretched, and which is drawn to `goal`.
    fn turned(x: &[f64], goal: &[f64], factors: &[[f64; 2]]) -> Vec<f64> {
        let mut out = Vec::new();
        for (k, [stretch, angle]) in factors.iter().enumerate() {
            let d = [x[2 * k] - goal[2 * k], x[2 * k + 1] - goal[2 * k + 1]];
            let (s, c) = angle.sin_cos();
            out.push(goal[2 * k] + stretch * (c * d[0] - s * d[1]));
            out.push(goal[2 * k + 1] + stretch * (s * d[0] + c * d[1]));
        }
        out
    }

    const FACTORS: [[f64; 2]; 4] = [[1.05, 0.11], [0.999, 0.0], [0.9, 2.0], [0.3, 0.0]];
    const GOAL: [f64; 8] = [3.0, -1.0, 0.5, 7.0, 2.0, 2.0, -4.0, 1.0];

    fn error(x: &[f64]) -> f64 {
        x.iter()
            .zip(GOAL)
            .map(|(x, g)| (x - g).abs())
            .fold(0.0, f64::max)
    }

    #[test]
    fn an_iteration_that_circles_away_comes_to_rest() {
        let mut mixed = vec![0.0; 8];
        let mut plain = mixed.clone();
        let mut anderson = Anderson::new(8, vec![1.0; 8]);
        let mut step = Vec::new();
        for _ in 0..10 {
            plain = turned(&plain, &GOAL, &FACTORS);
            let result = turned(&mixed, &GOAL, &FACTORS);
            anderson.step(&mixed, &result, &mut step);
            mixed = result.iter().zip(&step).map(|(g, s)| g + s).collect();
        }
        assert!(error(&plain) > 3.0 && error(&mixed) < 1e-8, "{mixed:?}");
    }

    #[test]
    fn values_that_follow_keep_the_linear_conditions_of_the_results() {
        // The last value is the sum of the others plus one, in every result.
        let mut x = vec![0.0; 9];
        let mut anderson = Anderson::new(3, vec![1.0; 8]);
        let mut step = Vec::new();
        for _ in 0..12 {
            let mut result = turned(&x[..8], &GOAL, &FACTORS);
            result.push(1.0 + result.iter().sum::<f64>());
            anderson.step(&x, &result, &mut step);
            x = result.iter().zip(&step).map(|(g, s)| g + s).collect();
            assert!((x[8] - 1.0 - x[..8].iter().sum::<f64>()).abs() < 1e-10);
        }
    }

    #[test]
    fn what_is_remembered_goes_on_to_the_same_bits() {
        let run = |cut: Option<usize>| {
            let mut x = vec![0.0; 8];
            let mut anderson = Anderson::new(3, vec![0.5; 7]);
            let mut step = Vec::new();
            for k in 0..9 {
                if cut == Some(k) {
                    let (memory, kept) = (anderson.memory(), anderson.kept());
                    anderson = Anderson::new(3, vec![0.5; 7]);
                    anderson.restore(&memory, kept);
                }
                let result = turned(&x, &GOAL, &FACTORS);
                anderson.step(&x, &result, &mut step);
                x = result.iter().zip(&step).map(|(g, s)| g + s).collect();
            }
            x.into_iter().map(f64::to_bits).collect::<Vec<_>>()
        };
        for cut in 0..9 {
            assert_eq!(run(Some(cut)), run(None), "{cut}");
        }
    }
}
