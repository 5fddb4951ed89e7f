//! Closed surfaces around bodies: forces that are known, faults where they stand, nothing where none is asked for.

use serde_json::{Value, json};

use super::{driven, last, run, said};

fn around(name: &str, distance_m: f64) -> Value {
    json!({"name": name, "surface": {"around": {"body": "ball", "distance_m": distance_m}}})
}

/// A dielectric ball of radius 1 in `- z - (z^2 - (x^2 + y^2) / 2) / 4`, with its own field on the walls.
fn pulled(ratio: f64) -> Value {
    let [first, second] = [
        (ratio - 1.0) / (ratio + 2.0),
        2.0 * (ratio - 1.0) / (2.0 * ratio + 3.0),
    ];
    let square = "(x^2 + y^2 + z^2)";
    let expr = format!(
        "-z*(1 - {first}/{square}^1.5) - 0.25*(z^2 - 0.5*(x^2 + y^2))*(1 - {second}/{square}^2.5)"
    );
    json!({"kind": "emfield.scene", "version": 1, "geometry": "space",
        "domain": {"box": {"min_m": [-4, -4, -4], "max_m": [4, 4, 4]}},
        "bodies": [{"name": "ball", "shape": {"sphere": {"centre_m": [0, 0, 0], "radius_m": 1}},
            "relative_permittivity": ratio}],
        "electrostatics": {"outer": [{"potential_v": {"expr": expr}}]},
        "method": {"order": 4}, "points": {"spacing_m": 0.2},
        "output": {"precision": "f64", "enclosures": [around("near", 0.4), around("far", 1.2)]}})
}

#[test]
fn a_dielectric_ball_is_pulled_as_its_dipole_is() {
    let folder = tempfile::tempdir().unwrap();
    for ratio in [4.0, 0.25] {
        // F = 4 pi eps0 R^3 (S - 1)/(S + 2) E dE/dz.
        let exact =
            4.0 * std::f64::consts::PI * 8.854_187_812_8e-12 * (ratio - 1.0) / (ratio + 2.0) * 0.5;
        let totals = last(&run(folder.path(), &pulled(ratio)), "/totals");
        for name in ["near", "far"] {
            let force = |axis: &str| {
                totals
                    .get(&format!("{name}.electric_force_{axis}"))
                    .unwrap()
            };
            let error = (force("z") / exact - 1.0).abs();
            assert!(error < 5e-3, "{ratio} {name}: {error:e}");
            assert!(force("x").abs().max(force("y").abs()) < 1e-3 * exact.abs());
            let own = totals.get("electric_force_ball_z").unwrap();
            let spread = totals
                .get(&format!("{name}.electric_force_spread"))
                .unwrap();
            assert!(spread >= (force("z") - own).abs() * (1.0 - 1e-9));
        }
    }
}

#[test]
fn a_uniform_field_pulls_at_nothing_even_by_a_box_askew() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = pulled(4.0);
    scene["electrostatics"] = json!({"applied_field_v_m": [1, 2, 3]});
    scene["bodies"][0]["relative_permittivity"] = json!(1);
    scene["output"]["enclosures"] = json!([{"name": "box", "spacing_m": 0.5, "surface": {"shape":
        {"turned": {"angle_deg": 20, "shape": {"box": {"min_m": [-1.5, -1.4, -1.3], "max_m": [1.4, 1.6, 1.7]}}}}}}]);
    let totals = last(&run(folder.path(), &scene), "/totals");
    for axis in ["x", "y", "z"] {
        let force = totals.get(&format!("box.electric_force_{axis}")).unwrap();
        assert!(force.abs() < 1e-16, "{force:e}");
    }
}

#[test]
fn what_no_surface_is_asked_for_is_the_same_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let with = run(folder.path(), &pulled(4.0));
    let (with, totals) = (with.frame("/points", 0).unwrap(), last(&with, "/totals"));
    let mut scene = pulled(4.0);
    scene["output"]["enclosures"] = json!([]);
    let without = run(folder.path(), &scene);
    let left = last(&without, "/totals");
    assert!(left.values.iter().all(|v| !v.name.contains('.')));
    assert_eq!(left.values.len() + 8, totals.values.len());
    for value in &left.values {
        let other = totals.get(&value.name).unwrap();
        assert_eq!(value.value.to_bits(), other.to_bits(), "{}", value.name);
    }
    let frame = without.frame("/points", 0).unwrap();
    for name in ["potential", "electric_field_z"] {
        assert_eq!(frame.f64(name).unwrap(), with.f64(name).unwrap());
    }
}

