//! What must not change the weights: threads, the place and size of the cloud, the order of points.

use proptest::prelude::*;
use wls::{Cloud, Everything, Metric, Plan, Search, Stencils, Wants};

use crate::clouds::{Points, graded, lattice};

const BOTH: Wants = Wants {
    value: false,
    gradient: true,
    hessian: false,
    laplacian: true,
};

fn bits<const D: usize>(points: &Points<D>, order: u8, threads: usize) -> Vec<(u32, u64)> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    pool.install(|| {
        let plan = Plan {
            positive: order == 2,
            ..Plan::new::<D>(order, BOTH)
        };
        let stencils = Stencils::build(&points.search(), &plan, &Everything).unwrap();
        let mut bits = Vec::new();
        for i in 0..stencils.rows() {
            let row = stencils.laplacian(i);
            bits.extend(row.iter().map(|(j, w)| (j as u32, w.to_bits())));
            let row = stencils.derivative(i, 0);
            bits.extend(row.iter().map(|(j, w)| (j as u32, w.to_bits())));
        }
        bits
    })
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    for (points, order) in [(graded::<3>(9, 0.2), 2), (lattice::<3>(9, 0.0), 4)] {
        let one = bits(&points, order, 1);
        for threads in [2, 7] {
            assert!(one == bits(&points, order, threads), "{threads} threads");
        }
    }
    let plane = graded::<2>(20, 0.1);
    assert!(bits(&plane, 3, 1) == bits(&plane, 3, 4));
}

/// Gradient and Laplacian of x y + sin z-like values given by number, at the middle point.
fn operators(points: &Points<3>, field: &[f64], at: usize) -> ([f64; 3], f64) {
    let search = Search::new(Cloud {
        points: &points.places,
        metrics: &points.metrics,
    })
    .unwrap();
    let stencils = Stencils::build(&search, &Plan::new::<3>(2, BOTH), &Everything).unwrap();
    (
        stencils.gradient_of(field, at),
        stencils.laplacian(at).apply(field),
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn turning_moving_scaling_and_renumbering(
        angle in 0.0..6.3_f64,
        shift in -10.0..10.0_f64,
        size in 1e-3..1e3_f64,
        step in 1_usize..200,
    ) {
        let points = lattice::<3>(6, 0.3);
        let field = points.field(|p| (3.0 * p[0]).sin() * p[1] + p[2].exp());
        let at = 6 * 6 * 3 + 6 * 3 + 3;
        let (slope, curved) = operators(&points, &field, at);
        let count = points.places.len();
        // A number without common divisors with 216 = 6^3 goes through all of them.
        let step = 6 * step + 1;
        let (sin, cos) = angle.sin_cos();
        let mut moved = points.clone();
        let mut values = field.clone();
        for k in 0..count {
            let [x, y, z] = points.places[k];
            let turned = [cos * x - sin * y, sin * x + cos * y, z].map(|x| size * (x + shift));
            moved.places[k * step % count] = turned;
            values[k * step % count] = field[k];
        }
        moved.metrics = vec![Metric::round(size * points.metrics[0].spacing()); count];
        let (other, lap) = operators(&moved, &values, at * step % count);
        let expected = [cos * slope[0] - sin * slope[1], sin * slope[0] + cos * slope[1], slope[2]];
        for (found, expected) in other.iter().zip(expected) {
            prop_assert!((found * size - expected).abs() < 1e-9);
        }
        prop_assert!((lap * size * size - curved).abs() < 1e-7);
    }
}
