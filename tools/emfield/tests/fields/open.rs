//! Electrostatics with walls that stand for open space.

use std::path::Path;

use serde_json::{Value, json};

use super::{last, run, said};

/// Two wires in a plane, at potentials that differ.
fn wires(potentials: [f64; 2], electrostatics: &Value) -> Value {
    let wire = |name: &str, x: f64, radius: f64, potential: f64| {
        json!({"name": name, "potential_v": potential,
            "shape": {"disc": {"centre_m": [x, 0], "radius_m": radius}}})
    };
    json!({
        "kind": "emfield.scene", "version": 1, "geometry": "plane",
        "domain": {"sphere": {"centre_m": [0, 0], "radius_m": 4e-3}},
        "bodies": [wire("left", -7e-4, 1e-3, potentials[0]), wire("right", 1.3e-3, 5e-4, potentials[1])],
        "electrostatics": electrostatics,
        "points": {"spacing_m": 2e-4}, "output": {"precision": "f64"}
    })
}

fn total(folder: &Path, scene: &Value, name: &str) -> f64 {
    last(&run(folder, scene), "/totals").get(name).unwrap()
}

/// A potential that all electrodes have more is there far away too, and makes no field.
#[test]
fn a_potential_that_all_electrodes_share_is_one_far_away() {
    let folder = tempfile::tempdir().unwrap();
    let open = json!({"outer": "multipole"});
    let far = |v: [f64; 2]| {
        let (code, _, out) = said(folder.path(), &wires(v, &open));
        assert_eq!(code, 0);
        let record = std::fs::read_to_string(out.with_extension("run.json")).unwrap();
        let record: Value = serde_json::from_str(&record).unwrap();
        let entry = record["closing"].as_array().unwrap().iter();
        let mut entry = entry.filter(|e| e["name"] == "potential_far");
        entry.next().unwrap()["value"].as_f64().unwrap()
    };
    let (low, high) = (far([3.0, 1.0]), far([13.0, 11.0]));
    assert!((high - low - 10.0).abs() < 1e-6, "{low} {high}");
    assert!(low > 1.0 && low < 3.0);
    let dipole = |v| total(folder.path(), &wires(v, &open), "electric_dipole_x");
    let (one, other) = (dipole([3.0, 1.0]), dipole([13.0, 11.0]));
    assert!((one / other - 1.0).abs() < 1e-6, "{one} {other}");
    let charge = total(folder.path(), &wires([3.0, 1.0], &open), "electric_charge");
    // A tenth of a millionth of what either wire has.
    assert!(charge.abs() < 1e-16, "{charge}");
}

/// A formula of a uniform field is that field, and one that comes from among the bodies is told.
#[test]
fn an_applied_potential_is_a_formula_or_a_uniform_field() {
    let folder = tempfile::tempdir().unwrap();
    let dipole = |electrostatics: &Value| {
        let scene = wires([0.0, 0.0], electrostatics);
        total(folder.path(), &scene, "electric_dipole_x")
    };
    let uniform = json!({"outer": "multipole", "applied_field_v_m": [1e3, 0]});
    let formula = json!({"outer": "multipole", "applied_potential_v": {"expr": "-1e3*x"}});
    let (one, other) = (dipole(&uniform), dipole(&formula));
    assert!((one / other - 1.0).abs() < 1e-9, "{one} {other}");
    let inside = json!({"outer": "multipole", "applied_potential_v": {"expr": "x^2 + y^2"}});
    let (code, text, _) = said(folder.path(), &wires([0.0, 0.0], &inside));
    assert_eq!(code, 3);
    assert!(
        text.contains("the applied potential has sources within the walls"),
        "{text}"
    );
}

#[test]
fn bodies_leave_room_before_open_walls() {
    let folder = tempfile::tempdir().unwrap();
    let near = |radius: f64| {
        let mut scene = wires([1.0, -1.0], &json!({"outer": "multipole"}));
        scene["domain"]["sphere"]["radius_m"] = radius.into();
        let (code, text, _) = said(folder.path(), &scene);
        assert_eq!(code, 2);
        text
    };
    let text = near(1.95e-3);
    assert!(
        text.contains("/electrostatics/outer") && text.contains("wants room for two spacings"),
        "{text}"
    );
    let text = near(1.75e-3);
    assert!(
        text.contains("right touches the wall sphere at ("),
        "{text}"
    );
}

/// Walls that are given count no multipoles.
#[test]
fn walls_that_are_given_have_no_moments() {
    let folder = tempfile::tempdir().unwrap();
    let given = wires([3.0, 1.0], &json!({"outer": [{"potential_v": 0}]}));
    let totals = last(&run(folder.path(), &given), "/totals");
    assert!(totals.get("electric_charge").is_err());
    assert!(totals.get("electric_force_left_x").is_ok());
}
