//! Scenes that are refused before anything is made for them, in words and in time.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::time::Instant;

use serde_json::{Value, json};

/// Exit code of `check` and what it says on stderr.
fn check(scene: &Value) -> (Option<i32>, String) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.json");
    std::fs::write(&file, serde_json::to_string_pretty(scene).unwrap()).unwrap();
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_emfield"))
        .arg("check")
        .arg(&file)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), said)
}

/// A ball between walls as far as `high` \[m\].
fn ball(high: f64) -> Value {
    json!({"kind": "emfield.scene", "version": 1, "geometry": "space",
        "domain": {"box": {"min_m": [-5e-4, -5e-4, -5e-4], "max_m": [5e-4, high, 5e-4]}},
        "bodies": [{"name": "ball", "relative_permittivity": 80,
            "shape": {"sphere": {"centre_m": [0, 0, 0], "radius_m": 5e-5}}}],
        "electrostatics": {"outer": [{"potential_v": {"expr": "z"}}]},
        "points": {"spacing_m": 5e-6}, "method": {"order": 4}})
}

fn iron(middle: f64) -> Value {
    json!({"kind": "emfield.scene", "version": 1, "geometry": "plane",
        "domain": {"sphere": {"centre_m": [0, 0], "radius_m": 0.02}},
        "bodies": [{"name": "iron", "shape": {"disc": {"centre_m": [middle, 0], "radius_m": 0.01}},
            "relative_permeability": {"expr": "1/(1 - 0.999/(1 + (B/2)^8)^0.125)"}}],
        "eddy_currents": {"static": {}, "applied_flux_density_t": [0.9, 0.4, 0], "outer": "multipole"},
        "points": {"spacing_m": 0.001}})
}

/// It took all memory, or overflowed.
#[test]
fn a_liquid_between_faces_is_at_least_a_spacing_wide() {
    let layer = |width: f64, spacing: f64| {
        json!({"kind": "emfield.scene", "version": 1, "geometry": "plane",
            "liquid": {"shape": {"box": {"min_m": [0, 0], "max_m": [width, 0.01]}},
                "faces": {"periodic": ["x"], "wall": [{"face": "y-"}, {"face": "y+"}]},
                "density_kg_m3": 1000, "viscosity_pa_s": 0.01, "march": {"end_s": 0.01}},
            "points": {"spacing_m": spacing}})
    };
    for (width, spacing) in [(1e-300, 5e-4), (0.01, 5e8), (4e-4, 5e-4), (0.01, 1e-12)] {
        let (code, said) = check(&layer(width, spacing));
        assert_eq!(code, Some(2), "{width} {spacing}: {said}");
        assert!(
            said.contains("/points/spacing_m") && !said.contains("panic"),
            "{said}"
        );
    }
    let (code, said) = check(&layer(6e-4, 5e-4));
    assert_eq!(code, Some(0), "{said}");
}

/// It took all memory, or overflowed.
#[test]
fn domains_of_any_size_are_refused_by_their_number_of_points() {
    for high in [1e3, 1e12, 1e300] {
        let began = Instant::now();
        let (code, said) = check(&ball(high));
        assert_eq!(code, Some(2), "{high}: {said}");
        let told = ["/domain: ", "/points/spacing_m: "]
            .iter()
            .any(|at| said.contains(at));
        assert!(
            told && said.contains("scene.json:") && !said.contains("panic"),
            "{said}"
        );
        assert!(began.elapsed().as_secs_f64() < 8.0, "{high}");
    }
    let mut vast = ball(5e-4);
    vast["bodies"][0]["shape"]["sphere"]["radius_m"] = json!(1e300);
    let (code, said) = check(&vast);
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("/bodies/0/shape: ") && !said.contains("panic"),
        "{said}"
    );
    let (code, said) = check(&ball(5e-4));
    assert_eq!(code, Some(0), "{said}");
}

/// A long domain has its points counted, and what `check` knows is told in time.
#[test]
fn a_check_of_many_points_ends_in_time() {
    let began = Instant::now();
    let (code, said) = check(&ball(1.0));
    assert!(matches!(code, Some(0 | 3)), "{said}");
    // 2 s of work; by the clock more where other work is done.
    assert!(began.elapsed().as_secs_f64() < 70.0);
}

/// It panicked at the first point that iron does not have, and `check` did not tell.
#[test]
fn a_body_that_lies_outside_is_refused() {
    let (code, said) = check(&iron(1.0));
    assert!(
        code == Some(2) && said.contains("/bodies/0/shape: no part of"),
        "{said}"
    );
    assert_eq!(check(&iron(0.0)).0, Some(0));
}

/// It panicked at the third number.
#[test]
fn a_field_of_two_numbers_is_refused_where_three_are_wanted() {
    let mut scene = iron(0.0);
    scene["eddy_currents"]["applied_flux_density_t"] = json!([0, 1]);
    let (code, said) = check(&scene);
    assert!(
        code == Some(2) && said.contains("/eddy_currents/applied_flux_density_t: 2 numbers; 3"),
        "{said}"
    );
}
