//! The JSON Schema of a scene: what schemars derives, the envelope, and no unknown keys anywhere.

use schemars::JsonSchema;
use serde_json::{Map, Value, json};

use super::{Expected, names};

/// The key of a scene that names its substances.
pub(super) const SUBSTANCES: &str = "substances";

/// Keys that every scene has or may have besides those of its type.
pub(crate) const ENVELOPE: [&str; 6] = [
    "kind",
    "version",
    "$schema",
    "comment",
    SUBSTANCES,
    artefact::WRITTEN,
];

/// The schema of a scene type with kind and version.
#[must_use]
pub fn schema_of<S: JsonSchema>(expected: Expected) -> Value {
    let mut schema = schemars::schema_for!(S).to_value();
    close(&mut schema, true);
    names::after_things(&mut schema);
    if let Value::Object(map) = &mut schema {
        map.insert(
            "title".to_owned(),
            json!(format!("{} version {}", expected.kind, expected.version)),
        );
        let properties = map.entry("properties").or_insert_with(|| json!({}));
        if let Value::Object(old) = properties {
            let mut all = Map::new();
            all.insert(
                "kind".to_owned(),
                json!({"const": expected.kind, "description": "What this file is."}),
            );
            all.insert(
                "version".to_owned(),
                json!({"const": expected.version, "description": "Version of the kind."}),
            );
            all.insert(
                "$schema".to_owned(),
                json!({"type": "string", "description": "For editors."}),
            );
            all.insert(
                "comment".to_owned(),
                json!({"type": "string", "description": "For people."}),
            );
            if expected.kind.ends_with(".scene") {
                all.insert(SUBSTANCES.to_owned(), substances());
                all.insert(
                    artefact::WRITTEN.to_owned(),
                    json!({"type": "string", "description": "Hash of the scene before what it names was read; told by artefacts."}),
                );
            }
            all.extend(std::mem::take(old));
            *old = all;
        }
        map.insert("additionalProperties".to_owned(), json!(false));
        if let Value::Array(required) = map.entry("required").or_insert_with(|| json!([])) {
            required.insert(0, json!("version"));
            required.insert(0, json!("kind"));
        }
    }
    schema
}

/// The schema of the key `substances`.
fn substances() -> Value {
    json!({
        "type": "object",
        "description": "Substances that values name: \"density_kg_m3\": \"steel\" takes the density of \"steel\". Each has the \
                        file of a sheet (schemas/substance.v1.json), beside the scene, or values of its own, which go before.",
        "additionalProperties": {"type": "object"}
    })
}

/// The schema as text with a final line feed.
#[must_use]
pub fn schema_text(schema: &Value) -> String {
    format!("{schema:#}\n")
}

/// Refuses unknown keys in every object whose keys the schema lists.
fn close(schema: &mut Value, closable: bool) {
    let Value::Object(map) = schema else { return };
    let own_keys = map.contains_key("properties");
    let composed = ["$ref", "allOf", "oneOf", "anyOf"]
        .iter()
        .any(|key| map.contains_key(*key));
    if closable && !composed && own_keys && !map.contains_key("additionalProperties") {
        map.insert("additionalProperties".to_owned(), json!(false));
    }
    for (key, value) in map.iter_mut() {
        match (key.as_str(), value) {
            ("properties" | "$defs" | "patternProperties", Value::Object(children)) => {
                children.values_mut().for_each(|child| close(child, true));
            }
            ("allOf", Value::Array(parts)) => parts.iter_mut().for_each(|part| close(part, false)),
            ("oneOf" | "anyOf", Value::Array(parts)) => {
                parts.iter_mut().for_each(|part| close(part, !own_keys))
            }
            ("items" | "additionalProperties", child) => close(child, true),
            _ => {}
        }
    }
}
