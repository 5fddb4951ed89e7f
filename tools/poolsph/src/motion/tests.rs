//! Exact and limiting cases of the motion.

use particles::{Matter, POSITION};

use super::integration::{CARRIED, PRESSURE};
use super::*;
use crate::forces::tension::{self, Tension};
use crate::march::{Group, March};
use crate::near::{Near, Role};
use crate::stage::{Stage, StageError};
use crate::state::{PHASE, Particle, State, TEMPERATURE, VELOCITY, phase};

pub(super) const METAL: Matter = Matter {
    density: 7850.0,
    spacing: 0.5e-3,
    smoothing_length: 0.5e-3,
};

fn parameters(method: Method) -> Parameters {
    let text = r#"{"viscosity_pa_s": 0.004, "density_tolerance": 1e-6}"#;
    Parameters {
        method,
        ..serde_json::from_str(text).unwrap()
    }
}

/// The cells of a box, each as `phase` says, with velocities as `velocity` says.
pub(super) fn block(
    cells: [i32; 3],
    phase: impl Fn([i32; 3]) -> u8,
    velocity: impl Fn([f64; 3]) -> [f64; 3],
) -> State {
    let mut state = State::new(METAL);
    state.metal.declare(&PRESSURE);
    state.metal.declare(&CARRIED);
    state.flowing = true;
    for cell in 0..cells.iter().product() {
        let index = [
            cell % cells[0],
            cell / cells[0] % cells[1],
            cell / cells[0] / cells[1],
        ];
        let position = index.map(|i| METAL.spacing * (f64::from(i) + 0.5));
        let phase = phase(index);
        state.push(Particle {
            position,
            velocity: if phase == phase::LIQUID {
                velocity(position)
            } else {
                [0.0; 3]
            },
            phase,
            droplet: false,
            wall: phase == phase::SOLID,
            temperature: 0.0,
            enthalpy: 0.0,
        });
    }
    state
}

/// A tank of 6 x 6 x 8 liquid cells with two layers of wall.
pub(super) fn tank() -> State {
    block(
        [10, 10, 12],
        |[i, j, k]| {
            if k < 2 || [i, j].iter().any(|i| !(2..8).contains(i)) {
                phase::SOLID
            } else if k < 10 {
                phase::LIQUID
            } else {
                phase::FLYING
            }
        },
        |_| [0.0; 3],
    )
}

pub(super) fn march(method: Method, gravity: bool, tension: bool) -> March {
    let mut after: Vec<Box<dyn Stage>> = Vec::new();
    if tension {
        let parameters = tension::Parameters {
            surface_tension_n_m: 1.0,
        };
        after.push(Box::new(Tension::new(parameters, METAL)));
    }
    let parameters = Parameters {
        gravity_m_s2: gravity.then_some([0.0, 0.0, -9.8]),
        ..parameters(method)
    };
    after.push(Box::new(Motion::new(
        parameters,
        Law::Uniform(0.004),
        METAL,
    )));
    March::new(vec![Group::new("metal").gathering().of(after)], 1e-4)
}

pub(super) fn steps(march: &mut March, state: &mut State, steps: u32) -> Result<(), StageError> {
    for _ in 0..steps {
        march.step(state, u64::MAX, |_, work| work())?;
    }
    Ok(())
}

#[test]
fn liquid_at_rest_carries_its_weight() {
    let mut state = tank();
    let mut march = march(Method::Projection, true, false);
    steps(&mut march, &mut state, 100).unwrap();
    let (surface, mut error, mut count) = (10.0 * METAL.spacing, 0.0, 0.0);
    let bottom = METAL.density * 9.8 * 8.0 * METAL.spacing;
    let pressure = state.near.liquid_mean(state.metal.column(&CARRIED));
    for a in (0..state.len()).filter(|a| state.metal.column(&PHASE)[*a] == phase::LIQUID) {
        let speed = state.metal.column(&VELOCITY)[a]
            .iter()
            .map(|u| u * u)
            .sum::<f64>()
            .sqrt();
        assert!(
            speed < 0.005 * (9.8 * 8.0 * METAL.spacing).sqrt(),
            "{speed}"
        );
        error +=
            pressure[a] - METAL.density * 9.8 * (surface - state.metal.column(&POSITION)[a][2]);
        count += 1.0;
    }
    // The mean has all but e^-2 of its end after 10 ms.
    let settled = 1.0 - (-2.0_f64).exp();
    let deviation = (error / count + (1.0 - settled) * 0.5 * bottom) / bottom;
    assert!(deviation.abs() < 0.01, "{deviation}");
}

