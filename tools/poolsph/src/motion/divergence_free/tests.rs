//! Exact cases of the operators and of a step.

use particles::POSITION;
use shapes::frame::{along, dot};

use super::*;
use crate::march::{Group, March};
use crate::motion::integration::PRESSURE;
use crate::motion::tests::{METAL, block, march, steps, tank};
use crate::motion::{Law, Method, Motion, Parameters};
use crate::stage::Stage;
use crate::state::{PHASE, State, VELOCITY, phase};

/// A shaken block: places are moved by up to a tenth of a spacing.
fn shaken(cells: [i32; 3], phase: impl Fn([i32; 3]) -> u8) -> State {
    shaken_by(0.1, cells, phase)
}

/// Places are moved by up to a part of a spacing along each axis.
fn shaken_by(part: f64, cells: [i32; 3], phase: impl Fn([i32; 3]) -> u8) -> State {
    let mut state = block(cells, phase, |_| [0.0; 3]);
    let mut seed = 11_u64;
    for x in state.metal.column_mut(&POSITION).iter_mut().flatten() {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        *x += METAL.spacing * 2.0 * part * ((seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5);
    }
    state.gather();
    state
}

fn inner(near: &Near, a: usize, cells: f64) -> bool {
    let within = |x: &f64| (2.6..cells - 2.6).contains(&(x / METAL.spacing));
    near.position[a].iter().all(within)
}

#[test]
fn slopes_are_exact_in_a_cloud_in_disorder() {
    let state = shaken([10; 3], |_| phase::LIQUID);
    let near = &state.near;
    let turn = [[1.0, 2.0, -3.0], [0.5, -4.0, 2.0], [7.0, 1.0, 3.5]];
    let u: Vec<[f64; 3]> = near
        .position
        .iter()
        .map(|x| turn.map(|line| dot(line, *x)))
        .collect();
    let mut solver = DivergenceFree::new(METAL);
    solver.islands.find(near);
    solver.look(near);
    solver.sum(near, &u);
    let asked = [3e5, -2e5, 1e5];
    solver.total = near.position.iter().map(|x| 4e3 + dot(asked, *x)).collect();
    solver.weight.settle(near, &solver.islands, &solver.rows);
    solver.differ(near);
    let mut seen = 0;
    for a in (0..near.len()).filter(|a| inner(near, *a, 10.0)) {
        assert!(
            (solver.rows[a].divergence - 0.5).abs() < 1e-5,
            "{:?}",
            solver.rows[a]
        );
        for (found, asked) in solver.slope[a].iter().zip(asked) {
            assert!((found - asked).abs() < 1e-6 * 3e5, "{:?}", solver.slope[a]);
        }
        seen += 1;
    }
    assert!(seen > 50, "{seen}");
}

#[test]
fn pressure_below_a_plane_surface_is_exact_on_the_lattice() {
    let state = {
        let mut state = block([10; 3], |_| phase::LIQUID, |_| [0.0; 3]);
        state.gather();
        state
    };
    let near = &state.near;
    let still = vec![[0.0; 3]; near.len()];
    let mut solver = DivergenceFree::new(METAL);
    solver.islands.find(near);
    solver.look(near);
    solver.sum(near, &still);
    let top = 10.0 * METAL.spacing;
    solver.total = near.position.iter().map(|x| 8e4 * (top - x[2])).collect();
    solver.weight.settle(near, &solver.islands, &solver.rows);
    solver.differ(near);
    for a in 0..near.len() {
        let [x, y, z] = near.position[a].map(|x| x / METAL.spacing);
        if [x, y].iter().all(|x| (2.6..7.4).contains(x)) && z > 2.6 {
            let [p, q, r] = solver.slope[a];
            assert!(
                p.abs() + q.abs() < 1.0 && (r + 8e4).abs() < 1.0,
                "{:?} at {z}",
                solver.slope[a]
            );
        }
    }
}

#[test]
fn liquid_at_rest_carries_its_weight_and_stays() {
    let mut state = tank();
    let mut march = march(Method::DivergenceFree, true, false);
    // Beside the walls the surface finds its height first.
    steps(&mut march, &mut state, 400).unwrap();
    let top = 10.0 * METAL.spacing;
    let (mut energy, mut count) = (0.0, 0.0);
    let bottom = METAL.density * 9.8 * 8.0 * METAL.spacing;
    for a in (0..state.len()).filter(|a| state.metal.column(&PHASE)[*a] == phase::LIQUID) {
        let asked = METAL.density * 9.8 * (top - state.metal.column(&POSITION)[a][2]);
        let error = (state.metal.column(&PRESSURE)[a] - asked).abs() / bottom;
        assert!(
            error < 0.01,
            "{error} at {:?}",
            state.metal.column(&POSITION)[a]
        );
        energy += squared(state.metal.column(&VELOCITY)[a]);
        count += 1.0;
    }
    let speed = f64::sqrt(energy / count / (9.8 * 8.0 * METAL.spacing));
    assert!(speed < 1e-3, "{speed}");
}

#[test]
fn a_body_that_touches_nothing_keeps_its_momentum() {
    let mut state = shaken([7; 3], |_| phase::LIQUID);
    for (k, u) in state.metal.column_mut(&VELOCITY).iter_mut().enumerate() {
        *u = [0, 1, 2].map(|i| 0.3 * ((k * (7 + 5 * i)) as f64).sin());
    }
    state.gather();
    let momentum = |state: &State| {
        state
            .metal
            .column(&VELOCITY)
            .iter()
            .fold([0.0; 3], |sum, u| along(sum, 1.0, *u))
    };
    let before = momentum(&state);
    let size: f64 = state
        .metal
        .column(&VELOCITY)
        .iter()
        .map(|u| squared(*u).sqrt())
        .sum();
    let text = r#"{"viscosity_pa_s": 0.004, "method": "divergence_free"}"#;
    let parameters: Parameters = serde_json::from_str(text).unwrap();
    let mut motion = Motion::new(parameters, crate::motion::Law::Uniform(0.004), METAL);
    motion.advance(&mut state, 1e-4).unwrap();
    let change = difference(momentum(&state), before);
    assert!(
        squared(change).sqrt() < 1e-12 * size,
        "{change:?} of {size}"
    );
    let after: f64 = state
        .metal
        .column(&VELOCITY)
        .iter()
        .map(|u| squared(*u).sqrt())
        .sum();
    assert!(after < 0.98 * size, "nothing happened: {after} of {size}");
}

/// Presses on all of the surface alike.
struct Gas(f64);

impl Stage for Gas {
    fn name(&self) -> &'static str {
        "gas"
    }

    fn advance(&mut self, state: &mut State, _: f64) -> Result<(), crate::stage::StageError> {
        state.near.outer.clear();
        state.near.outer.resize(state.near.len(), self.0);
        Ok(())
    }
}

