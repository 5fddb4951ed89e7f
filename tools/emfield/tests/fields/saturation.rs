//! Bodies whose permeability depends on the field.

use std::f64::consts::PI;

use artefact::Reader;
use serde_json::{Value, json};

use super::{last, run, said};

const MU0: f64 = 4e-7 * PI;

/// A steel: it bends at 1.3 T, and has 1/2500 of the reluctivity of vacuum in weak fields.
fn steel() -> Value {
    json!({"b_t": [0, 0.2, 0.6, 1.0, 1.3, 1.5, 1.7, 2.0, 2.3],
        "h_a_m": [0, 60, 110, 190, 420, 1600, 8000, 60_000, 280_000]})
}

/// A bar of radius 1 about the origin in a field along x.
fn bar(permeability: &Value, flux: f64) -> Value {
    json!({"kind": "emfield.scene", "version": 1, "geometry": "plane",
        "domain": {"sphere": {"centre_m": [0, 0], "radius_m": 2}},
        "bodies": [{"name": "bar", "relative_permeability": permeability,
            "shape": {"disc": {"centre_m": [0, 0], "radius_m": 1}}}],
        "eddy_currents": {"static": {}, "outer": "multipole", "applied_flux_density_t": [flux, 0, 0]},
        "points": {"spacing_m": 0.2, "layers": {"first_m": 0.1}, "outward": 0},
        "method": {"order": 4},
        "output": {"precision": "f64"}})
}

fn flux(reader: &Reader) -> Vec<[f64; 3]> {
    let end = reader.count("/points") - 1;
    let points = reader.frame("/points", end).unwrap();
    points.vectors("magnetic_flux_density").unwrap()
}

/// The greatest difference of two fields.
fn apart(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let far = |(a, b): (&[f64; 3], &[f64; 3])| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>();
    a.iter().zip(b).map(far).fold(0.0, f64::max).sqrt()
}

/// A straight curve is a number, in a plane, about an axis and in space; slopes beside it know one thing less.
#[test]
fn a_straight_curve_is_the_permeability_that_it_has() {
    let folder = tempfile::tempdir().unwrap();
    let line = json!({"b_t": [0, 10], "h_a_m": [0, 10.0 / (20.0 * MU0)]});
    let plane = |mu: &Value| bar(mu, 1.0);
    let axis = |mu: &Value| {
        let mut scene = bar(mu, 1.0);
        scene["geometry"] = json!("axisymmetric");
        scene["eddy_currents"]["applied_flux_density_t"] = json!([0, 1]);
        scene
    };
    let space = |mu: &Value| {
        let mut scene = bar(mu, 1.0);
        scene["geometry"] = json!("space");
        scene["domain"]["sphere"]["centre_m"] = json!([0, 0, 0]);
        let ball = json!({"sphere": {"centre_m": [0, 0, 0], "radius_m": 1}});
        scene["bodies"][0]["shape"] = ball;
        scene["points"]["spacing_m"] = json!(0.25);
        scene["method"] = json!({"order": 2});
        scene
    };
    let scenes: [&dyn Fn(&Value) -> Value; 3] = [&plane, &axis, &space];
    for (number, scene) in scenes.iter().enumerate() {
        let wanted = flux(&run(folder.path(), &scene(&json!(20.0))));
        let found = flux(&run(folder.path(), &scene(&line)));
        let off = apart(&found, &wanted);
        assert!(off < [0.01, 0.03, 0.12][number], "{number}: {off}");
    }
}

/// The bar conducts, and the field about it is switched on.
fn marched(permeability: &Value, geometry: &str) -> Value {
    let mut scene = bar(permeability, 1.0);
    scene["geometry"] = json!(geometry);
    scene["bodies"][0]["conductivity_s_m"] = json!(1e4);
    let currents = scene["eddy_currents"].as_object_mut().unwrap();
    currents.remove("static");
    currents.insert(
        "transient".to_owned(),
        json!({"end_s": 0.2, "step_s": 0.05}),
    );
    if geometry == "axisymmetric" {
        currents.insert("applied_flux_density_t".to_owned(), json!([0, 1]));
    }
    scene
}

