//! Supports that are no good, and the classic ones that only seem so.

use wls::{Everything, Metric, Plan, Reach, Stencils, Wants};

use crate::clouds::{Points, Random, lattice};

const BOTH: Wants = Wants {
    value: false,
    gradient: true,
    hessian: false,
    laplacian: true,
};

fn cloud<const D: usize>(places: Vec<[f64; D]>, spacing: f64) -> Points<D> {
    let metrics = vec![Metric::round(spacing); places.len()];
    Points { places, metrics }
}

/// The point and its neighbours along the axes.
fn cross<const D: usize>(spacing: f64) -> Points<D> {
    let mut places = vec![[0.5; D]];
    for a in 0..D {
        for side in [-spacing, spacing] {
            let mut place = [0.5; D];
            place[a] += side;
            places.push(place);
        }
    }
    cloud(places, spacing)
}

struct First;

impl<const D: usize> wls::Rules<D> for First {
    fn wanted(&self, i: usize) -> bool {
        i == 0
    }
}

fn as_finite_differences<const D: usize>() {
    let spacing = 0.01;
    let points = cross::<D>(spacing);
    let plan = Plan {
        reach: Reach::Radius(1.5),
        ..Plan::new::<D>(2, BOTH)
    };
    let stencils = Stencils::build(&points.search(), &plan, &First).unwrap();
    // The mixed monomials vanish on a cross: no matter, for what is wanted.
    assert_eq!(stencils.report().by_svd, 1);
    let unit = spacing * spacing;
    for (j, weight) in stencils.laplacian(0).iter() {
        let classic = if j == 0 { -2.0 * D as f64 } else { 1.0 };
        assert!((weight * unit - classic).abs() < 1e-11, "{j}: {weight}");
    }
    for a in 0..D {
        for (j, weight) in stencils.derivative(0, a).iter() {
            let classic = match j.wrapping_sub(1 + 2 * a) {
                0 => -0.5,
                1 => 0.5,
                _ => 0.0,
            };
            assert!((weight * spacing - classic).abs() < 1e-11);
        }
    }
}

#[test]
fn a_cross_gives_finite_differences() {
    as_finite_differences::<2>();
    as_finite_differences::<3>();
}

#[test]
fn coincident_points_are_named() {
    let mut points = lattice::<3>(6, 0.1);
    points.places[40] = points.places[41];
    let error =
        Stencils::build(&points.search(), &Plan::new::<3>(2, BOTH), &Everything).unwrap_err();
    assert!(
        matches!(error, wls::Error::Coincident { a: 40, b: 41, .. }),
        "{error}"
    );
}

#[test]
fn a_lone_point_is_named() {
    let mut points = lattice::<3>(6, 0.1);
    points.places[17] = [40.0, 0.0, 0.0];
    for plan in [
        Plan::new::<3>(2, BOTH),
        Plan::new::<3>(4, BOTH),
        Plan::new::<3>(
            1,
            Wants {
                laplacian: false,
                ..BOTH
            },
        ),
    ] {
        let error = Stencils::build(&points.search(), &plan, &Everything).unwrap_err();
        assert!(
            matches!(
                error,
                wls::Error::Lone { point: 17, .. } | wls::Error::Flat { point: 17, .. }
            ),
            "{error}"
        );
    }
    let one = cloud(vec![[0.0; 3]], 1.0);
    assert!(Stencils::build(&one.search(), &Plan::new::<3>(2, BOTH), &Everything).is_err());
}

#[test]
fn a_plane_in_space_is_refused_and_a_line_too() {
    let sheet = lattice::<2>(12, 0.2);
    let places = sheet.places.iter().map(|p| [p[0], p[1], 0.3 * p[0] - p[1]]);
    let points = cloud(places.collect(), 0.15);
    let error =
        Stencils::build(&points.search(), &Plan::new::<3>(2, BOTH), &Everything).unwrap_err();
    assert!(matches!(error, wls::Error::Flat { .. }), "{error}");
    let line = cloud(
        (0..50)
            .map(|k| [0.01 * f64::from(k), 0.02 * f64::from(k)])
            .collect(),
        0.02,
    );
    assert!(Stencils::build(&line.search(), &Plan::new::<2>(2, BOTH), &Everything).is_err());
}

