//! Smooth fields: the error falls with the spacing as the order of the fit says.

use wls::{Everything, Plan, Stencils, Wants};

use crate::clouds::{Points, graded, lattice};

/// Root mean square errors of gradient and Laplacian of exp(x) sin(2 y + 1) (cos z).
fn errors<const D: usize>(points: &Points<D>, order: u8) -> [f64; 2] {
    let z = |p: [f64; D]| if D == 3 { p[2] } else { 0.0 };
    let field = points.field(|p| p[0].exp() * (2.0 * p[1] + 1.0).sin() * z(p).cos());
    let wants = Wants {
        gradient: true,
        laplacian: true,
        ..Wants::default()
    };
    let plan = Plan::new::<D>(order, wants);
    let stencils = Stencils::build(&points.search(), &plan, &Everything).unwrap();
    let (mut first, mut second) = (0.0_f64, 0.0_f64);
    for (i, &p) in points.places.iter().enumerate() {
        let slope = 2.0 * p[0].exp() * (2.0 * p[1] + 1.0).cos() * z(p).cos();
        let found = stencils.gradient_of(&field, i);
        first += (found[0] - field[i]).powi(2) + (found[1] - slope).powi(2);
        let curved = if D == 3 { -4.0 } else { -3.0 } * field[i];
        second += (stencils.laplacian(i).apply(&field) - curved).powi(2);
    }
    let count = points.places.len() as f64;
    [(first / count).sqrt(), (second / count).sqrt()]
}

/// Clouds of one kind at two resolutions, and the ratio of their spacings.
fn hold<const D: usize>(name: &str, cloud: impl Fn(usize) -> Points<D>, sizes: [usize; 2]) {
    let ratio = (sizes[1] as f64 / sizes[0] as f64).ln();
    for order in 2..=4 {
        let (coarse, fine) = (
            errors(&cloud(sizes[0]), order),
            errors(&cloud(sizes[1]), order),
        );
        let observed = |k: usize| (coarse[k] / fine[k]).ln() / ratio;
        let p = f64::from(order);
        assert!(
            observed(0) > p - 0.2 && observed(1) > p - 1.2,
            "{name}, order {order}: gradient {:.2}, Laplacian {:.2}",
            observed(0),
            observed(1)
        );
    }
}

#[test]
fn plane() {
    hold("regular", |n| lattice::<2>(n, 0.0), [16, 64]);
    hold("jitter 10 %", |n| lattice::<2>(n, 0.1), [16, 64]);
    hold("jitter 30 %", |n| lattice::<2>(n, 0.3), [16, 64]);
    hold("graded 1:3", |n| graded::<2>(n, 0.1), [16, 64]);
}

#[test]
fn space() {
    hold("regular", |n| lattice::<3>(n, 0.0), [10, 20]);
    hold("jitter 10 %", |n| lattice::<3>(n, 0.1), [10, 20]);
    hold("jitter 30 %", |n| lattice::<3>(n, 0.3), [10, 20]);
    hold("graded 1:3", |n| graded::<3>(n, 0.1), [10, 20]);
}

/// Weights of the Laplacian without their signs, in spacings: the largest sum.
fn loudest<const D: usize>(points: &Points<D>, order: u8) -> f64 {
    let wants = Wants {
        gradient: true,
        laplacian: true,
        ..Wants::default()
    };
    let plan = Plan::new::<D>(order, wants);
    let stencils = Stencils::build(&points.search(), &plan, &Everything).unwrap();
    let sum = |i: usize| -> f64 {
        let spacing = points.metrics[i].spacing();
        let all = stencils.laplacian(i).iter().map(|(_, w)| w.abs());
        all.sum::<f64>() * spacing * spacing
    };
    (0..points.places.len()).map(sum).fold(0.0, f64::max)
}

/// On faces of jittered lattices supports that tell little have condition numbers as good ones, and weights several times as
/// large: 113 for cubics in space, 32 for quadratics in a plane.
#[test]
fn points_of_faces_are_no_louder_than_those_of_corners() {
    let cubic = loudest(&lattice::<3>(12, 0.1), 3);
    assert!(cubic < 36.0, "{cubic}");
    let quadratic = loudest(&lattice::<2>(48, 0.3), 2);
    assert!(quadratic < 10.0, "{quadratic}");
}
