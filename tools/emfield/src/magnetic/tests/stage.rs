use std::convert::Infallible;

use krylov::{Options, Rule};

use crate::magnetic::diffusion::Conductors;
use crate::magnetic::stage::{Alone, Equations};
use crate::magnetic::unknown::Unknown;
use crate::march::scheme::{March, slope};
use crate::stencils::sides::{Form, Sides};
use crate::stencils::tests::rings;

/// The equations of `H_z` in a cylinder of radius 1 and `mu sigma = 1`, around which a field of 1 was switched on.
fn cylinder(spacing: f64) -> Equations<1> {
    let region = rings(spacing);
    let form = Form {
        order: 4,
        ..Form::default()
    };
    let sides = Sides::new(&region, &form).unwrap();
    let conductors = Conductors {
        mu_sigma: vec![0.0, 1.0],
        axial: None,
        permeable: None,
    };
    let held = |i| conductors.held(&region, Unknown::Axial, i).then_some([1.0]);
    Equations {
        bound: Vec::new(),
        rates: conductors.rates(&region, &sides, Unknown::Axial),
        rows: conductors.rows(&region, &sides, Unknown::Axial),
        low: None,
        held: (0..region.len()).map(held).collect(),
        given: Vec::new(),
        pairs: Vec::new(),
        options: Options::default(),
    }
}

/// A march in steps of a length from rest.
fn march(equations: &Equations<1>, step: f64) -> March<'static> {
    let n = equations.rows.len();
    let stage = Box::new(Alone::new(equations.clone(), slope(step)).unwrap());
    March::new(stage, vec![0.0; n], n, step)
}

/// Makes the steps of a length from one to another.
fn advance(march: &mut March<'_>, steps: std::ops::Range<u32>, step: f64) {
    let rule = Rule {
        reduction: 1e-12,
        ..Rule::default()
    };
    for k in steps {
        let on = |_| Ok::<f64, Infallible>(1.0);
        let solved = march.advance(f64::from(k) * step, on, rule).unwrap();
        assert!(solved.iter().all(|s| s.worst() < 1e-10));
    }
}

/// `H_z` on the axis at the time 0.1, in steps.
fn switched_on(steps: u32) -> f64 {
    let step = 0.1 / f64::from(steps);
    let mut march = march(&cylinder(0.1), step);
    advance(&mut march, 0..steps, step);
    march.state().unknown[0]
}

/// Carslaw and Jaeger (1959), section 7.6, with the first zeros of J0 and J1 there.
fn exact() -> f64 {
    let terms = [
        (2.404_825_557_695_773, 0.519_147_497_289_466_9),
        (5.520_078_110_286_311, -0.340_264_806_556_811_4),
        (8.653_727_912_911_013, 0.271_452_299_383_482_7),
        (11.791_534_439_014_28, -0.232_459_831_364_723_4),
    ];
    let sum: f64 = terms
        .iter()
        .map(|(z, j): &(f64, f64)| (-z * z * 0.1).exp() / (z * j))
        .sum();
    1.0 - 2.0 * sum
}

#[test]
fn a_field_that_is_switched_on_diffuses_with_second_order_in_time() {
    let [a, b, c] = [5, 10, 20].map(|steps| switched_on(steps) - exact());
    assert!(c.abs() < 3e-4, "{a:e} {b:e} {c:e}");
    // What is left of the points' error does not fall with the step.
    let order = ((a - b) / (b - c)).abs().log2();
    assert!((1.7..2.6).contains(&order), "{a:e} {b:e} {c:e}");
}

#[test]
fn a_march_that_was_rescued_goes_on_with_the_same_bits() {
    let step = 0.02;
    let plain = cylinder(0.05);
    // Rows of another equation as those of low order: multigrid stands still with them.
    let mut low = plain.rows.clone();
    for i in 0..low.len() {
        for (k, v) in low.values_mut(i).iter_mut().enumerate() {
            *v *= if k % 2 == 0 { -1.0 } else { 1.0 };
        }
    }
    let options = Options {
        direct: 0,
        ..Options::default()
    };
    let equations = Equations {
        low: Some(low),
        options,
        ..plain
    };
    let mut straight = march(&equations, step);
    advance(&mut straight, 0..2, step);
    let way = straight.rescued();
    println!("{way:?}");
    assert!(way.is_some());
    let reached = straight.state().clone();
    advance(&mut straight, 2..4, step);
    let resumed = |way| {
        let mut other = march(&equations, step);
        other
            .restore(reached.unknown.clone(), reached.total.clone(), way)
            .unwrap();
        advance(&mut other, 2..4, step);
        other.state().clone()
    };
    assert_eq!(*straight.state(), resumed(way));
    assert_ne!(*straight.state(), resumed(None), "nothing was rescued");
}
