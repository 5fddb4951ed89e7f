//! Generalised minimal residuals for several columns.

use crate::columns::{add, dot, norms, update};
use crate::operator::{Preconditioned, residual};
use crate::scratch::{Scratch, fits};
use crate::{Ending, Inverse, Operator, Restarted, Rule, Scalar, Solved, Stagnation, Watch};

/// A cycle that leaves more than this share of the residual gains nothing.
const GAIN: f64 = 0.9;

/// The small least-squares problem of one column: Hessenberg matrix, rotations, right side.
struct Small<S> {
    matrix: Vec<S>,
    rotations: Vec<(f64, S)>,
    side: Vec<S>,
    most: usize,
    /// Steps that count for this column.
    steps: usize,
    rests: bool,
}

impl<S: Scalar> Small<S> {
    fn new(most: usize, norm: f64, rests: bool) -> Self {
        let mut side = vec![S::ZERO; most + 1];
        side[0] = S::real(norm);
        Self {
            matrix: vec![S::ZERO; most * (most + 1)],
            rotations: Vec::with_capacity(most),
            side,
            most,
            steps: 0,
            rests,
        }
    }

    fn column(&mut self, m: usize) -> &mut [S] {
        let wide = self.most + 1;
        &mut self.matrix[m * wide..(m + 1) * wide]
    }

    /// Rotates column `m` into the triangle; what is left of the residual.
    fn rotate(&mut self, m: usize) -> f64 {
        for k in 0..m {
            let (c, s) = self.rotations[k];
            let column = self.column(m);
            let (upper, lower) = (column[k], column[k + 1]);
            column[k] = upper.times_real(c) + s * lower;
            column[k + 1] = lower.times_real(c) - s.conjugate() * upper;
        }
        let column = self.column(m);
        let (a, b) = (column[m], column[m + 1]);
        let length = a.modulus().hypot(b.modulus());
        let (c, s) = if a.modulus() > 0.0 {
            let unit = a.times_real(1.0 / a.modulus());
            column[m] = unit.times_real(length);
            (
                a.modulus() / length,
                unit * b.conjugate().times_real(1.0 / length),
            )
        } else {
            column[m] = b;
            (0.0, S::ONE)
        };
        column[m + 1] = S::ZERO;
        self.rotations.push((c, s));
        let (upper, lower) = (self.side[m], self.side[m + 1]);
        self.side[m] = upper.times_real(c) + s * lower;
        self.side[m + 1] = lower.times_real(c) - s.conjugate() * upper;
        self.steps = m + 1;
        self.side[m + 1].modulus()
    }

    /// Coefficients of the basis; a vanishing pivot leaves its vector out.
    fn solve(&mut self) -> Vec<S> {
        let wide = self.most + 1;
        let mut y = vec![S::ZERO; self.steps];
        for m in (0..self.steps).rev() {
            let mut sum = self.side[m];
            for (k, y) in y.iter().enumerate().skip(m + 1) {
                sum -= self.matrix[k * wide + m] * *y;
            }
            let pivot = self.matrix[m * wide + m];
            y[m] = if pivot.modulus() > 0.0 {
                sum / pivot
            } else {
                S::ZERO
            };
        }
        y
    }
}

