//! Stabilised bi-conjugate gradients.

use crate::operator::{column, column_mut};
use crate::sums::{add, add_norm, dot};
use crate::{Error, Inverse, Krylov, Operator, Outcome, Workspace, finite, residual, sizes};

/// Stabilised bi-conjugate gradients for a matrix that need not be symmetric, preconditioned from the right (van der Vorst
/// 1992, SIAM J. Sci. Stat. Comput. 13, 631); `x` is the first guess and becomes the solution. For solves of a few
/// iterations: [`Outcome::last`] is the residual that is carried along, and nothing begins anew where a divisor vanishes.
///
/// # Errors
/// When values leave the numbers or lengths differ. To run out of iterations is no error: see [`Outcome::last`].
pub fn bicgstab(
    a: &impl Operator<f64>,
    rhs: &[f64],
    x: &mut [f64],
    inverse: &mut impl Inverse<f64>,
    rule: Krylov,
    work: &mut Workspace,
) -> Result<Outcome, Error> {
    sizes(a, rhs, x)?;
    let [r, shadow, p, v, s, t, y, z, ..] = work.fit(8, x.len()) else {
        return Err(Error::Size {
            expected: 8,
            found: 0,
        });
    };
    let first = residual(a, rhs, x, r)?;
    shadow.copy_from_slice(r);
    p.fill(0.0);
    v.fill(0.0);
    let (mut last, mut iterations) = (first, 0);
    let (mut rho, mut alpha, mut omega) = (1.0, 1.0, 1.0);
    while last > rule.target(first) && iterations < rule.iterations {
        let before = rho;
        rho = dot(shadow, r);
        if rho == 0.0 || omega == 0.0 {
            break;
        }
        let beta = rho / before * (alpha / omega);
        for ((p, r), v) in p.iter_mut().zip(&*r).zip(&*v) {
            *p = r + beta * (*p - omega * v);
        }
        inverse.invert(column(p), column_mut(y));
        a.apply(column(y), column_mut(v));
        let along = dot(shadow, v);
        if along == 0.0 {
            break;
        }
        alpha = rho / along;
        s.copy_from_slice(r);
        add(s, -alpha, v);
        inverse.invert(column(s), column_mut(z));
        a.apply(column(z), column_mut(t));
        let size = dot(t, t);
        omega = if size > 0.0 { dot(t, s) / size } else { 0.0 };
        add(x, alpha, y);
        add(x, omega, z);
        r.copy_from_slice(s);
        last = add_norm(r, -omega, t).sqrt();
        iterations += 1;
    }
    finite("the value", x)?;
    Ok(Outcome {
        iterations,
        first,
        last,
        rounding: a.rounding(column(x)),
    })
}
