//! One-sided slopes in a narrow wedge beside a face that bends.

use wls::{Condition, Metric, Plan, Rules, Stencils, Wants};

use crate::clouds::{Points, Random};

/// Slope of the upper face of the wedge over the lower one: 28 degrees.
const RISE: f64 = 0.53;
/// Radius of curvature of both faces.
const RADIUS: f64 = 5.0;
/// Points of different faces, and those between them, keep this apart.
const APART: f64 = 0.65;

/// Points a spacing of 1 apart on the lower face of a wedge that closes at x = 0, on its upper face, and between them; how
/// many on the lower face.
fn wedge() -> (Points<3>, usize) {
    let mut random = Random::new(7);
    let mut drawn = Vec::new();
    for level in 0..4 {
        for k in 0..49 {
            let x = f64::from(k % 7) + 0.4 + 0.25 * random.next();
            let y = f64::from(k / 7) + 0.25 * random.next();
            let base = -((x - 3.0).powi(2) + (y - 3.0).powi(2)) / (2.0 * RADIUS);
            let up = match level {
                0 => 0.0,
                1 => RISE * x,
                _ => f64::from(level - 1),
            };
            if up <= RISE * x {
                drawn.push((level, [x, y, base + up]));
            }
        }
    }
    let mut places: Vec<[f64; 3]> = Vec::new();
    let mut lower = 0;
    for (level, x) in drawn {
        let apart =
            |p: &[f64; 3]| (0..3).map(|k| (p[k] - x[k]).powi(2)).sum::<f64>() > APART * APART;
        if places.iter().all(apart) {
            places.push(x);
            lower += usize::from(level == 0);
        }
    }
    let metrics = vec![Metric::round(1.0); places.len()];
    (Points { places, metrics }, lower)
}

/// Slopes out of the lower face, of harmonic polynomials.
struct Lower<'a> {
    places: &'a [[f64; 3]],
    count: usize,
    sided: bool,
}

impl Lower<'_> {
    fn normal(&self, i: usize) -> [f64; 3] {
        let [x, y, _] = self.places[i];
        let n = [(x - 3.0) / RADIUS, (y - 3.0) / RADIUS, 1.0];
        let size = n.iter().map(|n| n * n).sum::<f64>().sqrt();
        n.map(|n| n / size)
    }
}

impl Rules<3> for Lower<'_> {
    fn wanted(&self, i: usize) -> bool {
        i < self.count && self.places[i][0] < 4.2 && (1.0..5.0).contains(&self.places[i][1])
    }

    fn side(&self, i: usize) -> Option<[f64; 3]> {
        self.sided.then(|| self.normal(i))
    }

    fn conditions(&self, _: usize, conditions: &mut Vec<Condition<3>>) {
        conditions.push(Condition::Harmonic);
    }
}

#[test]
fn the_own_point_hardly_leans_on_itself() {
    let (points, count) = wedge();
    let leaning = |sided: bool| {
        let places = &points.places;
        let rules = Lower {
            places,
            count,
            sided,
        };
        let gradient = Wants {
            gradient: true,
            ..Wants::default()
        };
        let plan = Plan {
            interpolating: true,
            ..Plan::new::<3>(2, gradient)
        };
        let stencils = Stencils::build(&points.search(), &plan, &rules).unwrap();
        let wanted: Vec<usize> = (0..count).filter(|i| rules.wanted(*i)).collect();
        assert!(wanted.len() > 10);
        for &i in &wanted {
            // Linear fields are met all the same.
            let slope = stencils.derivative(i, 2).apply_with(|j| places[j][2]);
            assert!((slope - 1.0).abs() < 1e-9, "{i}: {slope}");
        }
        let own = |i: usize| -> f64 {
            let part = |(axis, n): (usize, f64)| n * stencils.derivative(i, axis).own(i);
            rules.normal(i).into_iter().enumerate().map(part).sum()
        };
        wanted.iter().map(|i| own(*i)).fold(0.0, f64::max)
    };
    let (left, lowered) = (leaning(false), leaning(true));
    assert!(left > 1.0, "{left}: the wedge is too wide");
    assert!(lowered < 0.7 * left, "{lowered} {left}");
}
