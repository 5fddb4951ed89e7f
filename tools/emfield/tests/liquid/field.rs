//! Drops that move in an electric field.

use std::path::Path;

use artefact::Reader;
use serde_json::{Value, json};

use super::{bytes, column, drop, resumed, run, said};

const EPS0: f64 = 8.854_187_812_8e-12;
const TENSION: f64 = 0.072;

/// A drop at rest in a field of eps0 E^2 R/gamma = 0.05 along a direction, for some steps of a tenth of sqrt(rho R^3/gamma).
fn drawn(radius: f64, along: [f64; 3], steps: u32) -> Value {
    let mut scene = drop(radius, 1000.0, TENSION, 0.1);
    let liquid = scene["liquid"].as_object_mut().unwrap();
    liquid.remove("velocity_m_s");
    let field = (0.05 * TENSION / (EPS0 * radius)).sqrt();
    let step = 0.1 * (1000.0 * radius.powi(3) / TENSION).sqrt();
    liquid["march"] = json!({"step_s": step, "end_s": f64::from(steps) * step});
    liquid.insert(
        "viscosity_pa_s".to_owned(),
        json!(0.2 * (1000.0 * TENSION * radius).sqrt()),
    );
    liquid.insert(
        "electric".to_owned(),
        json!({"field_v_m": along.map(|c| c * field), "relative_permittivity": 80}),
    );
    scene
}

/// How far a mode of degree 2 in any direction has come, over the radius.
fn strength(folder: &Path, scene: &Value, radius: f64) -> f64 {
    let reader = run(folder, scene);
    column(&reader, "strength_2").last().unwrap().1 / radius
}

#[test]
fn a_drop_in_a_field_knows_neither_scale_nor_threads() {
    let folder = tempfile::tempdir().unwrap();
    let [one, small, large] = [1e-3, 1e-3 / 20.0, 1e-1].map(|radius| {
        let scene = drawn(radius, [0.0, 0.0, 1.0], 3);
        strength(folder.path(), &scene, radius)
    });
    assert!(one > 1e-3, "{one:e}");
    assert!((small / one - 1.0).abs() < 1e-6, "{small:e} {one:e}");
    assert!((large / one - 1.0).abs() < 1e-6, "{large:e} {one:e}");
    let scene = drawn(1e-3, [0.0, 0.0, 1.0], 2);
    assert!(bytes(folder.path(), &scene, "1") == bytes(folder.path(), &scene, "2"));
}

#[test]
fn a_drop_is_drawn_alike_in_any_direction() {
    let folder = tempfile::tempdir().unwrap();
    let third = 3.0_f64.sqrt().recip();
    let directions = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [third; 3]];
    let [up, aside, between] =
        directions.map(|n| strength(folder.path(), &drawn(1e-3, n, 3), 1e-3));
    assert!((aside / up - 1.0).abs() < 1e-2, "{aside:e} {up:e}");
    assert!((between / up - 1.0).abs() < 1e-2, "{between:e} {up:e}");
}

#[test]
fn no_field_and_a_field_of_nothing_move_a_drop_alike() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = drop(1e-3, 1000.0, TENSION, 0.02);
    let absent = run(folder.path(), &scene);
    let of = |reader: &Reader, name: &str| column(reader, name);
    let names = ["mode_2", "radius_x", "kinetic_energy"];
    let without = names.map(|name| of(&absent, name));
    assert!(!absent.frame("/surface", 0).unwrap().has("traction"));
    scene["liquid"]["electric"] = json!({"field_v_m": [0, 0, 0]});
    let nothing = run(folder.path(), &scene);
    assert_eq!(without, names.map(|name| of(&nothing, name)));
    assert!(nothing.frame("/surface", 0).unwrap().has("traction"));
}

#[test]
fn a_resumed_drop_in_a_field_is_a_straight_one() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = drawn(1e-3, [0.0, 0.0, 1.0], 5);
    // A conductor has two potentials to keep.
    scene["liquid"]["electric"]["relative_permittivity"] = Value::Null;
    let straight = bytes(folder.path(), &scene, "2");
    assert!(straight == resumed(folder.path(), &scene));
}

#[test]
fn fields_that_cannot_act_are_told_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let good = drawn(1e-3, [0.0, 0.0, 1.0], 2);
    for (key, value, path) in [
        ("charge_c", json!(1e-12), "/liquid/electric/charge_c"),
        ("field_v_m", json!([1, 2]), "/liquid/electric/field_v_m"),
        (
            "relative_permittivity",
            json!(0),
            "/liquid/electric/relative_permittivity",
        ),
    ] {
        let mut scene = good.clone();
        scene["liquid"]["electric"][key] = value;
        let (code, text, _) = said(folder.path(), &scene, "1");
        assert!(code == 2 && text.contains(path), "{path}: {text}");
    }
}
