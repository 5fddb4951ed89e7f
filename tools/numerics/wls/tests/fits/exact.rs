//! Polynomials of the basis have no error.

use wls::{Everything, Metric, Plan, Reach, Rules, Stencils, Wants};

use crate::clouds::{Points, graded, lattice};

const ALL: Wants = Wants {
    value: true,
    gradient: true,
    hessian: true,
    laplacian: true,
};
/// Where the polynomials are centred.
const CENTRE: f64 = 0.4;

fn power(x: f64, n: i32, derivatives: i32) -> f64 {
    let factor: f64 = (0..derivatives).map(|d| f64::from(n - d)).product();
    if derivatives > n {
        0.0
    } else {
        factor * (x - CENTRE).powi(n - derivatives)
    }
}

/// The derivative `orders` (one number per axis) of the monomial with `exponents`.
fn monomial<const D: usize>(place: [f64; D], exponents: [i32; D], orders: [i32; D]) -> f64 {
    (0..D)
        .map(|a| power(place[a], exponents[a], orders[a]))
        .product()
}

fn exponents<const D: usize>(degree: i32) -> Vec<[i32; D]> {
    let side = degree as usize + 1;
    (0..side.pow(D as u32))
        .map(|k| std::array::from_fn(|a| (k / side.pow(a as u32) % side) as i32))
        .filter(|e: &[i32; D]| e.iter().sum::<i32>() <= degree)
        .collect()
}

/// Greatest error of all operators, for all monomials of degree up to that of the plan; derivatives
/// count by the least spacing.
fn worst<const D: usize>(
    points: &Points<D>,
    plan: &Plan,
    rules: &impl Rules<D>,
    least: f64,
) -> f64 {
    let search = points.search();
    let stencils = Stencils::build(&search, plan, rules).unwrap();
    assert_eq!(stencils.report().lowered, 0, "{:?}", stencils.report());
    let unit = |a: usize| std::array::from_fn::<i32, D, _>(|b| i32::from(a == b));
    let mut worst = 0.0_f64;
    for e in exponents::<D>(i32::from(plan.order)) {
        let field = points.field(|p| monomial(p, e, [0; D]));
        for (i, &place) in points.places.iter().enumerate() {
            let mut check = |found: f64, exact: f64, power: i32| {
                assert!(found.is_finite());
                worst = worst.max((found - exact).abs() * least.powi(power));
            };
            check(stencils.value(i).apply(&field), field[i], 0);
            let mut sum = 0.0;
            for a in 0..D {
                let first = stencils.derivative(i, a).apply(&field);
                check(first, monomial(place, e, unit(a)), 1);
                for b in a..D {
                    let both = std::array::from_fn(|c| unit(a)[c] + unit(b)[c]);
                    let exact = monomial(place, e, both);
                    check(stencils.second(i, a, b).apply(&field), exact, 2);
                    if a == b {
                        sum += exact;
                    }
                }
            }
            check(stencils.laplacian(i).apply(&field), sum, 2);
        }
    }
    worst
}

fn all_orders<const D: usize>(points: &Points<D>, rules: &impl Rules<D>, name: &str) {
    let spacings = points.metrics.iter().map(Metric::spacing);
    let least = spacings.fold(f64::INFINITY, f64::min);
    for order in 2..=4 {
        let error = worst(points, &Plan::new::<D>(order, ALL), rules, least);
        assert!(error < 1e-10, "{name}, order {order}: {error:e}");
    }
    let wants = Wants {
        hessian: false,
        laplacian: false,
        ..ALL
    };
    let stencils = Stencils::build(&points.search(), &Plan::new::<D>(1, wants), rules).unwrap();
    let field = points.field(|p| (0..D).map(|a| (a as f64 - 0.7) * p[a]).sum::<f64>());
    for i in 0..points.places.len() {
        assert!((stencils.value(i).apply(&field) - field[i]).abs() < 1e-12);
        for (a, slope) in stencils.gradient_of(&field, i).into_iter().enumerate() {
            assert!((slope - (a as f64 - 0.7)).abs() < 1e-11);
        }
    }
}