#[test]
fn a_pressure_upon_the_whole_surface_moves_nothing() {
    let after = |pressure: f64| {
        let mut state = shaken([10, 10, 8], |[i, j, k]| {
            let wall = k < 2 || [i, j].iter().any(|i| !(2..8).contains(i));
            if wall { phase::SOLID } else { phase::LIQUID }
        });
        let text = r#"{"viscosity_pa_s": 0.004, "gravity_m_s2": [0, 0, -9.8], "method": "divergence_free"}"#;
        let parameters: Parameters = serde_json::from_str(text).unwrap();
        let law = crate::motion::Law::Uniform(0.004);
        let motion = Motion::new(parameters, law, METAL);
        let after: Vec<Box<dyn Stage>> = vec![Box::new(Gas(pressure)), Box::new(motion)];
        let metal = Group::new("metal").gathering().of(after);
        let mut march = March::new(vec![metal], 1e-4);
        steps(&mut march, &mut state, 20).unwrap();
        state
    };
    let (without, with) = (after(0.0), after(2e4));
    let [still, fast] = [&without, &with].map(|state| state.metal.column(&VELOCITY));
    let [less, more] = [&without, &with].map(|state| state.metal.column(&PRESSURE));
    let fastest = still.iter().map(|u| squared(*u)).fold(0.0, f64::max).sqrt();
    assert!(fastest > 1e-3, "{fastest}");
    for a in 0..without.len() {
        let change = squared(difference(fast[a], still[a])).sqrt();
        assert!(change < 1e-6 * fastest, "{change} of {fastest}");
        if without.metal.column(&PHASE)[a] == phase::LIQUID {
            let more = more[a] - less[a];
            assert!((more / 2e4 - 1.0).abs() < 1e-6, "{more}");
        }
    }
}

