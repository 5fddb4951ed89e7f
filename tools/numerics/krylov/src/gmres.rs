//! Generalised minimal residuals.

use crate::conjugate::{Goal, begin, residual, rounded};
use crate::operator::{column, column_mut};
use crate::scratch::{Scratch, fits};
use crate::sums::{add, dot};
use crate::{Breakdown, Ending, Inverse, Operator, Restarted, Rule, Solved, Stagnation, Watch};

/// Restarted, flexible, right-preconditioned GMRES for a matrix that need not be symmetric
/// (Saad 1993, SIAM J. Sci. Comput. 14, 461); `x` is the first guess and becomes the solution.
/// Holds one column more than twice the steps of a cycle at most, and only those that a solve has come to need.
///
/// # Panics
/// When lengths differ.
pub fn gmres(
    a: &impl Operator<f64>,
    rhs: &[f64],
    x: &mut [f64],
    inverse: &mut impl Inverse<f64>,
    restarted: Restarted,
    scratch: &mut Scratch<f64>,
) -> Solved {
    let n = fits(a.len(), rhs, x);
    let Restarted { rule, after } = restarted;
    let [r] = scratch.columns(n);
    let mut watch = begin(a, rhs, x, r, &rule);
    let mut goal = Goal::new(watch.target[0], a.rounding(column(x)));
    let (mut products, mut stuck) = (1, None);
    loop {
        let before = watch.now[0];
        let ended = watch.ended(&rule, products, goal.reached(before));
        if let Some(ending) = ended.or(stuck) {
            return watch.solved(ending, products);
        }
        let room = Room {
            steps: after.max(1).min(rule.products - products),
            products,
            rule: &rule,
        };
        match cycle(a, x, inverse, &room, &mut watch, scratch) {
            Ok(steps) => products += steps + 1,
            Err(why) => return watch.solved(Ending::BrokenDown(why), products),
        }
        let met = watch.all_done();
        let [r] = scratch.columns(n);
        watch.note([residual(a, rhs, x, r)], products);
        // A minimised residual that is not the true one, or a cycle that gains nothing.
        if met && goal.renewed(watch.now[0], a.rounding(column(x))) {
            stuck = Some(rounded(&watch));
        } else if watch.now[0] > 0.999_999 * before {
            let products = room.steps;
            stuck = Some(Ending::Stagnated(Stagnation::Plateau { products }));
        }
    }
}

/// How far a cycle may go.
struct Room<'a> {
    steps: usize,
    /// Products before it.
    products: usize,
    rule: &'a Rule<'a>,
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
    fn solve(&mut self, steps: usize) -> Result<(), Breakdown> {
        for m in (0..steps).rev() {
            let wide = self.most + 1;
            let mut sum = self.side[m];
            for k in m + 1..steps {
                sum -= self.triangle[k * wide + m] * self.side[k];
            }
            let pivot = self.triangle[m * wide + m];
            if pivot == 0.0 || !pivot.is_finite() {
                return Err(Breakdown::Polynomial);
            }
            self.side[m] = sum / pivot;
        }
        Ok(())
    }
}

/// One cycle from the residual in column 0; its steps.
fn cycle(
    a: &impl Operator<f64>,
    x: &mut [f64],
    inverse: &mut impl Inverse<f64>,
    room: &Room,
    watch: &mut Watch<1>,
    scratch: &mut Scratch<f64>,
) -> Result<usize, Breakdown> {
    let (n, most) = (x.len(), room.steps);
    let mut numbers = std::mem::take(&mut scratch.small);
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
    small.side[0] = watch.now[0];
    let scale = 1.0 / watch.now[0];
    let [first] = scratch.columns(n);
    first.iter_mut().for_each(|v| *v *= scale);
    let mut m = 0;
    while m < most && !watch.all_done() && !room.rule.stopped() {
        // Column 2 m: basis; 2 m + 1: the same preconditioned; 2 m + 2: the next of the basis.
        let columns = scratch.fit(2 * m + 3, n);
        let (old, new) = columns.split_at_mut(2 * m + 1);
        let [z, v, ..] = new else { break };
        inverse.invert(column(&old[2 * m]), column_mut(z));
        a.apply(column(z), column_mut(v));
        let size = dot(v, v).sqrt();
        if !size.is_finite() {
            return Err(Breakdown::NotFinite);
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
        watch.step([small.side[m].abs()], room.products + m);
        // An invariant space holds the solution, or the matrix is singular.
        if length <= 1e-15 * size {
            break;
        }
        let inverse = 1.0 / length;
        v.iter_mut().for_each(|v| *v *= inverse);
    }
    small.solve(m)?;
    for k in 0..m {
        add(x, small.side[k], &scratch.columns[2 * k + 1]);
    }
    scratch.small = numbers;
    Ok(m)
}
