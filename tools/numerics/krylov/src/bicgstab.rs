//! Stabilised bi-conjugate gradients.

use crate::conjugate::begin;
use crate::operator::{column, column_mut};
use crate::scratch::{Scratch, fits};
use crate::sums::{add, add_norm, dot};
use crate::{Breakdown, Ending, Inverse, Operator, Rule, Solved};

/// Stabilised bi-conjugate gradients for a matrix that need not be symmetric, preconditioned from the right (van der Vorst
/// 1992, SIAM J. Sci. Stat. Comput. 13, 631); `x` is the first guess and becomes the solution. For solves of a few
/// iterations: [`Solved::last`] is the residual that is carried along, and nothing begins anew where a divisor vanishes.
///
/// # Panics
/// When lengths differ.
pub fn bicgstab(
    a: &impl Operator<f64>,
    rhs: &[f64],
    x: &mut [f64],
    inverse: &mut impl Inverse<f64>,
    rule: Rule,
    scratch: &mut Scratch<f64>,
) -> Solved {
    let [r, shadow, p, v, s, t, y, z] = scratch.columns(fits(a.len(), rhs, x));
    let mut watch = begin(a, rhs, x, r, &rule);
    shadow.copy_from_slice(r);
    p.fill(0.0);
    v.fill(0.0);
    let mut products = 1;
    let (mut rho, mut alpha, mut omega) = (1.0, 1.0, 1.0);
    let mut ending = loop {
        if let Some(ending) = watch.ended(&rule, products, watch.all_done()) {
            break ending;
        }
        let before = rho;
        rho = dot(shadow, r);
        if rho == 0.0 || omega == 0.0 {
            break Ending::BrokenDown(Breakdown::Shadow);
        }
        let beta = rho / before * (alpha / omega);
        for ((p, r), v) in p.iter_mut().zip(&*r).zip(&*v) {
            *p = r + beta * (*p - omega * v);
        }
        inverse.invert(column(p), column_mut(y));
        a.apply(column(y), column_mut(v));
        let along = dot(shadow, v);
        if along == 0.0 {
            break Ending::BrokenDown(Breakdown::Shadow);
        }
        alpha = rho / along;
        s.copy_from_slice(r);
        add(s, -alpha, v);
        inverse.invert(column(s), column_mut(z));
        a.apply(column(z), column_mut(t));
        products += 2;
        let size = dot(t, t);
        omega = if size > 0.0 { dot(t, s) / size } else { 0.0 };
        add(x, alpha, y);
        add(x, omega, z);
        r.copy_from_slice(s);
        watch.step([add_norm(r, -omega, t).sqrt()], products);
    };
    if !x.iter().all(|x| x.is_finite()) {
        ending = Ending::BrokenDown(Breakdown::NotFinite);
    }
    watch.solved(ending, products)
}
