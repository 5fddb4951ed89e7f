//! When a solve is to end, and how it ended.

use crate::Error;
use std::sync::atomic::{AtomicBool, Ordering};

/// Products without a decrease by a tenth after which a solve has stagnated.
pub(crate) const PATIENCE: usize = 80;

/// When to stop.
#[derive(Debug, Clone, Copy)]
pub struct Rule<'a> {
    /// Wanted residual over that of a zero guess, `|b - A x| / |b|`, of each column.
    pub reduction: f64,
    /// Wanted residual over that of the first guess: for solves that improve what others go on from.
    pub decrease: f64,
    /// Residual below which nothing is gained, in the unit of the right side.
    pub floor: f64,
    /// Most products with the matrix.
    pub products: usize,
    /// Looked at after each product: whoever set it no longer wants a solution. What it does not
    /// stop it does not change.
    pub stop: Option<&'a AtomicBool>,
}

impl<'a> Rule<'a> {
    /// A reduction, within so many products.
    #[must_use]
    pub const fn to(reduction: f64, products: usize) -> Self {
        Self {
            reduction,
            decrease: 0.0,
            floor: 0.0,
            products,
            stop: None,
        }
    }

    /// The same with cycles of so many steps.
    #[must_use]
    pub fn restarted(self, after: usize) -> Restarted<'a> {
        Restarted { rule: self, after }
    }

    /// Is the solution no longer wanted?
    pub(crate) fn stopped(&self) -> bool {
        self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed))
    }
}

impl Default for Rule<'_> {
    fn default() -> Self {
        Self::to(1e-8, 2000)
    }
}

/// A rule for a method that starts anew after so many steps.
#[derive(Debug, Clone, Copy)]
pub struct Restarted<'a> {
    /// When to stop.
    pub rule: Rule<'a>,
    /// Steps of a cycle.
    pub after: usize,
}

/// How it ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ending {
    /// Every column has the wanted residual, evaluated anew, or what rounding leaves ([`Operator::rounding`](crate::Operator)).
    Converged,
    /// The residual has not fallen for long.
    Stagnated(Stagnation),
    /// A divisor vanished or a number left the numbers.
    BrokenDown(Breakdown),
    /// The products allowed are spent.
    Spent,
    /// The solution was no longer wanted ([`Rule::stop`]).
    Stopped,
}

/// Why a residual stays where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stagnation {
    /// It is as small as rounding lets it be: the wanted reduction is too small for this matrix.
    Rounding {
        /// Residual that rounding leaves, about, over that of a zero guess.
        level: f64,
    },
    /// The right side has a part which the matrix cannot make: it is singular, or nearly so, as
    /// where nothing fixes a constant.
    Singular {
        /// Norm of the correction that the preconditioner makes, over that of the residual.
        correction: f64,
    },
    /// The factors of the preconditioner amplify: they suit the matrix ill.
    Preconditioner {
        /// Largest entry of the inverse applied to ones.
        growth: f64,
    },
    /// The space found so far does not lower it: the method or its preconditioner is too weak.
    Plateau {
        /// Products since the residual last fell by a tenth.
        products: usize,
    },
}

/// What vanished or overflowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Breakdown {
    /// The residual is orthogonal to the shadow residual, again after a new one was chosen.
    Shadow,
    /// The minimising polynomial has no solution.
    Polynomial,
    /// A product or a preconditioned vector is not finite.
    NotFinite,
    /// A pivot of the factors is zero.
    Pivot,
    /// A curvature is not positive.
    Indefinite,
}

impl std::fmt::Display for Ending {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Converged => write!(f, "converged"),
            Self::Spent => write!(f, "the products allowed are spent"),
            Self::Stopped => write!(f, "stopped"),
            Self::Stagnated(why) => write!(f, "stagnated: {why}"),
            Self::BrokenDown(what) => write!(f, "broken down: {what}"),
        }
    }
}

