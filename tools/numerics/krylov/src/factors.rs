//! The factors in use, and the iterations they serve.

use crate::operator::{Equations, residual};
use crate::{
    Breakdown, Coefficient, Direct, Ending, Error, Grids, Incomplete, Inverse, Keep, Method,
    Multigrid, Operator, Options, Order, Rows, Rule, Scalar, Scratch, Solved, Stagnation,
    bicgstab2, minimal_residual,
};

/// Bytes of a basis of minimal residuals, about.
const MEMORY: usize = 600 << 20;

/// Factors in use.
pub(crate) enum Factors<T, S: Scalar> {
    Multigrid(Box<Multigrid<T, S>>),
    Direct(Box<Direct<S>>),
    Real(Incomplete<f32>),
    Complex(Incomplete<S::Single>),
}

impl<T: Coefficient<S> + Scalar, S: Scalar> Factors<T, S>
where
    f32: Coefficient<S> + Coefficient<T>,
{
    /// Factors for a method that iterates, of rows that were multiplied by `scale`.
    pub(crate) fn new(
        rows: &Rows<T>,
        shift: &[S],
        order: &Order,
        scale: &[f64],
        options: Options,
    ) -> Result<Self, Error> {
        let grids = |grids| {
            if options.fluxes {
                let least = scale.iter().copied().fold(f64::INFINITY, f64::min);
                let weights = scale.iter().map(|s| least / s).collect();
                Multigrid::of_fluxes(rows, shift, order, weights, grids).map(Box::new)
            } else {
                Multigrid::new(rows, shift, order, grids).map(Box::new)
            }
        };
        let real = |keep| Self::Real(Incomplete::new(rows, shift, order, keep));
        Ok(match options.method {
            Method::Incomplete(keep) => real(keep),
            Method::IncompleteOfLarge(least) => {
                let large = rows.thinned(least, false);
                Self::Real(Incomplete::new(&large, shift, order, Keep::PATTERN))
            }
            Method::IncompleteComplex(keep) => {
                Self::Complex(Incomplete::new(rows, shift, order, keep))
            }
            Method::Multigrid(how) => Self::Multigrid(grids(how)?),
            Method::Chosen | Method::Direct => match grids(Grids::default()) {
                Ok(grids) => Self::Multigrid(grids),
                Err(_) => real(Keep::PATTERN),
            },
        })
    }
}

impl<T: Coefficient<S> + Scalar, S: Scalar> Factors<T, S>
where
    f32: Coefficient<S>,
{
    /// Solves equations of which these are the factors, or nearly so.
    pub(crate) fn solve<const C: usize>(
        &mut self,
        equations: &Equations<'_, impl Operator<S, C>, S, C>,
        y: &mut [[S; C]],
        rule: Rule,
        scratch: &mut Scratch<S>,
    ) -> Solved {
        let solved = self.stabilised(equations, y, rule, scratch);
        if weak(&solved) && !matches!(self, Self::Direct(_)) {
            self.minimal(equations, y, solved, rule, scratch)
        } else {
            solved
        }
    }

    /// Goes on where short recurrences stood still, with the products that are left: for eigenvalues about zero they fail
    /// where minimal residuals do not.
    pub(crate) fn minimal<const C: usize>(
        &mut self,
        equations: &Equations<'_, impl Operator<S, C>, S, C>,
        y: &mut [[S; C]],
        solved: Solved,
        rule: Rule,
        scratch: &mut Scratch<S>,
    ) -> Solved {
        let &Equations { a, b } = equations;
        if solved.products >= rule.products {
            return solved;
        }
        if solved.worst() > 1.0 {
            y.fill([S::ZERO; C]);
        }
        let vectors = MEMORY / (size_of::<[S; C]>() * b.len().max(1));
        let rule = Rule {
            products: rule.products - solved.products,
            ..rule
        };
        let rule = rule.restarted(vectors.clamp(20, 120));
        let first = solved.ending;
        let mut both = joined(solved, minimal_residual(a, b, y, self, rule, scratch));
        if both.ending == Ending::Spent {
            // What the first way stood still at the second has not overcome.
            both.ending = first;
        }
        both
    }

    /// Short recurrences.
    pub(crate) fn stabilised<const C: usize>(
        &mut self,
        equations: &Equations<'_, impl Operator<S, C>, S, C>,
        y: &mut [[S; C]],
        rule: Rule,
        scratch: &mut Scratch<S>,
    ) -> Solved {
        let &Equations { a, b } = equations;
        if !matches!(self, Self::Direct(_)) {
            return bicgstab2(a, b, y, self, rule, scratch);
        }
        let first = Rule {
            products: rule.products.min(9),
            ..rule
        };
        self.invert(b, y);
        let mut solved = bicgstab2(a, b, y, self, first, scratch);
        if solved.ending == Ending::Spent {
            solved.ending = refused(equations, y);
        }
        solved
    }
}

// One inverse for all kinds, so that each solver is compiled once for each kind of number.
impl<T: Coefficient<S> + Scalar, S: Scalar, const C: usize> Inverse<S, C> for Factors<T, S>
where
    f32: Coefficient<S>,
{
    fn invert(&mut self, rhs: &[[S; C]], out: &mut [[S; C]]) {
        match self {
            Self::Multigrid(grids) => grids.invert(rhs, out),
            Self::Direct(factors) => factors.invert(rhs, out),
            Self::Real(factors) => factors.solve(rhs, out),
            Self::Complex(factors) => factors.solve(rhs, out),
        }
    }
}

/// Did short recurrences stand still?
pub(crate) fn weak(solved: &Solved) -> bool {
    matches!(
        solved.ending,
        Ending::Stagnated(Stagnation::Plateau { .. })
            | Ending::BrokenDown(Breakdown::Shadow | Breakdown::Polynomial)
    )
}

/// A second solve after a first.
pub(crate) fn joined(first: Solved, mut second: Solved) -> Solved {
    second.products += first.products;
    second.steps += first.steps;
    second.first = first.first;
    let mut history = first.history;
    history.append(&mut second.history);
    second.history = history;
    second
}

/// Why sparse factors do not solve a system: what they make is no solution.
fn refused<S: Scalar, const C: usize>(
    equations: &Equations<'_, impl Operator<S, C>, S, C>,
    y: &[[S; C]],
) -> Ending {
    let &Equations { a, b } = equations;
    let mut r = b.to_vec();
    let left = residual(a, b, y, &mut r);
    if left.iter().any(|r| !r.is_finite()) {
        return Ending::BrokenDown(Breakdown::Pivot);
    }
    let size = |v: &[[S; C]]| {
        let squares = v.iter().flatten().map(|v| v.square());
        squares.sum::<f64>().sqrt()
    };
    Ending::Stagnated(Stagnation::Singular {
        correction: size(y) / size(b).max(f64::MIN_POSITIVE),
    })
}
