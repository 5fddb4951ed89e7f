//! Operators on clouds in disorder, where what they should give is known.

use kernels::Wendland;
use kernels::moments::times;
use shapes::Body;

use super::filled::Filled;
use super::operators::Sums;
use crate::matter::water::around::Around;
use crate::matter::water::seen::Seen;

const D: f64 = 0.1;

/// A square of water above a wall at y = 0, shaken by 0.2 of its spacing.
fn cloud(u: impl Fn([f64; 3]) -> [f64; 3]) -> Around<Wendland<2>> {
    let wall = serde_json::json!({"half_space": {"point_m": [0, 0], "normal": [0, 1]}});
    let wall = Body::new(&serde_json::from_value(wall).unwrap(), 2);
    let mut around = Around::new(Wendland::<2>::new(1.5 * D), 1.5 * D, vec![wall]);
    let shake = |k: usize| 0.2 * D * (((k * 7919) % 1000) as f64 / 500.0 - 1.0);
    let places: Vec<[f64; 3]> = (0..400)
        .map(|k| {
            let [i, j] = [k % 20, k / 20].map(|i| (i as f64 + 0.5) * D);
            [i + shake(k), j + shake(k + 13), 0.0]
        })
        .collect();
    around
        .near
        .refresh(&places, &mut vec![[f64::NAN; 3]; 400], 0);
    let seen = places.iter().map(|x| Seen {
        x: *x,
        u: u(*x),
        volume: D * D,
        value: 0.0,
    });
    around.seen = seen.collect();
    around
}

fn inside(around: &Around<Wendland<2>>) -> Vec<usize> {
    let is_inside = |x: [f64; 3]| x[0] > 0.5 && x[0] < 1.5 && x[1] > 0.4 && x[1] < 1.5;
    let all = 0..around.seen.len();
    all.filter(|a| is_inside(around.seen[*a].x)).collect()
}

#[test]
fn linear_fields_have_their_slope_and_divergence() {
    let around = cloud(|[x, y, _]| [3.0 * x - y, 2.0 * x - 5.0 * y, 0.0]);
    let filled = Filled::of(&around.kernel, D, 2);
    for a in inside(&around) {
        let row = Sums::of::<2, _>(&around, a, false, &filled, &[], &mut Vec::new());
        assert!((row.divergence + 2.0).abs() < 1e-11, "{row:?}");
        assert!((row.slope[1][0] + 1.0).abs() < 1e-11 && (row.slope[0][1] - 2.0).abs() < 1e-11);
        let p = |x: [f64; 3]| 7.0 * x[0] - 4.0 * x[1];
        let mut sum = [0.0; 3];
        around.each(a, |_, other, x, _, slope| {
            let part = other.volume * slope * (p(other.x) - p(around.seen[a].x));
            (0..3).for_each(|k| sum[k] += part * x[k]);
        });
        let [x, y, _] = times(row.inverse, sum);
        assert!((x - 7.0).abs() + (y + 4.0).abs() < 1e-11, "{x} {y}");
    }
}

#[test]
fn what_goes_at_a_wall_closes_and_what_goes_along_it_does_not() {
    for (u, closes) in [([0.0, -1.0, 0.0], true), ([1.0, 0.0, 0.0], false)] {
        let around = cloud(|_| u);
        let filled = Filled::of(&around.kernel, D, 2);
        let low = (0..400)
            .filter(|a| around.seen[*a].x[1] < D && (around.seen[*a].x[0] - 1.0).abs() < 0.5);
        for a in low {
            let row = Sums::of::<2, _>(&around, a, true, &filled, &[], &mut Vec::new());
            assert!(row.missing <= 0.0, "a wall is no surface: {row:?}");
            assert_eq!(row.divergence < -1.0, closes, "{row:?}");
            assert!(closes || row.divergence.abs() < 1e-12, "{row:?}");
        }
    }
}

#[test]
fn couplings_of_pairs_are_alike_from_both_sides() {
    let around = cloud(|_| [0.0; 3]);
    let filled = Filled::of(&around.kernel, D, 2);
    let row = |a: usize| {
        let mut with = Vec::new();
        let _ = Sums::of::<2, _>(
            &around,
            a,
            around.seen[a].x[1] < around.near.radius(),
            &filled,
            &[],
            &mut with,
        );
        with
    };
    let sum = |a: usize, b: u32| {
        row(a)
            .iter()
            .filter(|(c, _)| *c == b)
            .map(|(_, w)| w)
            .sum::<f64>()
    };
    for (a, b) in [(5, 25), (5, 6), (45, 5), (210, 211)] {
        let (there, back) = (sum(a, b as u32), sum(b, a as u32));
        assert!(
            there > 0.0 && (there / back - 1.0).abs() < 1e-12,
            "{there} {back}"
        );
    }
}
