//! Heat that is narrower than the spacing of points.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::process::Command;

use serde_json::{Value, json};

/// What `more` in the scene of a plate stores in 1 s \[J/m\].
fn stored(points: &Value, more: &Value) -> f64 {
    let mut scene = json!({
        "kind": "heatsph.scene", "version": 1, "dimensions": 2,
        "body": {"box": {"min_m": [0, 0], "max_m": [0.2, 0.1]}}, "points": points,
        "materials": [{"name": "steel", "density_kg_m3": 7800, "specific_heat_j_kg_k": 500, "conductivity_w_m_k": 40}],
        "initial_temperature_k": 300, "time": {"end_s": 1}
    });
    scene
        .as_object_mut()
        .unwrap()
        .extend(more.as_object().unwrap().clone());
    let folder = tempfile::tempdir().unwrap();
    let [path, out] = ["scene.json", "out.mcap"].map(|name| folder.path().join(name));
    std::fs::write(&path, scene.to_string()).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_heatsph"))
        .arg("run")
        .arg(&path)
        .arg("--out")
        .arg(&out)
        .args(["--progress", "none", "--threads", "1"])
        .output()
        .unwrap();
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let text = std::fs::read_to_string(out.with_extension("run.json")).unwrap();
    let record: Value = serde_json::from_str(&text).unwrap();
    let rows = record["closing"].as_array().unwrap();
    let row = rows
        .iter()
        .find(|row| row["name"] == "heat_stored")
        .unwrap();
    row["value"].as_f64().unwrap()
}

#[test]
fn a_spot_on_a_face_and_a_source_within_keep_their_power() {
    let [plain, shifted] = [
        json!({"spacing_m": 0.01}),
        json!({"spacing_m": 0.01, "jitter": 0.3}),
    ];
    for points in [plain, shifted] {
        for width in [2e-3, 1e-4] {
            for x in [0.1, 0.095, 0.1037] {
                let spot = json!({"expr": format!("1e8*exp(-((x - {x})/{width})^2)")});
                let heat = stored(
                    &points,
                    &json!({"boundaries": [{"on": ["y+"], "heat_flux_w_m2": spot}]}),
                );
                let exact = 1e8 * width * std::f64::consts::PI.sqrt();
                assert!(
                    (heat / exact - 1.0).abs() < 0.01,
                    "spot {width} at {x}: {heat} of {exact}"
                );
                let spot = format!("1e10*exp(-((x - {x})^2 + (y - 0.043)^2)/{width}^2)");
                let heat = stored(&points, &json!({"source_w_m3": {"expr": spot}}));
                let exact = 1e10 * width * width * std::f64::consts::PI;
                assert!(
                    (heat / exact - 1.0).abs() < 0.01,
                    "source {width} at {x}: {heat} of {exact}"
                );
            }
        }
    }
}

#[test]
fn a_torch_narrower_than_the_spacing_keeps_its_power_as_it_moves() {
    let width = 2e-4;
    let torch = format!("1e9*exp(-((x - 0.05 - t)^2 + (y - 0.0437)^2)/{width}^2)");
    let exact = 1e9 * width * width * std::f64::consts::PI * 0.02;
    let [plain, shifted] = [
        json!({"spacing_m": 0.01}),
        json!({"spacing_m": 0.01, "jitter": 0.3}),
    ];
    // Two spacings on its way.
    for (points, march) in [
        (&plain, json!({"implicit": {"tolerance": 1e-2}})),
        (&plain, json!({"implicit": {"step_s": 1e-3}})),
        (&plain, json!({"stabilised": {"tolerance": 1e-2}})),
        (&plain, json!({"explicit": {"step_s": 1e-3}})),
        (&shifted, json!({"stabilised": {"step_s": 1e-3}})),
    ] {
        let mut time = json!({"end_s": 0.02});
        let keys = time.as_object_mut().unwrap();
        keys.extend(march.as_object().unwrap().clone());
        let more = json!({"source_w_m3": {"expr": torch}, "time": time});
        let heat = stored(points, &more);
        assert!(
            (heat / exact - 1.0).abs() < 0.01,
            "{time}: {heat} of {exact}"
        );
    }
}

/// Power of a source in a plate whose first temperature is a formula \[W/m\].
fn power(points: &Value, source: &str, temperature: &str) -> f64 {
    let scene = json!({
        "dimensions": 2, "body": {"box": {"min_m": [0, 0], "max_m": [0.2, 0.1]}}, "points": points,
        "materials": [{"name": "m", "density_kg_m3": 7800, "specific_heat_j_kg_k": 500, "conductivity_w_m_k": 40}],
        "initial_temperature_k": {"expr": temperature}, "source_w_m3": {"expr": source}, "time": {"end_s": 1}
    });
    let scene = serde_json::from_value(scene).unwrap();
    let (system, first) = heatsph::assemble::system(&scene).unwrap();
    let mut rates = heatsph::system::Rates::default();
    system.rates(0.0, &first, &mut rates).unwrap();
    assert!(!rates.hidden);
    rates.source
}

#[test]
fn a_zone_of_temperature_narrower_than_the_spacing_keeps_its_power() {
    // 20 K from point to point, and a source of some kelvin about 500 K: where T = 500 K a band that is 0.1 m long.
    for points in [
        json!({"spacing_m": 0.01}),
        json!({"spacing_m": 0.01, "jitter": 0.2}),
    ] {
        for temperature in [
            "303 + 2000*x",
            "303 + 2000*(x + 0.5*y)",
            "298 + 2000*(x - 0.3*y)",
        ] {
            for width in [2.0, 0.2] {
                let source = format!("1e8*exp(-((T - 500)/{width})^2)");
                let exact = 1e8 * width * std::f64::consts::PI.sqrt() / 2000.0 * 0.1;
                let found = power(&points, &source, temperature);
                assert!(
                    (found / exact - 1.0).abs() < 0.01,
                    "{temperature} {width}: {found} of {exact}"
                );
            }
        }
    }
    // Both at once: a spot that is hot only in a part of it.
    let spot = "1e8*exp(-((y - 0.0437)/1e-3)^2)*exp(-((T - 500)/2)^2)";
    let exact = 1e8 * 1e-3 * 2.0 * std::f64::consts::PI / 2000.0;
    for points in [
        json!({"spacing_m": 0.01}),
        json!({"spacing_m": 0.01, "jitter": 0.2}),
    ] {
        let found = power(&points, spot, "303 + 2000*x");
        assert!((found / exact - 1.0).abs() < 0.01, "{found} of {exact}");
    }
}

#[test]
fn a_flux_within_a_shape_has_the_area_of_the_shape() {
    let flux = |x: f64, half: f64| {
        let within = json!({"box": {"min_m": [x - half, 0], "max_m": [x + half, 0.2]}});
        json!({"boundaries": [{"on": ["y+"], "heat_flux_w_m2": 1e5, "within": within}]})
    };
    // Around a patch's middle, around its edge, and as wide as one and a half patches.
    for (x, half) in [(0.1, 2e-3), (0.095, 2e-3), (0.0963, 4e-3), (0.1, 7.5e-3)] {
        let heat = stored(&json!({"spacing_m": 0.01}), &flux(x, half));
        let exact = 1e5 * 2.0 * half;
        assert!(
            (heat / exact - 1.0).abs() < 0.04,
            "{half} at {x}: {heat} of {exact}"
        );
    }
}
