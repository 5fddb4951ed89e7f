//! Solvers on equations of scattered points: jumps, eddy currents, layers, what cannot be solved.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod clouds;

use clouds::{C64, Cloud};
use krylov::{
    Coefficient, Direct, Ending, Grids, Inverse, Keep, Method, Operator, Options, Pair, Rescue,
    Rows, Rule, Shifted, Solved, Stagnation, System,
};

fn options(method: Method) -> Options {
    Options {
        method,
        ..Options::default()
    }
}

/// Largest residual of a row, over its largest coefficient.
fn left(cloud: &clouds::System, x: &[[C64; 3]]) -> f64 {
    let zeros = vec![C64::ZERO; cloud.rows.len()];
    let shift = if cloud.shift.is_empty() {
        &zeros
    } else {
        &cloud.shift
    };
    let a = Shifted {
        rows: &cloud.rows,
        shift,
    };
    let mut r = cloud.rhs.clone();
    a.apply(x, &mut r);
    let rows = (0..r.len()).map(|i| {
        let largest = cloud.rows.values(i).iter().map(|v| v.abs());
        let largest = largest.fold(shift[i].norm(), f64::max);
        let off = (0..3).map(|c| (r[i][c] - cloud.rhs[i][c]).norm());
        off.fold(0.0, f64::max) / largest
    });
    rows.fold(0.0, f64::max)
}

/// Solves a cloud by a method; the true residuals are checked.
fn solved(cloud: Cloud, method: Method) -> (Solved, Vec<[C64; 3]>) {
    let equations = cloud.build();
    let (rows, shift) = (equations.rows.clone(), equations.shift.clone());
    let mut system = System::<f64, C64>::new(rows, shift, options(method)).unwrap();
    let mut x = vec![[C64::ZERO; 3]; equations.rhs.len()];
    let solved = system.solve(&equations.rhs, &mut x, Rule::default());
    assert!(solved.converged(), "{cloud:?}: {}", solved.ending);
    assert!(solved.worst() <= 1e-8);
    let left = left(&equations, &x);
    assert!(left < 1e-5, "{cloud:?}: {left}");
    (solved, x)
}

#[test]
fn products_hardly_grow_with_the_number_of_points() {
    let grids = Method::Multigrid(Grids::default());
    let counts = [16, 24, 36].map(|side| solved(Cloud::plain(side), grids).0.products);
    assert!(counts.iter().all(|m| *m <= 20), "{counts:?}");
    let factors = Method::Incomplete(Keep::PATTERN);
    let alone = solved(Cloud::plain(36), factors).0.products;
    assert!(alone > counts[2], "{alone} {counts:?}");
}

/// Factors of a ball of permittivity 80 serve one of 60; the answer is that of the rows that were taken.
#[test]
fn a_system_that_takes_other_rows_solves_those() {
    let [made, other] = [80.0, 60.0].map(|ratio| Cloud::ball(22, ratio).build());
    let grids = options(Method::Multigrid(Grids::default()));
    let (rows, shift) = (made.rows.clone(), made.shift.clone());
    let mut system = System::<f64, C64>::new(rows, shift, grids).unwrap();
    system.renew(other.rows.clone()).unwrap();
    let mut x = vec![[C64::ZERO; 3]; other.rhs.len()];
    let solved = system.solve(&other.rhs, &mut x, Rule::default());
    assert!(solved.converged(), "{}", solved.ending);
    assert!(left(&other, &x) < 1e-5 && left(&made, &x) > 1e-3);
    let few = Cloud::plain(8).build().rows;
    assert!(system.renew(few).is_err());
}

#[test]
fn products_hardly_grow_with_the_levels() {
    for cloud in [
        Cloud::ball(22, 80.0),
        Cloud {
            squeeze: 0.16,
            ..Cloud::plain(22)
        },
    ] {
        let count = |bottom: usize| {
            let grids = Grids {
                bottom,
                ..Grids::default()
            };
            solved(cloud, Method::Multigrid(grids)).0.products
        };
        let (two, more) = (count(1500), count(10));
        assert!(
            more <= two + two / 2,
            "{cloud:?}: {more}, two levels: {two}"
        );
    }
}

#[test]
fn products_hardly_grow_with_the_jump() {
    let grids = Method::Multigrid(Grids::default());
    let count = |ratio| solved(Cloud::ball(22, ratio), grids).0.products;
    let usual = count(80.0);
    for ratio in [2.0, 1e3, 1e6] {
        let found = count(ratio);
        assert!(found <= 2 * usual, "ratio {ratio}: {found}, 80: {usual}");
    }
}

#[test]
fn rows_given_as_fluxes_have_the_same_solution() {
    let cloud = Cloud::ball(22, 80.0).build();
    let n = cloud.rows.len();
    let solve = |fluxes: bool| {
        let options = Options {
            fluxes,
            ..options(Method::Multigrid(Grids::default()))
        };
        let made = System::<f64, C64>::new(cloud.rows.clone(), cloud.shift.clone(), options);
        let mut x = vec![[C64::ZERO; 3]; n];
        let solved = made.unwrap().solve(&cloud.rhs, &mut x, Rule::default());
        assert!(solved.converged(), "{fluxes}: {}", solved.ending);
        x
    };
    let [a, b] = [false, true].map(solve);
    let far = a.iter().zip(&b).map(|(a, b)| (a[1] - b[1]).norm());
    assert!(far.fold(0.0, f64::max) < 1e-5);
}

