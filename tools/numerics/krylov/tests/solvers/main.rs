//! The solvers against dense solutions, jumps of coefficients, convection, faults and threads.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod clouds;

use clouds::{Cloud, dense, random};
use krylov::{
    Aggregation, Breakdown, Ending, Error, Inverse, Jacobi, Operator, Pattern, Rule, Scaled,
    Scratch, Solved, Sparse, conjugate_gradient, gmres,
};
use nalgebra::DVector;
use std::sync::Arc;

const RULE: Rule = Rule::to(1e-10, 101);

/// Solves with conjugate gradients and a fresh hierarchy.
fn solve(a: &Sparse, rhs: &[f64]) -> (Vec<f64>, Solved) {
    let mut x = vec![0.0; rhs.len()];
    let mut grid = Aggregation::new(a, true).unwrap();
    let scratch = &mut Scratch::default();
    let solved = conjugate_gradient(a, rhs, &mut x, &mut grid, RULE, scratch);
    assert!(solved.converged(), "{solved:?}");
    (x, solved)
}

/// Solves with GMRES and a fresh hierarchy.
fn solve_any(a: &Sparse, rhs: &[f64]) -> (Vec<f64>, Solved) {
    let mut x = vec![0.0; rhs.len()];
    let mut grid = Aggregation::new(a, false).unwrap();
    let scratch = &mut Scratch::default();
    let solved = gmres(a, rhs, &mut x, &mut grid, RULE.restarted(40), scratch);
    assert!(solved.converged(), "{solved:?}");
    (x, solved)
}

fn difference(x: &[f64], y: &[f64]) -> f64 {
    let most = y.iter().fold(0.0, |m, y| f64::max(m, y.abs()));
    let far = x
        .iter()
        .zip(y)
        .fold(0.0, |m, (x, y)| f64::max(m, (x - y).abs()));
    far / most
}

#[test]
fn solutions_are_those_of_a_dense_solver() {
    for (n, seed) in [
        (1, 1),
        (2, 2),
        (7, 3),
        (60, 4),
        (150, 5),
        (400, 6),
        (700, 7),
    ] {
        for spread in [1.0, 1e3, 1e6] {
            let (a, rhs) = random(n, seed, spread, true);
            let exact = dense(&a)
                .cholesky()
                .unwrap()
                .solve(&DVector::from_column_slice(&rhs));
            let (x, _) = solve(&a, &rhs);
            let far = difference(&x, exact.as_slice());
            assert!(far < 1e-7, "symmetric {n}, spread {spread}: {far}");

            let (a, rhs) = random(n, seed, spread, false);
            let exact = dense(&a)
                .lu()
                .solve(&DVector::from_column_slice(&rhs))
                .unwrap();
            let (x, _) = solve_any(&a, &rhs);
            let far = difference(&x, exact.as_slice());
            assert!(far < 1e-7, "unsymmetric {n}, spread {spread}: {far}");
        }
    }
}

#[test]
fn the_diagonal_is_a_preconditioner_too() {
    let (a, rhs) = random(200, 3, 10.0, true);
    let exact = dense(&a)
        .cholesky()
        .unwrap()
        .solve(&DVector::from_column_slice(&rhs));
    let rule = Rule::to(1e-10, 401);
    let mut jacobi = Jacobi::new(&a).unwrap();
    let mut work = Scratch::default();
    let mut x = vec![0.0; 200];
    let o = conjugate_gradient(&a, &rhs, &mut x, &mut jacobi, rule, &mut work);
    assert!(o.converged(), "{o:?}");
    assert!(difference(&x, exact.as_slice()) < 1e-7);
    x.fill(0.0);
    let o = gmres(&a, &rhs, &mut x, &mut jacobi, rule.restarted(60), &mut work);
    assert!(o.converged(), "{o:?}");
    assert!(difference(&x, exact.as_slice()) < 1e-7);
}

#[test]
fn iterations_hardly_grow_with_the_number_of_unknowns() {
    let most = |sides: [usize; 3], build: &dyn Fn(usize) -> (Sparse, Vec<f64>)| {
        sides.map(|side| {
            let (a, rhs) = build(side);
            solve(&a, &rhs).1.steps
        })
    };
    let flat = most([30, 100, 300], &|n| Cloud::square(n).build());
    assert!(flat.iter().all(|m| *m <= 21), "{flat:?}");
    let deep = most([8, 16, 32], &|n| Cloud::cube(n).build());
    assert!(deep.iter().all(|m| *m <= 18), "{deep:?}");
    let wide = most([30, 80, 200], &|n| {
        Cloud {
            reach: 3,
            ..Cloud::square(n)
        }
        .build()
    });
    assert!(wide.iter().all(|m| *m <= 21), "{wide:?}");
    let one = most([30, 100, 300], &|n| {
        Cloud {
            one: true,
            ..Cloud::square(n)
        }
        .build()
    });
    assert!(one.iter().all(|m| *m <= 26), "{one:?}");
}

