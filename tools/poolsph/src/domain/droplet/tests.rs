//! Droplets come in time, carry their feed, and land.

use particles::{Matter, POSITION};

use super::*;
use crate::source::Place;
use crate::state::{PHASE, Particle, VELOCITY, phase};

const METAL: Matter = Matter {
    density: 7850.0,
    spacing: 5e-4,
    smoothing_length: 5e-4,
};

fn parameters() -> Parameters {
    Parameters {
        period_s: Some(1e-2),
        feed_m3_s: None,
        radius_m: 0.75e-3,
        height_m: 5e-3,
        speed_m_s: 1.56,
        temperature_k: None,
    }
}

fn wire() -> Wire {
    Wire::new(parameters(), METAL, None, None).unwrap()
}

fn one() -> Droplets {
    Droplets::of(vec![wire()])
}

fn start() -> State {
    let mut state = State::new(METAL);
    state.metal.declare(&DROPLET);
    state.flowing = true;
    state.source = Some(Place {
        position: [0.0; 3],
        way: [0.0; 3],
        phase: 0.0,
        droplets: 0,
    });
    for i in -4..=4 {
        for j in -4..=4 {
            state.push(Particle {
                position: [f64::from(i) * 5e-4, f64::from(j) * 5e-4, -2.5e-4],
                velocity: [0.0; 3],
                phase: phase::SOLID,
                droplet: false,
                wall: false,
                temperature: 0.0,
                enthalpy: 0.0,
            });
        }
    }
    state
}

fn march(stage: &mut Droplets, state: &mut State, steps: u64) {
    for _ in 0..steps {
        stage.advance(state, 1e-4).unwrap();
        state.step += 1;
    }
}

#[test]
fn a_droplet_has_layers_of_five_nine_and_five() {
    let shape = shape(0.75e-3, 5e-4, None);
    let layer = |z: f64| shape.iter().filter(|p| (p[2] - z).abs() < 1e-9).count();
    assert_eq!([layer(-5e-4), layer(0.0), layer(5e-4)], [5, 9, 5]);
    assert_eq!(shape.len(), 19);
}

#[test]
fn droplets_come_in_time_and_land_with_their_speed() {
    let mut state = start();
    let mut stage = one();
    march(&mut stage, &mut state, 20);
    let first = 81;
    assert!(
        state.metal.column(&PHASE)[first..]
            .iter()
            .all(|p| *p == phase::FLYING)
    );
    // 5 mm less the half droplet, the support and the half particle, at 1.56 m/s.
    march(&mut stage, &mut state, 10);
    assert!(
        state.metal.column(&PHASE)[first..]
            .iter()
            .all(|p| *p == phase::LIQUID)
    );
    assert!((state.metal.column(&VELOCITY)[first][2] + 1.56).abs() < 1e-15);
    march(&mut stage, &mut state, 970);
    // Born at the first of the steps 1, 100, 200, ... of 1000.
    assert_eq!(state.source.unwrap().droplets, 11);
    assert_eq!(
        state.metal.column(&DROPLET).iter().filter(|d| **d).count(),
        11 * 19
    );
    assert!(state.source.unwrap().phase.abs() < 1e-9);
}

#[test]
fn droplets_of_any_spacing_carry_the_feed() {
    let feed = 1.49e-7;
    let parameters = Parameters {
        period_s: None,
        feed_m3_s: Some(feed),
        ..parameters()
    };
    for spacing in [1e-3, 7e-4, 5e-4, 4e-4, 2.5e-4] {
        let metal = Matter {
            spacing,
            smoothing_length: spacing,
            ..METAL
        };
        let stage = Wire::new(parameters, metal, None, None).unwrap();
        let volume = stage.particles() as f64 * spacing.powi(3);
        let supplied = stage.due(10.0) as f64 * volume;
        assert!((supplied - 10.0 * feed).abs() < 1.001 * volume, "{spacing}");
    }
    // A period goes before.
    assert_eq!(
        Parameters {
            period_s: Some(0.02),
            ..parameters
        }
        .period(5e-4, None),
        Some(0.02)
    );
    let silent = Parameters {
        feed_m3_s: None,
        ..parameters
    };
    let fault = Wire::new(silent, METAL, None, None).err().unwrap();
    assert!(fault.to_string().contains("feed_m3_s"), "{fault}");
}

