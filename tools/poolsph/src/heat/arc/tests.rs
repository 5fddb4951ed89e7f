//! Heat of the arc that follows the temperature of the metal: its limits, its balance, its faults.

use std::f64::consts::PI;
use std::sync::Arc as Shared;

use particles::POSITION;
use serde_json::{Value, json};

use super::*;
use crate::heat::caloric::tests::plain;
use crate::heat::surface_tests::{METAL, body};
use crate::patch::SEEN;
use crate::source::arcs::OneArc;
use crate::stage::Stage;
use crate::state::{ENTHALPY, State, TEMPERATURE};

/// Volume of a cone of height 1 over the radius of the table \[m2\].
const CONE: f64 = PI * 15.0 * 15.0 / 3.0;
const PHI: f64 = 3.85;
const VOLTAGE: f64 = 15.68;
/// Current density \[A/m2\] and excess temperature of the gas \[K\] on the axis.
const CURRENT: f64 = 9e6;
const GAS: f64 = 15e3;

/// An arc that falls linearly to nothing at 15 m.
fn table() -> artefact::Table {
    let cone = |peak: f64| [peak, peak * 2.0 / 3.0, peak / 3.0, 0.0];
    artefact::Table::new(4)
        .column("radius_m", "m", [0.0, 5.0, 10.0, 15.0])
        .column("heat_flux_convection_w_m2", "W/m2", cone(2e6))
        .column("heat_flux_radiation_w_m2", "W/m2", cone(1e6))
        .column("heat_flux_electron_w_m2", "W/m2", cone(-3e6))
        .column("heat_flux_ion_w_m2", "W/m2", cone(4e6))
        .column("current_density_a_m2", "A/m2", cone(CURRENT))
        .column("ionisation_voltage_v", "V", [VOLTAGE; 4])
        .column("gas_temperature_k", "K", cone(GAS).map(|t| t + 500.0))
        .attribute("gas_temperature_height_m", "m", 9e-5)
}

fn made(scene: Value) -> Result<Arc, run::Fault> {
    let parameters: ArcParameters = serde_json::from_value(scene).unwrap();
    let caloric = Shared::new(plain(1e9, 1.0, None));
    Arc::new(&parameters, caloric, METAL, Some(&table()))
}

fn cathode() -> Value {
    json!({"work_function_v": PHI, "richardson_a_m2_k2": 1.2e6})
}

/// A plate at `t` \[K\].
fn plate(t: f64) -> State {
    let mut state = body([20, 20, 4], |x| x[2] < 0.0);
    state.metal.column_mut(&TEMPERATURE).fill(t);
    state.metal.column_mut(&ENTHALPY).fill(t);
    state
}

/// Heat of each part within a step of `dt` \[J\]; their sum is the change of the energy.
fn put(arc: &mut Arc, state: &mut State, dt: f64) -> Vec<(&'static str, f64)> {
    let before = state.metal.column(&ENTHALPY).to_vec();
    arc.advance(state, dt).unwrap();
    let change: f64 = (state.metal.column(&ENTHALPY).iter().zip(&before))
        .map(|(after, before)| after - before)
        .sum();
    let parts: Vec<_> = (arc.figures().iter())
        .filter(|figure| figure.unit == "J")
        .map(|figure| (figure.name, figure.value))
        .collect();
    let sum: f64 = parts.iter().map(|part| part.1).sum();
    let scale: f64 = parts.iter().map(|part| part.1.abs()).sum();
    assert!((sum - change).abs() < 1e-9 * scale, "{sum} {change}");
    parts
}