#[test]
fn the_order_of_rows_hardly_matters() {
    // A line is the hardest: in random order nearly all couplings are between blocks.
    for (size, most) in [
        ([200, 200, 1], 24),
        ([32, 32, 32], 22),
        ([40_000, 1, 1], 34),
    ] {
        let cloud = Cloud {
            size,
            ..Cloud::square(1)
        };
        let (a, rhs) = cloud.build();
        let (b, mixed) = clouds::shuffled(&a, &rhs);
        let counts = [solve(&a, &rhs).1.steps, solve(&b, &mixed).1.steps];
        assert!(counts.iter().all(|m| *m <= most), "{size:?}: {counts:?}");
    }
}

#[test]
fn jumps_hardly_matter() {
    for jump in [1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9] {
        for one in [false, true] {
            let (a, rhs) = Cloud {
                jump,
                one,
                ..Cloud::square(120)
            }
            .build();
            let o = solve(&a, &rhs).1;
            assert!(o.steps <= 35, "jump {jump}, one {one}: {o:?}");
        }
    }
}

#[test]
fn strong_coupling_along_one_direction_only() {
    for squeeze in [1e-2, 1e-4, 1e-8] {
        let (a, rhs) = Cloud {
            squeeze,
            ..Cloud::square(120)
        }
        .build();
        let o = solve(&a, &rhs).1;
        assert!(o.steps <= 35, "squeeze {squeeze}: {o:?}");
    }
}

#[test]
fn points_that_nearly_coincide() {
    for close in [1e3, 1e6, 1e9] {
        let (a, rhs) = Cloud {
            close,
            ..Cloud::square(120)
        }
        .build();
        let o = solve(&a, &rhs).1;
        assert!(o.steps <= 30, "close {close}: {o:?}");
    }
}

#[test]
fn a_strong_diagonal_needs_few_iterations() {
    for (stored, most) in [(1e-3, 21), (1.0, 14), (1e2, 5), (1e4, 3)] {
        let (a, rhs) = Cloud {
            stored,
            ..Cloud::square(120)
        }
        .build();
        let o = solve(&a, &rhs).1;
        assert!(o.steps <= most, "stored {stored}: {o:?}");
    }
}

#[test]
fn convection() {
    for (flow, most) in [(0.1, 29), (1.0, 27), (10.0, 40), (1e3, 40)] {
        let counts = [30, 100, 200].map(|n| {
            let (a, rhs) = Cloud {
                flow,
                ..Cloud::square(n)
            }
            .build();
            solve_any(&a, &rhs).1.steps
        });
        assert!(counts.iter().all(|m| *m <= most), "flow {flow}: {counts:?}");
    }
}

/// `A diag(k)`: the Jacobian of conduction in the temperature.
fn jacobian(a: &Sparse, k: &[f64]) -> Sparse {
    let mut j = a.clone();
    let pattern = Arc::clone(a.pattern());
    let (diagonal, values) = j.parts_mut();
    for (d, k) in diagonal.iter_mut().zip(k) {
        *d *= k;
    }
    for (v, c) in values.iter_mut().zip(pattern.columns()) {
        *v *= k[*c as usize];
    }
    j
}