#[test]
fn a_mean_over_liquid_keeps_what_is_even_and_leaves_solid_alone() {
    let mut state = tank();
    steps(&mut march(Method::Projection, true, false), &mut state, 1).unwrap();
    let liquid = |a: usize| state.metal.column(&PHASE)[a] == phase::LIQUID;
    let own = |a: usize| if liquid(a) { 3.0 } else { a as f64 };
    let column: Vec<f64> = (0..state.len()).map(own).collect();
    for (a, mean) in state.near.liquid_mean(&column).into_iter().enumerate() {
        let off = (mean - column[a]).abs();
        assert!(
            if liquid(a) { off < 1e-12 } else { off == 0.0 },
            "{a}: {mean}"
        );
    }
    // What one particle alone has goes to those around it too, and none of it is more than that.
    let one = (0..state.len()).find(|a| liquid(*a)).unwrap();
    let peak: Vec<f64> = (0..state.len())
        .map(|a| f64::from(u8::from(a == one)))
        .collect();
    let means = state.near.liquid_mean(&peak);
    assert!(means[one] > 0.0 && means[one] < 1.0);
    assert!(means.iter().filter(|mean| **mean > 0.0).count() > 4);
}

#[test]
fn free_flight_keeps_momentum() {
    for method in [Method::Projection, Method::Homogenising] {
        let whirl = |x: [f64; 3]| [0.3 + 40.0 * x[1], -90.0 * x[0], 0.2 - 60.0 * x[2]];
        let mut state = block([7, 6, 5], |_| phase::LIQUID, whirl);
        let sum = |state: &State| {
            let add = |sum: [f64; 3], u: &[f64; 3]| [sum[0] + u[0], sum[1] + u[1], sum[2] + u[2]];
            state.metal.column(&VELOCITY).iter().fold([0.0; 3], add)
        };
        let before = sum(&state);
        steps(&mut march(method, false, true), &mut state, 30).unwrap();
        let after = sum(&state);
        let size: f64 = state
            .metal
            .column(&VELOCITY)
            .iter()
            .flatten()
            .map(|u| u.abs())
            .sum();
        for axis in 0..3 {
            let change = (after[axis] - before[axis]).abs() / size;
            assert!(change < 1e-12, "{method:?}, axis {axis}: {change:e}");
        }
    }
}

#[test]
fn a_parabola_feels_its_curvature() {
    // u_x = s z^2 has the viscous acceleration 2 s nu everywhere, a uniform shear has none.
    let slope = 1e4;
    let mut state = block(
        [8, 8, 8],
        |_| phase::LIQUID,
        |x| [slope * x[2] * x[2], 30.0 * x[2], 0.0],
    );
    state.gather();
    let near = &state.near;
    let mut change = vec![[0.0; 3]; near.len()];
    viscous(near, &mut change);
    let exact = 2.0 * slope * 0.004 / METAL.density;
    let inner = |x: &[f64; 3]| x.iter().all(|x| (x / METAL.spacing - 4.0).abs() < 2.0);
    let mut seen = 0;
    for (x, change) in near.position.iter().zip(&change).filter(|(x, _)| inner(x)) {
        assert!(
            (change[0] / exact - 1.0).abs() < 1e-9,
            "{change:?} at {x:?}"
        );
        assert!(change[1].abs() < 1e-9 * exact && change[2].abs() < 1e-9 * exact);
        seen += 1;
    }
    assert_eq!(seen, 64);
}

/// Adds the viscous acceleration of the velocities in `near` to `change`.
fn viscous(near: &Near, change: &mut [[f64; 3]]) {
    let mut around = around::Around::default();
    around.sum(near, &near.velocity);
    let mut viscosity = viscosity::Viscosity::new(Law::Uniform(0.004), METAL);
    viscosity.apply(near, &around, 1.0, change);
    noise::Noise::new(0.0, METAL).damp(near, &mut around, &viscosity, 1.0, change);
}

#[test]
fn viscosity_spares_single_particles() {
    // A wave has L = l, and loses what is taken from its kernel mean: l (1 - l) where it was l.
    let sign = |x: f64| {
        if (x / METAL.spacing) as i32 % 2 == 0 {
            1.0
        } else {
            -1.0
        }
    };
    let mut state = block(
        [12, 12, 12],
        |_| phase::LIQUID,
        |x| [sign(x[0]), sign(x[0]) * sign(x[1]), 0.0],
    );
    state.gather();
    let near = &state.near;
    let mut change = vec![[0.0; 3]; near.len()];
    viscous(near, &mut change);
    let w = |r: f64| near.kernel.value(r * METAL.spacing);
    let [edge, face, room] = [1.0_f64, 2.0, 3.0].map(|square| w(square.sqrt()));
    let number = w(0.0) + 6.0 * edge + 12.0 * face + 8.0 * room;
    // Twice the weight of the neighbours of the other sign.
    let one = 2.0 * (2.0 * edge + 8.0 * face + 8.0 * room) / number;
    let two = 2.0 * (4.0 * edge + 8.0 * face) / number;
    let moment = (6.0 * edge + 24.0 * face + 24.0 * room) * METAL.spacing.powi(2);
    let rate = 6.0 * 0.004 / (METAL.density * moment) * number;
    let inner = |x: &[f64; 3]| x.iter().all(|x| (x / METAL.spacing - 6.0).abs() < 1.6);
    let mut seen = 0;
    for a in (0..near.len()).filter(|a| inner(&near.position[*a])) {
        for (axis, l) in [one, two].into_iter().enumerate() {
            let found = change[a][axis] / near.velocity[a][axis];
            let exact = -rate * l * (1.0 - l);
            assert!((found / exact - 1.0).abs() < 1e-6, "{found} {exact}");
        }
        seen += 1;
    }
    assert_eq!(seen, 64);
}

