//! Exact and limiting cases of conduction and melting.

use std::f64::consts::PI;
use std::sync::Arc;

use particles::{Matter, POSITION};
use run::property::{Curve, Property};
use shapes::Face;

use super::caloric::Melting;
use super::caloric::tests::{plain, steel};
use super::*;
use crate::stage::Stage;
use crate::state::{ENTHALPY, FUSED, PHASE, Particle, State, TEMPERATURE, phase};

/// A box of nx x ny x nz particles with its lower corner at the origin.
fn lattice(metal: Matter, n: [usize; 3], caloric: &Caloric, t: impl Fn([f64; 3]) -> f64) -> State {
    let mut state = State::new(metal);
    state.metal.declare(&TEMPERATURE);
    state.metal.declare(&ENTHALPY);
    state.metal.declare(&FUSED);
    for i in 0..n[0] * n[1] * n[2] {
        let index = [i % n[0], i / n[0] % n[1], i / (n[0] * n[1])];
        let position = index.map(|k| (k as f64 + 0.5) * metal.spacing);
        let temperature = t(position);
        state.push(Particle {
            position,
            velocity: [0.0; 3],
            phase: phase::SOLID,
            droplet: false,
            wall: false,
            temperature,
            enthalpy: caloric.enthalpy(temperature),
        });
    }
    state
}

fn metal(density: f64, spacing: f64) -> Matter {
    Matter {
        density,
        spacing,
        smoothing_length: spacing,
    }
}

/// Mirrors all faces of the box but those in `open`.
fn parameters(metal: Matter, n: [usize; 3], open: Vec<Face>) -> Parameters {
    let all = [
        Face::XLow,
        Face::XHigh,
        Face::YLow,
        Face::YHigh,
        Face::ZLow,
        Face::ZHigh,
    ];
    Parameters {
        thermal_conductivity_w_m_k: Property::Constant(1.0),
        specific_heat_j_kg_k: Property::Constant(1.0),
        melting: None,
        rest_interval_steps: 1,
        exchange_tolerance_k: 0.0,
        faces: Some(Faces {
            min_m: [0.0; 3],
            max_m: n.map(|k| k as f64 * metal.spacing),
            mirror: all.into_iter().filter(|f| !open.contains(f)).collect(),
            open,
            surroundings_k: 0.0,
        }),
    }
}

fn march(state: &mut State, stage: &mut dyn Stage, dt: f64, steps: usize) {
    for _ in 0..steps {
        state.gather();
        stage.advance(state, dt).unwrap();
        state.step += 1;
        state.time = state.step as f64 * dt;
    }
}

/// Largest error of a decaying cosine over n spacings along x, t = 0.05 L^2 rho c/k.
fn cosine_error(n: usize) -> f64 {
    let size = [n, 3, 3];
    let metal = metal(2.0, 1.0 / n as f64);
    let caloric = Arc::new(plain(3.0, 0.5, None));
    let mut state = lattice(metal, size, &caloric, |x| 10.0 + (PI * x[0]).cos());
    let given = parameters(metal, size, vec![]);
    let mut stage = Conduction::new(&given, Substances::of(caloric, metal), metal).unwrap();
    let steps = 8 * n * n / 10;
    let end = 0.05 / 3.0;
    march(&mut state, &mut stage, end / steps as f64, steps);
    let decay = (-PI * PI * 0.05).exp();
    let exact = |x: [f64; 3]| 10.0 + decay * (PI * x[0]).cos();
    let errors = (state.metal.column(&POSITION).iter()).zip(state.metal.column(&TEMPERATURE));
    errors
        .map(|(x, t)| (t - exact(*x)).abs())
        .fold(0.0, f64::max)
}

#[test]
fn a_cosine_decays_with_second_order() {
    let (coarse, fine) = (cosine_error(10), cosine_error(20));
    let order = (coarse / fine).log2();
    assert!(fine < 5e-4, "error {fine}");
    assert!(
        (1.9..2.1).contains(&order),
        "order {order}: {coarse} {fine}"
    );
}

fn noise(i: usize) -> f64 {
    ((i as f64 * 12.9898).sin() * 43_758.545_3).fract().abs()
}

fn stored(state: &State) -> f64 {
    state.metal.column(&ENTHALPY).iter().sum::<f64>() * state.metal.matter.mass()
}

