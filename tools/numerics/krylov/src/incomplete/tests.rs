//! Factors against what they must reproduce.

use super::*;
use num_complex::Complex;

type C64 = Complex<f64>;

/// A lattice with couplings to all points within two steps, a little different in each direction.
fn lattice(n: usize) -> Rows<f64> {
    Rows::gathered(n * n * n, 0.0, |i, row| {
        let at = [i % n, i / n % n, i / n / n];
        for (d, step) in [1, n, n * n].into_iter().enumerate() {
            for (m, g) in [(1, 1.0), (2, 0.1)] {
                let g = g * (1.0 + 0.1 * d as f64);
                row.push((i as u32, g * 2.01));
                if at[d] >= m {
                    row.push(((i - m * step) as u32, -g));
                }
                if at[d] + m < n {
                    row.push(((i + m * step) as u32, -0.9 * g));
                }
            }
        }
    })
}

fn error<S: Scalar, F: Coefficient<S>>(a: &Rows<f64>, shift: &[S], keep: Keep) -> f64
where
    f64: Coefficient<S>,
{
    let order = Order::cuthill_mckee(a);
    let b = a.permuted(&order);
    let mut mixed = vec![S::ZERO; shift.len()];
    order.forth(shift, &mut mixed);
    let factors = Incomplete::<F>::new(&b, &mixed, &order, keep);
    assert_eq!(factors.weak_pivots(), 0);
    let x: Vec<[S; 2]> = (0..b.len())
        .map(|i| [S::real((i % 17) as f64), S::ONE])
        .collect();
    let mut rhs = x.clone();
    b.product(&x, &mut rhs, |i, sum, out| {
        let d = mixed.get(i).copied().unwrap_or_default();
        *out = [sum[0] + d * x[i][0], sum[1] + d * x[i][1]];
    });
    let mut y = x.clone();
    factors.solve(&rhs, &mut y);
    let far = x.iter().zip(&y).map(|(x, y)| (x[0] - y[0]).modulus());
    far.fold(0.0, f64::max) / 17.0
}

#[test]
fn factors_that_keep_all_are_exact() {
    let all = Keep::Threshold {
        drop: 0.0,
        fill: 1e9,
    };
    let a = lattice(9);
    let none: [f64; 0] = [];
    assert!(error::<f64, f64>(&a, &none, all) < 1e-12);
    let single = error::<f64, f32>(&a, &none, all);
    assert!(single < 1e-4 && single > 1e-12, "{single}");
    let shift: Vec<C64> = (0..a.len())
        .map(|i| C64::new(0.0, (i % 3) as f64))
        .collect();
    assert!(error::<C64, C64>(&a, &shift, all) < 1e-12);
    assert!(error::<C64, Complex<f32>>(&a, &shift, all) < 1e-4);
}

#[test]
fn more_fill_is_a_better_inverse() {
    let a = lattice(16);
    let none: [f64; 0] = [];
    let kept = |drop| Keep::Threshold { drop, fill: 20.0 };
    let errors = [Keep::PATTERN, kept(1e-2), kept(1e-4)].map(|k| error::<f64, f64>(&a, &none, k));
    assert!(
        errors[0] > errors[1] && errors[1] > 5.0 * errors[2],
        "{errors:?}"
    );
}

#[test]
fn a_line_of_three_entries_is_factorised_exactly() {
    let n = 20_000;
    let a = Rows::gathered(n, 0.0, |i, row| {
        row.push((i as u32, 2.5));
        if i > 0 {
            row.push((i as u32 - 1, -1.0));
        }
        if i + 1 < n {
            row.push((i as u32 + 1, -1.2));
        }
    });
    let none: [f64; 0] = [];
    // Walls of single points: without fill, a wall loses its couplings through slabs.
    let order = Order::natural(n);
    let f = Incomplete::<f64>::new(&a, &none, &order, Keep::PATTERN);
    let x: Vec<[f64; 1]> = (0..n).map(|i| [(i % 5) as f64]).collect();
    let (mut rhs, mut y) = (x.clone(), x.clone());
    a.product(&x, &mut rhs, |_, sum, out| *out = sum);
    f.solve(&rhs, &mut y);
    let far = x.iter().zip(&y).map(|(x, y)| (x[0] - y[0]).abs());
    assert!(far.fold(0.0, f64::max) < 1e-12);
}

#[test]
fn bits_know_no_threads() {
    let a = lattice(26);
    let order = Order::cuthill_mckee(&a);
    assert!(order.slabs().walls.len() > 1);
    let b = a.permuted(&order);
    let rhs: Vec<[f64; 1]> = (0..b.len()).map(|i| [(i as f64).sin()]).collect();
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let keep = Keep::Threshold {
                drop: 1e-3,
                fill: 2.0,
            };
            let f = Incomplete::<f32>::new(&b, &[0.0; 0], &order, keep);
            let mut y = rhs.clone();
            f.solve(&rhs, &mut y);
            y
        })
    };
    assert_eq!(with(1), with(3));
}