#[test]
fn shear_between_walls_feels_viscosity_whole() {
    // Beside a wall L is one-sided, and nothing is given back there: a shear that is steady stays so.
    let wall = |k: i32| !(2..10).contains(&k);
    let mut state = block(
        [8, 8, 12],
        |[_, _, k]| {
            if wall(k) { phase::SOLID } else { phase::LIQUID }
        },
        |x| [x[2], 0.0, 0.0],
    );
    state.gather();
    let near = &state.near;
    let mut change = vec![[0.0; 3]; near.len()];
    viscous(near, &mut change);
    let inner = |x: &[f64; 3]| x[..2].iter().all(|x| (x / METAL.spacing - 4.0).abs() < 1.0);
    let column = (0..near.len()).filter(|a| inner(&near.position[*a]));
    let mut beside = 0;
    for a in column.filter(|a| near.role[*a] == Role::Liquid) {
        let layer = (near.position[a][2] / METAL.spacing) as i32;
        if (4..8).contains(&layer) {
            assert!(change[a][0].abs() < 1e-12, "{:?} in {layer}", change[a]);
        } else {
            beside += 1;
        }
    }
    assert_eq!(beside, 16);
}

#[test]
fn same_bytes_on_one_thread_and_on_two() {
    for method in [Method::Projection, Method::Homogenising] {
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            pool.build().unwrap().install(|| {
                let mut state = tank();
                steps(&mut march(method, true, true), &mut state, 20).unwrap();
                let bits = |x: &f64| x.to_bits();
                let all = state
                    .metal
                    .column(&POSITION)
                    .iter()
                    .chain(state.metal.column(&VELOCITY))
                    .flatten();
                all.chain(state.metal.column(&PRESSURE))
                    .chain(state.metal.column(&CARRIED))
                    .map(bits)
                    .collect::<Vec<_>>()
            })
        };
        assert!(run(1) == run(2), "{method:?}");
    }
}

#[test]
fn a_resumed_march_takes_the_same_steps() {
    let mut state = tank();
    let mut first = march(Method::Projection, true, true);
    steps(&mut first, &mut state, 10).unwrap();
    let mut resumed = state.clone();
    let mut second = march(Method::Projection, true, true);
    for (from, to) in first.stages().zip(second.stages_mut()) {
        to.restore(&from.save());
    }
    steps(&mut first, &mut state, 5).unwrap();
    steps(&mut second, &mut resumed, 5).unwrap();
    for column in [&CARRIED, &PRESSURE] {
        assert!(state.metal.column(column) == resumed.metal.column(column));
    }
    assert!(state.metal.column(&POSITION) == resumed.metal.column(&POSITION));
}

#[test]
fn divergence_is_named() {
    for speed in [1e4, f64::NAN] {
        let mut state = tank();
        let wild = state
            .metal
            .column(&PHASE)
            .iter()
            .position(|p| *p == phase::LIQUID)
            .unwrap();
        state.metal.column_mut(&VELOCITY)[wild] = [0.0, 0.0, speed];
        let mut march = march(Method::Projection, true, false);
        let Err(StageError::Diverged {
            step,
            particle,
            quantity,
            ..
        }) = steps(&mut march, &mut state, 1)
        else {
            panic!("a speed of {speed} m/s was taken");
        };
        assert!((step, particle, quantity) == (0, wild, "speed"));
    }
}

#[test]
fn the_fastest_particle_divides_the_step() {
    let mut state = block([5, 5, 5], |_| phase::LIQUID, |_| [0.0, 0.0, 3.0]);
    let mut march = march(Method::Projection, false, false);
    steps(&mut march, &mut state, 1).unwrap();
    let figures = march.figures();
    let substeps = figures
        .iter()
        .find(|(_, f)| f.name == "substeps")
        .unwrap()
        .1;
    assert!((substeps.value - 2.0).abs() < 1e-12);
    let limit = march.limit(&state).unwrap();
    assert!(limit.name == "courant" && (limit.seconds - 0.4 * 0.5e-3 / 3.0).abs() < 1e-9);
}