#[test]
fn energy_is_kept_to_round_off_in_a_moving_melt() {
    let metal = metal(7850.0, 0.5e-3);
    let caloric = Arc::new(steel());
    let mut state = lattice(metal, [9, 9, 9], &caloric, |_| 300.0);
    for a in 0..state.len() {
        state.metal.column_mut(&ENTHALPY)[a] = 2.3e6 * noise(a);
        state.metal.column_mut(&TEMPERATURE)[a] =
            caloric.temperature(state.metal.column(&ENTHALPY)[a]);
    }
    state.flowing = true;
    let before = stored(&state);
    let given = parameters(metal, [9, 9, 9], vec![]);
    let mut conduction =
        Conduction::new(&given, Substances::of(Arc::clone(&caloric), metal), metal).unwrap();
    let mut phase = Phase::new(caloric, None);
    for step in 0..200 {
        march(&mut state, &mut phase, 1e-4, 1);
        march(&mut state, &mut conduction, 1e-4, 1);
        for a in 0..state.len() {
            if state.metal.column(&PHASE)[a] == phase::LIQUID {
                for k in 0..3 {
                    state.metal.column_mut(&POSITION)[a][k] +=
                        2e-5 * (noise(3 * a + k + step) - 0.5);
                }
            }
        }
    }
    assert!(state.liquid() > 100 && state.liquid() < 729);
    let drift = (stored(&state) - before) / before;
    assert!(drift.abs() < 1e-13, "drift {drift:e}");
}

/// erf by its series.
fn erf(x: f64) -> f64 {
    let mut term = 2.0 / PI.sqrt() * x;
    let mut sum = term;
    for n in 1..60 {
        let n = f64::from(n);
        term *= -x * x / n;
        sum += term / (2.0 * n + 1.0);
    }
    sum
}

/// Neumann's front into a solid at its melting point: `s = 2 l sqrt(a t)` with
/// `l exp(l^2) erf(l) = c (T_w - T_m)/(L sqrt(pi))`.
#[test]
fn the_parts_that_have_molten_tell_the_front_to_a_part_of_a_particle() {
    let (length, part) = (40, 0.6_f64);
    let (conductivity, heat, latent_heat) = (2.0, 500.0, 1e5);
    let metal = metal(4000.0, 1e-3);
    let melting = Melting {
        point: 10.0,
        latent_heat,
    };
    let caloric = Arc::new(plain(conductivity, heat, Some(melting)));
    let rise = part * (part * part).exp() * erf(part) * PI.sqrt() * latent_heat / heat;
    let wall = caloric.enthalpy(10.0 + rise);
    let mut state = lattice(metal, [length, 3, 3], &caloric, |_| 10.0);
    let given = parameters(metal, [length, 3, 3], vec![]);
    let mut conduction =
        Conduction::new(&given, Substances::of(Arc::clone(&caloric), metal), metal).unwrap();
    let mut phase = Phase::new(Arc::clone(&caloric), None);
    let held: Vec<usize> = (0..state.len())
        .filter(|a| state.metal.column(&POSITION)[*a][0] < metal.spacing)
        .collect();
    let dt = 0.5 * conduction.limit();
    let (mut worst, mut whole, mut passed) = (0.0_f64, 0.0_f64, 0);
    loop {
        for a in &held {
            state.metal.set(&ENTHALPY, *a, wall);
            state.metal.set(&TEMPERATURE, *a, 10.0 + rise);
        }
        march(&mut state, &mut conduction, dt, 1);
        march(&mut state, &mut phase, dt, 1);
        passed += 1;
        let time = f64::from(passed) * dt;
        // In spacings from the middle of the particle that is held.
        let exact =
            2.0 * part * (conductivity / (metal.density * heat) * time).sqrt() / metal.spacing;
        let sum = |f: fn(f64) -> f64| {
            state
                .metal
                .column(&FUSED)
                .iter()
                .map(|v| f(*v))
                .sum::<f64>()
                / 9.0
                - 0.5
        };
        if exact > 12.0 {
            break;
        }
        if exact > 4.0 {
            worst = worst.max((sum(|f| f) - exact).abs());
            whole = whole.max((sum(|f| f64::from(u8::from(f >= 0.5))) - exact).abs());
        }
    }
    assert!(
        worst < 0.15 && whole > 0.4,
        "off by {worst} and, in whole particles, {whole} spacings"
    );
}

#[test]
fn heat_does_not_leave_the_range_of_temperatures() {
    let metal = metal(7850.0, 0.5e-3);
    let caloric = Arc::new(steel());
    let mut state = lattice(metal, [8, 8, 8], &caloric, |x| {
        if x[0] < 2e-3 { 400.0 } else { 1500.0 }
    });
    let given = parameters(metal, [8, 8, 8], vec![]);
    let mut stage = Conduction::new(&given, Substances::of(caloric, metal), metal).unwrap();
    // Ten times the limit: divided within the stage.
    let dt = 10.0 * stage.limit();
    march(&mut state, &mut stage, dt, 20);
    let inside = |t: &f64| (400.0 - 1e-9..1500.0 + 1e-9).contains(t);
    assert!(state.metal.column(&TEMPERATURE).iter().all(inside));
    assert!(
        stage
            .figures()
            .iter()
            .any(|f| f.name == "conduction_substeps" && f.value > 9.5)
    );
}

