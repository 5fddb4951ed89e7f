//! Exact cases of what a free surface does: tension, viscosity at the surface, and damping of single particles.

use particles::POSITION;
use shapes::frame::{along, cross, dot};

use super::*;
use crate::forces::capillary::Capillary;
use crate::forces::tension;
use crate::march::{Group, March};
use crate::motion::integration::PRESSURE;
use crate::motion::tests::{METAL, block, steps};
use crate::motion::viscosity::Viscosity;
use crate::motion::{Law, Motion, Parameters};
use crate::stage::Stage;
use crate::state::{PHASE, State, VELOCITY, phase};

/// Viscosity \[Pa s\].
const MU: f64 = 0.004;

/// A ball of the lattice with a radius of `cells` about the origin.
fn ball(cells: i32, velocity: impl Fn([f64; 3]) -> [f64; 3]) -> State {
    let half = f64::from(cells) * METAL.spacing;
    let inner = |[i, j, k]: [i32; 3]| {
        let square = [i, j, k]
            .map(|i| (2 * (i - cells) + 1).pow(2))
            .iter()
            .sum::<i32>();
        square < 4 * cells * cells
    };
    let phase = |cell| {
        if inner(cell) {
            phase::LIQUID
        } else {
            phase::FLYING
        }
    };
    let mut state = block([2 * cells; 3], phase, |x| velocity(x.map(|x| x - half)));
    for x in state.metal.column_mut(&POSITION).iter_mut().flatten() {
        *x -= half;
    }
    state.gather();
    state
}

/// Sum over the particles of a vector each.
fn sum(near: &Near, of: impl Fn(usize) -> [f64; 3]) -> [f64; 3] {
    (0..near.len()).fold([0.0; 3], |sum, a| along(sum, 1.0, of(a)))
}

/// What viscosity makes of the velocities within a second, with what it does at the surface.
fn viscous(near: &Near, surface: bool) -> Vec<[f64; 3]> {
    let mut change = vec![[0.0; 3]; near.len()];
    let mut viscosity = Viscosity::new(Law::Uniform(MU), METAL);
    viscosity.apply_between_faces(near, 1.0, &mut change);
    if surface {
        let mut solver = DivergenceFree::new(METAL);
        solver.begin(near, &viscosity);
        solver.slacken(near, &viscosity, 1.0, &mut change);
    }
    change
}

#[test]
fn a_ball_that_turns_as_a_whole_is_not_slowed() {
    let spin = [3.0, -2.0, 5.0];
    let state = ball(8, |x| cross(spin, x));
    let near = &state.near;
    let slowed = |surface: bool| {
        let change = viscous(near, surface);
        dot(sum(near, |a| cross(near.position[a], change[a])), spin)
    };
    let (bare, whole) = (slowed(false), slowed(true));
    assert!(
        bare < 0.0 && whole.abs() < 0.1 * bare.abs(),
        "{whole} of {bare}"
    );
}

#[test]
fn a_ball_that_stretches_loses_what_its_shear_makes_heat_of() {
    // u = A x: 2 mu A:A in each volume, but for pairs that the surface lacks.
    let rate = [-1.0, -2.0, 3.0];
    let lost = |cells: i32, surface: bool| {
        let state = ball(cells, |x| [0, 1, 2].map(|i| rate[i] * x[i]));
        let near = &state.near;
        let exact = 2.0 * MU / METAL.density * dot(rate, rate) * near.len() as f64;
        let change = viscous(near, surface);
        let work = (0..near.len()).map(|a| dot(near.velocity[a], change[a]));
        -work.sum::<f64>() / exact
    };
    let [coarse, fine] = [6, 18].map(|cells| lost(cells, true) - 1.0);
    assert!(
        coarse.abs() < 0.25 && fine.abs() < 0.6 * coarse.abs(),
        "{coarse} {fine}"
    );
    assert!(lost(18, false) < 0.5);
}

