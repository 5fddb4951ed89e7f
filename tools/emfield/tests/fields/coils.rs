//! Coils that are regions of points: their fields, what they do to conductors, faults where they stand.

use std::f64::consts::PI;

use serde_json::{Value, json};

use super::{driven, last, run, said};

/// A bar of radius 0.5 that carries 1000 A along z.
fn bar(spacing: f64) -> Value {
    json!({"kind": "emfield.scene", "version": 1, "geometry": "plane",
        "domain": {"box": {"min_m": [-3, -3], "max_m": [3, 3]}},
        "bodies": [{"name": "bar", "shape": {"disc": {"centre_m": [0.2, 0], "radius_m": 0.5}}}],
        "eddy_currents": {"harmonic": {"frequency_hz": 50}, "outer": "multipole",
            "coils": [{"region": {"body": "bar", "current_a": 1e3, "phase_deg": 90}}]},
        "method": {"order": 4}, "points": {"spacing_m": spacing, "outward": spacing},
        "output": {"precision": "f64", "probes": [
            {"name": "in", "place_m": [0.4, 0]}, {"name": "out", "place_m": [1.7, 0]}]}})
}

#[test]
fn a_bar_has_the_field_of_ampere_within_and_without() {
    let folder = tempfile::tempdir().unwrap();
    let errors = [0.1, 0.05].map(|spacing| {
        let reader = run(folder.path(), &bar(spacing));
        let probes = last(&reader, "/probes");
        let b = |name: &str| {
            let get = |part: &str| {
                probes
                    .get(&format!("{name}.magnetic_flux_density_{part}_y"))
                    .unwrap()
            };
            assert!(get("real").abs() < 1e-6 * get("imag"));
            get("imag")
        };
        // mu0 I r / (2 pi a^2), mu0 I / (2 pi r).
        let inside = (b("in") / (2e-4 * 0.2 / 0.25) - 1.0).abs();
        let outside = (b("out") / (2e-4 / 1.5) - 1.0).abs();
        inside.max(outside)
    });
    assert!(errors[0] < 5e-3 && errors[1] < 5e-4, "{errors:?}");
}

#[test]
fn the_current_of_a_coil_is_written_and_nothing_of_conductors() {
    let folder = tempfile::tempdir().unwrap();
    let reader = run(folder.path(), &bar(0.1));
    let frame = reader.frame("/points", 0).unwrap();
    let places = frame.position_vectors().unwrap();
    let current = frame.vectors("current_density_imag").unwrap();
    let density = 1e3 / (PI * 0.25);
    for (p, j) in places.iter().zip(current) {
        let away = (p[0] - 0.2).hypot(p[1]);
        let wanted = if away < 0.5 + 1e-9 { density } else { 0.0 };
        assert!((j[2] - wanted).abs() < 1e-3 * density, "{p:?} {j:?}");
    }
    let totals = last(&reader, "/totals");
    assert!(totals.get("power_volume").unwrap().abs() < 1e-30);
    assert!(totals.get("force_volume_x").unwrap().abs() < 1e-30);
    // Without coils of points there is no such column.
    let mut scene = bar(0.1);
    scene["eddy_currents"]["coils"] = json!([{"wire": {"place_m": [0.2, 0], "current_a": 1e3}}]);
    let frame = run(folder.path(), &scene).frame("/points", 0).unwrap();
    assert!(!frame.has("current_density_real_z"));
}

/// A conducting ball of radius 1 above a ring of wire of radius 0.3, as points or as an exact source.
fn lifted(points: bool, drive: &Value) -> Value {
    let mut scene = json!({"kind": "emfield.scene", "version": 1, "geometry": "axisymmetric",
        "domain": {"sphere": {"centre_m": [0, 0], "radius_m": 5}},
        "bodies": [{"name": "ball", "shape": {"disc": {"centre_m": [0, 0], "radius_m": 1}},
            "conductivity_s_m": 1e6}],
        "eddy_currents": {"outer": "multipole",
            "coils": [{"loop": {"centre_m": [0, -1.8], "radius_m": 1.2, "wire_radius_m": 0.3, "current_a": 1e3}}]},
        "method": {"order": 4}, "points": {"spacing_m": 0.07, "layers": {"first_m": 0.035}, "outward": 0.05},
        "output": {"precision": "f64",
            "enclosures": [{"name": "near", "surface": {"around": {"body": "ball", "distance_m": 0.2}}}]}});
    if points {
        let bodies = scene["bodies"].as_array_mut().unwrap();
        bodies.push(
            json!({"name": "ring", "spacing_m": 0.05, "shape": {"disc": {"centre_m": [1.2, -1.8], "radius_m": 0.3}}}),
        );
        scene["eddy_currents"]["coils"] =
            json!([{"region": {"body": "ring", "current_a": 500, "turns": 2}}]);
    }
    driven(scene, drive)
}

#[test]
fn a_coil_of_points_lifts_as_its_exact_field_does() {
    let folder = tempfile::tempdir().unwrap();
    let steady = json!({"harmonic": {"frequency_hz": 5.066}});
    let [source, points] =
        [false, true].map(|points| last(&run(folder.path(), &lifted(points, &steady)), "/totals"));
    let wanted = source.get("near.force_z").unwrap();
    for name in [
        "force_volume_z",
        "force_maxwell_z",
        "force_coil_z",
        "near.force_z",
    ] {
        let found = points.get(name).unwrap();
        assert!(
            (found / wanted - 1.0).abs() < 1e-2,
            "{name}: {found} {wanted}"
        );
    }
    let [a, b] = [&source, &points].map(|t| t.get("near.power").unwrap());
    assert!((b / a - 1.0).abs() < 5e-3, "{b} {a}");
}