/// Where currents flow, too, a straight curve is the permeability that it has; without a curve no step is spent on it.
#[test]
fn currents_in_a_straight_curve_are_those_of_its_permeability() {
    let folder = tempfile::tempdir().unwrap();
    let line = json!({"b_t": [0, 10], "h_a_m": [0, 10.0 / (20.0 * MU0)]});
    for (geometry, most) in [("plane", 0.005), ("axisymmetric", 0.01)] {
        let wanted = run(folder.path(), &marched(&json!(20.0), geometry));
        let spent = last(&wanted, "/totals").get("steps_saturation").is_ok();
        assert!(!spent);
        let wanted = flux(&wanted);
        let found = flux(&run(folder.path(), &marched(&line, geometry)));
        let off = apart(&found, &wanted);
        assert!(off < most, "{geometry}: {off}");
    }
}

/// The plan names what is at work, and what is not.
#[test]
fn the_plan_tells_whether_a_permeability_depends_on_the_field() {
    let folder = tempfile::tempdir().unwrap();
    let planned = |mu: &Value| {
        let file = folder.path().join("scene.json");
        std::fs::write(&file, bar(mu, 1.0).to_string()).unwrap();
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_emfield"))
            .args(["check", file.to_str().unwrap()])
            .output()
            .unwrap();
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let (with, without) = (planned(&steel()), planned(&json!(20)));
    assert!(with.contains("eddy currents, saturation"), "{with}");
    assert!(without.contains("no permeability depends"), "{without}");
    assert!(!without.contains("eddy currents, saturation"), "{without}");
}

/// Inside a bar across the field B is uniform, with `B + mu_0 H = 2 B_0`, at any saturation (Jackson 1999, section 5.11).
#[test]
fn a_bar_has_the_same_flux_everywhere_at_any_saturation() {
    let folder = tempfile::tempdir().unwrap();
    // At a row of the table H is known.
    for (b, h) in [
        (0.6, 110.0),
        (1.5, 1600.0),
        (2.0, 60_000.0),
        (3.3, 280_000.0 + 1.0 / MU0),
    ] {
        let applied = 0.5 * (b + MU0 * h);
        let reader = run(folder.path(), &bar(&steel(), applied));
        let points = reader.frame("/points", 0).unwrap();
        let places = points.position_vectors().unwrap();
        let inside = flux(&reader).into_iter().zip(places);
        let off = inside.filter(|(_, x)| x[0].hypot(x[1]) < 0.999);
        let off = off.map(|(f, _)| (f[0] - b).hypot(f[1])).fold(0.0, f64::max);
        assert!(off < 2e-3 * b, "{b}: {off}");
    }
}

/// Force by tractions, by Maxwell's stress and on the wire are one: the traction of a curve has its coenergy.
#[test]
fn a_wire_draws_saturated_iron_with_one_force() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = bar(&steel(), 0.0);
    scene["points"]["spacing_m"] = json!(0.08);
    scene["points"]["layers"]["first_m"] = json!(0.04);
    // Some 1.5 T in vacuum at the bar.
    let currents = json!({"static": {}, "outer": "multipole",
        "coils": [{"wire": {"place_m": [1.5, 0], "current_a": 8e6}}]});
    scene["eddy_currents"] = currents;
    scene["domain"]["sphere"]["radius_m"] = json!(2.5);
    scene["output"]["enclosures"] =
        json!([{"name": "around", "surface": {"around": {"body": "bar", "distance_m": 0.2}}}]);
    let reader = run(folder.path(), &scene);
    let totals = last(&reader, "/totals");
    let ways = [
        "force_volume_x",
        "force_maxwell_x",
        "force_coil_x",
        "around.force_x",
    ];
    let forces = ways.map(|way| totals.get(way).unwrap());
    for (way, force) in ways.iter().zip(forces) {
        assert!(
            (force / forces[2] - 1.0).abs() < 0.01,
            "{way} {force} {forces:?}"
        );
    }
    // With one permeability, images pull with mu_0 I^2 k / (2 pi) (1/(d - R^2/d) - 1/d).
    let images = MU0 * 8e6 * 8e6 / (2.0 * PI) * (1.0 / (1.5 - 1.0 / 1.5) - 1.0 / 1.5);
    assert!(
        forces[2] < 0.8 * images && forces[2] > 0.3 * images,
        "{forces:?} {images}"
    );
}

