//! Density and specific heat that depend on temperature, through every march.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::f64::consts::PI;

use heatsph::march::explicit::Explicit;
use heatsph::march::implicit::Implicit;
use heatsph::march::stabilised::Stabilised;
use heatsph::march::{Method, State};
use heatsph::scene::Scene;
use heatsph::system::storage::Storage;
use heatsph::system::{Rates, System, extent};
use serde_json::{Value, json};

const MARCHES: [&str; 3] = ["explicit", "stabilised", "implicit"];

/// A bar from 0 to 1 with `more` in its scene.
fn bar(spacing: f64, material: &Value, more: &Value) -> (System, Vec<f64>) {
    let mut scene = json!({
        "dimensions": 2,
        "body": {"box": {"min_m": [0, 0], "max_m": [1, 4.0 * spacing]}},
        "points": {"spacing_m": spacing},
        "materials": [material], "initial_temperature_k": 0,
        "boundaries": [{"on": ["x-"], "temperature_k": 0}, {"on": ["x+"], "temperature_k": 1}],
        "time": {"end_s": 1}
    });
    let keys = scene.as_object_mut().unwrap();
    keys.extend(more.as_object().unwrap().clone());
    let scene: Scene = serde_json::from_value(scene).unwrap();
    heatsph::assemble::system(&scene).unwrap()
}

fn material(density: &Value, heat: &Value, conductivity: &str) -> Value {
    json!({"name": "m", "density_kg_m3": density, "specific_heat_j_kg_k": heat,
           "conductivity_w_m_k": {"expr": conductivity}})
}

/// Marches to `end` in `steps` steps, or in those of the explicit limit.
fn march(name: &str, system: &mut System, temperature: Vec<f64>, end: f64, steps: usize) -> State {
    let mut state = State::new(system, temperature);
    let mut rates = Rates::default();
    system.reach(&state.temperature).unwrap();
    system.rates(0.0, &state.temperature, &mut rates).unwrap();
    let mut explicit = Explicit::default();
    let mut stabilised = Stabilised::default();
    let mut implicit = Implicit::new(system, 1e-11, false);
    let method: &mut dyn Method = match name {
        "explicit" => &mut explicit,
        "stabilised" => &mut stabilised,
        _ => &mut implicit,
    };
    while state.time < end * (1.0 - 1e-12) {
        let limit = 0.9 * method.longest(system, &rates);
        let step = limit.min(end / steps as f64).min(end - state.time);
        let advanced = method.advance(system, &mut state, &mut rates, step);
        assert!(advanced.is_ok(), "{name} at {}: {advanced:?}", state.time);
        if system.reach(&state.temperature).unwrap() {
            system
                .rates(state.time, &state.temperature, &mut rates)
                .unwrap();
        }
    }
    state
}

/// Heat stored since the start, and what came in.
fn heats(system: &System, first: &[f64], state: &State) -> (f64, f64) {
    let content = system.storage.varies().unwrap();
    let before: f64 = content.heats(first).iter().sum();
    let stored = state.heat.iter().sum::<f64>() - before;
    (stored, state.entries.iter().sum::<f64>() + state.source)
}

#[test]
fn a_constant_diffusivity_makes_heat_a_linear_field() {
    // k and rho c grow alike: U, the integral of exp(a T), obeys the linear equation (Carslaw and Jaeger 1959, 1.6).
    let a = 2.0_f64;
    let full = a.exp_m1() / a;
    let end = 0.05;
    let exact = |x: f64| {
        let terms = (1..200).map(|n| {
            let (n, sign) = (f64::from(n), if n % 2 == 0 { 1.0 } else { -1.0 });
            sign / n * (n * PI * x).sin() * (-(n * PI).powi(2) * end).exp()
        });
        (a * full * (x + 2.0 / PI * terms.sum::<f64>())).ln_1p() / a
    };
    for name in MARCHES {
        let errors = [0.05, 0.025].map(|spacing| {
            let law = material(
                &json!({"expr": "exp(0.5*T)"}),
                &json!({"expr": "exp(1.5*T)"}),
                "exp(2*T)",
            );
            let (mut system, first) = bar(spacing, &law, &json!({}));
            let state = march(name, &mut system, first.clone(), end, 400);
            let (stored, came) = heats(&system, &first, &state);
            assert!(
                (stored / came - 1.0).abs() < 1e-8,
                "{name}: {stored} of {came}"
            );
            let error = |i: usize| (state.temperature[i] - exact(system.place(i)[0])).abs();
            (0..system.len()).map(error).fold(0.0, f64::max)
        });
        let order = (errors[0] / errors[1]).log2();
        assert!(
            order > 1.8 && errors[1] < 1e-3,
            "{name}: order {order}, {errors:?}"
        );
    }
}

/// Latent heat of 1 beside a heat capacity of 1, in a peak of some width about 0.5 K.
fn melting(width: f64) -> Value {
    let peak = format!("1 + 1/({width}*sqrt(pi))*exp(-((T - 0.5)/{width})^2)");
    material(&json!(1), &json!({"expr": peak}), "1")
}