#[test]
fn a_weight_that_walls_bear_moves_nothing_in_a_closed_box() {
    let after = |gravity: f64| {
        let mut state = shaken([9; 3], |cell| {
            let wall = cell.iter().any(|i| !(2..7).contains(i));
            if wall { phase::SOLID } else { phase::LIQUID }
        });
        for (k, u) in state.metal.column_mut(&VELOCITY).iter_mut().enumerate() {
            *u = [0, 1, 2].map(|i| 0.1 * ((k * (7 + 5 * i)) as f64).sin());
        }
        state.gather();
        let text = format!(
            r#"{{"viscosity_pa_s": 0.004, "gravity_m_s2": [0, {gravity}, {gravity}], "method": "divergence_free"}}"#
        );
        let parameters: Parameters = serde_json::from_str(&text).unwrap();
        let law = crate::motion::Law::Uniform(0.004);
        let motion = Motion::new(parameters, law, METAL);
        let metal = Group::new("metal").gathering().of(vec![Box::new(motion)]);
        let mut march = March::new(vec![metal], 1e-4);
        steps(&mut march, &mut state, 20).unwrap();
        state
    };
    let (without, with) = (after(0.0), after(-980.0));
    let [still, fast] = [&without, &with].map(|state| state.metal.column(&VELOCITY));
    let [here, there] = [&without, &with].map(|state| state.metal.column(&POSITION));
    let phases = without.metal.column(&PHASE);
    for a in (0..without.len()).filter(|a| phases[*a] == phase::LIQUID) {
        let change = squared(difference(fast[a], still[a])).sqrt();
        assert!(change < 1e-8, "{change} m/s");
        let [_, y, z] = difference(there[a], there[0]);
        let [_, v, w] = difference(here[a], here[0]);
        assert!((y - v).abs() + (z - w).abs() < 1e-12);
    }
    let deepest = with
        .metal
        .column(&PRESSURE)
        .iter()
        .copied()
        .fold(0.0, f64::max);
    assert!(
        deepest > 2.0 * METAL.density * 980.0 * METAL.spacing,
        "{deepest}"
    );
}

#[test]
fn a_box_without_a_surface_has_none_however_its_particles_lie() {
    let state = shaken_by(0.2, [14; 3], |cell| {
        let wall = cell.iter().any(|i| !(2..12).contains(i));
        if wall { phase::SOLID } else { phase::LIQUID }
    });
    let near = &state.near;
    let mut solver = DivergenceFree::new(METAL);
    solver.begin(
        near,
        &Viscosity::new(crate::motion::Law::Uniform(0.004), METAL),
    );
    solver.look(near);
    solver.sum(near, &near.velocity.clone());
    let (own, filled) = (near.kernel.value(0.0), solver.filled.number);
    let lack = |a: usize| 1.0 - (near.number[a] - own) / (filled - own);
    let most = (0..near.len())
        .filter(|a| near.role[*a] == Role::Liquid)
        .fold(0.0, |most: f64, a| most.max(lack(a)));
    assert!(most > 0.1, "{most} is no disorder");
    let open = solver.rows.iter().filter(|row| row.missing > 0.0).count();
    assert_eq!(open, 0);
}