#[test]
fn a_march_follows_the_wave_of_a_coil_of_points() {
    let folder = tempfile::tempdir().unwrap();
    let march =
        json!({"transient": {"end_s": 0.05, "step_s": 0.005, "wave": {"expr": "1 + 10*t"}}});
    let [source, points] =
        [false, true].map(|points| last(&run(folder.path(), &lifted(points, &march)), "/totals"));
    for name in [
        "force_volume_z",
        "force_coil_z",
        "near.force_z",
        "power_volume",
    ] {
        let [a, b] = [&source, &points].map(|t| t.get(name).unwrap());
        assert!((b / a - 1.0).abs() < 1e-2, "{name}: {b} {a}");
    }
}

/// A ring of square section about z in space, beside which a ball may stand.
fn ring(spacing: f64) -> Value {
    let bar = |radius: f64| json!({"cylinder": {"centre_m": [0, 0, 0], "radius_m": radius, "length_m": 0.8}});
    json!({"kind": "emfield.scene", "version": 1, "geometry": "space",
        "domain": {"sphere": {"centre_m": [0, 0, 0], "radius_m": 3.5}},
        "bodies": [{"name": "ring", "shape": {"difference": [bar(1.4), bar(0.6)]}}],
        "eddy_currents": {"harmonic": {"frequency_hz": 50}, "outer": "multipole",
            "coils": [{"region": {"body": "ring", "current_a": 1e3,
                "axis": {"centre_m": [0, 0, 0], "normal": [0, 0, -2]}}}]},
        "points": {"spacing_m": spacing, "outward": 0.15},
        "output": {"precision": "f64", "probes": [{"name": "far", "place_m": [0, 0, 2]}]}})
}

#[test]
fn a_ring_in_space_has_the_field_of_its_loops() {
    let folder = tempfile::tempdir().unwrap();
    // Loops over the section.
    let mut exact = 0.0;
    let at = |k: u32| 0.4 * ((f64::from(k) + 0.5) / 10.0 - 1.0);
    for (i, j) in (0..20).flat_map(|i| (0..20).map(move |j| (i, j))) {
        let (r, z) = (1.0 + at(i), 2.0 - at(j));
        exact -= 2e-4 * PI * r * r / (r * r + z * z).powf(1.5) / 400.0;
    }
    let errors = [0.2, 0.1].map(|spacing| {
        let probes = last(&run(folder.path(), &ring(spacing)), "/probes");
        (probes.get("far.magnetic_flux_density_real_z").unwrap() / exact - 1.0).abs()
    });
    // At its edges of second order, and so far from all.
    assert!(
        errors[1] < 0.05 && errors[1] < 0.4 * errors[0],
        "{errors:?}"
    );
}

#[test]
fn faults_are_located() {
    let folder = tempfile::tempdir().unwrap();
    let fault = |scene: &Value, at: &str, what: &str| {
        let (code, text, _) = said(folder.path(), scene);
        assert_eq!(code, 2, "{text}");
        assert!(text.contains(at) && text.contains(what), "{text}");
    };
    let at = "/eddy_currents/coils/0/region";
    let mut scene = ring(0.2);
    scene["bodies"][0]["shape"] =
        json!({"cylinder": {"centre_m": [0, 0, 0], "radius_m": 1, "length_m": 1}});
    fault(&scene, at, "the axis goes through the coil");
    let mut scene = ring(0.2);
    scene["bodies"][0]["conductivity_s_m"] = json!(1e6);
    fault(&scene, &format!("{at}/body"), "ring conducts");
    let mut scene = ring(0.2);
    scene["eddy_currents"]["coils"][0]["region"]["axis"] = Value::Null;
    fault(&scene, &format!("{at}/axis"), "an axis is wanted");
    let mut scene = bar(0.1);
    scene["eddy_currents"]["coils"][0]["region"]["body"] = json!("bear");
    fault(
        &scene,
        &format!("{at}/body"),
        "\"bear\" is no body; bodies are bar",
    );
    let mut scene = bar(0.1);
    scene["bodies"][0]["shape"]["disc"]["centre_m"] = json!([2.8, 0]);
    fault(&scene, at, "bar leaves the domain");
    let mut scene = bar(0.1);
    let stone =
        json!({"name": "stone", "shape": {"disc": {"centre_m": [0.2, 0.4], "radius_m": 0.3}}});
    scene["bodies"].as_array_mut().unwrap().insert(0, stone);
    fault(&scene, at, "stone cuts bar");
    scene["bodies"][0]["shape"]["disc"] = json!({"centre_m": [0.2, 0], "radius_m": 0.2});
    fault(&scene, at, "stone lies in bar");
    let mut scene = lifted(true, &json!({"harmonic": {"frequency_hz": 5.066}}));
    scene["output"]["enclosures"][0]["surface"]["around"]["body"] = json!("ring");
    fault(&scene, "/output/enclosures/0", "encloses or cuts a coil");
    // What is exact in vacuum is not where anything else surrounds the coils.
    let mut scene = lifted(false, &json!({"harmonic": {"frequency_hz": 5}}));
    scene["surroundings"] = json!({"relative_permeability": 2});
    let at = "/surroundings/relative_permeability";
    fault(&scene, at, "have the field that they have in vacuum");
}
