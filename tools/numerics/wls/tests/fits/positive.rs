//! Laplacians without negative weights of others.

use wls::{Everything, Plan, Stencils, Wants};

use crate::clouds::{Points, lattice};

fn check<const D: usize>(points: &Points<D>, interpolating: bool) -> wls::Report {
    let plan = Plan {
        positive: true,
        interpolating,
        ..Plan::new::<D>(
            2,
            Wants {
                laplacian: true,
                gradient: true,
                ..Wants::default()
            },
        )
    };
    let stencils = Stencils::build(&points.search(), &plan, &Everything).unwrap();
    let inside = points.inside(2.6 * points.metrics[0].spacing());
    for &i in &inside {
        let row = stencils.laplacian(i);
        let own = row.own(i);
        assert!(own < 0.0);
        for (j, weight) in row.iter().filter(|(j, _)| *j != i) {
            assert!(weight >= -1e-11 * own.abs(), "point {j} of {i}: {weight}");
        }
    }
    for (i, place) in points.places.iter().enumerate() {
        // Exact on quadratics all the same, on faces too.
        let square = stencils.laplacian(i).apply_with(|j| {
            let p = points.places[j];
            (p[0] - place[0]).powi(2) + (p[0] - place[0]) * (p[1] - place[1]) + 3.0 * p[1]
        });
        assert!((square - 2.0).abs() < 1e-9, "point {i}: {square}");
    }
    *stencils.report()
}

#[test]
fn weights_are_nonnegative_and_exact() {
    for interpolating in [false, true] {
        let report = check(&lattice::<2>(14, 0.3), interpolating);
        assert!(report.positive_made > 0, "{report:?}");
        let report = check(&lattice::<3>(9, 0.4), interpolating);
        assert!(report.positive_made > 0, "{report:?}");
    }
}
