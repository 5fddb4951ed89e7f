//! Points that weigh by their room: where a fine lattice meets a coarse one neither leads the fit.

use wls::{Condition, Metric, Plan, Reach, Rules, Stencils, Wants};

use crate::clouds::Points;

/// Harmonic polynomials everywhere inside.
struct Harmonic<'a>(&'a Points<2>);

impl Rules<2> for Harmonic<'_> {
    fn wanted(&self, i: usize) -> bool {
        self.0.places[i].iter().all(|x| x.abs() < 4.0)
    }

    fn conditions(&self, _: usize, conditions: &mut Vec<Condition<2>>) {
        conditions.push(Condition::Harmonic);
    }
}

/// A lattice of spacing 1/2 on the left, and of 1 on the right.
fn halves() -> Points<2> {
    let (mut places, mut metrics) = (Vec::new(), Vec::new());
    for k in -16..=16_i32 {
        for l in -16..=16_i32 {
            let coarse = k >= 0;
            if !coarse || (k % 2 == 0 && l % 2 == 0) {
                places.push([0.5 * f64::from(k), 0.5 * f64::from(l)]);
                metrics.push(Metric::round(if coarse { 1.0 } else { 0.5 }));
            }
        }
    }
    Points { places, metrics }
}

/// The real part of a power of x + i y.
fn power(p: [f64; 2], n: u32) -> f64 {
    let (mut re, mut im) = (1.0, 0.0);
    for _ in 0..n {
        (re, im) = (re * p[0] - im * p[1], re * p[1] + im * p[0]);
    }
    re
}

/// Greatest error of the value at a point from the points about it, of the power `n` about the point.
fn worst(points: &Points<2>, by_room: bool, n: u32) -> f64 {
    let wants = Wants {
        value: true,
        ..Wants::default()
    };
    let plan = Plan {
        reach: Reach::Radius(3.0),
        by_room,
        ..Plan::new::<2>(4, wants)
    };
    let stencils = Stencils::build(&points.search(), &plan, &Harmonic(points)).unwrap();
    let error = |i: usize| {
        let own = points.places[i];
        let about = |j: usize| power(std::array::from_fn(|a| points.places[j][a] - own[a]), n);
        stencils.value(i).apply_with(about).abs()
    };
    let rows = (0..points.places.len()).filter(|&i| Harmonic(points).wanted(i));
    rows.map(error).fold(0.0, f64::max)
}

#[test]
fn fits_across_lattices_lean_less_and_stay_exact() {
    let points = halves();
    assert!(worst(&points, true, 4) < 1e-9);
    let [alike, by_room] = [false, true].map(|room| worst(&points, room, 5));
    assert!(by_room < 0.5 * alike, "{by_room} {alike}");
}