#[test]
fn regular_and_jittered_clouds() {
    for jitter in [0.0, 0.1, 0.3] {
        all_orders(&lattice::<2>(12, jitter), &Everything, "plane");
        all_orders(&lattice::<3>(7, jitter), &Everything, "space");
    }
}

#[test]
fn graded_clouds() {
    all_orders(&graded::<2>(14, 0.2), &Everything, "plane");
    all_orders(&graded::<3>(8, 0.2), &Everything, "space");
}

#[test]
fn half_supports() {
    let points = lattice::<2>(14, 0.2);
    let places = points.places.clone();
    // Points near the face x = 0 have none on that side: they take what lies behind.
    let half = move |i: usize, j: usize| places[i][0] < 0.3 || places[j][0] <= places[i][0];
    all_orders(&points, &half, "plane");
    let points = lattice::<3>(9, 0.2);
    let places = points.places.clone();
    let half = move |i: usize, j: usize| places[i][0] < 0.5 || places[j][0] <= places[i][0];
    all_orders(&points, &half, "space");
}

#[test]
fn layers_much_thinner_than_wide() {
    let mut points = lattice::<3>(8, 0.1);
    let normal = [0.6, 0.0, 0.8];
    for place in &mut points.places {
        let across = place[0] * normal[0] + place[2] * normal[2];
        for (x, n) in place.iter_mut().zip(normal) {
            *x -= 5.0 / 6.0 * across * n;
        }
    }
    // Squeezed six times along the normal.
    points.metrics = vec![Metric::layered(normal, 0.125 / 6.0, 0.125); points.places.len()];
    for order in 2..=4 {
        let plan = Plan::new::<3>(order, ALL);
        let error = worst(&points, &plan, &Everything, 0.125 / 6.0);
        assert!(error < 1e-10, "order {order}: {error:e}");
    }
}

#[test]
fn equal_supports_of_any_size_share_their_weights() {
    // Three lattices far apart, each twice as fine as the one before.
    let one = lattice::<3>(8, 0.0);
    let (mut places, mut metrics) = (Vec::new(), Vec::new());
    for k in 0..3 {
        let size = 0.5_f64.powi(k);
        let place = |p: &[f64; 3]| p.map(|x| x * size + 10.0 * f64::from(k));
        places.extend(one.places.iter().map(place));
        metrics.extend(
            one.metrics
                .iter()
                .map(|m| Metric::round(m.spacing() * size)),
        );
    }
    let points = Points { places, metrics };
    let plan = Plan::new::<3>(2, ALL);
    let search = points.search();
    let stencils = Stencils::build(&search, &plan, &Everything).unwrap();
    let report = stencils.report();
    assert_eq!(report.rows, 1536);
    assert_eq!(report.solved + report.shared, 1536);
    // Five kinds of places along each axis: two near each face, and inside.
    assert_eq!(report.solved, 125);
    for (i, place) in points.places.iter().enumerate() {
        let centred = |j: usize| points.places[j][0] - place[0];
        let curved = stencils.laplacian(i).apply_with(|j| centred(j).powi(2));
        assert!((curved - 2.0).abs() < 1e-10);
    }
}

#[test]
fn probes_at_any_place() {
    let points = lattice::<3>(8, 0.2);
    let search = points.search();
    let places = [[0.31, 0.77, 0.5], points.places[100], [0.0, 0.0, 0.0]];
    for order in 2..=4 {
        let plan = Plan {
            reach: Reach::Nearest(90),
            ..Plan::new::<3>(order, ALL)
        };
        let probes = Stencils::at(&search, &plan, &places, &Everything).unwrap();
        let field = points.field(|p| p[0] * p[1] + p[2]);
        for (i, place) in places.iter().enumerate() {
            let exact = place[0] * place[1] + place[2];
            assert!((probes.value(i).apply(&field) - exact).abs() < 1e-11);
            assert!((probes.derivative(i, 0).apply(&field) - place[1]).abs() < 1e-10);
        }
    }
}