#[test]
fn what_has_frozen_too_densely_does_not_burst() {
    // Liquid beside a wall that is twice as dense as it should be, and liquid that is so itself.
    let mut state = tank();
    let places = state.metal.column(&POSITION).to_vec();
    for (a, place) in places.into_iter().enumerate() {
        let phase = state.metal.column(&PHASE)[a];
        if phase == phase::SOLID || (phase == phase::LIQUID && a % 9 == 0) {
            state.push(Particle {
                position: place.map(|x| x + 0.3 * METAL.spacing),
                velocity: [0.0; 3],
                phase,
                droplet: false,
                wall: phase == phase::SOLID,
                temperature: 0.0,
                enthalpy: 0.0,
            });
        }
    }
    let mut march = march(Method::Projection, true, false);
    for _ in 0..50 {
        steps(&mut march, &mut state, 1).unwrap();
        let speeds = state
            .metal
            .column(&VELOCITY)
            .iter()
            .map(|u| u.iter().map(|u| u * u).sum());
        let fastest = speeds.fold(0.0, f64::max).sqrt();
        // No particle crosses more of its diameter than one step may.
        assert!(fastest < 0.4 * METAL.spacing / 1e-4, "{fastest} m/s");
    }
}

/// Layers of the gap of a Couette flow.
const GAP: i32 = 24;

/// A viscosity over the temperature, which here is the layer, one node on either side of each.
fn layers(mu: impl Fn(i32) -> f64) -> Law {
    let nodes: Vec<f64> = (0..GAP)
        .flat_map(|k| [-0.25, 0.25].map(|part| f64::from(k) + part))
        .collect();
    let values = (0..GAP).flat_map(|k| [mu(k); 2]).collect();
    let mu = props::Table::new(nodes, values).unwrap();
    let range = (-1.0, f64::from(GAP));
    Law::OfTemperature { mu, range }
}

/// Velocity across the gap, by layer, where the stress in liquid of the viscosity `mu` by layer has become steady; the two
/// layers at either end keep `exact`.
fn sheared(mu: impl Fn(i32) -> f64, exact: impl Fn(i32) -> f64) -> Vec<f64> {
    let mut state = block([6, 6, GAP], |_| phase::LIQUID, |_| [0.0; 3]);
    let layer = |x: [f64; 3]| (x[2] / METAL.spacing - 0.5).round() as i32;
    let layers_of = state.metal.column(&POSITION).iter();
    let kelvin = layers_of.map(|x| f64::from(layer(*x))).collect();
    state.metal.declare(&TEMPERATURE);
    state.metal.put(&TEMPERATURE, kelvin);
    state.gather();
    let near = &mut state.near;
    let mut viscosity = viscosity::Viscosity::new(layers(mu), METAL);
    viscosity
        .take(near, state.metal.column(&TEMPERATURE))
        .unwrap();
    let around = around::Around::default();
    let layers: Vec<i32> = near.position.iter().map(|x| layer(*x)).collect();
    let hold = |u: &mut [[f64; 3]]| {
        for (u, &k) in u.iter_mut().zip(&layers) {
            if !(2..GAP - 2).contains(&k) {
                u[0] = exact(k);
            }
        }
    };
    hold(&mut near.velocity);
    for _ in 0..6000 {
        let mut predicted = near.velocity.clone();
        viscosity.apply(near, &around, viscosity.limit(), &mut predicted);
        hold(&mut predicted);
        near.velocity = predicted;
    }
    let mut mean = vec![0.0; GAP as usize];
    for (u, k) in near.velocity.iter().zip(layers) {
        mean[k as usize] += u[0] / 36.0;
    }
    mean
}

#[test]
fn one_stress_crosses_a_gap_whose_viscosity_varies() {
    // mu u' is constant: with mu linear across the gap u goes with its logarithm.
    let mu = |k: i32| 0.002 * (1.0 + 4.0 * f64::from(k) / f64::from(GAP - 1));
    let smooth = |k: i32| (mu(k) / 0.002).ln() / 5.0_f64.ln();
    // Two layers, the thin one below: the slopes are as the inverses.
    let two = |k: i32| if k < GAP / 2 { 0.002 } else { 0.02 };
    let bent = |k: i32| {
        let z = f64::from(k) - f64::from(GAP - 1) / 2.0;
        if z < 0.0 { 10.0 * z / 132.0 } else { z / 132.0 }
    };
    let off = |found: Vec<f64>, exact: &dyn Fn(i32) -> f64| {
        let each = found.iter().zip(0..).map(|(u, k)| (u - exact(k)).abs());
        each.fold(0.0, f64::max)
    };
    let found = off(sheared(mu, smooth), &smooth);
    assert!(found < 1e-3, "{found}");
    let found = off(sheared(two, bent), &bent);
    assert!(found < 1e-3, "{found}");
}
