use super::explicit::Explicit;
use super::implicit::Implicit;
use super::stabilised::Stabilised;
use super::*;
use crate::assemble;
use crate::scene::Scene;

/// A bar from 0 to 1 with k = c = 1, held at 0 and T1 at its ends.
fn bar(spacing: f64, k: &str, ends: [&str; 2], initial: &str) -> System {
    let text = format!(
        r#"{{"dimensions": 2, "body": {{"box": {{"min_m": [0, 0], "max_m": [1, {}]}}}},
            "points": {{"spacing_m": {spacing}}}, "initial_temperature_k": {{"expr": "{initial}"}},
            "materials": [{{"name": "m", "density_kg_m3": 1, "specific_heat_j_kg_k": 1,
              "conductivity_w_m_k": {{"expr": "{k}"}}}}],
            "boundaries": [{{"on": ["x-"], {}}}, {{"on": ["x+"], {}}}],
            "time": {{"end_s": 1}}}}"#,
        4.0 * spacing,
        ends[0],
        ends[1]
    );
    let scene: Scene = serde_json::from_str(&text).unwrap();
    assemble::system(&scene).unwrap().0
}

fn start(system: &System, initial: impl Fn(f64) -> f64) -> (State, Rates) {
    let temperature = (0..system.len())
        .map(|i| initial(system.place(i)[0]))
        .collect();
    let mut state = State::new(system, temperature);
    system.hold(&mut state.temperature, 0.0).unwrap();
    let mut rates = Rates::default();
    system.rates(0.0, &state.temperature, &mut rates).unwrap();
    (state, rates)
}

const COLD: &str = r#""temperature_k": 0"#;

/// Greatest error of the decaying sine at t = 0.1, in `steps` steps.
fn decay(method: &mut dyn Method, system: &System, steps: usize) -> (f64, f64) {
    let sine = |x: f64| (std::f64::consts::PI * x).sin();
    let (mut state, mut rates) = start(system, sine);
    let before = system.stored(&state.temperature);
    for _ in 0..steps {
        method
            .advance(system, &mut state, &mut rates, 0.1 / steps as f64)
            .unwrap();
    }
    let heat: f64 = state.entries.iter().sum();
    let stored = system.stored(&state.temperature) - before;
    // The eigenvalue of the lattice, so that only the error in time is left.
    let s = 0.05;
    let rate = 4.0 / (s * s) * (0.5 * std::f64::consts::PI * s).sin().powi(2);
    let exact = |i: usize| (-rate * 0.1).exp() * sine(system.place(i)[0]);
    let error = (0..system.len()).map(|i| (state.temperature[i] - exact(i)).abs());
    (error.fold(0.0, f64::max), ((stored - heat) / stored).abs())
}

#[test]
fn methods_have_their_order_and_lose_no_heat() {
    let system = bar(0.05, "1", [COLD, COLD], "sin(pi*x)");
    let errors = |make: &dyn Fn() -> Box<dyn Method>, steps: [usize; 2]| {
        steps.map(|n| {
            let (error, imbalance) = decay(make().as_mut(), &system, n);
            assert!(imbalance < 1e-10, "{n} steps lose {imbalance:e}");
            error
        })
    };
    let [a, b] = errors(&|| Box::new(Explicit::default()), [100, 200]);
    assert!((a / b).log2() > 0.9, "explicit: {a} {b}");
    let [a, b] = errors(&|| Box::new(Stabilised::default()), [8, 16]);
    assert!((a / b).log2() > 1.8, "stabilised: {a} {b}");
    let [a, b] = errors(&|| Box::new(Implicit::new(&system, 1e-12, false)), [8, 16]);
    assert!((a / b).log2() > 1.8, "implicit: {a} {b}");
}

