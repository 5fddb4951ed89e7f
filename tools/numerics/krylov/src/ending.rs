//! How a solve of several columns ended.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::Restarted;

/// When to stop.
#[derive(Debug, Clone, Copy)]
pub struct Rule<'a> {
    /// Wanted residual over that of a zero guess, `|b - A x| / |b|`, of each column.
    pub reduction: f64,
    /// Residual below which nothing is gained, in the unit of the right side.
    pub floor: f64,
    /// Most products with the matrix.
    pub products: usize,
    /// Looked at after each product: whoever set it no longer wants a solution. What it does not
    /// stop it does not change.
    pub stop: Option<&'a AtomicBool>,
}

impl Rule<'_> {
    /// The same with cycles of so many steps.
    #[must_use]
    pub fn restarted(self, after: usize) -> Restarted<Self> {
        Restarted { rule: self, after }
    }

    /// Is the solution no longer wanted?
    pub(crate) fn stopped(&self) -> bool {
        self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed))
    }
}

impl Default for Rule<'_> {
    fn default() -> Self {
        Self {
            reduction: 1e-8,
            floor: 0.0,
            products: 2000,
            stop: None,
        }
    }
}

/// How it ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ending {
    /// Every column has the wanted residual, evaluated anew.
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
        })
    }
}

/// What came of a solve.
#[derive(Debug, Clone, PartialEq)]
pub struct Solved {
    /// How it ended.
    pub ending: Ending,
    /// Products with the matrix (and as many preconditioned vectors) of all columns together.
    pub products: usize,
    /// True residual at the end over that of a zero guess, of each column.
    pub residuals: Vec<f64>,
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

    /// Largest true residual of the columns.
    #[must_use]
    pub fn worst(&self) -> f64 {
        self.residuals.iter().copied().fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Identity, Operator, Rows, Scratch, bicgstab2, minimal_residual};
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

    /// Products, ending and the residual of the solution of both methods.
    fn solved(most: usize) -> [(usize, Solved, f64); 2] {
        let n = 200;
        [true, false].map(|short| {
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
            let mut scratch = Scratch::default();
            let solved = if short {
                bicgstab2(&a, &rhs, &mut x, &mut Identity, rule, &mut scratch)
            } else {
                let rule = rule.restarted(30);
                minimal_residual(&a, &rhs, &mut x, &mut Identity, rule, &mut scratch)
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
