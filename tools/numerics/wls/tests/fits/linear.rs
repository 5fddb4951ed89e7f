//! Linear polynomials under conditions that speak of second derivatives: they bow as these say.

use wls::{Condition, Metric, Plan, Rules, Stencils, Wants};

use crate::clouds::{Points, lattice};

const SLOPE: Wants = Wants {
    value: false,
    gradient: true,
    hessian: false,
    laplacian: false,
};
/// Derivatives along the axes that count with the Laplacian \[1/m\].
const DRIFT: [f64; 2] = [3.0, -0.5];

/// The lower half of the points, those near its upper edge one-sided.
struct Below<'a> {
    points: &'a Points<2>,
    drift: bool,
    sided: bool,
}

impl Below<'_> {
    fn depth(&self, i: usize) -> f64 {
        (0.5 - self.points.places[i][1]) / self.points.metrics[i].spacing()
    }
}

impl Rules<2> for Below<'_> {
    fn wanted(&self, i: usize) -> bool {
        (0.0..1.0).contains(&self.depth(i)) && (0.2..0.8).contains(&self.points.places[i][0])
    }

    fn allowed(&self, i: usize, j: usize) -> bool {
        self.depth(j) > self.depth(i) - 0.6
    }

    fn side(&self, _: usize) -> Option<[f64; 2]> {
        self.sided.then_some([0.0, -1.0])
    }

    fn conditions(&self, i: usize, conditions: &mut Vec<Condition<2>>) {
        let at = self.points.places[i];
        conditions.push(if self.drift {
            Condition::Drift { at, drift: DRIFT }
        } else {
            Condition::Laplacian { at }
        });
    }
}

/// The largest error of a slope; `known` is what the condition says at a place.
fn worst(
    below: &Below<'_>,
    value: impl Fn([f64; 2]) -> f64,
    slope: impl Fn([f64; 2]) -> [f64; 2],
    known: impl Fn([f64; 2]) -> f64,
) -> f64 {
    let plan = Plan {
        interpolating: true,
        ..Plan::new::<2>(1, SLOPE)
    };
    let stencils = Stencils::build(&below.points.search(), &plan, below).unwrap();
    let field = below.points.field(value);
    let mut worst: f64 = 0.0;
    let mut rows = 0;
    for i in (0..field.len()).filter(|i| below.wanted(*i)) {
        rows += 1;
        let at = below.points.places[i];
        for axis in 0..2 {
            let row = stencils.derivative(i, axis);
            let share: f64 = row.conditions().sum();
            let error = row.apply(&field) + share * known(at) - slope(at)[axis];
            worst = worst.max(error.abs());
        }
    }
    assert!(rows > 3);
    worst
}

#[test]
fn what_bows_along_the_normal_has_its_slope_exactly() {
    for metric in [
        |h: f64| Metric::round(h),
        |h: f64| Metric::layered([0.0, 1.0], 0.7 * h, h),
        |h: f64| Metric::layered([0.6, 0.8], 0.7 * h, h),
    ] {
        let mut points = lattice::<2>(16, 0.2);
        for own in &mut points.metrics {
            *own = metric(own.spacing());
        }
        for drift in [false, true] {
            let below = Below {
                points: &points,
                drift,
                sided: true,
            };
            let along = |g: [f64; 2]| DRIFT[0] * g[0] + DRIFT[1] * g[1];
            let slope = |p: [f64; 2]| [2.0, 8.0 * p[1] - 1.0];
            let known = |p: [f64; 2]| 8.0 + if drift { along(slope(p)) } else { 0.0 };
            let value = |p: [f64; 2]| 1.0 + 2.0 * p[0] - p[1] + 4.0 * p[1] * p[1];
            let error = worst(&below, value, slope, known);
            assert!(error < 1e-9, "{drift}: {error:e}");
        }
    }
}

#[test]
fn slopes_under_a_drift_are_of_first_order() {
    // exp(a x + b y) has a Laplacian and a derivative along the drift of (a^2 + b^2 + drift . (a, b)) times itself.
    let [a, b] = [1.5, 4.0];
    let value = |p: [f64; 2]| (a * p[0] + b * p[1]).exp();
    let slope = |p: [f64; 2]| [a * value(p), b * value(p)];
    let known = |p: [f64; 2]| (a * a + b * b + DRIFT[0] * a + DRIFT[1] * b) * value(p);
    for sided in [true, false] {
        let errors = [20, 40, 80].map(|n| {
            let points = lattice::<2>(n, 0.1);
            let below = Below {
                points: &points,
                drift: true,
                sided,
            };
            worst(&below, value, slope, known)
        });
        assert!(errors[2] < 0.35 * errors[0], "{sided}: {errors:?}");
    }
}
