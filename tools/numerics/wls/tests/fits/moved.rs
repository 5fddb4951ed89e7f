//! Fits that points take with them: what is linear stays exact, and the order stays.

use wls::{Everything, Moved, Plan, Stencils, Wants};

use crate::clouds::lattice;

const ALL: Wants = Wants {
    value: false,
    gradient: true,
    hessian: true,
    laplacian: true,
};
const BOTH: Wants = Wants {
    hessian: false,
    ..ALL
};

/// A smooth map, of which 1 turns, stretches and bends.
fn map<const D: usize>(much: f64, p: [f64; D]) -> [f64; D] {
    let mut moved = p;
    moved[0] += much * (0.2 * p[0] + 0.1 * (3.0 * p[1]).sin());
    moved[1] += much * (0.15 * p[0] * p[1] - 0.1 * p[0]);
    if D == 3 {
        moved[2] += much * 0.1 * (2.0 * p[0]).cos();
    }
    moved
}

/// Root mean square errors of gradient and Laplacian of exp(x) sin(2 y + 1) at points that have moved.
fn errors<const D: usize>(n: usize, order: u8, much: f64) -> [f64; 2] {
    let points = lattice::<D>(n, 0.2);
    let fits = Stencils::build(&points.search(), &Plan::new::<D>(order, ALL), &Everything).unwrap();
    let places: Vec<[f64; D]> = points.places.iter().map(|p| map(much, *p)).collect();
    let moved = Moved::new(&fits, &places);
    let few = Stencils::build(&points.search(), &Plan::new::<D>(order, BOTH), &Nothing).unwrap();
    let mut carried = few;
    moved.fill(&fits, &mut carried, |_| true);
    let field: Vec<f64> = (places.iter())
        .map(|p| p[0].exp() * (2.0 * p[1] + 1.0).sin())
        .collect();
    let (mut first, mut second) = (0.0, 0.0);
    for (i, p) in places.iter().enumerate() {
        let slope = 2.0 * p[0].exp() * (2.0 * p[1] + 1.0).cos();
        let found = carried.gradient_of(&field, i);
        first += (found[0] - field[i]).powi(2) + (found[1] - slope).powi(2);
        second += (carried.laplacian(i).apply(&field) + 3.0 * field[i]).powi(2);
        let row = moved.laplacian(&fits, i);
        let sum: f64 = row.map(|(j, w)| w * field[j]).sum();
        let both = carried.laplacian(i).apply(&field);
        assert!((sum - both).abs() < 1e-9 * (1.0 + both.abs()));
    }
    let count = places.len() as f64;
    [(first / count).sqrt(), (second / count).sqrt()]
}

/// No row at all.
struct Nothing;

impl<const D: usize> wls::Rules<D> for Nothing {
    fn wanted(&self, _: usize) -> bool {
        false
    }
}

#[test]
fn the_order_of_carried_fits_is_that_of_their_polynomials() {
    for order in 2..=4 {
        let (coarse, fine) = (errors::<2>(16, order, 1.0), errors::<2>(48, order, 1.0));
        let observed = |k: usize| (coarse[k] / fine[k]).ln() / 3.0_f64.ln();
        let p = f64::from(order);
        assert!(
            observed(0) > p - 0.2 && observed(1) > p - 1.2,
            "order {order}: gradient {:.2}, Laplacian {:.2}",
            observed(0),
            observed(1)
        );
    }
    let (coarse, fine) = (errors::<3>(8, 3, 1.0), errors::<3>(16, 3, 1.0));
    assert!(coarse[0] > 6.0 * fine[0] && coarse[1] > 3.0 * fine[1]);
}

#[test]
fn what_is_linear_has_its_slopes_and_no_laplacian_wherever_points_go() {
    let points = lattice::<3>(7, 0.3);
    let fits = Stencils::build(&points.search(), &Plan::new::<3>(3, ALL), &Everything).unwrap();
    let places: Vec<[f64; 3]> = points.places.iter().map(|p| map(1.0, *p)).collect();
    let moved = Moved::new(&fits, &places);
    let linear: Vec<f64> = places
        .iter()
        .map(|p| 2.0 * p[0] - p[1] + 3.0 * p[2])
        .collect();
    for i in 0..places.len() {
        let sum: f64 = moved.laplacian(&fits, i).map(|(j, w)| w * linear[j]).sum();
        assert!(sum.abs() < 1e-9, "{i}: {sum}");
        assert!(moved.strain(i).unwrap() > 1e-3);
    }
}

#[test]
fn points_that_turn_together_keep_their_laplacians() {
    let points = lattice::<2>(9, 0.3);
    let fits = Stencils::build(&points.search(), &Plan::new::<2>(3, ALL), &Everything).unwrap();
    let (sine, cosine) = 0.7_f64.sin_cos();
    let turned = |p: &[f64; 2]| {
        [
            5.0 + cosine * p[0] - sine * p[1],
            sine * p[0] + cosine * p[1],
        ]
    };
    let places: Vec<[f64; 2]> = points.places.iter().map(turned).collect();
    let moved = Moved::new(&fits, &places);
    for i in 0..places.len() {
        assert!(moved.strain(i).unwrap() < 1e-9);
        for ((j, now), (k, before)) in moved.laplacian(&fits, i).zip(fits.laplacian(i).iter()) {
            assert_eq!(j, k);
            assert!((now - before).abs() < 1e-9 * 81.0);
        }
    }
}

#[test]
fn a_map_that_folds_carries_nothing() {
    let points = lattice::<2>(9, 0.0);
    let fits = Stencils::build(&points.search(), &Plan::new::<2>(2, ALL), &Everything).unwrap();
    let places: Vec<[f64; 2]> = points.places.iter().map(|p| [-p[0], p[1]]).collect();
    let moved = Moved::new(&fits, &places);
    assert!((0..places.len()).all(|i| moved.strain(i).is_none()));
}