#[test]
fn eddy_currents_of_all_depths() {
    let grids = Method::Multigrid(Grids::default());
    for shift in [1e2, 1e4, 1e6] {
        let cloud = Cloud {
            shift,
            ..Cloud::ball(22, 1.0)
        };
        let found = solved(cloud, grids).0.products;
        assert!(found <= 30, "{shift}: {found}");
    }
}

#[test]
fn squeezed_layers() {
    let grids = Method::Multigrid(Grids::default());
    for squeeze in [0.5, 0.16, 0.05] {
        let cloud = Cloud {
            squeeze,
            ..Cloud::plain(22)
        };
        let found = solved(cloud, grids).0.products;
        assert!(found <= 50, "{squeeze}: {found}");
    }
}

#[test]
fn all_methods_find_the_same_solution() {
    let cloud = Cloud {
        shift: 300.0,
        ..Cloud::ball(14, 3.0)
    };
    let exact = solved(cloud, Method::Direct).1;
    let others = [
        Method::Chosen,
        Method::Multigrid(Grids::default()),
        Method::Incomplete(Keep::PATTERN),
        Method::IncompleteComplex(Keep::Threshold {
            drop: 0.01,
            fill: 2.0,
        }),
    ];
    for method in others {
        let found = solved(cloud, method).1;
        let far = exact.iter().zip(&found).map(|(a, b)| (a[2] - b[2]).norm());
        assert!(far.fold(0.0, f64::max) < 1e-5, "{method:?}");
    }
}

#[test]
fn a_low_rank_part_is_solved_with_the_factors_of_the_rest() {
    let cloud = Cloud::plain(18).build();
    let n = cloud.rows.len();
    let field = |i: usize| (0.02 * i as f64).sin();
    // The right side of rows near the middle knows a mean of the solution.
    let u: Vec<f64> = (0..n)
        .map(|i| if i % 97 == 50 { field(i) } else { 0.0 })
        .collect();
    let v: Vec<f64> = (0..n).map(|i| (1.0 + field(i)) / n as f64).collect();
    let x: Vec<[f64; 1]> = (0..n).map(|i| [field(3 * i)]).collect();
    let mut rhs = x.clone();
    cloud.rows.apply(&x, &mut rhs);
    let mean: f64 = x.iter().zip(&v).map(|(x, v)| x[0] * v).sum();
    for (rhs, u) in rhs.iter_mut().zip(&u) {
        rhs[0] += u * mean;
    }
    let grids = options(Method::Multigrid(Grids::default()));
    let mut system = System::<f64, f64>::new(cloud.rows, Vec::new(), grids).unwrap();
    let mut y = vec![[0.0]; n];
    let rule = Rule {
        reduction: 1e-11,
        ..Rule::default()
    };
    let solved = system.solve_with(&[Pair::new(u, v)], &rhs, &mut y, rule);
    assert!(solved.converged() && solved.products < 40, "{solved:?}");
    let far = x.iter().zip(&y).map(|(x, y)| (x[0] - y[0]).abs());
    assert!(far.fold(0.0, f64::max) < 1e-6);
}

#[test]
fn other_rows_of_the_same_unknowns_precondition() {
    let cloud = Cloud::ball(20, 80.0);
    let equations = cloud.build();
    let low = Cloud {
        ratio: 60.0,
        ..cloud
    };
    let grids = options(Method::Multigrid(Grids::default()));
    let rows = equations.rows.clone();
    let mut system =
        System::<f64, C64>::with_low_order(rows, Vec::new(), low.build().rows, grids).unwrap();
    let mut x = vec![[C64::ZERO; 3]; equations.rhs.len()];
    let found = system.solve(&equations.rhs, &mut x, Rule::default());
    assert!(found.converged() && found.products < 60, "{found:?}");
    assert!(left(&equations, &x) < 1e-5);
}

#[test]
fn a_ball_that_hardly_conducts_is_rescued() {
    // One-sided rows next to an insulator make the iteration stagnate; sparse factors do not.
    let equations = Cloud::ball(18, 1e-6).build();
    let mut system =
        System::<f64, C64>::new(equations.rows.clone(), Vec::new(), Options::default()).unwrap();
    let mut x = vec![[C64::ZERO; 3]; equations.rhs.len()];
    let solved = system.solve(&equations.rhs, &mut x, Rule::default());
    assert!(solved.converged(), "{}", solved.ending);
    assert!(left(&equations, &x) < 1e-6);
    goes_on_the_same(&equations, system);
}

