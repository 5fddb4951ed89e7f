//! Preconditioned Krylov solvers.

use crate::{Error, FivePoint, Outcome, Precondition};

/// Stopping rule: the L1 residual falls to `reduction` of its first value, or to `floor` (in the
/// unit of the source), or `iterations` are spent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Krylov {
    /// Wanted last / first residual.
    pub reduction: f64,
    /// Residual below which nothing is gained.
    pub floor: f64,
    /// Most iterations.
    pub iterations: usize,
}

/// Scratch columns of a solve, kept between solves.
#[derive(Debug, Clone, Default)]
pub struct Workspace {
    columns: [Vec<f64>; 8],
}

impl Workspace {
    fn fit(&mut self, n: usize) -> &mut [Vec<f64>; 8] {
        for column in &mut self.columns {
            column.resize(n, 0.0);
        }
        &mut self.columns
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    // Four running sums: fixed order, and the compiler can keep them in one register.
    let mut sums = [0.0; 4];
    let (a4, b4) = (a.chunks_exact(4), b.chunks_exact(4));
    let tail: f64 = a4
        .remainder()
        .iter()
        .zip(b4.remainder())
        .map(|(x, y)| x * y)
        .sum();
    for (x, y) in a4.zip(b4) {
        for m in 0..4 {
            sums[m] += x[m] * y[m];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + tail
}

fn l1(r: &[f64]) -> f64 {
    r.iter().map(|v| v.abs()).sum()
}

/// `y += a x`.
fn add(y: &mut [f64], a: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += a * x;
    }
}

fn finite(equation: &FivePoint, x: &[f64]) -> Result<(), Error> {
    match x.iter().position(|v| !v.is_finite()) {
        Some(k) => Err(Error::NotFinite {
            column: k % equation.columns,
            row: k / equation.columns,
            what: "the value",
        }),
        None => Ok(()),
    }
}

impl Krylov {
    fn done(&self, first: f64, last: f64) -> bool {
        last <= self.reduction * first || last <= self.floor
    }
}

/// Conjugate gradients for a symmetric equation, flexible (Polak-Ribiere), so that a slightly
/// unsymmetric preconditioner does no harm.
///
/// # Errors
/// When the values leave the numbers.
pub fn conjugate_gradient(
    equation: &FivePoint,
    x: &mut [f64],
    precondition: &mut impl Precondition,
    rule: Krylov,
    work: &mut Workspace,
) -> Result<Outcome, Error> {
    let [r, z, p, q, older, ..] = work.fit(x.len());
    equation.residual(x, r);
    let first = l1(r);
    let (mut last, mut iterations, mut rz_old) = (first, 0, 0.0);
    while iterations < rule.iterations && !rule.done(first, last) {
        precondition.precondition(r, z);
        let rz = dot(r, z);
        if rz == 0.0 {
            break;
        }
        let beta = if iterations == 0 {
            0.0
        } else {
            (rz - dot(older, z)) / rz_old
        };
        for (p, z) in p.iter_mut().zip(z.iter()) {
            *p = z + if iterations == 0 { 0.0 } else { beta * *p };
        }
        equation.apply(p, q);
        let curvature = dot(p, q);
        if curvature == 0.0 {
            break;
        }
        let alpha = dot(r, p) / curvature;
        older.copy_from_slice(r);
        add(x, alpha, p);
        add(r, -alpha, q);
        rz_old = rz;
        last = l1(r);
        iterations += 1;
    }
    finite(equation, x)?;
    Ok(Outcome {
        iterations,
        first,
        last,
    })
}

/// BiCGSTAB for an equation that need not be symmetric.
///
/// # Errors
/// When the values leave the numbers.
pub fn bicgstab(
    equation: &FivePoint,
    x: &mut [f64],
    precondition: &mut impl Precondition,
    rule: Krylov,
    work: &mut Workspace,
) -> Result<Outcome, Error> {
    let [r, shadow, p, v, s, t, y, z] = work.fit(x.len());
    equation.residual(x, r);
    shadow.copy_from_slice(r);
    let first = l1(r);
    let (mut last, mut iterations) = (first, 0);
    let (mut rho, mut alpha, mut omega) = (1.0, 1.0, 1.0);
    while iterations < rule.iterations && !rule.done(first, last) {
        let rho_new = dot(shadow, r);
        if rho_new == 0.0 || omega == 0.0 {
            break;
        }
        let beta = if iterations == 0 {
            0.0
        } else {
            rho_new / rho * (alpha / omega)
        };
        for k in 0..p.len() {
            p[k] = r[k]
                + if iterations == 0 {
                    0.0
                } else {
                    beta * (p[k] - omega * v[k])
                };
        }
        precondition.precondition(p, y);
        equation.apply(y, v);
        let along = dot(shadow, v);
        if along == 0.0 {
            break;
        }
        alpha = rho_new / along;
        s.copy_from_slice(r);
        add(s, -alpha, v);
        precondition.precondition(s, z);
        equation.apply(z, t);
        let tt = dot(t, t);
        omega = if tt > 0.0 { dot(t, s) / tt } else { 0.0 };
        add(x, alpha, y);
        add(x, omega, z);
        r.copy_from_slice(s);
        add(r, -omega, t);
        rho = rho_new;
        last = l1(r);
        iterations += 1;
    }
    finite(equation, x)?;
    Ok(Outcome {
        iterations,
        first,
        last,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Incomplete;

    /// A layered conductor: conductivity `ratio` in the lower half, 1 above; insulated sides, a
    /// current through the top, ground below. Convection `flow` upward makes it unsymmetric.
    fn layers(n: usize, ratio: f64, flow: f64) -> FivePoint {
        let mut a = FivePoint::new(n, n);
        let sigma = |j: usize| if j < n / 2 { ratio } else { 1.0 };
        let face = |j: usize| 2.0 / (1.0 / sigma(j) + 1.0 / sigma(j + 1));
        for j in 0..n {
            for i in 0..n {
                let k = j * n + i;
                a.east[k] = if i + 1 < n { sigma(j) } else { 0.0 };
                a.west[k] = if i > 0 { sigma(j) } else { 0.0 };
                a.north[k] = if j + 1 < n { face(j) } else { 0.0 };
                a.south[k] = if j > 0 { face(j - 1) + flow } else { 0.0 };
                a.centre[k] = a.east[k] + a.west[k] + a.north[k] + a.south[k];
                if j == 0 {
                    a.centre[k] += 2.0 * sigma(0) + flow;
                }
                if j + 1 == n {
                    a.source[k] = 1.0;
                }
            }
        }
        a
    }

    const RULE: Krylov = Krylov {
        reduction: 1e-10,
        floor: 0.0,
        iterations: 80,
    };

    #[test]
    fn incomplete_factors_serve_both_methods() {
        for ratio in [1.0, 1e12, 1e-7] {
            let (a, n) = (layers(97, ratio, 0.0), 97);
            let mut factors = Incomplete::default();
            factors.rebuild(&a).unwrap();
            let mut work = Workspace::default();
            let rule = Krylov {
                iterations: 200,
                ..RULE
            };
            let mut x = vec![0.0; n * n];
            let o = conjugate_gradient(&a, &mut x, &mut factors, rule, &mut work).unwrap();
            assert!(o.last <= 1e-10 * o.first, "ratio {ratio}: {o:?}");
        }
        let a = layers(64, 10.0, 30.0);
        let mut factors = Incomplete::default();
        factors.rebuild(&a).unwrap();
        let mut x = vec![0.0; 64 * 64];
        let mut work = Workspace::default();
        let o = bicgstab(&a, &mut x, &mut factors, RULE, &mut work).unwrap();
        assert!(o.last <= 1e-10 * o.first, "{o:?}");
    }

    #[test]
    fn a_second_solve_of_the_same_equation_costs_nothing() {
        let a = layers(32, 1.0, 0.0);
        let mut x = vec![0.0; 32 * 32];
        let mut factors = Incomplete::default();
        factors.rebuild(&a).unwrap();
        let mut work = Workspace::default();
        let first = conjugate_gradient(&a, &mut x, &mut factors, RULE, &mut work).unwrap();
        let rule = Krylov {
            floor: 1e-8 * first.first,
            ..RULE
        };
        let o = conjugate_gradient(&a, &mut x, &mut factors, rule, &mut work).unwrap();
        assert_eq!(o.iterations, 0);
    }
}
