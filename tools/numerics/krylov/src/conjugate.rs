//! Conjugate gradients.

use crate::operator::{column, column_mut};
use crate::scratch::{Scratch, fits};
use crate::sums::{add, add_norm, dot, subtract_from, turn};
use crate::{Breakdown, Ending, Inverse, Operator, Rule, Solved, Stagnation, Watch};

/// Conjugate gradients for a symmetric positive definite matrix; `x` is the first guess and
/// becomes the solution. Flexible (Polak and Ribiere; Notay 2000, SIAM J. Sci. Comput. 22, 1444):
/// each direction is made conjugate to the one before it by the matrix itself, so that a
/// preconditioner which is not the same linear map in each call does no harm.
///
/// # Panics
/// When lengths differ.
pub fn conjugate_gradient(
    a: &impl Operator<f64>,
    rhs: &[f64],
    x: &mut [f64],
    inverse: &mut impl Inverse<f64>,
    rule: Rule,
    scratch: &mut Scratch<f64>,
) -> Solved {
    let [r, z, p, q] = scratch.columns(fits(a.len(), rhs, x));
    let mut watch = begin(a, rhs, x, r, &rule);
    let mut goal = Goal::new(watch.target[0], a.rounding(column(x)));
    let (mut products, mut curvature, mut stuck) = (1, 0.0, None);
    loop {
        let ended = watch.ended(&rule, products, goal.reached(watch.now[0]));
        if let Some(mut ending) = ended.or(stuck) {
            if matches!(ending, Ending::Spent | Ending::Stopped) {
                products += 1;
                watch.note([residual(a, rhs, x, r)], products);
                ending = watch.ended(&rule, products, false).unwrap_or(ending);
            }
            return watch.solved(ending, products);
        }
        inverse.invert(column(r), column_mut(z));
        // A z . p = z . q makes the new direction conjugate to the old one.
        if curvature > 0.0 {
            turn(p, -dot(z, q) / curvature, z);
        } else {
            p.copy_from_slice(z);
        }
        a.apply(column(p), column_mut(q));
        products += 1;
        curvature = dot(p, q);
        let along = dot(r, p);
        if let Some(value) = [curvature, along].iter().find(|v| v.is_nan() || **v <= 0.0) {
            let finite = value.is_finite();
            let why = if finite {
                Breakdown::Indefinite
            } else {
                Breakdown::NotFinite
            };
            return watch.solved(Ending::BrokenDown(why), products);
        }
        let alpha = along / curvature;
        add(x, alpha, p);
        watch.step([add_norm(r, -alpha, q).sqrt()], products);
        if goal.reached(watch.now[0]) {
            // What counts is the true residual; after a drift, go on from there.
            products += 1;
            watch.note([residual(a, rhs, x, r)], products);
            curvature = 0.0;
            if goal.renewed(watch.now[0], a.rounding(column(x))) {
                stuck = Some(rounded(&watch));
            }
        }
    }
}

/// `r = b - A x` and its norm.
pub(crate) fn residual(a: &impl Operator<f64>, rhs: &[f64], x: &[f64], r: &mut [f64]) -> f64 {
    a.apply(column(x), column_mut(r));
    subtract_from(rhs, r).sqrt()
}

/// Looks at the first residual.
pub(crate) fn begin(
    a: &impl Operator<f64>,
    rhs: &[f64],
    x: &[f64],
    r: &mut [f64],
    rule: &Rule,
) -> Watch<1> {
    Watch::new(rule, [dot(rhs, rhs).sqrt()], [residual(a, rhs, x, r)])
}

/// The residual is as small as rounding lets it be.
pub(crate) fn rounded(watch: &Watch<1>) -> Ending {
    let [level] = watch.relative();
    Ending::Stagnated(Stagnation::Rounding { level })
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
