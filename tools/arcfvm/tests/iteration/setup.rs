//! Scenes of the pipelines, and a checkpoint to keep them in.

use std::collections::BTreeMap;
use std::path::Path;

use artefact::{Checkpoint, Header, Version};
use serde_json::Value;

/// A JSON file of the repository.
pub(crate) fn json(path: &str) -> Value {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    serde_json::from_str(&std::fs::read_to_string(root.join(path)).unwrap()).unwrap()
}

/// A scene of the repository without what the harness reads of it.
pub(crate) fn scene(path: &str) -> Value {
    let mut scene = json(path);
    for key in ["$schema", "kind", "version", "comment"] {
        scene.as_object_mut().unwrap().remove(key);
    }
    scene
}

/// A checkpoint that holds nothing yet.
pub(crate) fn checkpoint() -> Checkpoint {
    Checkpoint::new(&Header {
        kind: "arc-source".to_owned(),
        version: Version { major: 1, minor: 0 },
        tool: "arcfvm".to_owned(),
        tool_version: "0".to_owned(),
        scene: Value::Null,
        inputs: BTreeMap::new(),
    })
}
