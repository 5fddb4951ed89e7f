use krylov::Rule;

use crate::electric::equations::{Held, Problem, Smeared};
use crate::stencils::region::{Kind, Region};
use crate::stencils::sides::{Form, Sides};
use crate::stencils::tests::rings;
use krylov::{Options, System};

/// Potential of a cylinder of permittivity `ratio` in a field of -1 along x.
fn exact(ratio: f64, p: [f64; 2]) -> f64 {
    let square = p[0] * p[0] + p[1] * p[1];
    if square <= 1.0 + 1e-9 {
        2.0 / (ratio + 1.0) * p[0]
    } else {
        p[0] * (1.0 - (ratio - 1.0) / (ratio + 1.0) / square)
    }
}

fn problem(region: &Region<2>, ratio: f64) -> Problem {
    let held = |i: usize| {
        matches!(region.kinds[i], Kind::Wall { .. })
            .then(|| Held::Potential(exact(ratio, region.places[i])))
    };
    Problem {
        permittivity: vec![1.0, ratio],
        electrodes: vec![None; 2],
        held: (0..region.len()).map(held).collect(),
    }
}

/// Largest errors of potential and field, of the largest of each.
fn errors(spacing: f64, ratio: f64, order: u8, smeared: bool) -> [f64; 2] {
    let region = rings(spacing);
    let problem = problem(&region, ratio);
    let form = Form {
        order,
        ..Form::default()
    };
    let form = if smeared {
        form.for_potentials()
    } else {
        form.for_harmonics(2)
    };
    let sides = Sides::new(&region, &form).unwrap();
    let crossing = smeared.then(|| Smeared::new(&region, &form).unwrap());
    let (rows, right) = match &crossing {
        None => problem.rows(&region, &sides),
        Some(stencils) => stencils.rows(&problem, &region),
    };
    let mut x = vec![[0.0]; region.len()];
    let rule = Rule {
        reduction: 1e-12,
        ..Rule::default()
    };
    let solved = System::new(rows, vec![], Options::default())
        .unwrap()
        .solve(&right, &mut x, rule);
    assert!(
        solved.converged(),
        "{spacing} {ratio} {order} {:?}",
        solved.ending
    );
    let v: Vec<f64> = x.iter().map(|x| x[0]).collect();
    let field = match &crossing {
        None => Problem::field(&region, &sides, &v, true),
        Some(stencils) => stencils.field(&v),
    };
    let mut found = [0.0_f64; 2];
    for i in 0..region.len() {
        let p = region.places[i];
        found[0] = found[0].max((v[i] - exact(ratio, p)).abs() / 3.0);
        let inside = p[0].hypot(p[1]) < 1.0 + 1e-9;
        let side = if inside { 1.0 - 2e-6 } else { 1.0 };
        for k in 0..2 {
            let h = 1e-6;
            let [mut a, mut b] = [p.map(|x| x * side); 2];
            a[k] -= h;
            b[k] += h;
            let slope = (exact(ratio, a) - exact(ratio, b)) / (2.0 * h);
            found[1] = found[1].max((field[i][k] - slope).abs() / 2.0);
        }
    }
    found
}

#[test]
fn one_sided_rows_have_order_p_less_one_up_to_the_interface() {
    for ratio in [0.1, 80.0, 1e6] {
        for (order, least) in [(2, [0.9, 0.9]), (4, [2.7, 2.9])] {
            let [coarse, fine] = [0.1, 0.05].map(|h| errors(h, ratio, order, false));
            let rates = [0, 1].map(|k| (coarse[k] / fine[k]).log2());
            let kept = rates[0] > least[0] && rates[1] > least[1];
            assert!(kept, "{ratio} {order}: {coarse:?} {fine:?}");
        }
    }
}

#[test]
fn the_smeared_form_is_worse() {
    let [crossing, sided] = [true, false].map(|s| errors(0.05, 80.0, 2, s));
    assert!(crossing[1] > 5.0 * sided[1]);
}

#[test]
fn harmonic_polynomials_of_degree_4_are_met_exactly() {
    let region = rings(0.1);
    // The real part of (x + i y)^4, beside a plane that a wall without field cannot hold.
    let exact = |p: [f64; 2]| {
        let [x, y] = p;
        x.powi(4) - 6.0 * x * x * y * y + y.powi(4) + 3.0 * x - 2.0
    };
    let mut problem = problem(&region, 1.0);
    for (held, place) in problem.held.iter_mut().zip(&region.places) {
        if let Some(Held::Potential(v)) = held {
            *v = exact(*place);
        }
    }
    let form = Form {
        order: 4,
        ..Form::default()
    }
    .for_harmonics(2);
    let sides = Sides::new(&region, &form).unwrap();
    let (rows, right) = problem.rows(&region, &sides);
    let mut x = vec![[0.0]; region.len()];
    let options = Options {
        method: krylov::Method::Direct,
        ..Options::default()
    };
    let mut system = System::new(rows, vec![], options).unwrap();
    assert!(system.solve(&right, &mut x, Rule::default()).converged());
    let v: Vec<f64> = x.iter().map(|x| x[0]).collect();
    let field = Problem::field(&region, &sides, &v, false);
    for (i, place) in region.places.iter().enumerate() {
        assert!((v[i] - exact(*place)).abs() < 1e-9, "{i} {}", v[i]);
        let [a, b] = *place;
        let slope = [
            4.0 * a.powi(3) - 12.0 * a * b * b + 3.0,
            4.0 * b.powi(3) - 12.0 * a * a * b,
        ];
        for k in 0..2 {
            assert!((field[i][k] + slope[k]).abs() < 1e-7, "{i} {:?}", field[i]);
        }
    }
}

/// Rows given as fluxes: the same few products for any contrast and any number of points.
#[test]
fn products_depend_neither_on_contrast_nor_on_size() {
    let products = |spacing: f64, ratio: f64| {
        let region = rings(spacing);
        let problem = problem(&region, ratio);
        let form = Form::default().for_harmonics(2);
        let sides = Sides::new(&region, &form).unwrap();
        let (rows, right) = problem.rows(&region, &sides);
        let options = Options {
            direct: 0,
            rescue: 0,
            fluxes: true,
            ..Options::default()
        };
        let mut x = vec![[0.0]; region.len()];
        let mut system = System::new(rows, vec![], options).unwrap();
        let solved = system.solve(&right, &mut x, Rule::default());
        assert!(solved.converged(), "{:?}", solved.ending);
        solved.products
    };
    for ratio in [1e-6, 80.0, 1e6] {
        let [coarse, fine] = [0.05, 0.02].map(|h| products(h, ratio));
        assert!(coarse <= 30 && fine <= 30, "{ratio}: {coarse} {fine}");
    }
}
