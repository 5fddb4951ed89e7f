//! Certificates of studies fit the schema that we publish.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use run::scene::{Expected, load};
use serde_json::Value;
use verification::certify;
use verification::certify::plan::Stage;

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
    let kept = kept(&root);
    for (study, path) in &kept {
        let (good, said) = validate(path);
        assert!(good, "{study}: {said}");
    }
    assert!(kept.len() >= 3, "{kept:?}");
}

/// The certificates that studies keep, by study.
fn kept(root: &Path) -> BTreeMap<String, PathBuf> {
    let mut kept = BTreeMap::new();
    for study in std::fs::read_dir(root.join("pipelines")).unwrap().flatten() {
        let path = study.path().join("certificate.json");
        if path.exists() {
            kept.insert(study.file_name().into_string().unwrap(), path);
        }
    }
    kept
}

/// The schema by which a program reads a scene: it knows no names of substances, which editors are offered in place of values.
fn without_names(node: &mut Value) {
    match node {
        Value::Object(map) => {
            let choices = map.get("anyOf").and_then(Value::as_array);
            let own = choices.and_then(|choices| match choices.as_slice() {
                [own, name] if name["description"] == "A substance of this scene." => {
                    Some(own.clone())
                }
                _ => None,
            });
            match own {
                Some(own) => {
                    *node = own;
                    without_names(node);
                }
                None => map.values_mut().for_each(without_names),
            }
        }
        Value::Array(list) => list.iter_mut().for_each(without_names),
        _ => {}
    }
}

/// The hash of the scene of a stage as it is today.
fn today(root: &Path, stage: &Stage) -> String {
    let tool = &stage.tool;
    let schema = root.join(format!("schemas/{tool}.scene.v1.json"));
    let schema = std::fs::read_to_string(schema).unwrap();
    let mut schema: Value = serde_json::from_str(&schema).unwrap();
    without_names(&mut schema);
    let expected = Expected {
        kind: format!("{tool}.scene").leak(),
        version: 1,
        migrations: &[],
    };
    let patches: Vec<PathBuf> = stage.patches.iter().map(|p| root.join(p)).collect();
    let loaded = load::<Value>(&root.join(&stage.scene), &patches, &schema, expected).unwrap();
    artefact::sha256(artefact::canonical(loaded.merged.value()).as_bytes())
}

/// A certificate of other scenes, figures or sizes than those of its study is no evidence: `make certify STUDY=name` makes it anew.
#[test]
fn kept_certificates_are_of_todays_scenes_and_plans() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    for (study, path) in kept(&root) {
        let told = std::fs::read_to_string(path).unwrap();
        let told: Value = serde_json::from_str(&told).unwrap();
        let plan = certify::plan_of(&root, &study).unwrap();
        let points = told["points"].as_array().unwrap();
        let base = points.iter().find(|p| p["knob"].is_null()).unwrap();
        for stage in &plan.stages {
            let was = base["scenes"][&stage.name].as_str().unwrap();
            let anew = format!("make certify STUDY={study}");
            let changed = format!("{study}: the scene of '{}' changed", stage.name);
            assert_eq!(was, today(&root, stage), "{changed}: {anew}");
        }
        let figures = told["figures"].as_object().unwrap().keys();
        let wanted = plan.figures.iter().map(|f| f.name.clone());
        assert_eq!(set(figures.cloned()), set(wanted), "{study}");
        let names = points
            .iter()
            .map(|p| p["name"].as_str().unwrap().to_owned());
        assert_eq!(set(names), set(certify::runs::names(&plan)), "{study}");
    }
}

fn set(names: impl IntoIterator<Item = String>) -> BTreeSet<String> {
    names.into_iter().collect()
}
