//! Patches of studies change what is there: one that puts members where the scene has the name of a substance would drop all the
//! substance has there, and the study would not start.

use std::path::Path;

use serde_json::{Map, Value};

use super::root;

/// Pointers at which the patch has an object and the scene a text, unless its members take what they keep from that substance.
fn over(scene: &Value, patch: &Value, at: &str, found: &mut Vec<String>) {
    let (Some(scene), Some(patch)) = (scene.as_object(), patch.as_object()) else {
        return;
    };
    for (key, part) in patch {
        let pointer = format!("{at}/{key}");
        match scene.get(key) {
            Some(Value::String(name)) => {
                let members = part.as_object();
                let keeps = |members: &Map<String, Value>| members.values().any(|v| v == name);
                if members.is_some_and(|members| !keeps(members)) {
                    found.push(format!("{pointer}, which is \"{name}\""));
                }
            }
            Some(own) => over(own, part, &pointer, found),
            None => {}
        }
    }
}

/// JSON files of a folder by path.
fn documents(folder: &Path) -> Vec<(String, Value)> {
    let entries = std::fs::read_dir(folder).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let json = paths.filter(|path| path.extension().is_some_and(|end| end == "json"));
    json.map(|path| {
        let text = std::fs::read_to_string(&path).unwrap();
        let value = serde_json::from_str(&text).unwrap();
        (path.display().to_string(), value)
    })
    .collect()
}

#[test]
fn patches_add_nothing_to_the_name_of_a_substance() {
    let mut found = Vec::new();
    for study in std::fs::read_dir(root().join("pipelines")).unwrap() {
        let folder = study.unwrap().path();
        if !folder.is_dir() {
            continue;
        }
        let documents = documents(&folder);
        let is_scene = |value: &Value| {
            let kind = value["kind"].as_str();
            kind.is_some_and(|kind| kind.ends_with(".scene"))
        };
        let patches = documents
            .iter()
            .filter(|(path, _)| path.ends_with(".patch.json"));
        for (path, patch) in patches {
            for (_, scene) in documents.iter().filter(|(_, value)| is_scene(value)) {
                let mut here = Vec::new();
                over(scene, patch, "", &mut here);
                found.extend(here.into_iter().map(|at| format!("{path}: {at}")));
            }
        }
    }
    assert!(found.is_empty(), "{found:#?}");
}
