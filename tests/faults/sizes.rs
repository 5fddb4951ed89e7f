//! Sizes that no machine holds: refused with place, number and a way out, before anything is made.

use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::workplace::{Place, header, root, tell};

/// A refusal allocates nothing to speak of: it must come at once.
const AT_ONCE: Duration = Duration::from_secs(5);

/// What `check` says to a scene of the pipelines with a patch; it must be refused, at once.
#[track_caller]
fn refused(tool: &str, scene: &str, patch: &Value, more: &[&str], words: &[&str]) {
    let place = Place::new();
    let patch = place.file("size.json", patch.to_string());
    let scene = root().join(scene);
    let mut arguments = vec!["check", scene.to_str().unwrap()];
    arguments.extend(["--patch", patch.to_str().unwrap()]);
    arguments.extend(more);
    let began = Instant::now();
    tell(tool, &arguments).must(2, words);
    assert!(began.elapsed() < AT_ONCE, "{:?}", began.elapsed());
}

#[track_caller]
fn pool(patch: &Value, words: &[&str]) {
    let scene = "pipelines/verify/pool-hydrostatic/scene.json";
    refused("poolsph", scene, patch, &[], words);
}

#[track_caller]
fn arc(patch: &Value, words: &[&str]) {
    let scene = "pipelines/verify/arc-potential/scene.json";
    refused("arcfvm", scene, patch, &[], words);
}

fn body(min: Value, max: Value) -> Value {
    json!({"spacing_m": 5e-4, "bodies": [
        {"shape": {"box": {"min_m": min, "max_m": max}}, "state": "liquid"}]})
}

#[test]
fn a_plate_of_two_metres_at_half_a_millimetre() {
    let plate = body(json!([0, 0, 0]), json!([2, 2, 0.02]));
    pool(
        &plate,
        &[
            "size.json:1:",
            "/bodies/0/shape",
            "6.4e8 particles",
            "at most 2e7",
            "spacing_m = 1.7e-3 would do",
        ],
    );
}

#[test]
fn particles_beyond_the_digits_of_a_number() {
    let far = body(json!([0, 0, 0]), json!([1e300, 1, 1]));
    pool(&far, &["/bodies/0/shape", "1e300 m"]);
    let far = body(json!([1e300, 1e300, 1e300]), json!([2e300, 2e300, 2e300]));
    pool(&far, &["/bodies/0/shape", "2e300 m"]);
    let mut off = body(json!([0, 0, 0]), json!([0.01, 0.01, 0.01]));
    off["bodies"][0]["lattice_m"] = json!([1e300, 0, 0]);
    pool(&off, &["/bodies/0/lattice_m", "1e300 m"]);
}

#[test]
fn spacings_too_small_and_too_large() {
    pool(
        &json!({"spacing_m": 1e-12}),
        &["/spacing_m", "1e-12 m is out of range", "from 1e-9 m"],
    );
    pool(&json!({"spacing_m": 1e-300}), &["/spacing_m", "1e-300 m"]);
    pool(&json!({"spacing_m": 1e300}), &["/spacing_m", "1e300 m"]);
    pool(
        &json!({"spacing_m": 1e-8}),
        &["/bodies/", "particles, at most 2e7"],
    );
}

#[test]
fn shapes_without_an_inside() {
    let flat =
        json!({"shape": {"sphere": {"centre_m": [0, 0, 0], "radius_m": 0}}, "state": "liquid"});
    pool(
        &json!({"bodies": [flat]}),
        &["/bodies/0/shape/sphere/radius_m", "above 0 m"],
    );
    let flat = |half: Value| {
        let shape = json!({"ellipsoid": {"centre_m": [0, 0, 0], "semi_axes_m": half}});
        json!({"bodies": [{"shape": shape, "state": "liquid"}]})
    };
    for half in [json!([0.01, 0, 0.01]), json!([0.01, -0.01, 0.01])] {
        pool(&flat(half), &["/bodies/0/shape", "not above the lower"]);
    }
    let inside_out = body(json!([0.01, 0, 0]), json!([0, 0.01, 0.01]));
    pool(&inside_out, &["/bodies/0/shape", "not above the lower"]);
}

#[test]
fn droplets_without_number() {
    let weld = "pipelines/gmaw-300a/pool.json";
    for (patch, words) in [
        (
            json!({"droplets": {"period_s": 1e-12}}),
            ["/droplets/period_s", "droplets until 10 s"],
        ),
        (
            json!({"droplets": {"radius_m": 10}}),
            ["/droplets/radius_m", "at most 2e7"],
        ),
    ] {
        refused("poolsph", weld, &patch, &[], &words);
    }
}

