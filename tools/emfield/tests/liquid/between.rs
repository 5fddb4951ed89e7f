//! Small flows between faces.

use serde_json::{Value, json};

use super::{column, run, said};

/// A square of 10 mm with these faces, for 80 steps at most.
fn square(faces: &Value) -> Value {
    json!({"kind": "emfield.scene", "version": 1, "geometry": "plane",
        "liquid": {"shape": {"box": {"min_m": [0, 0], "max_m": [0.01, 0.01]}}, "faces": faces,
            "density_kg_m3": 1000, "viscosity_pa_s": 1.0, "march": {"end_s": 0.2}},
        "points": {"spacing_m": 1e-3, "jitter": 0.2, "seed": 3}, "output": {"precision": "f64"}})
}

#[test]
fn a_wall_that_slides_draws_the_liquid_along() {
    let folder = tempfile::tempdir().unwrap();
    let faces = json!({"periodic": ["x"],
        "wall": [{"face": "y-"}, {"face": "y+", "velocity_m_s": [0.1, 0]}]});
    let reader = run(folder.path(), &square(&faces));
    let frame = reader
        .frame("/points", reader.count("/points") - 1)
        .unwrap();
    let places = frame.position_vectors().unwrap();
    for (x, u) in places.iter().zip(frame.vectors("velocity").unwrap()) {
        assert!((u[0] - 10.0 * x[1]).abs() < 1e-4, "{x:?} {u:?}");
        assert!(u[1].abs() < 1e-5, "{u:?}");
    }
    // The mean is that over points, of which those on walls have half a place.
    let share = |x: &[f64; 3]| {
        if x[1] % 0.01 == 0.0 { 0.5 } else { 1.0 }
    };
    let whole: f64 = places.iter().map(share).sum();
    let drawn: f64 = places.iter().map(|x| 10.0 * share(x) * x[1]).sum();
    let mean = column(&reader, "velocity_x");
    assert!((mean[mean.len() - 1].1 - drawn / whole).abs() < 1e-5);
}

#[test]
fn a_basin_at_rest_stays_at_rest_and_threads_change_no_byte() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = square(&json!({"mirror": ["x-", "x+"], "wall": [{"face": "y-"}]}));
    scene["liquid"]["gravity_m_s2"] = json!([0, -9.81]);
    scene["liquid"]["surface_tension_n_m"] = json!(0.07);
    scene["liquid"]["march"] = json!({"end_s": 0.01});
    let files = ["1", "2"].map(|threads| {
        let (code, text, out) = said(folder.path(), &scene, threads);
        assert_eq!(code, 0, "{text}");
        std::fs::read(out).unwrap()
    });
    assert!(files[0] == files[1]);
    let reader = run(folder.path(), &scene);
    let frame = reader
        .frame("/points", reader.count("/points") - 1)
        .unwrap();
    let places = frame.position_vectors().unwrap();
    for (x, p) in places.iter().zip(frame.f64("pressure").unwrap()) {
        assert!((p - 9810.0 * (0.01 - x[1])).abs() < 1e-4, "{x:?} {p}");
    }
    for (_, height) in column(&reader, "height") {
        assert!((height - 0.01).abs() < 1e-9);
    }
}

#[test]
fn faces_that_do_not_fit_are_told_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let wall = json!([{"face": "y-"}, {"face": "y+"}]);
    for (faces, path) in [
        (json!({"wall": wall}), "/liquid/faces"),
        (
            json!({"periodic": ["x", "z"], "wall": wall}),
            "/liquid/faces/periodic/1",
        ),
        (
            json!({"periodic": ["x"], "wall": wall, "mirror": ["y+"]}),
            "/liquid/faces/wall/1",
        ),
        (
            json!({"mirror": ["x-"], "wall": [{"face": "x+"}, {"face": "y-"}]}),
            "/liquid/faces/wall/0",
        ),
        (
            json!({"periodic": ["x"], "wall": [{"face": "y-", "velocity_m_s": [0, 1]}, {"face": "y+"}]}),
            "/liquid/faces/wall/0/velocity_m_s",
        ),
    ] {
        let (code, text, _) = said(folder.path(), &square(&faces), "1");
        assert!(code == 2 && text.contains(path), "{path}: {text}");
    }
    let mut scene = square(&json!({"periodic": ["x"], "wall": wall}));
    scene["liquid"]
        .as_object_mut()
        .unwrap()
        .remove("viscosity_pa_s");
    let (code, text, _) = said(folder.path(), &scene, "1");
    assert!(code == 2 && text.contains("/liquid/faces/wall"), "{text}");
}
