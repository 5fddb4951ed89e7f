//! Generalised minimal residuals.

use crate::conjugate::Goal;
use crate::operator::{column, column_mut};
use crate::sums::{add, dot};
use crate::{Error, Inverse, Krylov, Operator, Outcome, Restarted, Workspace, residual, sizes};

/// Restarted, flexible, right-preconditioned GMRES for a matrix that need not be symmetric
/// (Saad 1993, SIAM J. Sci. Comput. 14, 461); `x` is the first guess and becomes the solution.
/// Holds one column more than twice the steps of a cycle at most, and only those that a solve has come to need.
///
/// # Errors
/// When the matrix is singular on the way, values leave the numbers or lengths differ. To run out
/// of iterations is no error: see [`Outcome::last`].
pub fn gmres(
    a: &impl Operator<f64>,
    rhs: &[f64],
    x: &mut [f64],
    inverse: &mut impl Inverse<f64>,
    restarted: Restarted<Krylov>,
    work: &mut Workspace,
) -> Result<Outcome, Error> {
    sizes(a, rhs, x)?;
    let Restarted { rule, after } = restarted;
    let first = residual(a, rhs, x, &mut work.fit(1, x.len())[0])?;
    let mut goal = Goal::new(rule.target(first), a.rounding(column(x)));
    let (mut last, mut iterations) = (first, 0);
    while !goal.reached(last) && iterations < rule.iterations {
        let bounds = Cycle {
            steps: after.max(1).min(rule.iterations - iterations),
            residual: goal.target,
        };
        let cycle = cycle(a, x, inverse, last, bounds, work)?;
        iterations += cycle.steps;
        let before = last;
        last = residual(a, rhs, x, &mut work.columns[0])?;
        // A cycle that gains nothing, or a minimised residual that is not the true one.
        let met = cycle.residual <= goal.target;
        if last > 0.999_999 * before || (met && goal.renewed(last, a.rounding(column(x)))) {
            break;
        }
    }
    Ok(Outcome {
        iterations,
        first,
        last,
        rounding: a.rounding(column(x)),
    })
}

/// How far a cycle goes, or went.
struct Cycle {
    steps: usize,
    /// Norm of the residual as the rotations have it.
    residual: f64,
}

/// The small least-squares problem: an upper triangle, rotations and the rotated right side.
struct Small<'a> {
    triangle: &'a mut [f64],
    rotations: &'a mut [f64],
    side: &'a mut [f64],
    most: usize,
}

impl Small<'_> {
    fn column(&mut self, m: usize) -> &mut [f64] {
        let wide = self.most + 1;
        &mut self.triangle[m * wide..(m + 1) * wide]
    }

    /// Rotates column `m` into the triangle; the residual is the last of the right side.
    fn rotate(&mut self, m: usize) {
        for k in 0..m {
            let (c, s) = (self.rotations[2 * k], self.rotations[2 * k + 1]);
            let column = self.column(m);
            let (upper, lower) = (column[k], column[k + 1]);
            column[k] = c * upper + s * lower;
            column[k + 1] = c * lower - s * upper;
        }
        let column = self.column(m);
        let length = column[m].hypot(column[m + 1]);
        let (c, s) = if length > 0.0 {
            (column[m] / length, column[m + 1] / length)
        } else {
            (1.0, 0.0)
        };
        column[m] = length;
        (self.rotations[2 * m], self.rotations[2 * m + 1]) = (c, s);
        self.side[m + 1] = -s * self.side[m];
        self.side[m] *= c;
    }

    /// Backward substitution of the first `steps` rows, in place of the right side.
    fn solve(&mut self, steps: usize) -> Result<(), Error> {
        for m in (0..steps).rev() {
            let wide = self.most + 1;
            let mut sum = self.side[m];
            for k in m + 1..steps {
                sum -= self.triangle[k * wide + m] * self.side[k];
            }
            let pivot = self.triangle[m * wide + m];
            if pivot == 0.0 || !pivot.is_finite() {
                return Err(Error::Singular { index: 0 });
            }
            self.side[m] = sum / pivot;
        }
        Ok(())
    }
}

/// One cycle from the residual in column 0, of norm `norm`, to either of the bounds.
fn cycle(
    a: &impl Operator<f64>,
    x: &mut [f64],
    inverse: &mut impl Inverse<f64>,
    norm: f64,
    bounds: Cycle,
    work: &mut Workspace,
) -> Result<Cycle, Error> {
    let (n, most) = (x.len(), bounds.steps);
    let mut numbers = std::mem::take(&mut work.small);
    numbers.clear();
    numbers.resize(most * (most + 1) + 3 * most + 1, 0.0);
    let (triangle, rest) = numbers.split_at_mut(most * (most + 1));
    let (rotations, side) = rest.split_at_mut(2 * most);
    let mut small = Small {
        triangle,
        rotations,
        side,
        most,
    };
    small.side[0] = norm;
    let columns = work.fit(1, n);
    let scale = 1.0 / norm;
    columns[0].iter_mut().for_each(|v| *v *= scale);
    let mut m = 0;
    while m < most && small.side[m].abs() > bounds.residual {
        // Column 2 m: basis; 2 m + 1: the same preconditioned; 2 m + 2: the next of the basis.
        let columns = work.fit(2 * m + 3, n);
        let (old, new) = columns.split_at_mut(2 * m + 1);
        let [z, v, ..] = new else { break };
        inverse.invert(column(&old[2 * m]), column_mut(z));
        a.apply(column(z), column_mut(v));
        let size = dot(v, v).sqrt();
        if !size.is_finite() {
            crate::finite("the value", x)?;
            crate::finite("the preconditioned residual", z)?;
            crate::finite("the product", v)?;
        }
        for k in 0..=m {
            let h = dot(&old[2 * k], v);
            add(v, -h, &old[2 * k]);
            small.column(m)[k] = h;
        }
        let length = dot(v, v).sqrt();
        small.column(m)[m + 1] = length;
        small.rotate(m);
        m += 1;
        // An invariant space holds the solution, or the matrix is singular.
        if length <= 1e-15 * size {
            break;
        }
        let inverse = 1.0 / length;
        v.iter_mut().for_each(|v| *v *= inverse);
    }
    let left = small.side[m].abs();
    small.solve(m)?;
    for k in 0..m {
        add(x, small.side[k], &work.columns[2 * k + 1]);
    }
    work.small = numbers;
    Ok(Cycle {
        steps: m,
        residual: left,
    })
}
