//! Ways to solve the equations of a scene.

use serde_json::{Value, json};

use super::{last, run, said};

/// A ball of permittivity 80 between plates.
fn ball(way: &str) -> Value {
    json!({"kind": "emfield.scene", "version": 1, "geometry": "space",
        "domain": {"box": {"min_m": [-2, -2, -2], "max_m": [2, 2, 2]}},
        "bodies": [{"name": "ball", "relative_permittivity": 80,
            "shape": {"sphere": {"centre_m": [0, 0, 0], "radius_m": 1}}}],
        "electrostatics": {"outer": [{"potential_v": {"expr": "z"}}]},
        "points": {"spacing_m": 0.25}, "solver": {"way": way},
        "output": {"precision": "f64"}})
}

#[test]
fn every_way_finds_the_same_potential() {
    let folder = tempfile::tempdir().unwrap();
    let found = |way: &str| {
        let reader = run(folder.path(), &ball(way));
        let frame = reader.frame("/points", 0).unwrap();
        frame.f64("potential").unwrap()
    };
    let wanted = found("direct");
    for way in ["auto", "iterative", "ilu0", "ilut"] {
        let far = found(way)
            .iter()
            .zip(&wanted)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        assert!(far < 1e-6, "{way}: {far}");
    }
}

#[test]
fn incomplete_factors_are_refused_where_parts_are_solved_for() {
    let mut scene = ball("ilu0");
    let body = scene["bodies"][0].as_object_mut().unwrap();
    body.insert("conductivity_s_m".to_owned(), json!(1e6));
    scene.as_object_mut().unwrap().remove("electrostatics");
    scene["eddy_currents"] =
        json!({"harmonic": {"frequency_hz": 1}, "applied_flux_density_t": [0, 0, 1]});
    let folder = tempfile::tempdir().unwrap();
    let (code, text, _) = said(folder.path(), &scene);
    assert!(code == 2 && text.contains("/solver/way"), "{text}");
    scene["eddy_currents"]["potential"] = json!("none");
    let reader = run(folder.path(), &scene);
    assert!(last(&reader, "/totals").get("power_volume").unwrap() > 0.0);
}
