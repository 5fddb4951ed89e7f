//! A wire that is fed as fast as it melts.

use arcfvm::solver::Arc;
use serde_json::{Value, json};

use crate::{case, mirror, solve};

/// Heat that a kilogram of vapour takes \[J/kg\].
const LATENT: f64 = 6.1e6;

/// A plate below a wire that melts as it is fed.
fn melting(feed: Value) -> Value {
    let mut scene = mirror(2000.0);
    let wire = scene["bodies"]["upper"].as_object_mut().unwrap();
    wire.insert("feed".to_owned(), feed);
    // Nothing reaches its upper end.
    wire["material"]["thermal_conductivity_w_m_k"] = json!(5);
    scene
}

/// A wire 2400 K warm at its tip; its drops hold what they are told.
fn warm(drop_enthalpy: Option<f64>) -> Value {
    let mut feed = json!({"drop_temperature_k": 2400});
    if let Some(own) = drop_enthalpy {
        feed["drop_enthalpy_j_kg"] = json!(own);
    }
    melting(feed)
}

/// A wire of which a part boils off.
fn boiling(feed: Value) -> Value {
    let mut scene = melting(feed);
    scene["bodies"]["upper"]["electrode"]["evaporation"] =
        json!({"boiling_k": 3100, "latent_heat_j_kg": LATENT, "molar_mass_kg_mol": 0.055845});
    scene
}

/// Mean temperature of the tip \[K\].
fn tip(arc: &Arc) -> f64 {
    let wire = arc.case.wire.unwrap();
    let (grid, temperature) = (&arc.case.grid, arc.temperature());
    let cells = (0..wire.columns).map(|i| grid.ring[i] * temperature[grid.cell(i, wire.tip)]);
    cells.sum::<f64>() / wire.section
}

#[test]
fn drops_that_hold_less_than_the_tip_let_the_wire_come_faster() {
    // 600 J/(kg K) over 300 K.
    let most = 600.0 * (2400.0 - 300.0);
    let speeds = [None, Some(most), Some(0.5 * most)].map(|own| {
        let mut arc = solve(&warm(own));
        let balance = arc.settle().unwrap();
        let mean = tip(&arc);
        assert!((mean - 2400.0).abs() < 1.0, "{own:?}: {mean} K");
        let heat = arc.case.wire.unwrap().mass_rate(arc.feed) * own.unwrap_or(most);
        assert!(
            (balance.drops + heat).abs() < 1e-3 * heat,
            "{own:?}: {} {heat}",
            balance.drops
        );
        assert!(balance.closure().abs() < 1e-6 * heat, "{own:?}");
        arc.feed
    });
    assert!((speeds[0] / speeds[1] - 1.0).abs() < 1e-9);
    assert!((speeds[2] / speeds[0] - 2.0).abs() < 0.1, "{speeds:?}");
    let told = case(&warm(Some(1.1 * most))).unwrap_err();
    assert!(
        told.contains("/bodies/upper/feed/drop_enthalpy_j_kg"),
        "{told}"
    );
    assert!(told.contains("at most 1.2600e6 J/kg"), "{told}");
}

#[test]
fn a_wire_is_fed_so_fast_that_the_part_told_boils_off() {
    for (share, own) in [(0.02, None), (0.1, None), (0.1, Some(1e6))] {
        let mut feed = json!({"vapour_share": share});
        if let Some(own) = own {
            feed["drop_enthalpy_j_kg"] = json!(own);
        }
        let mut arc = solve(&boiling(feed));
        let balance = arc.settle().unwrap();
        let fed = arc.case.wire.unwrap().mass_rate(arc.feed);
        let held = own.unwrap_or(600.0 * (tip(&arc) - 300.0));
        assert!((balance.drops + fed * held).abs() < 1e-3 * fed * held);
        let boiled = -balance.electrodes[1].vapour;
        assert!(
            (boiled - share * fed * LATENT).abs() < 1e-3 * fed * held,
            "{share}: {boiled} W, {fed} kg/s"
        );
        assert!(balance.closure().abs() < 1e-6 * fed * held);
    }
}

#[test]
fn what_boils_of_a_tip_of_given_temperature_is_the_part_that_gives_it() {
    let share = solve(&boiling(json!({"vapour_share": 0.05})));
    let mean = tip(&share);
    let given = solve(&boiling(json!({"drop_temperature_k": mean})));
    assert!((given.feed / share.feed - 1.0).abs() < 1e-3, "{mean} K");
    assert!((tip(&given) - mean).abs() < 1.0);
}

#[test]
fn a_wire_melts_by_the_heat_of_what_it_runs_through_too() {
    let mut scene = warm(None);
    scene["bodies"]["upper"]["shape"]["ring"]["r_m"] = json!([0, 0.006]);
    scene["bodies"]["bed"] = json!({
        "shape": {"ring": {"r_m": [0.006, 0.01], "z_m": [0.016, 0.02]}},
        "material": {
            "density_kg_m3": 3000, "specific_heat_j_kg_k": 1000, "thermal_conductivity_w_m_k": 20,
            "electric_conductivity_s_m": 0
        }
    });
    scene["current"]["edges"]["top"] = json!([{"over_m": [0, 0.006], "total_current_a": 2000}]);
    // Its upper end stays cold.
    scene["heat"]["edges"]["outer"] = json!([{"over_m": [0.016, 0.018], "temperature_k": 4000}]);
    let arc = solve(&scene);
    let heating = arc.heating.as_ref().unwrap();
    let beside = arc
        .case
        .wire
        .unwrap()
        .from_beside(&arc.case, &heating.energy);
    let drops = arc.case.wire.unwrap().mass_rate(arc.feed) * 600.0 * 2100.0;
    assert!(beside > 0.01 * drops, "{beside} {drops}");
    assert!((tip(&arc) - 2400.0).abs() < 1.0, "{} K", tip(&arc));
}

#[test]
fn a_share_of_vapour_that_means_nothing_is_told() {
    let wrong = |feed: Value| case(&boiling(feed)).unwrap_err();
    let both = wrong(json!({"vapour_share": 0.1, "drop_temperature_k": 2400}));
    assert!(
        both.contains("wants exactly one of speed_m_s, drop_temperature_k and vapour_share"),
        "{both}"
    );
    let much = wrong(json!({"vapour_share": 0.1, "drop_enthalpy_j_kg": 2e6}));
    assert!(
        much.contains("/feed/drop_enthalpy_j_kg") && much.contains("1.6800e6 J/kg"),
        "{much}"
    );
    let at_speed = wrong(json!({"speed_m_s": 0.01, "drop_enthalpy_j_kg": 1e6}));
    assert!(at_speed.contains("/feed/drop_enthalpy_j_kg"), "{at_speed}");
    let dry = case(&melting(json!({"vapour_share": 0.1}))).unwrap_err();
    assert!(
        dry.contains("/bodies/upper/feed/vapour_share") && dry.contains("wants evaporation"),
        "{dry}"
    );
}