/// A thin sheet of points, `thickness` parts of a spacing thick, in a cloud that is not.
fn sheet(thickness: f64) -> Points<3> {
    let mut random = Random::new(5);
    let mut points = lattice::<3>(9, 0.2);
    for (k, place) in points.places.iter_mut().enumerate() {
        if (4..6).contains(&(k / 81)) {
            place[2] = 0.5 + thickness / 9.0 * random.next();
        }
    }
    points
}

#[test]
fn nearly_coplanar_supports_are_enlarged_or_lowered_and_never_wild() {
    for thickness in [1e-2, 1e-4, 1e-6] {
        let points = sheet(thickness);
        let places = points.places.clone();
        // Rows in the sheet may use the sheet and what lies two spacings off.
        let rules = move |i: usize, j: usize| {
            (places[i][2] - 0.5).abs() > 0.05
                || (places[j][2] - 0.5).abs() < 0.05
                || (places[j][2] - 0.5).abs() > 0.25
        };
        let plan = Plan::new::<3>(3, BOTH);
        let stencils = Stencils::build(&points.search(), &plan, &rules).unwrap();
        let report = stencils.report();
        assert!(report.worst_condition < 1e5, "{report:?}");
        let field = points.field(|p| p[0] * p[0] + p[1] * p[2]);
        for i in 0..points.places.len() {
            let found = stencils.laplacian(i).apply(&field);
            assert!(
                (found - 2.0).abs() < 1e-7,
                "{thickness:e}: {found} at {i}, {report:?}"
            );
        }
    }
}

#[test]
fn what_is_no_number_is_refused() {
    let mut points = lattice::<2>(4, 0.0);
    points.places[5] = [f64::NAN, 0.0];
    let cloud = wls::Cloud {
        points: &points.places,
        metrics: &points.metrics,
    };
    let error = wls::Search::new(cloud).unwrap_err();
    assert!(matches!(error, wls::Error::NotFinite { point: 5, .. }));
    let mut points = lattice::<2>(4, 0.0);
    points.metrics[3] = Metric::round(0.0);
    let cloud = wls::Cloud {
        points: &points.places,
        metrics: &points.metrics,
    };
    let error = wls::Search::new(cloud).unwrap_err();
    assert!(matches!(error, wls::Error::BadSpacing { point: 3, .. }));
}

#[test]
fn crowds_on_one_side_leave_laplacians_even() {
    let mut points: Points<2> = Points {
        places: Vec::new(),
        metrics: Vec::new(),
    };
    for (spacing, columns) in [(1.0, -8..0), (0.125, 0..24)] {
        for i in columns {
            for j in 0..(16.0 / spacing) as i32 {
                let place = [f64::from(i), f64::from(j)].map(|k| spacing * k);
                points.places.push(place);
                points.metrics.push(Metric::round(spacing));
            }
        }
    }
    let plan = Plan {
        interpolating: true,
        ..Plan::new::<2>(2, BOTH)
    };
    let made = Stencils::build(&points.search(), &plan, &Everything).unwrap();
    assert!(made.report().by_room > 0, "{:?}", made.report());
    for i in 0..points.places.len() {
        let place = points.places[i];
        let coarse = place[0] > -7.0 && place[0] < 0.0 && place[1] > 1.0 && place[1] < 14.0;
        let own: f64 = made
            .laplacian(i)
            .iter()
            .filter(|(j, _)| *j == i)
            .map(|e| e.1)
            .sum();
        let others = made.laplacian(i).iter().filter(|(j, _)| *j != i);
        let wrong: f64 = others.map(|(_, w)| (-w).max(0.0)).sum();
        assert!(
            !coarse || own < 0.0 && wrong <= -own,
            "{place:?}: {own} {wrong}"
        );
        let square = |j: usize| points.places[j].iter().map(|x| x * x).sum::<f64>();
        let bend: f64 = made.laplacian(i).iter().map(|(j, w)| w * square(j)).sum();
        assert!((bend - 4.0).abs() < 1e-7, "{place:?}: {bend}");
    }
}