#[test]
fn no_peak_is_stepped_over() {
    for width in [1e-2, 1e-5] {
        for name in MARCHES {
            let (mut system, first) = bar(
                0.1,
                &melting(width),
                &json!({
                "boundaries": [{"on": ["x+"], "temperature_k": 1}]}),
            );
            let state = march(name, &mut system, first.clone(), 6.0, 300);
            let (stored, came) = heats(&system, &first, &state);
            let wanted = if name == "implicit" { 1e-8 } else { 1e-10 };
            assert!(
                (stored / came - 1.0).abs() < wanted,
                "{name} {width}: {stored} of {came}"
            );
            let (low, high) = extent(&state.temperature);
            assert!(
                low > 0.99 && high <= 1.0 + 1e-9,
                "{name} {width}: {low} to {high}"
            );
            // Warm everywhere: a heat of 1 to reach 1 K, and 1 to melt, but for the little that is missing; the half
            // cells of the held points were warm at first.
            let area = 4.0 * 0.1 * 0.95;
            assert!(
                (stored / (2.0 * area) - 1.0).abs() < 0.01,
                "{name} {width}: {stored}"
            );
        }
    }
}

#[test]
fn temperatures_that_leave_a_peak_stay_bounded() {
    for name in MARCHES {
        let (mut system, first) = bar(0.1, &melting(0.05), &json!({"initial_temperature_k": 0.5}));
        let mut state = State::new(&system, first.clone());
        for _ in 0..20 {
            let next = march(name, &mut system, state.temperature.clone(), 0.01, 1);
            state = next;
            let (low, high) = extent(&state.temperature);
            assert!(low > -1e-3 && high < 1.0 + 1e-3, "{name}: {low} to {high}");
        }
    }
}

#[test]
fn each_place_may_have_its_own_heat_of_temperature() {
    // Without conduction a cell takes up Q t: the integral of 1 + x T is T + x T^2 / 2.
    let cases = [
        (json!({"expr": "1 + x*T"}), json!(1)),
        (
            json!({"expr": "1 + x"}),
            json!({"t_k": [0, 4], "value": [1, 5]}),
        ),
    ];
    for (density, heat) in cases {
        let both = density["expr"] == "1 + x*T";
        for name in MARCHES {
            let law = material(&density, &heat, "1e-9");
            let (mut system, first) = bar(0.1, &law, &json!({"boundaries": [], "source_w_m3": 2}));
            let state = march(name, &mut system, first.clone(), 1.0, 50);
            let (stored, came) = heats(&system, &first, &state);
            assert!(
                (stored / came - 1.0).abs() < 1e-9,
                "{name}: {stored} of {came}"
            );
            for i in 0..system.len() {
                let (x, t) = (system.place(i)[0], state.temperature[i]);
                let held = if both {
                    t + 0.5 * x * t * t
                } else {
                    (1.0 + x) * (t + 0.5 * t * t)
                };
                assert!((held - 2.0).abs() < 1e-6, "{name} at {x}: {t} holds {held}");
            }
        }
    }
}

#[test]
fn materials_that_meet_share_what_their_cells_hold() {
    let layers = json!([
        {"name": "hot", "density_kg_m3": {"expr": "2 + x"}, "specific_heat_j_kg_k": {"t_k": [0, 1, 3], "value": [1, 2, 4]},
         "conductivity_w_m_k": 10, "region": {"half_space": {"point_m": [0.43, 0], "normal": [1, 0]}}},
        {"name": "cold", "density_kg_m3": 1, "specific_heat_j_kg_k": 3, "conductivity_w_m_k": 0.1}]);
    let more = json!({"materials": layers, "boundaries": [], "initial_temperature_k": {"expr": "if(0.43 - x, 2, 1)"}});
    for name in MARCHES {
        let (mut system, first) = bar(0.1, &json!({}), &more);
        let content = system.storage.varies().unwrap();
        let held: f64 = content.heats(&first).iter().sum();
        // Above the least temperature, 1 K: the integral of c from 1 K to 2 K is 2.5.
        let exact = 0.4 * 2.5 * (2.0 * 0.43 + 0.5 * 0.43 * 0.43);
        assert!((held / exact - 1.0).abs() < 1e-2, "{held} of {exact}");
        let state = march(name, &mut system, first.clone(), 40.0, 100);
        let after: f64 = state.heat.iter().sum();
        assert!(
            (after / held - 1.0).abs() < 1e-9,
            "{name}: {after} of {held}"
        );
        let (low, high) = extent(&state.temperature);
        assert!(high - low < 1e-2 && low > 1.0, "{name}: {low} to {high}");
    }
}

#[test]
fn what_depends_on_place_alone_keeps_no_heat() {
    let law = material(&json!({"expr": "1 + x"}), &json!(2), "1");
    let (system, first) = bar(0.1, &law, &json!({}));
    assert!(matches!(system.storage, Storage::Fixed(_)));
    assert!(State::new(&system, first).heat.is_empty());
    // A steady state stores nothing, whatever its materials do.
    let steady = json!({"time": null, "steady": {}});
    let (system, _) = bar(0.1, &melting(0.1), &steady);
    assert!(system.storage.varies().is_none());
}