#[test]
fn ripples_fall_and_linear_flow_stays() {
    let turn = [[1.0, 2.0, -3.0], [0.5, -4.0, 2.0], [7.0, 1.0, 3.0]];
    let mut state = ball(5, |x| turn.map(|line| dot(line, x)));
    let mut seed = 5_u64;
    let noise: Vec<[f64; 3]> = (0..state.near.len())
        .map(|_| {
            [0; 3].map(|_| {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
            })
        })
        .collect();
    let near = &mut state.near;
    let still = vec![[0.0; 3]; near.len()];
    let mut solver = DivergenceFree::new(METAL);
    solver.look(near);
    solver.sum(near, &still);
    let damped = |near: &Near| {
        let mut out = near.velocity.clone();
        let surface = |a: usize| solver.rows[a].missing > 0.0;
        Ripples::default().damp(near, surface, &Interface::default(), 0.2, &mut out);
        out
    };
    let linear = damped(near);
    for (after, before) in linear.iter().zip(&near.velocity) {
        assert!(
            squared(difference(*after, *before)).sqrt() < 1e-12,
            "{after:?}"
        );
    }
    near.velocity = noise;
    let after = damped(near);
    let near = &*near;
    let energy = |u: &[[f64; 3]]| u.iter().map(|u| squared(*u)).sum::<f64>();
    let (first, last) = (energy(&near.velocity), energy(&after));
    assert!(last < 0.95 * first, "{last} of {first}");
    let change = |a: usize| difference(after[a], near.velocity[a]);
    let size = near.len() as f64;
    let moved = sum(near, change).map(|x| x / size);
    let turned = sum(near, |a| cross(near.position[a], change(a)));
    let turned = turned.map(|x| x / size / METAL.spacing);
    for x in moved.into_iter().chain(turned) {
        assert!(x.abs() < 1e-13, "{moved:?} {turned:?}");
    }
}

/// A march with a tension of `gamma` and steps of `dt`.
fn march(gamma: f64, dt: f64) -> March {
    march_of(gamma, 0.06, dt)
}

fn march_of(gamma: f64, mu: f64, dt: f64) -> March {
    let text = format!(r#"{{"viscosity_pa_s": {mu}, "method": "divergence_free"}}"#);
    let parameters: Parameters = serde_json::from_str(&text).unwrap();
    let motion = Motion::new(parameters, Law::Uniform(mu), METAL);
    let tension = Capillary::new(tension::Parameters {
        surface_tension_n_m: gamma,
    });
    let after: Vec<Box<dyn Stage>> = vec![Box::new(tension), Box::new(motion)];
    March::new(vec![Group::new("metal").gathering().of(after)], dt)
}

#[test]
fn a_drop_at_rest_stays_under_its_pressure() {
    let bits = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let mut state = ball(6, |_| [0.0; 3]);
            steps(&mut march(1.0, 1e-4), &mut state, 300).unwrap();
            state
        })
    };
    let state = bits(1);
    assert!(
        state.metal.column(&POSITION) == bits(2).metal.column(&POSITION),
        "on two threads"
    );
    let liquid: Vec<usize> = (0..state.len())
        .filter(|a| state.metal.column(&PHASE)[*a] == phase::LIQUID)
        .collect();
    let count = liquid.len() as f64;
    let radius = METAL.spacing * (0.75 * count / std::f64::consts::PI).cbrt();
    let inside = liquid
        .iter()
        .filter(|a| squared(state.metal.column(&POSITION)[**a]) < 0.25 * radius * radius);
    let (sum, inner) = inside.fold((0.0, 0.0), |(sum, n), a| {
        (sum + state.metal.column(&PRESSURE)[*a], n + 1.0)
    });
    let pressure = sum / inner * radius / 2.0;
    let energy: f64 = liquid
        .iter()
        .map(|a| squared(state.metal.column(&VELOCITY)[*a]))
        .sum();
    // Over gamma/mu: the capillary number.
    let capillary = f64::sqrt(energy / count) * 0.06;
    assert!((pressure - 1.0).abs() < 0.02, "{pressure}");
    assert!(capillary < 2e-4, "{capillary}");
    // Momentum within what tension would give in that time if it pulled to one side, gamma R t.
    let momentum = liquid.iter().fold([0.0; 3], |sum, a| {
        along(sum, METAL.mass(), state.metal.column(&VELOCITY)[*a])
    });
    let given = radius * state.time;
    assert!(
        squared(momentum).sqrt() < 1e-10 * given,
        "{momentum:?} of {given}"
    );
}