impl std::fmt::Display for Stagnation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Rounding { level } => {
                write!(f, "rounding leaves a residual of about {level:.1e}")
            }
            Self::Singular { correction } => write!(
                f,
                "the matrix is singular or nearly so (corrections are {correction:.1e} times the residual)"
            ),
            Self::Preconditioner { growth } => write!(
                f,
                "the preconditioner amplifies {growth:.1e} times and suits the matrix ill"
            ),
            Self::Plateau { products } => {
                write!(f, "no decrease within {products} products with the matrix")
            }
        }
    }
}

impl std::fmt::Display for Breakdown {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Shadow => "the residual is orthogonal to its shadow",
            Self::Polynomial => "the minimising polynomial has no solution",
            Self::NotFinite => "a number is not finite",
            Self::Pivot => "a pivot is zero",
            Self::Indefinite => "the matrix or its preconditioner is not positive definite",
        })
    }
}

/// What came of a solve.
#[derive(Debug, Clone, PartialEq)]
pub struct Solved {
    /// How it ended.
    pub ending: Ending,
    /// Steps of the method.
    pub steps: usize,
    /// Products with the matrix (and as many preconditioned vectors) of all columns together.
    pub products: usize,
    /// Largest residual of the columns at the start, in the unit of the right side.
    pub first: f64,
    /// The same at the end, evaluated anew.
    pub last: f64,
    /// Largest of the columns' residuals over that of a zero guess: at the start, then after each
    /// step of the method, as it is known there.
    pub history: Vec<f64>,
}

impl Solved {
    /// Did every column reach what was wanted?
    #[must_use]
    pub fn converged(&self) -> bool {
        self.ending == Ending::Converged
    }

    /// Largest residual of the columns over that of a zero guess, at the end.
    #[must_use]
    pub fn worst(&self) -> f64 {
        self.history.last().copied().unwrap_or(0.0)
    }

    /// The same where it did not break down.
    ///
    /// # Errors
    /// [`Error::BrokenDown`].
    pub fn sound(self) -> Result<Self, Error> {
        match self.ending {
            Ending::BrokenDown(why) => Err(Error::BrokenDown(why)),
            _ => Ok(self),
        }
    }
}

/// Residuals of the columns while a method is at work: what is wanted, what there is.
#[derive(Debug)]
pub struct Watch<const C: usize> {
    pub(crate) scale: [f64; C],
    pub(crate) target: [f64; C],
    pub(crate) now: [f64; C],
    first: f64,
    steps: usize,
    history: Vec<f64>,
    best: f64,
    best_at: usize,
}

impl<const C: usize> Watch<C> {
    /// Of columns whose right sides have the norms `scale`, and whose residuals have the norms `now`.
    #[must_use]
    pub fn new(rule: &Rule, scale: [f64; C], now: [f64; C]) -> Self {
        let wanted = |c: usize| (rule.reduction * scale[c]).max(rule.decrease * now[c]);
        let mut watch = Self {
            scale,
            target: std::array::from_fn(|c| wanted(c).max(rule.floor)),
            now,
            first: now.into_iter().fold(0.0, f64::max),
            steps: 0,
            history: Vec::new(),
            best: f64::INFINITY,
            best_at: 0,
        };
        watch.note(now, 0);
        watch
    }

    pub(crate) fn relative(&self) -> [f64; C] {
        std::array::from_fn(|c| {
            if self.now[c] == 0.0 {
                0.0
            } else if self.scale[c] > 0.0 {
                self.now[c] / self.scale[c]
            } else {
                f64::INFINITY
            }
        })
    }

    /// Takes residuals that were evaluated after so many products.
    pub fn note(&mut self, now: [f64; C], products: usize) {
        self.now = now;
        let worst = self.relative().into_iter().fold(0.0, f64::max);
        self.history.push(worst);
        if worst < 0.9 * self.best {
            self.best = worst;
            self.best_at = products;
        }
    }

    /// Takes the residuals after a step.
    pub fn step(&mut self, now: [f64; C], products: usize) {
        self.steps += 1;
        self.note(now, products);
    }

    pub(crate) fn done(&self, c: usize) -> bool {
        self.now[c] <= self.target[c]
    }

    /// Has every column the wanted residual?
    #[must_use]
    pub fn all_done(&self) -> bool {
        (0..C).all(|c| self.done(c))
    }

    pub(crate) fn finite(&self) -> bool {
        self.now.iter().all(|r| r.is_finite())
    }

