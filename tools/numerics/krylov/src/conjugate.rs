//! Conjugate gradients.

use crate::operator::{column, column_mut};
use crate::sums::{add, add_norm, dot, turn};
use crate::{Error, Inverse, Krylov, Operator, Outcome, Workspace, residual, sizes};

/// Conjugate gradients for a symmetric positive definite matrix; `x` is the first guess and
/// becomes the solution. Flexible (Polak and Ribiere; Notay 2000, SIAM J. Sci. Comput. 22, 1444):
/// each direction is made conjugate to the one before it by the matrix itself, so that a
/// preconditioner which is not the same linear map in each call does no harm.
///
/// # Errors
/// When the matrix or the preconditioner is not positive definite, values leave the numbers or
/// lengths differ. To run out of iterations is no error: see [`Outcome::last`].
pub fn conjugate_gradient(
    a: &impl Operator<f64>,
    rhs: &[f64],
    x: &mut [f64],
    inverse: &mut impl Inverse<f64>,
    rule: Krylov,
    work: &mut Workspace,
) -> Result<Outcome, Error> {
    sizes(a, rhs, x)?;
    let [r, z, p, q, ..] = work.fit(4, x.len()) else {
        return Err(Error::Size {
            expected: 4,
            found: 0,
        });
    };
    let first = residual(a, rhs, x, r)?;
    let mut goal = Goal::new(rule.target(first), a.rounding(column(x)));
    let (mut last, mut iterations, mut curvature) = (first, 0, 0.0);
    while !goal.reached(last) && iterations < rule.iterations {
        inverse.invert(column(r), column_mut(z));
        // A z . p = z . q makes the new direction conjugate to the old one.
        let beta = if curvature > 0.0 {
            -dot(z, q) / curvature
        } else {
            0.0
        };
        if curvature > 0.0 {
            turn(p, beta, z);
        } else {
            p.copy_from_slice(z);
        }
        a.apply(column(p), column_mut(q));
        curvature = dot(p, q);
        let along = dot(r, p);
        for value in [curvature, along] {
            if value.is_nan() || value <= 0.0 {
                return Err(indefinite(value, iterations, x, z));
            }
        }
        let alpha = along / curvature;
        add(x, alpha, p);
        last = add_norm(r, -alpha, q).sqrt();
        iterations += 1;
        if goal.reached(last) {
            // What counts is the true residual; after a drift, go on from there.
            last = residual(a, rhs, x, r)?;
            curvature = 0.0;
            if goal.renewed(last, a.rounding(column(x))) {
                break;
            }
        }
    }
    if iterations == rule.iterations {
        last = residual(a, rhs, x, r)?;
    }
    Ok(Outcome {
        iterations,
        first,
        last,
        rounding: a.rounding(column(x)),
    })
}

/// Norm below which a residual is none: products of such numbers with a matrix and with each other are no normal
/// numbers any more, and what is positive becomes zero.
const NOTHING: f64 = 1e-120;

/// The residual to be reached, and what has become of evaluating it anew.
pub(crate) struct Goal {
    pub(crate) target: f64,
    rounding: f64,
    before: f64,
}

impl Goal {
    pub(crate) fn new(target: f64, rounding: f64) -> Self {
        Self {
            target,
            rounding,
            before: f64::INFINITY,
        }
    }

    pub(crate) fn reached(&self, residual: f64) -> bool {
        residual <= self.target.max(self.rounding).max(NOTHING)
    }

    /// The residual evaluated anew: is it time to stop, because it is reached or because the last
    /// time was hardly worse?
    pub(crate) fn renewed(&mut self, residual: f64, rounding: f64) -> bool {
        self.rounding = rounding;
        let stalled = residual > 0.5 * self.before;
        self.before = residual;
        stalled || self.reached(residual)
    }
}

/// The error of a product that should be positive.
fn indefinite(value: f64, iteration: usize, x: &[f64], z: &[f64]) -> Error {
    if value.is_finite() {
        return Error::Indefinite { iteration, value };
    }
    let first = |values: &[f64]| values.iter().position(|v| !v.is_finite());
    match (first(x), first(z)) {
        (Some(index), _) => Error::NotFinite {
            index,
            what: "the value",
        },
        (None, Some(index)) => Error::NotFinite {
            index,
            what: "the preconditioned residual",
        },
        (None, None) => Error::NotFinite {
            index: 0,
            what: "the curvature",
        },
    }
}