/// What was rescued goes on with the bits of a system that is told how, from the same guess.
fn goes_on_the_same(equations: &clouds::System, mut system: System<f64, C64>) {
    let way = system.rescued().unwrap();
    let rows = equations.rows.clone();
    let mut told = System::<f64, C64>::new(rows, Vec::new(), Options::default()).unwrap();
    let mut anew = vec![[C64::ZERO; 3]; equations.rhs.len()];
    let mut other = anew.clone();
    system.solve(&equations.rhs, &mut anew, Rule::default());
    told.rescue(way).unwrap();
    told.solve(&equations.rhs, &mut other, Rule::default());
    assert_eq!(told.rescued(), Some(way));
    assert_eq!(anew, other);
}

#[test]
fn incomplete_factors_take_over_where_multigrid_stands_still() {
    // Coarse equations of a ball that conducts a million times better than the real one.
    let equations = Cloud::ball(18, 1e-2).build();
    let low = Cloud::ball(18, 1e4).build().rows;
    let options = Options {
        rescue: 0,
        ..Options::default()
    };
    for method in [Method::Multigrid(Grids::default()), Method::Chosen] {
        let rows = equations.rows.clone();
        let options = Options { method, ..options };
        let mut system =
            System::<f64, C64>::with_low_order(rows, Vec::new(), low.clone(), options).unwrap();
        let mut x = vec![[C64::ZERO; 3]; equations.rhs.len()];
        let solved = system.solve(&equations.rhs, &mut x, Rule::default());
        println!(
            "{method:?} {} {} {:?}",
            solved.products,
            solved.ending,
            system.rescued()
        );
        let chosen = method == Method::Chosen;
        assert_eq!(system.rescued(), chosen.then_some(Rescue::Incomplete));
        assert_eq!(solved.converged(), chosen, "{}", solved.ending);
        assert!(!chosen || left(&equations, &x) < 1e-6);
    }
}

#[test]
fn a_constant_that_nothing_fixes_is_told() {
    // No wall: every row adds up to zero; a right side that is not in reach.
    let n = 3000;
    let rows = Rows::gathered(n, 0.0, |i, row| {
        for k in [1, 55, n - 1, n - 55] {
            row.push((((i + k) % n) as u32, 1.0));
            row.push((i as u32, -1.0));
        }
    });
    let mut system = System::<f64, f64>::new(rows, Vec::new(), Options::default()).unwrap();
    let mut x = vec![[0.0]; n];
    let solved = system.solve(&vec![[1.0]; n], &mut x, Rule::default());
    assert!(!solved.converged());
    assert!(
        matches!(solved.ending, Ending::Stagnated(_) | Ending::BrokenDown(_)),
        "{}",
        solved.ending
    );
}

#[test]
fn rounding_is_told_from_a_weak_method() {
    let equations = Cloud::plain(14).build();
    let mut system = System::<f64, C64>::new(
        equations.rows.clone(),
        Vec::new(),
        options(Method::Multigrid(Grids::default())),
    )
    .unwrap();
    let mut x = vec![[C64::ZERO; 3]; equations.rhs.len()];
    let rule = Rule {
        reduction: 1e-19,
        ..Rule::default()
    };
    let solved = system.solve(&equations.rhs, &mut x, rule);
    let Ending::Stagnated(Stagnation::Rounding { level }) = solved.ending else {
        panic!("{}", solved.ending)
    };
    assert!(level < 1e-13 && solved.worst() < 1e-13, "{level}");
}

#[test]
fn bits_know_no_threads() {
    let cloud = Cloud {
        shift: 1e3,
        ..Cloud::ball(24, 10.0)
    };
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap()
            .install(|| solved(cloud, Method::Multigrid(Grids::default())))
    };
    assert!(with(1) == with(3));
}

#[test]
fn faults_are_located() {
    let rows = Rows::gathered(3000, 0.0, |i, row| {
        row.push((i as u32, if i == 1234 { f64::NAN } else { 1.0 }));
        row.push((((i + 7) % 3000) as u32, -0.5));
    });
    let error = System::<f64, f64>::new(rows, Vec::new(), Options::default()).err();
    assert!(error.unwrap().to_string().starts_with("row 1234"));
    let rows = Rows::gathered(3000, 0.0, |i, row| {
        row.push((i as u32, if i == 99 { 0.0 } else { 1.0 }));
    });
    let error = System::<f64, f64>::new(rows, Vec::new(), Options::default()).err();
    assert!(error.unwrap().to_string().starts_with("row 99"));
}

/// Sparse factors invert what they are given.
#[test]
fn sparse_factors_are_exact() {
    let equations = Cloud::ball(12, 80.0).build();
    let mut factors = Direct::<f64>::new(&equations.rows, &[]).unwrap();
    let n = equations.rows.len();
    let x: Vec<[f64; 1]> = (0..n).map(|i| [(i % 7) as f64]).collect();
    let (mut rhs, mut y) = (x.clone(), x.clone());
    equations.rows.apply(&x, &mut rhs);
    factors.invert(&rhs, &mut y);
    for (x, y) in x.iter().zip(&y) {
        assert!((x[0] - y[0]).abs() < 1e-8);
    }
    let widened: C64 = 2.0_f32.widened();
    assert!(widened == C64::new(2.0, 0.0));
}