/// A hot spot in a cold box, with a tolerance, stepped `steps` times.
fn spot(tolerance: f64, forget: bool) -> (State, f64) {
    let metal = metal(7850.0, 0.5e-3);
    let caloric = Arc::new(steel());
    let size = [30, 30, 12];
    let hot = |x: [f64; 3]| {
        if x.iter().all(|x| *x < 2e-3) {
            1500.0
        } else {
            300.0
        }
    };
    let mut state = lattice(metal, size, &caloric, hot);
    let mut given = parameters(metal, size, vec![]);
    given.exchange_tolerance_k = tolerance;
    let mut stage =
        Conduction::new(&given, Substances::of(Arc::clone(&caloric), metal), metal).unwrap();
    let mut visited = 0.0;
    for _ in 0..60 {
        if forget {
            let saved = stage.save();
            stage = Conduction::new(&given, Substances::of(Arc::clone(&caloric), metal), metal)
                .unwrap();
            stage.restore(&saved);
        }
        march(&mut state, &mut stage, 1e-3, 1);
        visited += stage.figures()[0].value / state.len() as f64 / 60.0;
    }
    (state, visited)
}

#[test]
fn passing_over_the_cold_changes_no_bit_and_a_tolerance_little() {
    let (lazy, part) = spot(1e-4, false);
    // A restored stage starts with every particle awake.
    let (eager, all) = spot(1e-4, true);
    assert!(part < 0.7 && all > 0.999, "visited {part} {all}");
    assert!(lazy.metal.column(&ENTHALPY) == eager.metal.column(&ENTHALPY));
    let (exact, _) = spot(0.0, false);
    let [lazy, exact] = [&lazy, &exact].map(|state| state.metal.column(&TEMPERATURE));
    let errors = lazy.iter().zip(exact);
    let worst = errors.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(worst < 2e-4, "tolerance costs {worst} K");
}

#[test]
fn an_open_face_lets_a_steady_gradient_through() {
    let metal = metal(1.0, 0.1);
    let caloric = Arc::new(plain(2.0, 1.0, None));
    let size = [12, 4, 4];
    let slope = |x: [f64; 3]| 100.0 - 10.0 * x[0];
    let mut state = lattice(metal, size, &caloric, slope);
    let given = parameters(metal, size, vec![Face::XHigh]);
    let mut stage = Conduction::new(&given, Substances::of(caloric.clone(), metal), metal).unwrap();
    for a in (0..state.len()).filter(|a| a % size[0] < 2) {
        stage.hold(
            a..a + 1,
            Curve::Constant(slope(state.metal.column(&POSITION)[a])),
        );
    }
    march(&mut state, &mut stage, 1e-4, 100);
    let errors = state
        .metal
        .column(&POSITION)
        .iter()
        .zip(state.metal.column(&TEMPERATURE));
    let free = errors.enumerate().filter(|(a, _)| a % size[0] >= 2);
    let worst = free
        .map(|(_, pair)| pair)
        .map(|(x, t)| (t - slope(*x)).abs())
        .fold(0.0, f64::max);
    assert!(worst < 1e-10, "{worst}");
    // The other way round the plate beyond would have to be a source: nothing comes in.
    let mut state = lattice(metal, size, &caloric, |x| 100.0 + 10.0 * x[0]);
    let before = stored(&state);
    let mut stage = Conduction::new(&given, Substances::of(caloric, metal), metal).unwrap();
    march(&mut state, &mut stage, 1e-4, 100);
    assert!(stored(&state) <= before * (1.0 + 1e-14));
}

#[test]
fn an_open_face_never_falls_below_the_surroundings() {
    let metal = metal(7850.0, 0.5e-3);
    let caloric = Arc::new(steel());
    let size = [10, 4, 4];
    let hot = |x: [f64; 3]| if x[0] < 2e-3 { 1700.0 } else { 300.0 };
    let mut state = lattice(metal, size, &caloric, hot);
    let before = stored(&state);
    let mut given = parameters(metal, size, vec![Face::XHigh]);
    given.faces.as_mut().unwrap().surroundings_k = 300.0;
    let mut stage = Conduction::new(&given, Substances::of(caloric, metal), metal).unwrap();
    for _ in 0..4000 {
        march(&mut state, &mut stage, 2e-3, 1);
        let coldest = state
            .metal
            .column(&TEMPERATURE)
            .iter()
            .fold(f64::MAX, |m, t| m.min(*t));
        assert!(coldest > 300.0 - 1e-9, "{coldest}");
    }
    // Heat leaves while there is a gradient, and the ledger knows how much.
    let warmest = state
        .metal
        .column(&TEMPERATURE)
        .iter()
        .fold(0.0_f64, |m, t| m.max(*t));
    assert!(warmest < 320.0, "{warmest}");
    let figures = stage.figures();
    let out = figures
        .iter()
        .find(|f| f.name == "energy_out_open_faces_j")
        .unwrap()
        .value;
    assert!(((before - stored(&state)) / out - 1.0).abs() < 1e-9);
}

