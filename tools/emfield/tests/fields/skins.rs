//! Skins that points do not resolve: told across the surface, over the reach of stencils, and along it.

use serde_json::{Value, json};

use super::said;

/// Exit code and warnings of a conductor in a field.
fn told(scene: &Value) -> (i32, String) {
    let folder = tempfile::tempdir().unwrap();
    let (code, _, out) = said(folder.path(), scene);
    let record = std::fs::read(out.with_extension("run.json")).unwrap();
    let record: Value = serde_json::from_slice(&record).unwrap();
    (code, record["warnings"].to_string())
}

/// A drop of radius 2.5 mm above a loop, its skin 0.16 mm deep at 1 MHz.
fn drop(first: f64) -> Value {
    json!({"kind": "emfield.scene", "version": 1, "geometry": "axisymmetric",
        "domain": {"sphere": {"centre_m": [0, 0], "radius_m": 0.005}},
        "bodies": [{"name": "drop", "conductivity_s_m": 1e7,
            "shape": {"disc": {"centre_m": [0, 0], "radius_m": 0.0025}}}],
        "eddy_currents": {"harmonic": {"frequency_hz": 1e6}, "outer": "multipole",
            "coils": [{"loop": {"centre_m": [0, -0.006], "radius_m": 0.005, "current_a": 200}}]},
        "points": {"spacing_m": 2e-4, "layers": {"first_m": first}}})
}

/// Layers of three quarters of the skin depth give heats that are 12 % apart.
#[test]
fn stencils_deeper_than_the_skin_are_told() {
    let (code, said) = told(&drop(1.2e-4));
    assert!(
        code == 3 && said.contains("of which polynomials follow"),
        "{code} {said}"
    );
    let (code, said) = told(&drop(4e-5));
    assert!(code == 0 && !said.contains("unresolved"), "{code} {said}");
}

/// A cylinder of radius 0.1 m whose skin is 3.8 mm deep.
fn cylinder(spacing: f64, first: f64) -> Value {
    json!({"kind": "emfield.scene", "version": 1, "geometry": "plane",
        "domain": {"sphere": {"centre_m": [0, 0], "radius_m": 0.1}},
        "surroundings": {"conductivity_s_m": 7.7e6},
        "eddy_currents": {"harmonic": {"frequency_hz": 2300}, "applied_flux_density_t": [0, 0, 1.2566370614359173e-6]},
        "points": {"spacing_m": spacing, "wall_layers": {"first_m": first}}, "method": {"order": 4}})
}

/// Points twice as wide as the skin is deep: with the first layer thinned the heat is 15 % off.
#[test]
fn a_surface_that_bends_within_a_stencil_is_told() {
    let (code, said) = told(&cylinder(0.0072, 0.0018));
    assert!(
        code == 3 && said.contains("along its surface"),
        "{code} {said}"
    );
    let (code, said) = told(&cylinder(0.0036, 0.0018));
    assert_eq!(code, 0, "{said}");
}