#[test]
fn a_steep_law_is_exact_when_steady() {
    for a in [1.0_f64, 4.0, 8.0, -3.0] {
        let hot = r#""temperature_k": 1"#;
        let system = bar(0.05, &format!("exp({a}*T)"), [COLD, hot], "0");
        let (mut state, mut rates) = start(&system, |_| 0.0);
        let mut solver = crate::solve::Solver::new(&system);
        let from = state.temperature.clone();
        let problem = crate::solve::Problem {
            shift: 0.0,
            from: &from,
            time: 0.0,
        };
        let goal = crate::solve::Goal {
            residual: 1e-11,
            steps: 60,
        };
        let effort = solver
            .newton(&system, problem, &mut state.temperature, &mut rates, goal)
            .unwrap();
        for i in 0..system.len() {
            let exact = ((a.exp() - 1.0) * system.place(i)[0]).ln_1p() / a;
            let error = (state.temperature[i] - exact).abs();
            assert!(error < 1e-7, "a = {a}: {error:e}, {effort:?}");
        }
    }
}

#[test]
fn long_implicit_steps_stay_between_the_ends() {
    let hot = r#""temperature_k": 1"#;
    for k in ["1", "exp(8*T)", "1e6"] {
        let system = bar(0.05, k, [COLD, hot], "0");
        for factor in [1.0, 10.0, 1000.0] {
            let (mut state, mut rates) = start(&system, |_| 0.0);
            let step = factor * system.explicit_limit(&rates);
            let mut method = Implicit::new(&system, 1e-10, true);
            for _ in 0..10 {
                method
                    .advance(&system, &mut state, &mut rates, step)
                    .unwrap();
                let (low, high) = crate::system::extent(&state.temperature);
                assert!(
                    low > -1e-8 && high < 1.0 + 1e-8,
                    "{k} {factor}: {low} {high}"
                );
            }
        }
    }
}