#[test]
fn jacobians_of_conductivity_that_depends_on_temperature() {
    let (a, rhs) = Cloud::square(100).build();
    let smooth = |i: usize| 20.0 + 15.0 * (i as f64 / 500.0).sin();
    let k: Vec<f64> = (0..rhs.len()).map(smooth).collect();
    let j = jacobian(&a, &k);
    let (x, o) = solve_any(&j, &rhs);
    assert!(o.steps <= 35, "{o:?}");
    // The hierarchy of the symmetric factor serves whatever the factors are.
    let mut grid = Aggregation::new(&a, true).unwrap();
    let mut scaled = Scaled {
        inner: &mut grid,
        columns: &k,
    };
    let (mut y, mut work) = (vec![0.0; rhs.len()], Scratch::default());
    let o = gmres(&j, &rhs, &mut y, &mut scaled, RULE.restarted(40), &mut work);
    assert!(o.steps <= 21, "{o:?}");
    assert!(difference(&x, &y) < 1e-7);
    let rough: Vec<f64> = (0..rhs.len())
        .map(|i| 10_f64.powi((i % 7) as i32 - 3))
        .collect();
    let j = jacobian(&a, &rough);
    scaled.columns = &rough;
    y.fill(0.0);
    let o = gmres(&j, &rhs, &mut y, &mut scaled, RULE.restarted(40), &mut work);
    assert!(o.steps <= 21 && o.converged(), "{o:?}");
}

#[test]
fn a_second_solve_costs_no_iterations() {
    for jump in [1.0, 1e9] {
        let (a, rhs) = Cloud {
            jump,
            ..Cloud::square(60)
        }
        .build();
        let mut grid = Aggregation::new(&a, true).unwrap();
        let (mut x, mut work) = (vec![0.0; rhs.len()], Scratch::default());
        let o = conjugate_gradient(&a, &rhs, &mut x, &mut grid, RULE, &mut work);
        let again = conjugate_gradient(&a, &rhs, &mut x, &mut grid, RULE, &mut work);
        assert_eq!((again.steps, again.last), (0, o.last));
        let again = gmres(&a, &rhs, &mut x, &mut grid, RULE.restarted(20), &mut work);
        assert_eq!((again.steps, again.last), (0, o.last));
    }
}

#[test]
fn renewed_is_as_good_as_new() {
    let build = |jump| {
        Cloud {
            jump,
            ..Cloud::square(90)
        }
        .build()
    };
    let ((a, rhs), (b, _)) = (build(1.0), build(50.0));
    let mut grid = Aggregation::new(&a, true).unwrap();
    let (mut x, mut y) = (vec![0.0; rhs.len()], vec![0.0; rhs.len()]);
    grid.invert(rhs.as_chunks().0, x.as_chunks_mut().0);
    // The same values: the same bits.
    grid.renew(&a).unwrap();
    grid.invert(rhs.as_chunks().0, y.as_chunks_mut().0);
    assert_eq!(x, y);
    // Other values: still a solver.
    grid.renew(&b).unwrap();
    x.fill(0.0);
    let work = &mut Scratch::default();
    let o = conjugate_gradient(&b, &rhs, &mut x, &mut grid, RULE, work);
    assert!(o.steps <= 30 && o.converged(), "{o:?}");
    // Groups of a short time step are of no use without storage.
    let (stored, _) = Cloud {
        stored: 50.0,
        ..Cloud::square(90)
    }
    .build();
    let mut short = Aggregation::new(&stored, true).unwrap();
    assert_eq!(short.levels(), 2);
    short.renew(&a).unwrap();
    x.fill(0.0);
    let o = conjugate_gradient(&a, &rhs, &mut x, &mut short, RULE, work);
    assert!(o.steps <= 22, "{o:?}");
    assert_eq!(
        grid.renew(&Cloud::square(3).build().0),
        Err(Error::Size {
            expected: 8100,
            found: 9
        })
    );
}

#[test]
fn threads_do_not_change_a_bit() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let (a, rhs) = Cloud {
                jump: 1e3,
                ..Cloud::square(200)
            }
            .build();
            let (x, _) = solve(&a, &rhs);
            let (b, rhs) = Cloud {
                flow: 1.0,
                ..Cloud::square(200)
            }
            .build();
            let (y, _) = solve_any(&b, &rhs);
            let bits = |x: Vec<f64>| x.into_iter().map(f64::to_bits).collect::<Vec<_>>();
            (bits(x), bits(y))
        })
    };
    let one = with(1);
    assert!(one == with(2) && one == with(3));
}

#[test]
fn memory_is_told_and_modest() {
    let (a, _) = Cloud::square(300).build();
    let grid = Aggregation::new(&a, true).unwrap();
    let matrix = 12 * a.values().len() + 16 * a.len();
    assert!(grid.bytes() < 2 * matrix, "{} of {matrix}", grid.bytes());
    assert!(grid.complexity() < 1.5 && grid.levels() > 3);
}