/// Restarted GMRES, preconditioned from the right (Saad and Schultz 1986, SIAM J. Sci. Stat.
/// Comput. 7, 856). `x` is the first guess and becomes the solution. Columns share products and have
/// least-squares problems of their own; one that has converged rests. Holds two vectors more than the steps of a cycle.
///
/// # Panics
/// When lengths differ.
pub fn minimal_residual<S: Scalar, const C: usize>(
    a: &impl Operator<S, C>,
    rhs: &[[S; C]],
    x: &mut [[S; C]],
    inverse: &mut impl Inverse<S, C>,
    restarted: Restarted,
    scratch: &mut Scratch<S>,
) -> Solved {
    let n = fits(a.len(), rhs, x);
    let (rule, restart) = (restarted.rule, restarted.after.max(1));
    let vectors = scratch.fit(restart + 2, n * C).iter_mut();
    let mut vectors: Vec<_> = vectors.map(|v| v.as_chunks_mut().0).collect();
    let z = vectors.pop().unwrap_or_default();
    let mut whole = Preconditioned { a, inverse, z };
    let start = residual(a, rhs, x, vectors[0]);
    let mut watch = Watch::new(&rule, norms(rhs), start);
    let mut products = 1;
    loop {
        if let Some(ending) = watch.ended(&rule, products, watch.all_done()) {
            return watch.solved(ending, products);
        }
        let before = watch.now;
        let steps = restart.min(rule.products - products);
        let mut small: Vec<Small<S>> = (0..C)
            .map(|c| Small::new(steps, before[c], watch.done(c)))
            .collect();
        let done = cycle(
            &mut whole,
            &mut vectors,
            &mut small,
            &rule,
            &mut watch,
            &mut products,
        );
        combine(&mut small, &mut vectors);
        whole.correct(x, vectors[done]);
        let carried = watch.now;
        let now = residual(a, rhs, x, vectors[0]);
        products += 1;
        watch.note(now, products);
        // Cut short, a cycle tells nothing.
        let whole = steps == restart && !rule.stopped();
        let idle = whole && (0..C).all(|c| watch.done(c) || now[c] > GAIN * before[c]);
        if idle && !watch.all_done() && watch.finite() {
            let rounding = (0..C).any(|c| now[c] > 10.0 * carried[c].max(1e-300) && !watch.done(c));
            let level = watch.relative().into_iter().fold(0.0, f64::max);
            let why = if rounding {
                Stagnation::Rounding { level }
            } else {
                Stagnation::Plateau { products: steps }
            };
            return watch.solved(Ending::Stagnated(why), products);
        }
    }
}

/// Builds the basis from the residual in the first vector; the number of the vector after the last
/// of the basis.
fn cycle<S: Scalar, const C: usize>(
    whole: &mut Preconditioned<'_, impl Operator<S, C>, impl Inverse<S, C>, S, C>,
    vectors: &mut [&mut [[S; C]]],
    small: &mut [Small<S>],
    rule: &Rule,
    watch: &mut Watch<C>,
    products: &mut usize,
) -> usize {
    let scale = |c: usize| {
        if small[c].rests {
            0.0
        } else {
            1.0 / watch.now[c]
        }
    };
    let scale = std::array::from_fn(scale);
    scaled(vectors[0], scale);
    let most = small.first().map_or(0, |s| s.most);
    for m in 0..most {
        let (basis, rest) = vectors.split_at_mut(m + 1);
        let Some(w) = rest.first_mut() else { return m };
        whole.apply(basis[m], w);
        *products += 1;
        for (k, v) in basis.iter().enumerate() {
            let h = dot(v, w);
            add(w, h.map(|h| h.times_real(-1.0)), v);
            for (small, h) in small.iter_mut().zip(h) {
                small.column(m)[k] = h;
            }
        }
        let length = norms(w);
        let mut now = watch.now;
        let mut scale = [0.0; C];
        for (c, small) in small.iter_mut().enumerate().filter(|s| !s.1.rests) {
            small.column(m)[m + 1] = S::real(length[c]);
            now[c] = small.rotate(m);
            let large = small.column(m)[m].modulus();
            if length[c] > 1e-14 * large {
                scale[c] = 1.0 / length[c];
            }
        }
        watch.step(now, *products);
        for (c, small) in small.iter_mut().enumerate() {
            small.rests |= watch.done(c) || scale[c] == 0.0;
            if small.rests {
                scale[c] = 0.0;
            }
        }
        scaled(w, scale);
        if small.iter().all(|s| s.rests) || rule.stopped() {
            return m + 1;
        }
    }
    most
}

