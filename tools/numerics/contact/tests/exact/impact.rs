//! Restitution, duration and overlap of impacts.

use contact::{Contact, Elastic, Ending, Hertz, History, Linear, Meeting, Normal};

use crate::motion::{advance, approaching};

/// Beginnings of a contact within a step that are tried.
const BEGINNINGS: u32 = 8;

/// What impacts at `speed` leave in the mean over where in a step they begin: restitution, duration of the push, greatest overlap.
///
/// A contact begins and ends within a step; where it does is chance in a bed of grains.
fn impact<N: Normal + Copy>(
    law: N,
    sizes: [(f64, f64); 2],
    speed: f64,
    duration: f64,
    parts: usize,
) -> [f64; 3] {
    let contact = Contact {
        normal: law,
        friction: None,
    };
    let step = duration / parts as f64;
    let mut mean = [0.0; 3];
    for n in 0..BEGINNINGS {
        let gap = (f64::from(n) + 0.5) / f64::from(BEGINNINGS) * speed * step;
        let mut grains = approaching(sizes, gap, speed);
        let (mut history, mut last) = (History::default(), None);
        let (mut pushed, mut deepest) = (0.0, 0.0_f64);
        for _ in 0..4 * parts {
            advance(&mut grains, &contact, &mut history, &mut last, step);
            if last.is_some_and(|r| r.push.abs() > 0.0) {
                pushed += step;
            }
            if let Some(meeting) = Meeting::of(&grains[0], &grains[1]) {
                deepest = deepest.max(meeting.overlap);
            }
        }
        let parting = grains[1].velocity[0] - grains[0].velocity[0];
        for (sum, one) in mean.iter_mut().zip([parting / speed, pushed, deepest]) {
            *sum += one / f64::from(BEGINNINGS);
        }
    }
    mean
}

#[test]
fn linear_impacts_have_the_restitution_and_duration_asked_for() {
    let (radius, mass) = (0.25e-3, 2.1e-7);
    for stiffness in [75.0, 1e4, 1e7] {
        for e in [0.05, 0.3, 0.75, 0.95, 1.0] {
            for ratio in [1.0_f64, 3.0] {
                let sizes = [(radius, mass), (ratio * radius, ratio.powi(3) * mass)];
                let law = Linear::new(stiffness, stiffness, e, Ending::ZeroForce);
                let effective = sizes[0].1 * sizes[1].1 / (sizes[0].1 + sizes[1].1);
                let duration = law.duration(effective);
                // Shallow at every stiffness: the speed follows the spring.
                let speed = 0.05 * radius * (stiffness / effective).sqrt();
                let [found, lasted, _] = impact(law, sizes, speed, duration, 50);
                assert!(
                    (found - e).abs() < 0.01 * e,
                    "k {stiffness}, e {e}: {found}"
                );
                assert!(
                    (lasted / duration - 1.0).abs() < 0.01,
                    "{lasted} {duration}"
                );
            }
        }
    }
}

#[test]
fn the_overlap_of_an_elastic_impact_is_v_over_omega() {
    let sizes = [(1e-3, 1e-5), (1e-3, 1e-5)];
    let law = Linear::new(1e4, 1e4, 1.0, Ending::ZeroForce);
    let [_, _, deepest] = impact(law, sizes, 0.1, law.duration(5e-6), 50);
    let exact = 0.1 * (5e-6_f64 / 1e4).sqrt();
    assert!((deepest / exact - 1.0).abs() < 0.01, "{deepest} {exact}");
}

#[test]
fn a_dashpot_that_pulls_ends_where_the_overlap_ends() {
    for e in [0.3, 0.75] {
        let law = Linear::new(1e4, 1e4, e, Ending::ZeroOverlap);
        let sizes = [(1e-3, 1e-5), (2e-3, 8e-5)];
        let effective = 8e-10 / 9e-5;
        let [found, ..] = impact(law, sizes, 0.1, law.duration(effective), 50);
        assert!((found / e - 1.0).abs() < 0.01, "{found} for {e}");
        let mass_of_one = Ending::ZeroOverlap.restitution(law.damping_ratio() * (2.0_f64).sqrt());
        assert!(mass_of_one < e, "the mass of one grain damps too much");
    }
}

#[test]
fn errors_of_the_restitution_fall_with_the_square_of_the_step() {
    let sizes = [(1e-3, 1e-5), (1e-3, 1e-5)];
    let law = Linear::new(1e4, 1e4, 0.75, Ending::ZeroForce);
    let error = |parts| {
        let [e, ..] = impact(law, sizes, 0.1, law.duration(5e-6), parts);
        (e - 0.75).abs()
    };
    let order = (error(50) / error(200)).log2() / 2.0;
    assert!(order > 1.8, "order {order}: {} {}", error(50), error(200));
    assert!(error(50) < 1e-3, "{}", error(50));
}

#[test]
fn hertz_impacts_last_as_hertz_says_at_every_speed() {
    let steel = Elastic {
        youngs_modulus: 2.1e11,
        poisson_ratio: 0.3,
    };
    let soft = Elastic {
        youngs_modulus: 1e7,
        poisson_ratio: 0.45,
    };
    let sizes = [(5e-3, 4e-3), (2e-3, 3e-4)];
    let mass = sizes[0].1 * sizes[1].1 / (sizes[0].1 + sizes[1].1);
    let radius = 1e-5 / 7e-3;
    for pair in [[steel, steel], [steel, soft]] {
        for speed in [0.01, 1.0] {
            let law = Hertz::new(pair, 1.0, Ending::ZeroForce);
            let exact = law.elastic_duration(mass, radius, speed);
            let [e, lasted, deepest] = impact(law, sizes, speed, exact, 200);
            assert!((e - 1.0).abs() < 1e-3, "{e}");
            assert!((lasted / exact - 1.0).abs() < 0.01, "{lasted} {exact}");
            let expected = law.deepest(mass, radius, speed);
            assert!((deepest / expected - 1.0).abs() < 1e-3);
            for asked in [0.2, 0.6, 0.9] {
                let law = Hertz::new(pair, asked, Ending::ZeroForce);
                let [e, ..] = impact(law, sizes, speed, exact, 400);
                assert!((e / asked - 1.0).abs() < 0.01, "{e} for {asked} at {speed}");
            }
        }
    }
}

#[test]
fn damping_ratios_give_back_their_restitution() {
    for ending in [Ending::ZeroForce, Ending::ZeroOverlap] {
        for e in [1e-6, 0.05, 0.135_335_283, 0.5, 0.9, 1.0] {
            let back = ending.restitution(ending.damping_ratio(e));
            assert!((back / e - 1.0).abs() < 1e-6, "{ending:?}: {back} for {e}");
        }
    }
}
