//! Scenes of which nothing but the spacing is given: it refines all, and what points far away leave is told.

use serde_json::{Value, json};

use super::{last, run, said};

/// A ball of radius 2.5 mm in open space about its axis, with a permeability and what acts on it.
fn ball(permeability: f64, currents: &Value, points: &Value) -> Value {
    json!({"kind": "emfield.scene", "version": 1, "geometry": "axisymmetric",
        "domain": {"sphere": {"centre_m": [0, 0], "radius_m": 0.0075}},
        "bodies": [{"name": "ball", "shape": {"disc": {"centre_m": [0, 0], "radius_m": 0.0025}},
            "relative_permeability": permeability}],
        "eddy_currents": currents, "points": points,
        "output": {"precision": "f64", "probes": [{"name": "c", "place_m": [0, 0]}]}})
}

fn uniform() -> Value {
    json!({"static": {}, "applied_flux_density_t": [0, 0.01], "outer": "multipole"})
}

/// With spacings that only bodies had it came to 4 % more than there is: 0.02940 T with 0.2 mm, 0.03034 with 0.1.
#[test]
fn a_smaller_spacing_alone_comes_to_the_exact_field() {
    let folder = tempfile::tempdir().unwrap();
    let exact = 0.03 * 100.0 / 102.0;
    let error = |spacing: f64| {
        let (_, text, out) = said(
            folder.path(),
            &ball(100.0, &uniform(), &json!({"spacing_m": spacing})),
        );
        assert!(out.exists(), "{text}");
        let reader = artefact::Reader::open(&out).unwrap();
        let found = last(&reader, "/probes")
            .get("c.magnetic_flux_density_z")
            .unwrap();
        (found / exact - 1.0).abs()
    };
    let [coarse, fine] = [2e-4, 1e-4].map(error);
    assert!(fine < 0.016 && fine < 0.4 * coarse, "{coarse} {fine}");
}

/// Who lets spacings rise by a quarter of the distance, however fine the bodies are, is told what that leaves.
#[test]
fn a_far_field_that_is_off_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let points = json!({"spacing_m": 1e-4, "outward": 0.25});
    let (code, _, out) = said(folder.path(), &ball(100.0, &uniform(), &points));
    assert_eq!(code, 3);
    let record = std::fs::read_to_string(out.with_extension("run.json")).unwrap();
    assert!(
        record.contains("far field: the flux density at bodies is off by about"),
        "{record}"
    );
    // As dense far away as at the body.
    let reader = run(
        folder.path(),
        &ball(
            100.0,
            &uniform(),
            &json!({"spacing_m": 1e-4, "outward": 0.02}),
        ),
    );
    assert!(reader.has("/probes"));
}

/// Above a loop the mean force on a ball in whose currents there is hardly any phase: the sum of the sources' own stress over its
/// surface, which comes to nothing, was a hundred thousand times as large.
#[test]
fn a_weak_force_is_not_lost_among_the_stresses_of_the_sources() {
    let folder = tempfile::tempdir().unwrap();
    let drive = json!({"harmonic": {"frequency_hz": 0.5}, "amplitude": "peak", "outer": "multipole",
        "coils": [{"loop": {"centre_m": [0, -0.0045], "radius_m": 0.004, "current_a": 300}}]});
    let mut scene = ball(1.0, &drive, &json!({"spacing_m": 2e-4}));
    scene["bodies"][0]["conductivity_s_m"] = json!(1e7);
    scene["method"] = json!({"order": 4});
    let totals = last(&run(folder.path(), &scene), "/totals");
    let [volume, maxwell, coil] =
        ["volume", "maxwell", "coil"].map(|way| totals.get(&format!("force_{way}_z")).unwrap());
    assert!(volume > 0.0);
    for other in [maxwell, coil] {
        assert!(
            (other / volume - 1.0).abs() < 0.05,
            "{volume:e} {maxwell:e} {coil:e}"
        );
    }
    let heats =
        ["power_volume", "power_poynting", "power_spread"].map(|name| totals.get(name).unwrap());
    assert!(
        heats[2] < 0.05 * heats[0]
            && (heats[2] - (heats[0] - heats[1]).abs()).abs() < 1e-12 * heats[0]
    );
}
