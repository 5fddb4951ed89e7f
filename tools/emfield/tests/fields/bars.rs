//! Bars along z with given net currents.

use std::path::Path;

use serde_json::{Value, json};

use super::{last, run, said};

/// A disc bar at a place along x.
fn bar(name: &str, x: f64, own: &Value) -> Value {
    let mut bar = json!({"name": name, "conductivity_s_m": 1e7,
        "shape": {"disc": {"centre_m": [x, 0], "radius_m": 0.01}}});
    let own = own.as_object().unwrap().clone();
    bar.as_object_mut().unwrap().extend(own);
    bar
}

fn scene(bodies: &[Value], currents: &Value) -> Value {
    json!({
        "kind": "emfield.scene", "version": 1, "geometry": "plane",
        "domain": {"sphere": {"centre_m": [0, 0], "radius_m": 0.06}},
        "bodies": bodies, "eddy_currents": currents,
        "points": {"spacing_m": 0.0025, "layers": {"first_m": 0.00125}}, "output": {"precision": "f64"}
    })
}

fn total(folder: &Path, scene: &Value, name: &str) -> f64 {
    last(&run(folder, scene), "/totals").get(name).unwrap()
}

/// A bar far from the middle of all that conducts has the heat of one in the middle, where nothing joins it to others.
#[test]
fn an_isolated_bar_is_the_same_anywhere() {
    let folder = tempfile::tempdir().unwrap();
    let field = json!({"harmonic": {"frequency_hz": 500}, "outer": "multipole",
        "applied_flux_density_t": [0, 0.02, 0]});
    let none = json!({"net_current_a": 0});
    let heat = |bodies: &[Value]| total(folder.path(), &scene(bodies, &field), "power_volume");
    let alone = heat(&[bar("a", 0.0, &json!({}))]);
    let isolated = heat(&[bar("a", 0.0, &none)]);
    assert!((isolated / alone - 1.0).abs() < 1e-6, "{isolated} {alone}");
    // A grain that hardly conducts draws the middle away.
    let grain = json!({"name": "grain", "conductivity_s_m": 1e2,
        "shape": {"disc": {"centre_m": [0.045, 0], "radius_m": 0.008}}});
    let aside = heat(&[bar("a", -0.03, &none), grain]);
    assert!((aside / alone - 1.0).abs() < 2e-2, "{aside} {alone}");
}

/// Two bars with opposite currents push each other away by `mu0 I^2 / (2 pi d)`, far apart and slow.
#[test]
fn bars_with_opposite_currents_repel() {
    let folder = tempfile::tempdir().unwrap();
    let currents = json!({"harmonic": {"frequency_hz": 0.01}, "outer": "multipole"});
    let net = |amperes: f64| json!({"net_current_a": amperes});
    let bodies = [bar("a", -0.03, &net(1000.0)), bar("b", 0.03, &net(-1000.0))];
    let mut scene = scene(&bodies, &currents);
    scene["output"]["enclosures"] =
        json!([{"name": "one", "surface": {"around": {"body": "b", "distance_m": 0.005}}}]);
    let found = last(&run(folder.path(), &scene), "/totals");
    let force = found.get("one.force_x").unwrap();
    let exact = 2e-7 * 1e6 / 0.06;
    assert!((force / exact - 1.0).abs() < 1e-2, "{force} {exact}");
    // What is applied along bars is not known beyond them.
    assert!(found.get("one.power").is_err());
    let voltage = |name: &str| found.get(&format!("bar_voltage_{name}_real")).unwrap();
    // Four spacings a radius have the section to 0.2 %.
    let direct = 1000.0 / (1e7 * std::f64::consts::PI * 1e-4);
    assert!((voltage("a") / direct - 1.0).abs() < 5e-3);
    assert!((voltage("a") + voltage("b")).abs() < 2e-3 * direct);
}

#[test]
fn net_currents_have_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |bodies: &[Value], currents: &Value, what: &str| {
        let (code, text, _) = said(folder.path(), &scene(bodies, currents));
        assert_eq!(code, 2, "{text}");
        assert!(
            text.contains("/bodies/0/net_current") && text.contains(what),
            "{text}"
        );
    };
    let net = json!({"net_current_a": 1});
    let harmonic = json!({"harmonic": {"frequency_hz": 50}});
    let march = json!({"transient": {"end_s": 1, "step_s": 0.1}});
    refused(&[bar("a", 0.0, &net)], &march, "take \"harmonic\"");
    let along = json!({"harmonic": {"frequency_hz": 50}, "applied_flux_density_t": [0, 0, 1]});
    refused(&[bar("a", 0.0, &net)], &along, "a bar along z in a plane");
    let still = json!({"net_current_a": 1, "conductivity_s_m": 0});
    refused(&[bar("a", 0.0, &still)], &harmonic, "does not conduct");
    let iron = json!({"net_current_a": 1, "relative_permeability": 100});
    refused(&[bar("a", 0.0, &iron)], &harmonic, "permeability");
    let lead = json!({"net_current_phase_deg": 10});
    let wire = json!({"harmonic": {"frequency_hz": 50}, "coils": [{"wire": {"place_m": [0.1, 0], "current_a": 1}}]});
    refused(&[bar("a", 0.0, &lead)], &wire, "which is absent");
    let block = |low: f64| json!({"box": {"min_m": [low, -0.01], "max_m": [low + 0.02, 0.01]}});
    let touching = [
        bar(
            "a",
            0.0,
            &json!({"net_current_a": 1, "shape": block(-0.02)}),
        ),
        bar("b", 0.0, &json!({"shape": block(0.0)})),
    ];
    refused(&touching, &harmonic, "the bar touches b at (");
}
