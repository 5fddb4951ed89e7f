//! Bodies of another permeability: what draws them, and what a scene with them cannot have.

use std::f64::consts::PI;

use serde_json::{Value, json};

use super::{last, run, said};

const MU0: f64 = 4e-7 * PI;

/// A bar of radius 1 about the origin beside a wire of 1000 A at distance 3, which hardly changes in time.
fn bar(permeability: f64, spacing: f64) -> Value {
    json!({"kind": "emfield.scene", "version": 1, "geometry": "plane",
        "domain": {"sphere": {"centre_m": [0, 0], "radius_m": 2}},
        "bodies": [{"name": "bar", "relative_permeability": permeability,
            "shape": {"disc": {"centre_m": [0, 0], "radius_m": 1}}}],
        "eddy_currents": {"harmonic": {"frequency_hz": 50}, "outer": "multipole",
            "coils": [{"wire": {"place_m": [3, 0], "current_a": 1e3}}]},
        "method": {"order": 4},
        "points": {"spacing_m": spacing, "layers": {"first_m": 0.5 * spacing}, "outward": 0},
        "output": {"precision": "f64", "enclosures": [
            {"name": "around", "surface": {"around": {"body": "bar", "distance_m": 0.4}}}]}})
}

/// The pull of a wire on a bar of radius R by its images (Jackson 1999, section 5.12, in a plane): `+k I` at `R^2 / d` and
/// `-k I` in the middle, `k = (mu - 1) / (mu + 1)`.
fn pull(permeability: f64) -> f64 {
    let share = (permeability - 1.0) / (permeability + 1.0);
    MU0 * 1e6 / (2.0 * PI) * share * (1.0 / (3.0 - 1.0 / 3.0) - 1.0 / 3.0)
}

#[test]
fn a_wire_draws_iron_and_repels_what_the_field_avoids_as_images_tell() {
    let folder = tempfile::tempdir().unwrap();
    for permeability in [1e4, 5.0, 0.2] {
        let reader = run(folder.path(), &bar(permeability, 0.08));
        let totals = last(&reader, "/totals");
        let wanted = pull(permeability);
        for way in [
            "force_volume_x",
            "force_maxwell_x",
            "force_coil_x",
            "around.force_x",
        ] {
            let found = totals.get(way).unwrap();
            assert!(
                (found / wanted - 1.0).abs() < 5e-3,
                "{permeability} {way} {found} {wanted}"
            );
        }
        // The traction adds up to the force, and nothing conducts.
        let surface = reader.frame("/surface", 0).unwrap();
        let traction = surface.vectors("magnetic_traction").unwrap();
        let area = surface.f64("area").unwrap();
        let sum: f64 = traction.iter().zip(&area).map(|(t, a)| t[0] * a).sum();
        assert!((sum / wanted - 1.0).abs() < 5e-3);
        assert!(
            reader
                .frame("/points", 0)
                .unwrap()
                .vectors("current_density_real")
                .is_err()
        );
    }
}

#[test]
fn where_permeability_is_uniform_there_is_no_traction() {
    let folder = tempfile::tempdir().unwrap();
    let reader = run(folder.path(), &bar(1.0, 0.2));
    let surface = reader.frame("/surface", 0).unwrap();
    assert!(surface.vectors("magnetic_traction").is_err());
    let totals = last(&reader, "/totals");
    assert_eq!(
        totals.get("force_volume_x").unwrap().to_bits(),
        0.0_f64.to_bits()
    );
}

#[test]
fn a_wire_within_iron_is_told_with_its_place_in_the_scene() {
    let mut scene = bar(10.0, 0.2);
    scene["eddy_currents"]["coils"][0]["wire"]["place_m"] = json!([0.5, 0]);
    let folder = tempfile::tempdir().unwrap();
    let (code, said, _) = said(folder.path(), &scene);
    assert_eq!(code, 2);
    assert!(
        said.contains("/eddy_currents/coils/0/wire") && said.contains("bar"),
        "{said}"
    );
}