#[test]
fn a_method_taken_up_anew_takes_the_same_step() {
    let system = bar(0.05, "exp(2*T)", [COLD, r#""temperature_k": 1"#], "0");
    let (mut state, mut rates) = start(&system, |_| 0.0);
    let mut method = Implicit::new(&system, 1e-8, false);
    // Until nothing changes: a step then has nothing to solve.
    for step in [0.01, 0.1, 1.0, 10.0, 1e3, 1e3, 1e3] {
        let (mut twin, mut its) = (state.clone(), rates.clone());
        let error = method.advance(&system, &mut state, &mut rates, step);
        let again = Implicit::new(&system, 1e-8, false).advance(&system, &mut twin, &mut its, step);
        assert_eq!(error.unwrap().to_bits(), again.unwrap().to_bits(), "{step}");
        assert_eq!(state, twin);
    }
}

/// A front into a bar of exactly 0 K, `cells` across, until it is a good way in.
fn front(a: f64, cells: f64, method: &str) {
    let spacing = 1.0 / cells;
    let hot = r#""temperature_k": 1"#;
    let system = bar(spacing, &format!("exp({a}*T)"), [COLD, hot], "0");
    let (mut state, mut rates) = start(&system, |_| 0.0);
    let end = 4.0 * (a / (a.exp() - 1.0)) * spacing * spacing;
    let mut stabilised = Stabilised::default();
    let mut implicit = Implicit::new(&system, 1e-9, false);
    let method: &mut dyn Method = match method {
        "stabilised" => &mut stabilised,
        _ => &mut implicit,
    };
    for step in 0..40 {
        let error = method.advance(&system, &mut state, &mut rates, end);
        assert!(
            error.is_ok(),
            "a = {a}, {cells} across, step {step}: {error:?}"
        );
        let (low, high) = crate::system::extent(&state.temperature);
        assert!(
            low > -0.2 && high < 1.2,
            "a = {a}, {cells} across, step {step}: {low} to {high}"
        );
    }
}

#[test]
fn a_steep_front_runs_into_a_bar_of_exactly_0_k() {
    for method in ["implicit", "stabilised"] {
        for (a, cells) in [(2.0, 320.0), (6.5, 160.0), (8.0, 40.0), (8.0, 320.0)] {
            front(a, cells, method);
        }
    }
}

#[test]
fn stages_follow_a_conductivity_that_rises_within_a_step() {
    let hot = r#""temperature_k": 1"#;
    let system = bar(0.05, "exp(8*T)", [COLD, hot], "0");
    let (mut state, mut rates) = start(&system, |_| 0.0);
    let mut method = Stabilised::default();
    for _ in 0..10 {
        let error = method.advance(&system, &mut state, &mut rates, 1e-4);
        assert!(error.is_ok(), "{error:?}");
        let (low, high) = crate::system::extent(&state.temperature);
        assert!(low > -0.2 && high < 1.2, "{low} to {high}");
    }
}

/// Temperature of a slab from -half to half that cools from 1 to 0 by convection, `biot = psi half / k`, at x over
/// half and the time over half^2 over diffusivity (Carslaw and Jaeger 1959, section 3.11).
fn cooling(x: f64, time: f64, biot: f64) -> f64 {
    let mut sum = 0.0;
    for n in 0..40 {
        let (mut low, mut high) = (
            std::f64::consts::PI * f64::from(n),
            std::f64::consts::PI * (f64::from(n) + 0.5),
        );
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            // b tan b rises through the biot number between n pi and the pole behind it.
            if middle * middle.tan() < biot {
                low = middle;
            } else {
                high = middle;
            }
        }
        let b = 0.5 * (low + high);
        let share = 4.0 * b.sin() / (2.0 * b + (2.0 * b).sin());
        sum += share * (-b * b * time).exp() * (b * x).cos();
    }
    sum
}

/// Greatest error of a rectangle of 8 by 13 that cools on all sides, in the corners too.
fn rectangle(cells: f64) -> f64 {
    let (psi, kappa, end) = (2.5, 0.6, 2.0);
    let text = format!(
        r#"{{"dimensions": 2, "body": {{"box": {{"min_m": [-4, -6.5], "max_m": [4, 6.5]}}}},
            "points": {{"spacing_m": {}}}, "initial_temperature_k": 1,
            "materials": [{{"name": "m", "density_kg_m3": 1, "specific_heat_j_kg_k": 1, "conductivity_w_m_k": {kappa}}}],
            "boundaries": [{{"on": ["x-", "x+", "y-", "y+"],
              "convection": {{"coefficient_w_m2_k": {psi}, "ambient_k": 0}}}}],
            "time": {{"end_s": {end}}}}}"#,
        1.0 / cells,
    );
    let scene: Scene = serde_json::from_str(&text).unwrap();
    let system = assemble::system(&scene).unwrap().0;
    let (mut state, mut rates) = start(&system, |_| 1.0);
    let mut method = Stabilised::default();
    let steps = (40.0 * cells) as usize;
    for _ in 0..steps {
        method
            .advance(&system, &mut state, &mut rates, end / steps as f64)
            .unwrap();
    }
    let error = |i: usize| {
        let [x, y, _] = system.place(i);
        let of =
            |x: f64, half: f64| cooling(x / half, kappa * end / (half * half), psi * half / kappa);
        (state.temperature[i] - of(x, 4.0) * of(y, 6.5)).abs()
    };
    (0..system.len()).map(error).fold(0.0, f64::max)
}

#[test]
fn corners_that_cool_on_both_sides_are_of_second_order() {
    let [coarse, fine] = [2.0, 4.0].map(rectangle);
    let order = (coarse / fine).log2();
    assert!(order > 1.8, "order {order}: {coarse:.2e} {fine:.2e}");
}

#[test]
fn heat_prescribed_is_not_integrated_on_for_who_wants_to_stop() {
    let flux = r#""heat_flux_w_m2": {"expr": "1e3*exp(-(t - 0.5)^2/1e-4)"}"#;
    let system = bar(0.1, "1", [flux, COLD], "0");
    let (mut state, _) = start(&system, |_| 0.0);
    state.time = 1.0;
    let course = crate::course::Course::new(&system, &state.temperature, state.time);
    let heat = |halt: bool| course.heat(&system, &state, &halt.into()).unwrap();
    let exact = 1e3 * (std::f64::consts::PI * 1e-4).sqrt() * 0.4;
    let prescribed = heat(false).unwrap()[0].prescribed;
    assert!(
        (prescribed / exact - 1.0).abs() < 1e-3,
        "{prescribed} {exact}"
    );
    assert_eq!(heat(true), None);
}
