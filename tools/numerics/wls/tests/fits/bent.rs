//! Layers along a surface that bends: they may be as thin as one likes.

use std::f64::consts::PI;

use wls::{Everything, Metric, Plan, Stencils, Wants};

use crate::clouds::Points;

/// Spacing along the surface of the unit ball.
const ALONG: f64 = 0.2;
const WANTS: Wants = Wants {
    value: false,
    gradient: true,
    hessian: false,
    laplacian: true,
};

/// Levels of points `thickness` apart on both sides of the unit ball, straight above each other.
fn levels(thickness: f64, metric: impl Fn([f64; 3], [f64; 3]) -> Metric<3>) -> Points<3> {
    let number = (4.0 * PI / (ALONG * ALONG)).round();
    let turn = PI * (3.0 - 5.0_f64.sqrt());
    let mut points = Points {
        places: Vec::new(),
        metrics: Vec::new(),
    };
    for k in 0..number as usize {
        let z = 1.0 - (2.0 * k as f64 + 1.0) / number;
        let ring = (1.0 - z * z).sqrt();
        let (sine, cosine) = (turn * k as f64).sin_cos();
        let normal = [ring * cosine, ring * sine, z];
        for level in -4..=4 {
            let r = 1.0 + f64::from(level) * thickness;
            points.places.push(normal.map(|n| r * n));
            points.metrics.push(metric(normal, [-sine, cosine, 0.0]));
        }
    }
    points
}

fn bent(thickness: f64) -> impl Fn([f64; 3], [f64; 3]) -> Metric<3> {
    move |normal, along| Metric::layered(normal, thickness, ALONG).bent(along, [1.0; 2])
}

/// Root mean square errors of gradient and Laplacian on the surface, for exp(x) sin(2 y + 1).
fn errors(points: &Points<3>, order: u8) -> [f64; 2] {
    let field = points.field(|p| p[0].exp() * (2.0 * p[1] + 1.0).sin());
    let plan = Plan {
        interpolating: true,
        ..Plan::new::<3>(order, WANTS)
    };
    let stencils = Stencils::build(&points.search(), &plan, &Everything).unwrap();
    let (mut first, mut second, mut count) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (i, p) in points.places.iter().enumerate().skip(4).step_by(9) {
        let slope = 2.0 * p[0].exp() * (2.0 * p[1] + 1.0).cos();
        let found = stencils.gradient_of(&field, i);
        first += (found[0] - field[i]).powi(2) + (found[1] - slope).powi(2) + found[2].powi(2);
        second += (stencils.laplacian(i).apply(&field) + 3.0 * field[i]).powi(2);
        count += 1.0;
    }
    [(first / count).sqrt(), (second / count).sqrt()]
}

#[test]
fn polynomials_along_the_surface_are_exact() {
    let thickness = 0.004;
    let points = levels(thickness, bent(thickness));
    let search = points.search();
    let plan = Plan {
        interpolating: true,
        ..Plan::new::<3>(2, WANTS)
    };
    let stencils = Stencils::build(&search, &plan, &Everything).unwrap();
    let i = 9 * 150 + 4;
    let (own, metric) = (points.places[i], points.metrics[i]);
    let up = |s: [f64; 3]| (0..3).map(|k| s[k] * own[k]).sum::<f64>();
    let s = |p: [f64; 3]| metric.scaled(std::array::from_fn(|k| p[k] - own[k]));
    let square = |p: [f64; 3]| s(p).iter().map(|x| x * x).sum::<f64>();
    // The distance from the surface has the gradient n and the Laplacian of both curvatures, 2.
    let height = points.field(|p| up(s(p)));
    let slope = stencils.gradient_of(&height, i);
    assert!((0..3).all(|k| (slope[k] * thickness - own[k]).abs() < 1e-9));
    let laplacian = |field: &[f64]| stencils.laplacian(i).apply(field);
    assert!((laplacian(&height) * thickness - 2.0).abs() < 1e-6);
    let heights = points.field(|p| up(s(p)).powi(2));
    assert!((laplacian(&heights) * thickness * thickness - 2.0).abs() < 1e-9);
    let level = points.field(|p| square(p) - up(s(p)).powi(2));
    assert!((laplacian(&level) * ALONG * ALONG - 4.0).abs() < 1e-6);
}

#[test]
fn thin_layers_cost_no_accuracy() {
    for (order, kept) in [(2, 2), (4, 1)] {
        let found = [0.04, 0.004, 0.0004].map(|t| errors(&levels(t, bent(t)), order));
        for k in 0..kept {
            assert!(
                found[1][k] < 1.5 * found[0][k] && found[2][k] < 1.5 * found[0][k],
                "order {order}: {found:?}"
            );
        }
    }
}

#[test]
fn flat_supports_lose_what_falls_within_thin_layers() {
    // A skin of a quarter of the spacing, in layers a fifth of that thick.
    let (thickness, skin) = (0.01, 0.05);
    let worst = |points: &Points<3>| {
        let radius = |p: &[f64; 3]| p.iter().map(|x| x * x).sum::<f64>().sqrt();
        let field = points.field(|p| ((radius(&p) - 1.0) / skin).exp());
        let plan = Plan::new::<3>(2, WANTS);
        let stencils = Stencils::build(&points.search(), &plan, &Everything).unwrap();
        let slope = |i: usize| -> f64 {
            let n = points.places[i];
            let found = stencils.gradient_of(&field, i);
            (0..3).map(|k| found[k] * n[k] * skin).sum()
        };
        let surface = (4..points.places.len()).step_by(9);
        surface.map(|i| (slope(i) - 1.0).abs()).fold(0.0, f64::max)
    };
    let own = worst(&levels(thickness, bent(thickness)));
    let straight = levels(thickness, |n, along| bent(thickness)(n, along).straight());
    let flat = worst(&straight);
    assert!(own < 0.1 && flat > 3.0 * own, "{own} {flat}");
}