fn of(parts: &[(&'static str, f64)], name: &str) -> f64 {
    parts.iter().find(|part| part.0 == name).unwrap().1
}

#[test]
fn a_cold_plane_takes_what_the_ions_bring_and_a_hot_one_loses_by_electrons() {
    let scene = json!({"parts": [], "cathode": cathode()});
    let dt = 1e-8;
    for (t, ion, electron) in [
        (500.0, CURRENT * VOLTAGE, 0.0),
        (6000.0, 0.0, -CURRENT * PHI),
    ] {
        let parts = put(&mut made(scene.clone()).unwrap(), &mut plate(t), dt);
        assert_eq!(parts.len(), 2);
        for (name, exact) in [
            ("energy_in_arc_ion_j", ion),
            ("energy_in_arc_electron_j", electron),
        ] {
            let found = of(&parts, name) / (dt * CONE);
            assert!(
                (found - exact).abs() <= 0.01 * exact.abs().max(1e-9),
                "{name} {found} {exact}"
            );
        }
    }
}

#[test]
fn a_plane_takes_what_the_gas_gives_it() {
    let scene = json!({"parts": [], "gas": {"thermal_conductivity_w_m_k": 0.6}});
    let parts = put(&mut made(scene).unwrap(), &mut plate(500.0), 1e-9);
    let found = of(&parts, "energy_in_arc_convection_j") / 1e-9;
    // Nearly all of the resistance is that of the gas.
    let exact = 0.6 * GAS / 9e-5 * CONE;
    assert!((found / exact - 1.0).abs() < 0.01, "{found} {exact}");
}

#[test]
fn other_parts_stay_as_the_table_has_them() {
    let names = |scene| {
        let parts = put(&mut made(scene).unwrap(), &mut plate(500.0), 1e-9);
        let radiation = of(&parts, "energy_in_arc_radiation_j");
        assert!((radiation / (1e6 * 1e-9 * CONE) - 1.0).abs() < 0.01);
        parts
    };
    let table = names(json!({}));
    assert!((of(&table, "energy_in_arc_ion_j") / (4e6 * 1e-9 * CONE) - 1.0).abs() < 0.01);
    let both = names(json!({"cathode": cathode(), "gas": {"thermal_conductivity_w_m_k": 0.6}}));
    assert_eq!(table.len(), 4);
    assert!(
        both.iter()
            .map(|part| part.0)
            .eq(table.iter().map(|part| part.0))
    );
    let one = names(json!({"parts": ["radiation"], "cathode": cathode()}));
    assert!(
        one.iter()
            .all(|part| part.0 != "energy_in_arc_convection_j")
            && one.len() == 3
    );
}

#[test]
fn a_long_step_ends_at_the_balance_of_electrons_and_ions() {
    let mut arc = made(json!({"parts": [], "cathode": cathode()})).unwrap();
    let limit = arc.limit(&plate(500.0)).unwrap();
    assert_eq!(limit.name, "arc_feedback");
    let mut state = plate(500.0);
    put(&mut arc, &mut state, 300.0 * limit.seconds);
    // j_e phi = (j - j_e) V_i.
    let share = VOLTAGE / (PHI + VOLTAGE);
    let balance = |j: f64| {
        let (mut low, mut high) = (500.0, 6000.0);
        for _ in 0..80 {
            let t = 0.5 * (low + high);
            let electrons = 1.2e6 * t * t * (-PHI * 11_604.518_121_55 / t).exp();
            (low, high) = if electrons > share * j {
                (low, t)
            } else {
                (t, high)
            };
        }
        low
    };
    let mut near = 0;
    for a in 0..state.len() {
        let r = state.metal.column(&POSITION)[a][0].hypot(state.metal.column(&POSITION)[a][1]);
        if state.metal.column(&SEEN)[a] > 0.0 && r < 14.0 {
            let (found, exact) = (
                state.metal.column(&TEMPERATURE)[a],
                balance(CURRENT * (1.0 - r / 15.0)),
            );
            assert!(found <= exact + 1e-6, "passed: {found} {exact}");
            if r < 7.0 {
                assert!(exact - found < 1e-3, "{found} {exact} at {r}");
                near += 1;
            }
        }
    }
    assert!(near > 100, "{near}");
}

#[test]
fn fluxes_that_know_no_temperature_bound_no_step() {
    for scene in [json!({}), json!({"flux_w_m2": 1e6})] {
        assert!(made(scene).unwrap().limit(&plate(500.0)).is_none());
    }
}

#[test]
fn heat_given_twice_is_a_fault_at_its_key() {
    let gas = json!({"thermal_conductivity_w_m_k": 0.6});
    for (scene, at) in [
        (
            json!({"parts": ["radiation", "ion"], "cathode": cathode()}),
            "/parts/1",
        ),
        (
            json!({"parts": ["electron"], "cathode": cathode()}),
            "/parts/0",
        ),
        (json!({"parts": ["convection"], "gas": gas}), "/parts/0"),
        (json!({"flux_w_m2": 1e6, "cathode": cathode()}), "/cathode"),
        (json!({"flux_w_m2": 1e6, "gas": gas}), "/gas"),
        (json!({"flux_w_m2": 1e6, "parts": ["ion"]}), "/parts"),
    ] {
        let fault = made(scene).err().unwrap().to_string();
        assert!(fault.contains(at), "{at}: {fault}");
    }
}

/// Arcs of the same table, each with an entry of the scene.
fn several(arcs: Value, heat: Value) -> Arc {
    let arcs: Vec<OneArc> = serde_json::from_value(arcs).unwrap();
    let heat: ArcParameters = serde_json::from_value(heat).unwrap();
    let mut stage = Arc::without_arcs(Shared::new(plain(1e9, 1.0, None)), METAL, heat.on);
    for arc in &arcs {
        let own = arc.heat.as_ref().unwrap_or(&heat);
        stage.burn(own, arc.burning(), Some(&table())).unwrap();
    }
    stage
}

#[test]
fn arcs_of_half_a_level_heat_as_one_does() {
    let half = json!({"period_s": 1.0, "times_s": [0], "levels": [0.5]});
    let arcs = json!([{"waveform": half}, {"waveform": half}]);
    let scene = json!({"cathode": cathode()});
    let dt = 1e-8;
    let both = put(&mut several(arcs, scene.clone()), &mut plate(2800.0), dt);
    let one = put(&mut made(scene).unwrap(), &mut plate(2800.0), dt);
    assert_eq!(both.len(), 4);
    for ((name, found), (own, exact)) in both.iter().zip(&one) {
        assert_eq!(name, own);
        assert!((found / exact - 1.0).abs() < 1e-9, "{name} {found} {exact}");
    }
    // The bound of the step is that of both.
    let limit = |arc: Arc| arc.limit(&plate(500.0)).unwrap().seconds;
    let full = json!([{}, {}]);
    let scene = json!({"cathode": cathode()});
    let ratio = limit(several(full, scene.clone())) / limit(made(scene).unwrap());
    assert!((ratio - 0.5).abs() < 1e-12, "{ratio}");
}

#[test]
fn pulses_heat_by_the_mean_of_their_levels_whatever_the_steps() {
    // The peak burns for 4 of 10 ms; the base has a quarter of its heat in the rest.
    let arcs = json!([{"waveform": {"period_s": 0.01, "times_s": [0, 0.004, 0.004], "levels": [1, 1, 0.25]}}]);
    let scene = json!({"parts": ["radiation"]});
    for steps in [1, 7, 33] {
        let mut pulsed = several(arcs.clone(), scene.clone());
        let mut state = plate(500.0);
        let dt = 0.02 / f64::from(steps);
        let mut sum = Vec::new();
        for _ in 0..steps {
            pulsed.advance(&mut state, dt).unwrap();
            state.time += dt;
            sum = pulsed.figures();
        }
        let steady = put(&mut made(scene.clone()).unwrap(), &mut plate(500.0), 0.02);
        let found = sum.iter().find(|f| f.unit == "J").unwrap().value;
        let exact = 0.55 * of(&steady, "energy_in_arc_radiation_j");
        assert!(
            (found / exact - 1.0).abs() < 1e-9,
            "{steps}: {found} {exact}"
        );
    }
}

#[test]
fn an_arc_beside_the_axis_heats_around_its_own() {
    let arcs = json!([{"offset_m": [3, -2, 0], "heat": {"parts": ["radiation"]}}]);
    let mut state = plate(500.0);
    let mut arc = several(arcs, json!({}));
    let found = put(&mut arc, &mut state, 1e-3);
    assert_eq!(found.len(), 1);
    let mut moment = [0.0; 3];
    for (x, t) in state
        .metal
        .column(&POSITION)
        .iter()
        .zip(state.metal.column(&ENTHALPY))
    {
        let heat = (t - 500.0) * METAL.mass();
        moment = [
            moment[0] + heat * x[0],
            moment[1] + heat * x[1],
            moment[2] + heat,
        ];
    }
    let middle = [moment[0] / moment[2], moment[1] / moment[2]];
    assert!(
        (middle[0] - 3.0).abs() < 1e-2 && (middle[1] + 2.0).abs() < 1e-2,
        "{middle:?}"
    );
}

#[test]
fn a_plate_that_is_cathode_and_anode_in_turn_takes_each_heat_in_its_time() {
    let half =
        |levels: [f64; 3]| json!({"period_s": 0.02, "times_s": [0, 0.01, 0.01], "levels": levels});
    let arcs = json!([
        {"waveform": half([1.0, 1.0, 0.0]), "heat": {"parts": [], "cathode": cathode()}},
        {"waveform": half([0.0, 0.0, 1.0]), "heat": {"parts": ["electron"]}},
    ]);
    let mut arc = several(arcs, json!({}));
    let mut state = plate(500.0);
    let first = put(&mut arc, &mut state, 1e-8);
    assert!(of(&first, "energy_in_arc_ion_j") > 0.0);
    assert!(
        of(&first, "energy_in_arc_electron_j").abs() < 1e-9 * of(&first, "energy_in_arc_ion_j")
    );
    state.time = 0.015;
    arc.advance(&mut state, 1e-8).unwrap();
    let after = arc.figures();
    let value = |name: &str| after.iter().find(|f| f.name == name).unwrap().value;
    assert!((value("energy_in_arc_electron_j") / (-3e6 * 1e-8 * CONE) - 1.0).abs() < 0.01);
    assert!((value("energy_in_arc_ion_j") / of(&first, "energy_in_arc_ion_j") - 1.0).abs() < 1e-9);
}

#[test]
fn an_arc_whose_tables_fall_beside_the_plate_is_told() {
    let told = |x: f64| {
        let mut arc = Arc::without_arcs(Shared::new(plain(1e9, 1.0, None)), METAL, Onto::default());
        let parameters: ArcParameters =
            serde_json::from_value(json!({"parts": ["radiation"]})).unwrap();
        let beside: OneArc = serde_json::from_value(json!({"offset_m": [x, 0, 0]})).unwrap();
        for burning in [Burning::default(), beside.burning()] {
            arc.burn(&parameters, burning, Some(&table())).unwrap();
        }
        arc.advance(&mut plate(300.0), 1e-4).unwrap();
        arc.warnings()
    };
    assert!(told(0.0).is_empty(), "{:?}", told(0.0));
    let said = told(100.0);
    assert!(
        said.len() == 1 && said[0].starts_with("arc 1: of ") && said[0].contains("0.0 %"),
        "{said:?}"
    );
}

/// What is told, and noted, of a Gaussian of 5 m that stands `x` \[m\] beside the middle of a plate of 20 m to each side.
fn gaussian(x: f64, open: &[crate::rest::Plane]) -> [Vec<String>; 2] {
    let flux = json!({"flux_w_m2": {"expr": "1e6*exp(-(r/5)^2)"}});
    let parameters: ArcParameters = serde_json::from_value(flux).unwrap();
    let stands: OneArc = serde_json::from_value(json!({"offset_m": [x, 0, 0]})).unwrap();
    let arc = Arc::without_arcs(Shared::new(plain(1e9, 1.0, None)), METAL, Onto::default());
    let mut arc = arc.within(open);
    arc.burn(&parameters, stands.burning(), None).unwrap();
    arc.advance(&mut plate(300.0), 1e-4).unwrap();
    [arc.warnings(), arc.notes()]
}

#[test]
fn a_formula_that_falls_beside_the_plate_by_a_hundredth_is_told_with_both_figures() {
    let none: [Vec<String>; 2] = Default::default();
    assert_eq!(gaussian(0.0, &[]), none);
    // Beyond an edge at the distance d lies (1 - erf(d/5))/2: 0.24 % of it at 10 m, 1.7 % at 7.5 m, half of it at the edge.
    assert_eq!(gaussian(10.0, &[]), none);
    for (x, exact) in [(12.5, 98.31), (20.0, 50.0)] {
        let [said, noted] = gaussian(x, &[]);
        assert!(noted.is_empty() && said.len() == 1, "{said:?}");
        let percent = said[0]
            .split(" W, ")
            .nth(1)
            .and_then(|rest| rest.split(' ').next());
        let percent: f64 = percent.unwrap().parse().unwrap();
        assert!((percent - exact).abs() < 0.3, "{said:?}");
        // pi 5^2 1e6 W in all.
        assert!(said[0].contains("of 7.8540e7 W"), "{said:?}");
    }
}

#[test]
fn heat_beyond_an_open_face_is_noted_as_not_computed() {
    let open = [crate::rest::Plane {
        axis: 0,
        at: 20.0,
        outward: 1.0,
    }];
    let [said, noted] = gaussian(12.5, &open);
    assert!(said.is_empty() && noted.len() == 1, "{said:?} {noted:?}");
    let [said, noted] = gaussian(22.5, &open);
    assert!(noted.is_empty() && said.len() == 1, "{said:?} {noted:?}");
    assert!(said[0].contains("beyond the open faces"), "{said:?}");
}

#[test]
fn an_arc_narrower_than_the_particles_is_told() {
    // Cones between the middles of particles, which stand 1 m apart.
    let told = |reach: f64| {
        let cone = artefact::Table::new(2)
            .column("radius_m", "m", [0.0, reach])
            .column("heat_flux_radiation_w_m2", "W/m2", [1e6, 0.0]);
        let parameters = serde_json::from_value(json!({"parts": ["radiation"]})).unwrap();
        let caloric = Shared::new(plain(1e9, 1.0, None));
        let mut arc = Arc::new(&parameters, caloric, METAL, Some(&cone)).unwrap();
        arc.advance(&mut plate(300.0), 1e-4).unwrap();
        arc.warnings()
    };
    assert!(told(8.0).is_empty(), "{:?}", told(8.0));
    assert_eq!(told(1.3).len(), 1, "{:?}", told(1.3));
}

#[test]
fn metal_colder_than_the_gas_is_known_for_is_told() {
    let told = |first: f64| {
        let gas =
            json!({"thermal_conductivity_w_m_k": {"t_k": [first, 20000], "value": [0.1, 2.0]}});
        let mut arc = made(json!({"parts": ["radiation"], "gas": gas})).unwrap();
        arc.advance(&mut plate(300.0), 1e-6).unwrap();
        arc.warnings()
    };
    assert!(told(300.0).is_empty(), "{:?}", told(300.0));
    let said = told(5000.0);
    assert!(
        said.len() == 1 && said[0].contains("from 5000 K on"),
        "{said:?}"
    );
}