#[test]
fn half_droplets_and_their_images_carry_the_feed() {
    let feed = 1.05e-7;
    let parameters = Parameters {
        period_s: None,
        feed_m3_s: Some(feed),
        radius_m: 1.25e-3,
        ..parameters()
    };
    for (axis, below) in [(0, false), (0, true), (1, false)] {
        let mirror = Mirror { axis, below };
        let half = shape(1.25e-3, 5e-4, Some(mirror));
        // Two halves are nearly the droplet of a ball, and none is on the plane.
        let ball = 4.0 / 3.0 * std::f64::consts::PI * 1.25e-3_f64.powi(3);
        let both = 2.0 * half.len() as f64 * 5e-4_f64.powi(3);
        assert!((both / ball - 1.0).abs() < 0.15, "{}", both / ball);
        let side = if below { -1.0 } else { 1.0 };
        assert!(half.iter().all(|x| side * x[axis] > 2.4e-4));
        let stage = Wire::new(parameters, METAL, Some(mirror), None).unwrap();
        let supplied = stage.due(10.0) as f64 * both;
        assert!((supplied - 10.0 * feed).abs() < 1.001 * both);
    }
}

#[test]
fn a_mirror_halves_droplets_on_it_and_may_not_cut_others() {
    let mirror = Mirror {
        axis: 0,
        below: false,
    };
    let of = |start: [f64; 3], velocity: [f64; 3]| {
        parameters().mirror(start, velocity, &[(mirror, 0.0)])
    };
    let along = [0.0, 5e-3, 0.0];
    assert_eq!(of([0.0; 3], along).unwrap(), Some(mirror));
    assert_eq!(of([1e-3, 0.0, 0.0], along).unwrap(), None);
    let cut = of([5e-4, 0.0, 0.0], along).err().unwrap();
    assert!(cut.to_string().contains("mirror"), "{cut}");
}

#[test]
fn phases_run_from_birth_to_birth() {
    let mut state = start();
    let mut stage = one();
    for step in 1..=250_u64 {
        march(&mut stage, &mut state, 1);
        let place = state.source.unwrap();
        let expected = (step % 100) as f64 / 100.0;
        assert!(
            (place.phase - expected).abs() < 1e-9,
            "{step}: {}",
            place.phase
        );
    }
}

#[test]
fn before_the_flow_a_droplet_comes_to_rest_where_it_touches() {
    let mut state = start();
    state.flowing = false;
    let mut stage = one();
    march(&mut stage, &mut state, 60);
    let lowest = state.metal.column(&POSITION)[81..]
        .iter()
        .map(|p| p[2])
        .fold(f64::MAX, f64::min);
    assert!(
        state.metal.column(&PHASE)[81..]
            .iter()
            .all(|p| *p == phase::LIQUID)
    );
    // The bottom layer of five stands over lattice places 2.5e-4 m below the plate's face.
    assert!((lowest - 2.5e-4).abs() < 1e-6, "{lowest}");
    assert!(
        state.metal.column(&VELOCITY)[81]
            .iter()
            .all(|u| u.abs() < 1e-15)
    );
}

#[test]
fn a_restored_stage_goes_on_alike() {
    let (mut state, mut stage) = (start(), one());
    march(&mut stage, &mut state, 115);
    let mut again = one();
    again.restore(&stage.save());
    let mut copy = state.clone();
    march(&mut stage, &mut state, 200);
    march(&mut again, &mut copy, 200);
    assert_eq!(state.metal.column(&POSITION), copy.metal.column(&POSITION));
    assert_eq!(state.metal.column(&PHASE), copy.metal.column(&PHASE));
}

#[test]
fn a_second_wire_feeds_where_it_stands_and_resumes() {
    let slow = Parameters {
        period_s: Some(1.7e-2),
        radius_m: 6e-4,
        ..parameters()
    };
    let both = || {
        let second = Wire::new(slow, METAL, None, None).unwrap();
        Droplets::of(vec![wire(), second.beside([0.0, -4e-3, 0.0])])
    };
    let (mut state, mut stage) = (start(), both());
    march(&mut stage, &mut state, 120);
    let behind = |state: &State| {
        let places = state.metal.column(&POSITION)[81..].iter();
        places.filter(|x| x[1] < -2e-3).count()
    };
    // Two of the first wire, one of the second: a cross of seven.
    assert_eq!([behind(&state), state.len() - 81], [7, 7 + 2 * 19]);
    assert_eq!(state.source.unwrap().droplets, 2);
    let (mut copy, mut again) = (state.clone(), both());
    again.restore(&stage.save());
    march(&mut stage, &mut state, 230);
    march(&mut again, &mut copy, 230);
    assert_eq!(state.metal.column(&POSITION), copy.metal.column(&POSITION));
    assert_eq!(state.metal.column(&PHASE), copy.metal.column(&PHASE));
    // At 35 ms: births at 0, 10, 20, 30 ms, and at 0, 17, 34 ms.
    assert_eq!([behind(&state), state.len() - 81], [3 * 7, 3 * 7 + 4 * 19]);
    let born = stage.figures()[0].value;
    assert!((born - 7.0).abs() < 1e-12);
}
