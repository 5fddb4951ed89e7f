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

/// A ball of radius 1 and another permeability in a uniform field of 1 T along a direction, which hardly changes in time.
fn ball(permeability: f64, along: [f64; 3], spacing: f64) -> Value {
    json!({"kind": "emfield.scene", "version": 1, "geometry": "space",
        "domain": {"sphere": {"centre_m": [0, 0, 0], "radius_m": 2.5}},
        "bodies": [{"name": "ball", "relative_permeability": permeability,
            "shape": {"sphere": {"centre_m": [0, 0, 0], "radius_m": 1}}}],
        "eddy_currents": {"harmonic": {"frequency_hz": 50}, "outer": "multipole",
            "applied_flux_density_t": along},
        "method": {"order": 4},
        "points": {"spacing_m": spacing, "layers": {"first_m": 0.4 * spacing}},
        "output": {"precision": "f64"}})
}

/// The greatest difference of the flux density within a ball from a uniform one.
fn within(reader: &artefact::Reader, number: usize, column: &str, flux: [f64; 3]) -> f64 {
    let points = reader.frame("/points", number).unwrap();
    let places = points.position_vectors().unwrap();
    let found = points.vectors(column).unwrap();
    let off = found.iter().zip(places).map(|(b, x)| {
        let r = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let off: f64 = (0..3).map(|k| (b[k] - flux[k]).powi(2)).sum();
        if r < 0.999 { off.sqrt() } else { 0.0 }
    });
    off.fold(0.0, f64::max)
}

/// The flux density in a ball in a uniform field is `3 mu / (mu + 2)` times it everywhere (Jackson 1999, section 5.11).
#[test]
fn a_ball_in_space_has_the_same_flux_everywhere() {
    let folder = tempfile::tempdir().unwrap();
    let along = [0.6, 0.0, 0.8];
    for (permeability, bound) in [(200.0, 0.02), (5.0, 0.01), (0.01, 0.02)] {
        let reader = run(folder.path(), &ball(permeability, along, 0.2));
        let size = 3.0 * permeability / (permeability + 2.0);
        let off = within(
            &reader,
            0,
            "magnetic_flux_density_real",
            along.map(|b| size * b),
        );
        assert!(off < bound * size.max(1.0), "{permeability}: {off}");
    }
}

/// Switched on, the field enters a ball that conducts and ends as in one that does not.
#[test]
fn in_time_the_field_settles_in_a_ball_of_iron() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = ball(5.0, [0.0, 0.0, 1.0], 0.25);
    scene["bodies"][0]["conductivity_s_m"] = json!(100);
    let currents = scene["eddy_currents"].as_object_mut().unwrap();
    currents.remove("harmonic");
    currents.insert(
        "transient".to_owned(),
        json!({"end_s": 4e-4, "step_s": 4e-5}),
    );
    let reader = run(folder.path(), &scene);
    let end = reader.count("/points") as usize - 1;
    let flux = [0.0, 0.0, 15.0 / 7.0];
    let off = |number: usize| within(&reader, number, "magnetic_flux_density", flux);
    assert!(off(0) > 1.0 && off(end) < 0.03, "{} {}", off(0), off(end));
}

/// Its heat is that about an axis, whether charges are sought, of which there are none, or not.
#[test]
fn a_hot_iron_ball_in_space_is_that_about_its_axis() {
    let folder = tempfile::tempdir().unwrap();
    let mut space = ball(20.0, [0.0, 0.0, 1.0], 0.2);
    space["bodies"][0]["conductivity_s_m"] = json!(5e3);
    let mut axis = space.clone();
    axis["geometry"] = json!("axisymmetric");
    axis["domain"] = json!({"sphere": {"centre_m": [0, 0], "radius_m": 2.5}});
    axis["bodies"][0]["shape"] = json!({"disc": {"centre_m": [0, 0], "radius_m": 1}});
    axis["eddy_currents"]["applied_flux_density_t"] = json!([0, 1]);
    axis["points"] = json!({"spacing_m": 0.05, "layers": {"first_m": 0.02}});
    let heat = |scene: &Value| {
        let reader = run(folder.path(), scene);
        last(&reader, "/totals").get("power_volume").unwrap()
    };
    let wanted = heat(&axis);
    for potential in ["none", "conductors"] {
        space["eddy_currents"]["potential"] = json!(potential);
        let found = heat(&space);
        assert!(
            (found / wanted - 1.0).abs() < 0.03,
            "{potential}: {found} {wanted}"
        );
    }
}