/// A conducting ball of radius 1 below which a loop carries a current, about its axis; `mu sigma w R^2` is 40.
fn lifted(drive: &Value) -> Value {
    let scene = json!({"kind": "emfield.scene", "version": 1, "geometry": "axisymmetric",
        "domain": {"sphere": {"centre_m": [0, 0], "radius_m": 4}},
        "bodies": [{"name": "ball", "shape": {"disc": {"centre_m": [0, 0], "radius_m": 1}},
            "conductivity_s_m": 1e6}],
        "eddy_currents": {"outer": "multipole",
            "coils": [{"loop": {"centre_m": [0, -1.8], "radius_m": 1.2, "current_a": 1e3}}]},
        "method": {"order": 4}, "points": {"spacing_m": 0.1, "layers": {"first_m": 0.05}, "outward": 0},
        "output": {"precision": "f64", "enclosures": [around("near", 0.2), around("far", 0.6)]}});
    driven(scene, drive)
}

#[test]
fn a_ball_above_a_loop_is_lifted_by_what_any_surface_says() {
    let folder = tempfile::tempdir().unwrap();
    let scene = lifted(&json!({"harmonic": {"frequency_hz": 5.066}}));
    let totals = last(&run(folder.path(), &scene), "/totals");
    let get = |name: &str| totals.get(name).unwrap();
    let (coil, heat) = (get("force_coil_z"), get("power_volume"));
    assert!(coil > 0.0 && heat > 0.0);
    for name in ["near", "far"] {
        let force = get(&format!("{name}.force_z"));
        assert!((force / coil - 1.0).abs() < 3e-3, "{name}: {force} {coil}");
        let spread = get(&format!("{name}.force_spread"));
        assert!(spread >= (force - coil).abs() && spread < 1e-2 * coil);
        let power = get(&format!("{name}.power"));
        assert!((power / heat - 1.0).abs() < 5e-3, "{name}: {power} {heat}");
    }
    assert!(totals.get("near.force_x").is_err());
}

#[test]
fn a_march_says_the_force_at_each_instant() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = lifted(&json!({"transient": {"end_s": 0.05, "step_s": 0.0025}}));
    scene["output"]["at_s"] = json!([0.01]);
    let reader = run(folder.path(), &scene);
    assert_eq!(reader.count("/totals"), 3);
    for instant in 1..3 {
        let totals = reader.record_at("/totals", instant).unwrap();
        let coil = totals.get("force_coil_z").unwrap();
        let force = totals.get("near.force_z").unwrap();
        assert!(
            coil > 0.0 && (force / coil - 1.0).abs() < 0.02,
            "{force} {coil}"
        );
        // Some of the power makes the field within.
        assert!(totals.get("near.power").is_err());
    }
}

#[test]
fn faults_are_located() {
    let folder = tempfile::tempdir().unwrap();
    let fault = |surface: Value| {
        let mut scene = lifted(&json!({"harmonic": {"frequency_hz": 5.066}}));
        scene["output"]["enclosures"] = json!([{"name": "e", "surface": surface}]);
        let (code, text, _) = said(folder.path(), &scene);
        assert_eq!(code, 2, "{text}");
        assert!(text.contains("/output/enclosures/0"), "{text}");
        text
    };
    let disc =
        |z: f64, radius: f64| json!({"shape": {"disc": {"centre_m": [0, z], "radius_m": radius}}});
    for (surface, what) in [
        (disc(0.0, 5.0), "leaves the domain"),
        (disc(0.5, 1.2), "cuts ball"),
        (disc(0.0, 0.5), "lies in ball, which conducts"),
        (disc(2.5, 0.5), "encloses nothing"),
        (disc(0.0, 3.0), "encloses or cuts a coil"),
        (
            json!({"shape": {"half_space": {"point_m": [0, 2], "normal": [0, 1]}}}),
            "has no end",
        ),
        (
            json!({"around": {"body": "bell", "distance_m": 0.1}}),
            "\"bell\" is no body; bodies are ball",
        ),
    ] {
        let text = fault(surface);
        assert!(text.contains(what), "{text}");
    }
}