#[test]
fn arcs_of_a_thousand_million_cells() {
    arc(
        &json!({"grid": {"r": 1e-7, "z": 1e-7}}),
        &["/grid", "at most 4000000 in all", "times as large would do"],
    );
    arc(&json!({"grid": {"r": 1e-300}}), &["/grid", "cells"]);
    let graded = json!({"at_m": [0, 0.005, 1], "spacing_m": [1e-12, 1e-12, 1e-3]});
    arc(&json!({"grid": {"r": graded}}), &["/grid", "cells"]);
}

#[test]
fn arcs_of_any_size_but_none_that_exists() {
    arc(
        &json!({"domain": {"r_m": [0, 1e300]}}),
        &["/domain/r_m", "1e300", "out of range"],
    );
    arc(
        &json!({"domain": {"z_m": [0, 1e-200]}}),
        &["/domain/z_m", "1e-200"],
    );
    arc(&json!({"domain": {"r_m": [0, 0]}}), &["/domain/r_m"]);
}

#[test]
fn averages_on_a_grid_that_no_machine_holds() {
    let place = Place::new();
    let frames = place.frames("pool.mcap", &header());
    let input = format!("frames={}", frames.display());
    let scene = place.scene();
    let scene = scene.to_str().unwrap();
    for (patch, words) in [
        (
            json!({"spacing_m": 1e-9}),
            ["/sections/0", "grid points with 0.000000001 m"],
        ),
        (json!({"spacing_m": 1e-300}), ["/sections/0", "grid points"]),
    ] {
        refused("avg", scene, &patch, &["--input", &input], &words);
    }
    let mut wide: Value = serde_json::from_str(crate::workplace::SCENE).unwrap();
    wide["sections"][0]["first_m"] = json!([0, 1e300]);
    let sections = json!({"sections": wide["sections"]});
    refused(
        "avg",
        scene,
        &sections,
        &["--input", &input],
        &["/sections/0"],
    );
}

#[test]
fn a_wire_beyond_the_domain() {
    let wire = json!({"bodies": {"wire": {"shape": {"ring": {"z_m": [1e300, 0.02]}}}}});
    let gas = root().join("pipelines/gases/argon-1atm.json");
    let input = format!("gas={}", gas.display());
    let scene = "pipelines/gmaw-300a/arc.json";
    let words = [
        "/bodies/wire/shape/ring/z_m",
        "does not rise within the domain",
    ];
    refused("arcfvm", scene, &wire, &["--input", &input], &words);
}

/// Coordinates are rounded by 1e-16 of their size: points come to lie on one another.
#[test]
fn bodies_too_far_from_the_origin_for_their_points() {
    const WORDS: &str = "are told apart up to";
    for far in [1e13_f64, 1e300, -1e13] {
        let sphere = json!({"centre_m": [0, 0, far]});
        let patch = json!({"liquid": {"shape": {"sphere": &sphere}}});
        let drop = "pipelines/verify/liquid-drop/scene.json";
        refused("emfield", drop, &patch, &[], &["/liquid/shape", WORDS]);
        let (min, max) = (far - 0.1 * far.abs(), far + 0.1 * far.abs());
        let domain = json!({"min_m": [0, 0, min], "max_m": [0.025, 0.025, max]});
        let domain = json!({"domain": {"box": domain}});
        let loops = "pipelines/verify/em-sphere-loops/scene.json";
        let words = ["/domain/box/min_m/2", WORDS];
        refused("emfield", loops, &domain, &[], &words);
        let disc = json!({"body": {"cylinder": {"centre_m": [0, 0, far]}}});
        let shock = "pipelines/verify/heat-shock-disc/scene.json";
        refused("heatsph", shock, &disc, &[], &["/body", WORDS]);
        let bar = json!({
            "name": "bar",
            "body": {"cylinder": {"centre_m": [0, 0, far], "radius_m": 0.02, "length_m": 0.2}},
            "spacing_m": 0.005,
            "density_kg_m3": 1000,
            "elastic": {"youngs_modulus_pa": 2e6, "poisson_ratio": 0.3975}
        });
        let solid = "pipelines/verify/solid-bar/scene.json";
        let solids = json!({"solids": [bar]});
        refused("jetsph", solid, &solids, &[], &["/solids/0/body", WORDS]);
    }
}