/// Multiplies each column.
fn scaled<S: Scalar, const C: usize>(v: &mut [[S; C]], by: [f64; C]) {
    update(v, |_, v| {
        for v in v {
            for c in 0..C {
                v[c] = v[c].times_real(by[c]);
            }
        }
    });
}

/// The combination of the basis that minimises the residual, in the vector after it.
fn combine<S: Scalar, const C: usize>(small: &mut [Small<S>], vectors: &mut [&mut [[S; C]]]) {
    let weights: Vec<Vec<S>> = small.iter_mut().map(Small::solve).collect();
    let done = weights.iter().map(Vec::len).max().unwrap_or(0);
    let (basis, rest) = vectors.split_at_mut(done);
    let Some(sum) = rest.first_mut() else { return };
    sum.fill([S::ZERO; C]);
    for (k, v) in basis.iter().enumerate() {
        let weight = |c: usize| weights[c].get(k).copied().unwrap_or(S::ZERO);
        add(sum, std::array::from_fn(weight), v);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Identity, Rows};
    use num_complex::Complex;

    type C64 = Complex<f64>;

    fn ring(n: usize) -> Rows<C64> {
        Rows::gathered(n, C64::ZERO, |i, row| {
            row.push((i as u32, C64::new(0.3, 0.2)));
            row.push((((i + 1) % n) as u32, C64::new(-1.3, 0.4)));
            row.push((((i + 5) % n) as u32, C64::new(0.7, 0.0)));
        })
    }

    #[test]
    fn a_matrix_with_eigenvalues_all_around_zero_is_solved_within_its_size() {
        let n = 60;
        let a = ring(n);
        let exact: Vec<[C64; 2]> = (0..n)
            .map(|i| {
                [
                    C64::new((i * i % 7) as f64, 1.0),
                    C64::new(0.0, (i % 4) as f64),
                ]
            })
            .collect();
        let mut rhs = exact.clone();
        a.apply(&exact, &mut rhs);
        let mut x = vec![[C64::ZERO; 2]; n];
        let rule = Rule {
            reduction: 1e-12,
            ..Rule::default()
        };
        let solved = minimal_residual(
            &a,
            &rhs,
            &mut x,
            &mut Identity,
            rule.restarted(n),
            &mut Scratch::default(),
        );
        assert!(solved.converged() && solved.products <= 2 * n, "{solved:?}");
        for (x, e) in x.iter().zip(&exact) {
            assert!((x[0] - e[0]).norm() + (x[1] - e[1]).norm() < 1e-8);
        }
        assert!(
            solved
                .history
                .is_sorted_by(|a, b| b <= &(a * 1.001 + 1e-14))
        );
    }

    /// A shift round the ring of `n`, where no combination of less than `n` powers helps.
    fn shifted(n: usize, rule: Rule, restart: usize) -> Solved {
        let a = Rows::gathered(n, 0.0, |i, row| row.push((((i + 1) % n) as u32, 1.0)));
        let mut rhs = vec![[0.0]; n];
        rhs[0] = [1.0];
        let mut x = vec![[0.0]; n];
        let mut scratch = Scratch::default();
        let rule = rule.restarted(restart);
        minimal_residual(&a, &rhs, &mut x, &mut Identity, rule, &mut scratch)
    }

    #[test]
    fn products_that_are_spent_within_a_cycle_are_told_as_spent() {
        let rule = Rule {
            products: 8,
            ..Rule::default()
        };
        let ending = shifted(50, rule, 50).ending;
        assert!(matches!(ending, Ending::Spent), "{ending}");
    }

    #[test]
    fn restarts_that_gain_nothing_are_told() {
        let ending = shifted(50, Rule::default(), 10).ending;
        let plateau = matches!(ending, Ending::Stagnated(Stagnation::Plateau { .. }));
        assert!(plateau, "{ending}");
        assert!(shifted(50, Rule::default(), 50).converged());
    }
}