/// Relative error of the front of a one-phase Stefan problem with n spacings (Neumann's solution,
/// Carslaw and Jaeger 1959, section 11.2): wall at 1 K above the melting point, solid at it.
fn stefan_error(n: usize) -> f64 {
    let size = [n, 3, 3];
    let metal = metal(1.0, 1.0 / n as f64);
    // Stefan number 1: lambda e^(lambda^2) erf(lambda) = 1/sqrt(pi).
    let lambda = 0.620_062_640_1;
    let melting = Melting {
        point: 5.0,
        latent_heat: 1.0,
    };
    let caloric = Arc::new(plain(1.0, 1.0, Some(melting)));
    let mut state = lattice(metal, size, &caloric, |_| 5.0);
    let mut given = parameters(metal, size, vec![]);
    given
        .faces
        .as_mut()
        .unwrap()
        .mirror
        .retain(|f| *f != Face::XLow);
    for j in 0..18 {
        state.push(Particle {
            position: [
                -(0.5 + (j % 2) as f64) * metal.spacing,
                (0.5 + (j / 2 % 3) as f64) * metal.spacing,
                (0.5 + (j / 6) as f64) * metal.spacing,
            ],
            velocity: [0.0; 3],
            phase: phase::SOLID,
            droplet: false,
            wall: true,
            temperature: 6.0,
            enthalpy: 0.0,
        });
    }
    let plate = n * 9;
    let mut stage =
        Conduction::new(&given, Substances::of(Arc::clone(&caloric), metal), metal).unwrap();
    stage.hold(plate..plate + 18, Curve::Constant(6.0));
    let end = 0.25;
    let steps = (end / stage.limit()).ceil() as usize;
    march(&mut state, &mut stage, end / steps as f64, steps);
    // The boundary value sits half a spacing outside of the first particle.
    let start = -0.5 * metal.spacing;
    let latent: f64 = (state.metal.column(&ENTHALPY)[..plate].iter())
        .zip(state.metal.column(&TEMPERATURE))
        .map(|(h, t)| h - (t - 5.0) - caloric.enthalpy(5.0))
        .sum::<f64>()
        * metal.spacing
        / 9.0;
    let front = 2.0 * lambda * f64::sqrt(end);
    (latent - start) / front - 1.0
}

#[test]
fn a_melting_front_follows_neumann() {
    let (coarse, fine) = (stefan_error(20), stefan_error(80));
    assert!(fine.abs() < 2e-3, "front off by {coarse} {fine}");
    assert!(
        fine.abs() < 0.5 * coarse.abs(),
        "no convergence: {coarse} {fine}"
    );
}

#[test]
fn the_flow_starts_with_120_liquid_particles_and_not_with_119() {
    let metal = metal(1000.0, 1e-3);
    let melting = Melting {
        point: 1000.0,
        latent_heat: 200.0,
    };
    let caloric = Arc::new(plain(1.0, 1.0, Some(melting)));
    for (liquid, flows) in [(0, false), (119, false), (120, true), (130, true)] {
        let mut state = lattice(metal, [13, 10, 1], &caloric, |_| 999.0);
        for enthalpy in &mut state.metal.column_mut(&ENTHALPY)[..liquid] {
            // Half of the latent heat and a little.
            *enthalpy = caloric.enthalpy(1000.0) + 100.0 + 1e-6;
        }
        let start = FlowStart {
            liquid_particles: 120,
        };
        let mut stage = Phase::new(caloric.clone(), Some(start));
        stage.advance(&mut state, 1e-4).unwrap();
        assert_eq!(state.flowing, flows, "{liquid} particles are liquid");
        assert_eq!(state.liquid(), liquid);
        // What flows goes on to flow when some of it freezes.
        state.metal.column_mut(&ENTHALPY).fill(0.0);
        stage.advance(&mut state, 1e-4).unwrap();
        assert_eq!((state.flowing, state.liquid()), (flows, 0));
    }
}
