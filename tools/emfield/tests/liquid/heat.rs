//! Drops that warm, cool and melt.

use artefact::Reader;
use serde_json::{Value, json};

use super::stretched::{pressed, renewed};
use super::{column, drop, run, said};

/// A ball that stands still, so well conducting that it is as warm everywhere, in surroundings of another temperature.
fn ball(start: f64, around: f64, end: f64) -> Value {
    let mut scene = drop(1e-3, 7000.0, 1.5, 0.1);
    let liquid = scene["liquid"].as_object_mut().unwrap();
    liquid.remove("velocity_m_s");
    liquid["march"] = json!({"end_s": end, "step_s": end / 40.0});
    liquid.insert(
        "heat".to_owned(),
        json!({"specific_heat_j_kg_k": 800, "thermal_conductivity_w_m_k": 1e4, "temperature_k": start,
            "radiation": {"emissivity": 0.5, "surroundings_k": around}, "still": true}),
    );
    scene
}

#[test]
fn a_ball_cools_as_its_surface_radiates() {
    let folder = tempfile::tempdir().unwrap();
    let reader = run(folder.path(), &ball(2000.0, 1000.0, 4.0));
    // dT/dt = -3 eps sigma (T^4 - T_far^4)/(rho c R), in fine steps.
    let rate = 3.0 * 0.5 * 5.670_374_419e-8 / (7000.0 * 800.0 * 1e-3);
    let (mut t, steps) = (2000.0_f64, 40_000);
    for _ in 0..steps {
        t -= 4.0 / f64::from(steps) * rate * (t.powi(4) - 1e12);
    }
    let found = column(&reader, "temperature");
    let last = found.last().unwrap().1;
    assert!(
        ((2000.0 - last) / (2000.0 - t) - 1.0).abs() < 1e-2,
        "{last} {t}"
    );
    let frame = reader.frame("/points", 1).unwrap();
    assert!(frame.has("temperature") && !frame.has("molten"));
}

#[test]
fn a_ball_melts_at_its_melting_point() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = ball(1790.0, 2500.0, 4.0);
    scene["liquid"]["heat"]["melting"] =
        json!({"melting_point_k": 1800, "latent_heat_j_kg": 2.5e5});
    // At so few points a front is as thick as their distance, but no heat is lost.
    let (code, text, out) = said(folder.path(), &scene, "2");
    assert!(code == 0 && !text.contains("put back evenly"), "{text}");
    let reader = Reader::open_kind(&out, "point-fields", 1).unwrap();
    let [heat, radiated] = ["heat", "radiated"].map(|name| column(&reader, name));
    let mut came = 0.0;
    for (k, ends) in radiated.windows(2).enumerate() {
        came -= 0.5 * (ends[0].1 + ends[1].1) * (ends[1].0 - ends[0].0);
        let found = heat[k + 1].1 - heat[0].1;
        assert!((found / came - 1.0).abs() < 2e-2, "{k}: {found:e} {came:e}");
    }
    let molten = column(&reader, "molten");
    assert!(molten[0].1.abs() < 1e-12 && (molten.last().unwrap().1 - 1.0).abs() < 1e-12);
    assert!(molten.iter().any(|m| m.1 > 0.05 && m.1 < 0.95));
    let frame = reader.frame("/points", 0).unwrap();
    assert!(frame.has("molten"));
}

#[test]
fn what_is_not_molten_must_stand_still() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = ball(1700.0, 300.0, 1.0);
    scene["liquid"]["heat"]["melting"] =
        json!({"melting_point_k": 1800, "latent_heat_j_kg": 2.5e5});
    scene["liquid"]["heat"]["still"] = json!(false);
    let (code, text, _) = said(folder.path(), &scene, "1");
    assert!(
        code == 2 && text.contains("/liquid/heat/temperature_k"),
        "{text}"
    );
    scene["liquid"]["heat"]["still"] = json!(true);
    scene["liquid"]["march"] = json!({"end_s": 1.0});
    let (code, text, _) = said(folder.path(), &scene, "1");
    assert!(code == 2 && text.contains("step_s"), "{text}");
}

#[test]
fn points_that_come_and_merge_are_as_warm_as_those_about_them() {
    let mut scene = pressed();
    scene["liquid"]["heat"] = json!({"specific_heat_j_kg_k": 800, "thermal_conductivity_w_m_k": 0.5,
        "temperature_k": {"expr": "350 + 1e4*z"}});
    let folder = tempfile::tempdir().unwrap();
    let reader = run(folder.path(), &scene);
    let [added, merged] = renewed(folder.path(), "drop-2.run.json");
    assert!(added > 0 && merged > 0, "{added} {merged}");
    let [heat, low, high] =
        ["heat", "temperature_lowest", "temperature_highest"].map(|name| column(&reader, name));
    let (first, last) = (heat[0].1, heat.last().unwrap().1);
    assert!((last / first - 1.0).abs() < 1e-12, "{first:e} {last:e}");
    assert!(low.last().unwrap().1 > 339.0 && high.last().unwrap().1 < 361.0);
}
