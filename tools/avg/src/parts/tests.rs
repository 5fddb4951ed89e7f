use super::*;

/// Normal deviates (Box and Muller 1958) from a linear congruential generator (Knuth's MMIX).
struct Chance(u64);

impl Chance {
    fn even(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = self.0.wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        let (a, b) = (self.even(), self.even());
        (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
    }
}

fn estimate(parts: &Parts, values: &[f64]) -> Estimate {
    let mut found = Estimate::default();
    for (frame, value) in values.iter().enumerate() {
        found.add(parts.of(frame), *value);
    }
    found
}

/// Share of 1,000 runs whose interval holds the true mean, 2000.
fn coverage(mut run: impl FnMut(&mut Chance) -> Estimate) -> f64 {
    let mut chance = Chance(2019);
    let holds = |found: Estimate| (found.mean - 2000.0).abs() <= found.half_interval();
    let held = (0..1000).filter(|_| holds(run(&mut chance))).count();
    held as f64 / 1000.0
}

#[test]
fn the_interval_holds_the_true_mean_as_often_as_it_says_with_6_droplets_and_more() {
    for (droplets, frames) in [(6, 1), (6, 8), (6, 50), (12, 8), (25, 8), (125, 8)] {
        let of: Vec<i64> = (0..droplets * frames).map(|n| n / frames).collect();
        let parts = Parts::by_droplets(&of);
        let share = coverage(|chance| {
            let mut values = Vec::new();
            for _ in 0..droplets {
                // What all frames of a droplet share is ten times what tells them apart.
                let shared = 10.0 * chance.normal();
                values.extend((0..frames).map(|_| 2000.0 + shared + chance.normal()));
            }
            estimate(&parts, &values)
        });
        assert!((0.93..=0.97).contains(&share), "{share} of {droplets}");
    }
}

#[test]
fn droplets_that_share_their_chance_with_the_next_ones_are_taken_together() {
    let of: Vec<i64> = (0..400).collect();
    let parts = Parts::by_droplets(&of);
    assert_eq!(parts.count, DROPLET_PARTS);
    let share = coverage(|chance| estimate(&parts, &remembering(400, 0.6, chance)));
    assert!((0.93..=0.97).contains(&share), "{share}");
}

/// Values about 2000 that remember the share `keep` of the last one.
fn remembering(count: usize, keep: f64, chance: &mut Chance) -> Vec<f64> {
    let mut off = 10.0 * chance.normal();
    let mut next = || {
        off = keep * off + 10.0 * (1.0 - keep * keep).sqrt() * chance.normal();
        2000.0 + off
    };
    (0..count).map(|_| next()).collect()
}

#[test]
fn without_droplets_spans_longer_than_the_memory_hold_it_too() {
    for (frames, keep) in [(100, 0.0), (200, 0.5), (1000, 0.9), (4000, 0.97)] {
        let parts = Parts::by_spans(frames);
        let share = coverage(|chance| estimate(&parts, &remembering(frames, keep, chance)));
        assert!((0.93..=0.97).contains(&share), "{share} with {keep}");
    }
}

#[test]
fn more_frames_of_the_same_droplets_bring_no_smaller_error() {
    let shared = [3.0, -1.0, 4.0, -1.5, 5.0, -9.0];
    let error = |frames: usize| {
        let of: Vec<i64> = (0..6 * frames).map(|n| (n / frames) as i64).collect();
        let values: Vec<f64> = of.iter().map(|d| shared[*d as usize]).collect();
        estimate(&Parts::by_droplets(&of), &values).standard_error()
    };
    for frames in [2, 10, 1000] {
        assert!((error(frames) / error(1) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn parts_of_unequal_numbers_weigh_by_them() {
    let parts = Parts::by_droplets(&[0, 0, 0, 1, 2, 2]);
    let found = estimate(&parts, &[1.0, 2.0, 3.0, 7.0, 4.0, 6.0]);
    // Means 2, 7, 5 of 3, 1, 2 frames about 23/6.
    let mean = 23.0 / 6.0;
    let sum: f64 = [(3.0, 2.0), (1.0, 7.0), (2.0, 5.0)]
        .map(|(n, m): (f64, f64)| (n * (m - mean)).powi(2))
        .iter()
        .sum();
    assert!((found.mean - mean).abs() < 1e-14);
    assert!((found.standard_error() - (1.5 * sum).sqrt() / 6.0).abs() < 1e-14);
    assert_eq!(found.parts(), 3);
    assert!((found.half_interval() / found.standard_error() - 4.303).abs() < 1e-12);
}

#[test]
fn one_frame_a_part_is_the_error_of_independent_values() {
    let values = [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0];
    let found = estimate(&Parts::by_spans(8), &values);
    assert!((found.standard_error() - (32.0_f64 / 7.0 / 8.0).sqrt()).abs() < 1e-14);
    assert_eq!(estimate(&Parts::by_spans(1), &[3.0]).parts(), 1);
    assert!(estimate(&Parts::by_spans(1), &[3.0]).half_interval() == 0.0);
}

#[test]
fn values_that_are_equal_but_for_rounding_have_no_error_and_no_square_below_nothing() {
    let mut chance = Chance(7);
    for _ in 0..10_000 {
        let value = chance.even();
        let of: Vec<i64> = (0..12).map(|n| n * n / 9).collect();
        let values: Vec<f64> = of
            .iter()
            .map(|_| value * (1.0 + (chance.even() - 0.5) * 4.0 * f64::EPSILON))
            .collect();
        let found = estimate(&Parts::by_droplets(&of), &values);
        let error = found.standard_error();
        assert!((0.0..1e-8).contains(&error), "{error} {values:?}");
    }
}