#[test]
fn waves_of_the_surface_divide_the_step() {
    let mut state = ball(3, |_| [0.0; 3]);
    let limit = (METAL.mass() / (2.0 * std::f64::consts::PI)).sqrt();
    let mut march = march(1.0, 2.5 * limit);
    let told = march.limit(&state).unwrap();
    assert!((told.seconds / limit - 1.0).abs() < 1e-12 && told.name == "capillary");
    steps(&mut march, &mut state, 1).unwrap();
    let figures = march.figures();
    let substeps = figures.iter().find(|(_, f)| f.name == "substeps").unwrap();
    // Particles that have begun to close in on one another ask for more than the waves do.
    assert!(substeps.1.value >= 3.0, "{}", substeps.1.value);
}

#[test]
fn what_strikes_within_a_step_divides_the_rest_of_it() {
    // Two cubes, five spacings apart, of which each goes 1.98 in the step: five parts by the fastest, and they see each other in the last.
    let substeps = |upper: f64| {
        let of = |[_, _, k]: [i32; 3]| match k {
            4..8 => phase::FLYING,
            _ => phase::LIQUID,
        };
        let velocity = |[_, _, z]: [f64; 3]| {
            let lower = z < 6.0 * METAL.spacing;
            [0.0, 0.0, if lower { 9.9 } else { upper }]
        };
        let mut state = block([4, 4, 12], of, velocity);
        let mut march = march_of(1.0, 0.0, 1e-4);
        steps(&mut march, &mut state, 1).unwrap();
        let figures = march.figures();
        let (_, told) = figures.iter().find(|(_, f)| f.name == "substeps").unwrap();
        told.value
    };
    assert!((substeps(9.9) - 5.0).abs() < 1e-12, "{}", substeps(9.9));
    assert!(substeps(-9.9) > 6.0, "{}", substeps(-9.9));
}

#[test]
fn a_drop_without_viscosity_needs_no_normals() {
    let mut state = ball(4, |_| [0.0; 3]);
    steps(&mut march_of(1.0, 0.0, 1e-4), &mut state, 3).unwrap();
    assert!(
        state
            .metal
            .column(&VELOCITY)
            .iter()
            .any(|u| squared(*u) > 0.0)
    );
}

#[test]
fn a_drop_that_swings_loses_no_more_than_viscosity_takes() {
    let (oh, cells) = (0.02, 7);
    let mode = |[x, y, z]: [f64; 3]| [-x, -y, 2.0 * z];
    let number = ball(cells, |_| [0.0; 3]).near.len() as f64;
    let radius = METAL.spacing * (0.75 * number / std::f64::consts::PI).cbrt();
    let time = (METAL.density * radius.powi(3)).sqrt();
    let mu = oh * (METAL.density * radius).sqrt();
    let frequency = 8.0_f64.sqrt() / time;
    let period = std::f64::consts::TAU / frequency;
    // From the sphere, by the flow of the second mode, to a tenth of its radius.
    let mut state = ball(cells, |x| mode(x).map(|u| 0.05 * frequency * u));
    let swing = |state: &State| {
        let moves = state.metal.column(&POSITION).iter();
        let moves = moves.zip(state.metal.column(&VELOCITY));
        let liquid = moves.zip(state.metal.column(&PHASE));
        let liquid = liquid.filter(|(_, p)| **p == phase::LIQUID);
        liquid.map(|((x, u), _)| dot(mode(*x), *u)).sum::<f64>()
    };
    let first = swing(&state);
    let mut march = march_of(1.0, mu, period / 300.0);
    steps(&mut march, &mut state, 300).unwrap();
    // 5 nu/R^2 (Lamb 1932, section 355).
    let exact = 5.0 * mu / METAL.density / radius.powi(2) * period;
    let decay = -(swing(&state) / first).ln() / exact;
    assert!((0.6..1.5).contains(&decay), "{decay} times Lamb's");
}