#[test]
fn a_plane_surface_is_one_and_its_particles_are_shifted_along_it() {
    let mut state = tank();
    let top = |state: &State| {
        let near = &state.near;
        let middle = [0, 1].map(|_| 4.5 * METAL.spacing);
        let from = |a: &usize| {
            let [x, y, z] = near.position[*a];
            (x - middle[0]).abs() + (y - middle[1]).abs() + (9.5 * METAL.spacing - z).abs()
        };
        let liquid = (0..near.len()).filter(|a| near.role[*a] == Role::Liquid);
        liquid.min_by(|a, b| from(a).total_cmp(&from(b))).unwrap()
    };
    state.gather();
    let id = state.near.id[top(&state)] as usize;
    state.metal.column_mut(&POSITION)[id][0] += 0.2 * METAL.spacing;
    state.metal.column_mut(&VELOCITY)[id] = [0.1, 0.0, 0.0];
    state.gather();
    let a = top(&state);
    let near = &mut state.near;
    assert_eq!(near.id[a] as usize, id);
    let mut solver = DivergenceFree::new(METAL);
    solver.begin(
        near,
        &Viscosity::new(crate::motion::Law::Uniform(0.004), METAL),
    );
    solver.look(near);
    solver.sum(near, &near.velocity.clone());
    assert!(solver.rows[a].missing > 0.2 * solver.filled.weight);
    let (before, velocity) = (near.position[a], near.velocity[a]);
    solver.even(near, 1e-4);
    assert!(squared(difference(near.velocity[a], velocity)) <= 0.0);
    let [x, y, z] = difference(near.position[a], before).map(|x| x / METAL.spacing);
    assert!(x < -1e-4, "{x}");
    assert!(y.abs() < 1e-9 && z.abs() < 1e-3 * x.abs(), "{y} {z}");
}

#[test]
fn a_cloud_in_disorder_does_not_burst_by_its_own_pressure() {
    let mut state = shaken_by(0.25, [8; 3], |_| phase::LIQUID);
    for (k, u) in state.metal.column_mut(&VELOCITY).iter_mut().enumerate() {
        *u = [0, 1, 2].map(|i| 0.5 * ((k * (7 + 5 * i)) as f64).sin());
    }
    state.gather();
    let near = &mut state.near;
    let fastest = |u: &[[f64; 3]]| u.iter().map(|u| squared(*u)).fold(0.0, f64::max).sqrt();
    let viscosity = Viscosity::new(Law::Uniform(0.004), METAL);
    let step = Step {
        metal: METAL,
        dt: 1e-4,
        share: 1.0,
    };
    let tolerance = Tolerance {
        density: 1e-7,
        sweeps_min: 2,
        sweeps_max: 500,
    };
    let mut solver = DivergenceFree::new(METAL);
    let mut u = near.velocity.clone();
    let first = fastest(&u);
    // The particles stay where they are: only what a step does to the velocity is repeated.
    for _ in 0..60 {
        solver.begin(near, &viscosity);
        solver.solve(near, &mut u, [0.0; 3], step, tolerance);
        near.velocity.copy_from_slice(&u);
    }
    let last = fastest(&u);
    assert!(last < 3.0 * first, "{last} of {first}");
}

#[test]
fn a_column_that_collapses_is_nowhere_faster_than_the_front_of_a_dam_break() {
    let (wide, high) = (8, 12);
    let mut state = block(
        [32, 32, 2 + high],
        |[i, j, k]| {
            let inside = [i, j].iter().all(|i| (12..12 + wide).contains(i));
            match k {
                0..2 => phase::SOLID,
                _ if inside => phase::LIQUID,
                _ => phase::FLYING,
            }
        },
        |_| [0.0; 3],
    );
    // 2 sqrt(g h) on a smooth floor without friction (Ritter 1892).
    let front = 2.0 * (9.8 * f64::from(high) * METAL.spacing).sqrt();
    let mut march = march(Method::DivergenceFree, true, false);
    let mut fastest = 0.0_f64;
    for _ in 0..400 {
        steps(&mut march, &mut state, 1).unwrap();
        fastest = fastest.max(state.near.fastest_squared().sqrt());
    }
    assert!(
        fastest > 0.35 * front && fastest < front,
        "{fastest} of {front}"
    );
}