#[test]
fn faults_have_names() {
    let (good, rhs) = Cloud::square(40).build();
    let mut a = good.clone();
    a.diagonal_mut()[77] = -1.0;
    let negative = Error::NotPositive {
        index: 77,
        value: -1.0,
    };
    assert_eq!(Aggregation::new(&a, true).err(), Some(negative));
    assert_eq!(Jacobi::new(&a).err(), Some(negative));
    a.diagonal_mut()[77] = f64::NAN;
    let what = "the diagonal";
    assert_eq!(
        Aggregation::new(&a, true).err(),
        Some(Error::NotFinite { index: 77, what })
    );
    let mut a = good.clone();
    let k = a.pattern().row(500).start;
    a.values_mut()[k] = f64::INFINITY;
    let what = "a coefficient";
    assert_eq!(
        Aggregation::new(&a, false).err(),
        Some(Error::NotFinite { index: 500, what })
    );

    let mut grid = Aggregation::new(&good, true).unwrap();
    let mut work = Scratch::default();
    let (mut x, mut bad) = (vec![0.0; 1600], rhs.clone());
    bad[3] = f64::NAN;
    let lost = Ending::BrokenDown(Breakdown::NotFinite);
    let o = conjugate_gradient(&good, &bad, &mut x, &mut grid, RULE, &mut work);
    assert_eq!(o.ending, lost);
    let o = gmres(&good, &bad, &mut x, &mut grid, RULE.restarted(9), &mut work);
    assert_eq!(o.ending, lost);

    // Positive diagonal, but twice as much across: an eigenvalue is negative.
    let pattern = Arc::new(Pattern::new(vec![0, 1, 2], vec![1, 0]));
    let mut a = Sparse::zeros(pattern);
    a.diagonal_mut().fill(1.0);
    a.values_mut().fill(2.0);
    let mut jacobi = Jacobi::new(&a).unwrap();
    let o = conjugate_gradient(
        &a,
        &[1.0, -1.0],
        &mut [0.0; 2],
        &mut jacobi,
        RULE,
        &mut work,
    );
    let fault = Error::BrokenDown(Breakdown::Indefinite);
    assert_eq!((o.steps, o.sound()), (0, Err(fault)));
}

#[test]
fn insulated_rows_without_a_fixed_value_are_singular() {
    for n in [5, 60] {
        // A cloud whose right half hangs together, tied to nothing.
        let (whole, _) = Cloud::square(n).build();
        let right = |i: usize| i % n > n / 2;
        let mut a = whole.clone();
        a.fill(|i, columns, values| {
            for (v, j) in values.iter_mut().zip(columns) {
                *v = if right(i) == right(*j as usize) {
                    -1.0
                } else {
                    0.0
                };
            }
            let fixed = if right(i) { 0.0 } else { 1.0 };
            fixed - values.iter().sum::<f64>()
        });
        for symmetric in [true, false] {
            let fault = Aggregation::new(&a, symmetric).err();
            assert!(
                matches!(fault, Some(Error::Singular { index }) if right(index)),
                "{n}: {fault:?}"
            );
        }
    }
}

#[test]
fn strange_graphs_end() {
    // A hub with many leaves: no pairs of good quality.
    let n = 1000_u32;
    let mut offsets = vec![0, n as usize - 1];
    let mut columns: Vec<u32> = (1..n).collect();
    for _ in 1..n {
        columns.push(0);
        offsets.push(columns.len());
    }
    let mut a = Sparse::zeros(Arc::new(Pattern::new(offsets, columns)));
    a.fill(|i, columns, values| {
        values.fill(-1.0);
        columns.len() as f64 + if i == 9 { 1.0 } else { 0.0 }
    });
    let mut rhs = vec![0.0; n as usize];
    rhs[77] = 1.0;
    let (x, o) = solve(&a, &rhs);
    // Current 1 from leaf 77 through the hub and leaf 9.
    assert!(
        (x[77] - 3.0).abs() < 1e-6 && (x[9] - 1.0).abs() < 1e-6,
        "{o:?}"
    );
    // Rows without any neighbour.
    let mut a = Sparse::zeros(Arc::new(Pattern::new(vec![0; 301], vec![])));
    a.diagonal_mut().fill(4.0);
    let (x, _) = solve(&a, &[1.0; 300]);
    assert!(x.iter().all(|x| (x - 0.25).abs() < 1e-12));
    // No rows at all.
    let a = Sparse::zeros(Arc::new(Pattern::new(vec![0], vec![])));
    assert_eq!(solve(&a, &[]).1.steps, 0);
    assert!(a.is_empty());
}
