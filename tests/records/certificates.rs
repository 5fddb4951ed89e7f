//! Certificates of studies fit the schema that we publish.

use std::path::Path;

use verification::certify;

use super::{validate, written};

#[test]
fn a_certificate_fits_its_schema_and_so_do_those_that_studies_keep() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let plan = certify::plan_of(&root, "fgm-shock").unwrap();
    let base = certify::runs::Point {
        name: "base".to_owned(),
        knob: None,
        size: None,
        patch: serde_json::Value::Null,
        figures: plan.figures.iter().map(|f| (f.name.clone(), 1.5)).collect(),
        run_time_s: Some(2.0),
        processor_s: None,
        peak_memory_bytes: Some(1000),
        points: None,
        missing: None,
        warnings: vec!["a figure lies beyond its table".to_owned()],
        frozen: std::collections::BTreeMap::new(),
        scenes: [("disc".to_owned(), "0".repeat(64))].into(),
    };
    let certificate = certify::verdict::conclude(&plan, &[base], None);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fgm-shock.json");
    let (good, said) = written(&path, &certificate);
    assert!(good, "{said}");
    let mut odd = serde_json::to_value(&certificate).unwrap();
    odd["points"][0]["run_time_s"] = serde_json::json!(-1);
    let (good, said) = written(&path, &odd);
    assert!(!good && said.contains("run_time_s"), "{said}");
    let mut kept = 0;
    for study in std::fs::read_dir(root.join("pipelines")).unwrap() {
        let path = study.unwrap().path().join("certificate.json");
        if path.exists() {
            kept += 1;
            let (good, said) = validate(&path);
            assert!(good, "{}: {said}", path.display());
        }
    }
    assert!(kept >= 3, "{kept}");
}
