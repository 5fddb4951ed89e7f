//! Forces whose ways disagree: told with their place where points do not resolve what pulls, not told where they do.

use serde_json::{Value, json};

use super::said;

/// Two dielectric balls of radius 1 along the field between two plates, their centres so far apart.
fn pair(apart: f64, ratio: f64) -> Value {
    let ball = |name: &str, z: f64| {
        json!({"name": name, "shape": {"sphere": {"centre_m": [0, 0, z], "radius_m": 1}},
            "relative_permittivity": ratio})
    };
    json!({"kind": "emfield.scene", "version": 1, "geometry": "space",
        "domain": {"box": {"min_m": [-4, -4, -4], "max_m": [4, 4, 4]}},
        "bodies": [ball("lower", -0.5 * apart), ball("upper", 0.5 * apart)],
        "electrostatics": {"outer": [{"potential_v": {"expr": "z"}}]},
        "method": {"order": 2}, "points": {"spacing_m": 0.2}})
}

/// Exit code, and what the run record tells of forces: notes and warnings.
fn told(scene: &Value) -> (i32, [Vec<String>; 2]) {
    let folder = tempfile::tempdir().unwrap();
    let (code, _, out) = said(folder.path(), scene);
    let record = std::fs::read(out.with_extension("run.json")).unwrap();
    let record: Value = serde_json::from_slice(&record).unwrap();
    let told = |key: &str| {
        let all = record[key].as_array().unwrap().iter();
        let texts = all.filter_map(Value::as_str).map(str::to_owned);
        texts.filter(|t| t.starts_with("force on")).collect()
    };
    (code, ["notes", "warnings"].map(told))
}

#[test]
fn forces_on_balls_apart_are_no_doubt() {
    assert_eq!(told(&pair(2.5, 80.0)), (0, [Vec::new(), Vec::new()]));
}

#[test]
fn a_coarse_box_is_told_with_its_place() {
    let mut scene = pair(0.0, 80.0);
    scene["bodies"] = json!([{"name": "block", "relative_permittivity": 80,
        "shape": {"box": {"min_m": [-1.2, -0.8, -0.8], "max_m": [0, 0.8, 0.8]}}}]);
    scene["method"]["order"] = json!(4);
    let (_, told) = told(&scene);
    let mut all = told.into_iter().flatten();
    let own = all.find(|t| t.contains("force on block:")).unwrap();
    assert!(
        own.contains("N by its tractions") && own.contains("most near ("),
        "{own}"
    );
}

/// The wedge at their seam charges conducting balls that cross: their tractions agree with the field about them, and both
/// are wrong.
#[test]
fn a_charge_that_nobody_gave_is_told() {
    let (code, [_, told]) = told(&pair(1.88, 1e6));
    assert_eq!(code, 3);
    assert!(
        told.iter().any(|t| t.contains("as if they carried")),
        "{told:?}"
    );
}