    pub(crate) fn stuck(&self, products: usize) -> bool {
        products > self.best_at + PATIENCE
    }

    /// What ends a solve at this point, if anything; `reached` where the residuals are small enough.
    #[must_use]
    pub fn ended(&self, rule: &Rule, products: usize, reached: bool) -> Option<Ending> {
        if !self.finite() {
            Some(Ending::BrokenDown(Breakdown::NotFinite))
        } else if reached {
            Some(Ending::Converged)
        } else if products >= rule.products {
            Some(Ending::Spent)
        } else {
            rule.stopped().then_some(Ending::Stopped)
        }
    }

    /// What came of it.
    #[must_use]
    pub fn solved(self, ending: Ending, products: usize) -> Solved {
        Solved {
            ending,
            steps: self.steps,
            products,
            first: self.first,
            last: self.now.into_iter().fold(0.0, f64::max),
            history: self.history,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Identity, Operator, Rows, Scratch, bicgstab2, minimal_residual};
    use crate::{bicgstab, conjugate_gradient, gmres};
    use std::sync::atomic::AtomicUsize;

    /// A chain whose solution is no longer wanted after so many products.
    struct Unwanted {
        rows: Rows<f64>,
        products: AtomicUsize,
        most: usize,
        stop: AtomicBool,
    }

    impl Operator<f64> for Unwanted {
        fn len(&self) -> usize {
            self.rows.len()
        }

        fn apply(&self, x: &[[f64; 1]], out: &mut [[f64; 1]]) {
            self.rows.apply(x, out);
            let done = self.products.fetch_add(1, Ordering::Relaxed) + 1;
            self.stop.fetch_or(done == self.most, Ordering::Relaxed);
        }
    }

    /// Products, ending and the residual of the solution of all methods.
    fn solved(most: usize) -> [(usize, Solved, f64); 5] {
        let n = 200;
        [0, 1, 2, 3, 4].map(|method| {
            let a = Unwanted {
                rows: Rows::gathered(n, 0.0, |i, row| {
                    row.push((i as u32, 2.0));
                    let beside = [i.wrapping_sub(1), i + 1].into_iter();
                    row.extend(beside.filter(|j| *j < n).map(|j| (j as u32, -0.98)));
                }),
                products: AtomicUsize::new(0),
                most,
                stop: AtomicBool::new(false),
            };
            let (rhs, mut x) = (vec![[1.0]; n], vec![[0.0]; n]);
            let rule = Rule {
                stop: Some(&a.stop),
                ..Rule::default()
            };
            let (none, scratch) = (&mut Identity, &mut Scratch::default());
            let (b, y) = (rhs.as_flattened(), x.as_flattened_mut());
            let solved = match method {
                0 => conjugate_gradient(&a, b, y, none, rule, scratch),
                1 => bicgstab(&a, b, y, none, rule, scratch),
                2 => gmres(&a, b, y, none, rule.restarted(30), scratch),
                3 => bicgstab2(&a, &rhs, &mut x, none, rule, scratch),
                _ => minimal_residual(&a, &rhs, &mut x, none, rule.restarted(30), scratch),
            };
            let mut left = rhs.clone();
            a.rows.apply(&x, &mut left);
            let square = |(b, r): (&[f64; 1], &[f64; 1])| (b[0] - r[0]).powi(2);
            let left: f64 = rhs.iter().zip(&left).map(square).sum();
            let size = (n as f64).sqrt();
            (a.products.into_inner(), solved, left.sqrt() / size)
        })
    }

    #[test]
    fn a_solve_that_is_no_longer_wanted_ends_with_the_next_product() {
        for most in [1, 5, 18] {
            for (products, solved, left) in solved(most) {
                assert_eq!(solved.ending, Ending::Stopped);
                assert!(products <= most + 2, "{products} products, not {most}");
                // The residual told is that of what was found so far.
                assert!(left > 1e-8 && (solved.worst() - left).abs() < 1e-9 * left);
            }
        }
        for (products, solved, left) in solved(usize::MAX) {
            assert!(solved.converged() && products > 20 && left < 2e-8);
        }
    }
}