/// Where nothing conducts each instant of a march is a static field; where it conducts, the march ends in one.
#[test]
fn marches_end_in_static_fields() {
    let folder = tempfile::tempdir().unwrap();
    let still = flux(&run(folder.path(), &bar(&steel(), 0.9)));
    let mut scene = bar(&steel(), 0.9);
    let currents = scene["eddy_currents"].as_object_mut().unwrap();
    currents.remove("static");
    let wave = json!({"expr": "min(1, t)"});
    currents.insert(
        "transient".to_owned(),
        json!({"end_s": 1, "step_s": 0.25, "wave": wave}),
    );
    let found = flux(&run(folder.path(), &scene));
    assert!(apart(&found, &still) < 1e-6);
    // mu sigma R^2 is 30 ms in weak fields and less beyond.
    scene["bodies"][0]["conductivity_s_m"] = json!(10);
    let found = flux(&run(folder.path(), &scene));
    assert!(apart(&found, &still) < 1e-3, "{}", apart(&found, &still));
}

#[test]
fn what_no_curve_can_do_is_told_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let at = "/bodies/0/relative_permeability";
    let refused = |scene: &Value, wanted: &[&str]| {
        let (code, text, _) = said(folder.path(), scene);
        assert_eq!(code, 2, "{text}");
        for wanted in wanted {
            assert!(text.contains(wanted), "{wanted}: {text}");
        }
    };
    let mut harmonic = bar(&steel(), 1.0);
    let currents = harmonic["eddy_currents"].as_object_mut().unwrap();
    currents.remove("static");
    currents.insert("harmonic".to_owned(), json!({"frequency_hz": 50}));
    refused(&harmonic, &[at, "sinusoid", "\"transient\"", "\"static\""]);
    let mut along = bar(&steel(), 1.0);
    along["eddy_currents"]["applied_flux_density_t"] = json!([0, 0, 1]);
    along["eddy_currents"]["outer"] = json!("zero");
    refused(&along, &[at, "along z"]);
    for (table, key, what) in [
        (
            json!({"b_t": [0, 1, 0.9], "h_a_m": [0, 1, 2]}),
            "/b_t/2",
            "0.9 T does not rise",
        ),
        (
            json!({"b_t": [0, 1, 2], "h_a_m": [0, 5, 5]}),
            "/h_a_m/2",
            "H rises with B",
        ),
        (json!({"b_t": [0.1, 1], "h_a_m": [0, 5]}), "/b_t/0", "0.1 T"),
        (
            json!({"b_t": [0, 1, 1.1], "h_a_m": [0, 100, 1e6]}),
            "/h_a_m/2",
            "at most",
        ),
        (
            json!({"b_t": [0, 1], "h_a_m": [0, 1, 2]}),
            "",
            "equally many",
        ),
        (json!({"expr": "1 + 999/(1 + B^10)"}), "/expr", "mu_0"),
        (json!({"expr": "B - 5"}), "/expr", "above 0"),
        (json!({"expr": "5 + T"}), "/expr", "nothing depends on 'T'"),
        (json!({"expr": "5"}), "/expr", "write 5"),
    ] {
        refused(&bar(&table, 1.0), &[&format!("{at}{key}"), what]);
    }
    let mut within = bar(&steel(), 1.0);
    let disc = json!({"disc": {"centre_m": [0, 0], "radius_m": 0.5}});
    within["output"]["enclosures"] = json!([{"name": "in", "surface": {"shape": disc}}]);
    refused(&within, &["permeability depends on the field"]);
}

/// A formula and the rows that it gives are one curve.
#[test]
fn a_formula_is_the_table_of_its_rows() {
    let folder = tempfile::tempdir().unwrap();
    let mu = |b: f64| 1.0 / (1.0 - 0.999 / (1.0 + (b / 2.0_f64).powi(8)).powf(0.125));
    let b: Vec<f64> = (0..=400).map(|k| 0.01 * f64::from(k)).collect();
    let h: Vec<f64> = b.iter().map(|b| b / (MU0 * mu(*b))).collect();
    let table = flux(&run(
        folder.path(),
        &bar(&json!({"b_t": b, "h_a_m": h}), 1.1),
    ));
    let text = json!({"expr": "1/(1 - 0.999/(1 + (B/2)^8)^0.125)"});
    let formula = flux(&run(folder.path(), &bar(&text, 1.1)));
    assert!(apart(&table, &formula) < 1e-4);
}
