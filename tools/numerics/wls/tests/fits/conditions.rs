//! Fits that obey conditions.

use wls::{Condition, Plan, Rules, Stencils, Wants};

use crate::clouds::lattice;

const BOTH: Wants = Wants {
    value: true,
    gradient: true,
    hessian: false,
    laplacian: true,
};

#[test]
fn an_interpolating_fit_passes_through_its_point() {
    let points = lattice::<2>(10, 0.3);
    let plan = Plan {
        interpolating: true,
        ..Plan::new::<2>(2, BOTH)
    };
    let stencils = Stencils::build(&points.search(), &plan, &wls::Everything).unwrap();
    let field = points.field(|p| (9.0 * p[0]).sin() + p[1] * p[1]);
    for i in 0..points.places.len() {
        assert!((stencils.value(i).apply(&field) - field[i]).abs() < 1e-12);
        let sum = stencils
            .laplacian(i)
            .apply_with(|j| points.places[j][1].powi(2));
        assert!((sum - 2.0).abs() < 1e-9);
    }
}

/// A wall at x = 0 with a known slope along its normal, and nothing behind it.
struct Wall {
    places: Vec<[f64; 3]>,
}

impl Rules<3> for Wall {
    fn wanted(&self, i: usize) -> bool {
        self.places[i][0] < 0.2
    }

    fn conditions(&self, i: usize, conditions: &mut Vec<Condition<3>>) {
        let [_, y, z] = self.places[i];
        conditions.push(Condition::Flux {
            at: [0.0, y, z],
            normal: [-1.0, 0.0, 0.0],
        });
        conditions.push(Condition::Laplacian { at: self.places[i] });
    }
}

#[test]
fn a_known_flux_and_a_known_laplacian_enter_with_weights_of_their_own() {
    let points = lattice::<3>(8, 0.2);
    let rules = Wall {
        places: points.places.clone(),
    };
    let field = points.field(|p| p[0].powi(2) + 3.0 * p[0] * p[1] - p[2] + 2.0 * p[0]);
    for order in 2..=4 {
        let plan = Plan::new::<3>(order, BOTH);
        let stencils = Stencils::build(&points.search(), &plan, &rules).unwrap();
        for (i, p) in points.places.iter().enumerate() {
            if !rules.wanted(i) {
                assert!(stencils.neighbours(i).is_empty());
                continue;
            }
            let data = [-(3.0 * p[1] + 2.0), 2.0];
            let with = |row: wls::Row<'_>| {
                let known = row.conditions().zip(data).map(|(w, g)| w * g).sum::<f64>();
                row.apply(&field) + known
            };
            let slope = 2.0 * p[0] + 3.0 * p[1] + 2.0;
            assert!((with(stencils.derivative(i, 0)) - slope).abs() < 1e-10);
            assert!((with(stencils.value(i)) - field[i]).abs() < 1e-11);
            let row = stencils.laplacian(i);
            assert!((with(row) - 2.0).abs() < 1e-9);
            // The Laplacian is given: the points have no say.
            assert!(row.iter().all(|(_, w)| w.abs() < 1e-7));
            assert!((row.conditions().nth(1).unwrap() - 1.0).abs() < 1e-9);
        }
    }
}

struct Air;

impl Rules<3> for Air {
    fn conditions(&self, _: usize, conditions: &mut Vec<Condition<3>>) {
        conditions.push(Condition::Harmonic);
    }
}

#[test]
fn harmonic_fits_are_exact_for_harmonic_polynomials_and_see_no_others() {
    let points = lattice::<3>(8, 0.2);
    // x^4 - 6 x^2 y^2 + y^4 has no Laplacian.
    let field = points.field(|p| p[0].powi(4) - 6.0 * (p[0] * p[1]).powi(2) + p[1].powi(4));
    let stencils = Stencils::build(&points.search(), &Plan::new::<3>(4, BOTH), &Air).unwrap();
    for (i, p) in points.places.iter().enumerate() {
        let slope = 4.0 * p[0].powi(3) - 12.0 * p[0] * p[1] * p[1];
        assert!((stencils.derivative(i, 0).apply(&field) - slope).abs() < 1e-10);
        let curved = stencils
            .laplacian(i)
            .apply_with(|j| points.places[j][0].powi(2));
        assert!(curved.abs() < 1e-8, "{curved}");
        assert_eq!(stencils.laplacian(i).conditions().len(), 0);
    }
}

#[test]
fn conditions_stand_in_for_points_that_are_missing() {
    // One layer of points beside a wall of known flux: no fit of order 2 without it.
    let sheet = lattice::<2>(9, 0.1);
    let places = sheet
        .places
        .iter()
        .map(|p| [0.05, p[0], p[1]])
        .collect::<Vec<_>>();
    let layers = places.iter().chain(&places).enumerate().map(|(k, p)| {
        let x = if k < places.len() { 0.05 } else { 0.15 };
        [x, p[1], p[2]]
    });
    let places = layers.collect::<Vec<_>>();
    let points = crate::clouds::Points {
        metrics: vec![wls::Metric::round(0.11); places.len()],
        places,
    };
    let rules = Wall {
        places: points.places.clone(),
    };
    let plan = Plan::new::<3>(2, BOTH);
    let field = points.field(|p| p[0].powi(2) + p[1]);
    let stencils = Stencils::build(&points.search(), &plan, &rules).unwrap();
    assert_eq!(stencils.report().lowered, 0);
    for (i, p) in points.places.iter().enumerate() {
        // Flux 0 at the wall, Laplacian 2.
        let row = stencils.derivative(i, 0);
        let known = 2.0 * row.conditions().nth(1).unwrap();
        assert!((row.apply(&field) + known - 2.0 * p[0]).abs() < 1e-10);
    }
}

/// Points of which each knows the Laplacian and the derivative along a drift.
struct Drifting {
    places: Vec<[f64; 2]>,
}

impl Rules<2> for Drifting {
    fn wanted(&self, i: usize) -> bool {
        self.places[i][0] < 0.3
    }

    fn conditions(&self, i: usize, conditions: &mut Vec<Condition<2>>) {
        conditions.push(Condition::Drift {
            at: self.places[i],
            drift: [3.0, -0.5],
        });
    }
}

#[test]
fn a_known_laplacian_with_a_drift_is_obeyed() {
    let points = lattice::<2>(9, 0.2);
    let rules = Drifting {
        places: points.places.clone(),
    };
    // No polynomial of the order of the fit: only the condition makes the operators agree.
    let field = points.field(|p| (3.0 * p[0] - p[1]).exp());
    let stencils = Stencils::build(&points.search(), &Plan::new::<2>(2, BOTH), &rules).unwrap();
    for i in (0..points.places.len()).filter(|i| rules.wanted(*i)) {
        let with = |row: wls::Row<'_>| {
            let known = row.conditions().map(|w| w * 7.0).sum::<f64>();
            row.apply(&field) + known
        };
        let [dx, dy] = [0, 1].map(|axis| with(stencils.derivative(i, axis)));
        let sum = with(stencils.laplacian(i)) + 3.0 * dx - 0.5 * dy;
        assert!((sum - 7.0).abs() < 1e-8, "{sum}");
    }
}
