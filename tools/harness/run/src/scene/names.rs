//! Definitions of a schema called after what they define, and descriptions as people write them.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Map, Value};

/// Where definitions stand.
const DEFS: &str = "#/$defs/";

/// Calls each definition whose type has a name that many types have (`Parameters3`) after the key that holds it
/// (`Marangoni`), and takes from descriptions what only the documentation of the code needs.
pub(super) fn after_things(schema: &mut Value) {
    let mut held = BTreeMap::new();
    holders(schema, "", &mut held);
    let defs = schema.get("$defs").and_then(Value::as_object);
    let mut taken: BTreeSet<String> = defs
        .into_iter()
        .flatten()
        .map(|(name, _)| name.clone())
        .collect();
    let mut renamed = BTreeMap::new();
    for name in taken.clone() {
        let keys = held.get(&name).into_iter().flatten().collect::<Vec<_>>();
        if let ([key], true) = (keys.as_slice(), says_nothing(&name)) {
            let thing = camel(key);
            if taken.insert(thing.clone()) {
                renamed.insert(name, thing);
            }
        }
    }
    rename(schema, &renamed);
}

/// Whether the name of a type is one of many: `Parameters`, or one with a number behind it.
fn says_nothing(name: &str) -> bool {
    name == "Parameters" || name.ends_with(|c: char| c.is_ascii_digit())
}

/// Keys of scenes that hold each definition.
fn holders(node: &Value, key: &str, found: &mut BTreeMap<String, BTreeSet<String>>) {
    match node {
        Value::Object(map) => {
            let target = map.get("$ref").and_then(Value::as_str);
            if let Some(name) = target.and_then(|t| t.strip_prefix(DEFS)) {
                found
                    .entry(name.to_owned())
                    .or_default()
                    .insert(key.to_owned());
            }
            for (word, child) in map {
                match (word.as_str(), child) {
                    ("properties", Value::Object(properties)) => {
                        properties
                            .iter()
                            .for_each(|(key, child)| holders(child, key, found));
                    }
                    _ => holders(child, key, found),
                }
            }
        }
        Value::Array(list) => list.iter().for_each(|child| holders(child, key, found)),
        _ => {}
    }
}

/// `arc_pressure` as `ArcPressure`.
fn camel(key: &str) -> String {
    let words = key.split('_');
    words
        .map(|word| {
            let (first, rest) = word.split_at(word.len().min(1));
            first.to_uppercase() + rest
        })
        .collect()
}

fn rename(node: &mut Value, renamed: &BTreeMap<String, String>) {
    match node {
        Value::Object(map) => {
            if let Some(Value::Object(defs)) = map.get_mut("$defs") {
                let own = std::mem::take(defs).into_iter();
                *defs = own
                    .map(|(name, def)| (renamed.get(&name).cloned().unwrap_or(name), def))
                    .collect::<Map<String, Value>>();
            }
            for (key, child) in map.iter_mut() {
                match (key.as_str(), child) {
                    ("$ref", Value::String(target)) => {
                        let name = target.strip_prefix(DEFS).and_then(|name| renamed.get(name));
                        if let Some(name) = name {
                            *target = format!("{DEFS}{name}");
                        }
                    }
                    ("description", Value::String(text)) => *text = plain(text),
                    (_, child) => rename(child, renamed),
                }
            }
        }
        Value::Array(list) => list.iter_mut().for_each(|child| rename(child, renamed)),
        _ => {}
    }
}

/// A description without escapes and links of the documentation of code.
fn plain(text: &str) -> String {
    text.replace("\\[", "[")
        .replace("\\]", "]")
        .replace("[`", "`")
        .replace("`]", "`")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn definitions_are_called_after_the_key_that_holds_them() {
        let mut schema = json!({
            "properties": {
                "arc_pressure": {"anyOf": [{"$ref": "#/$defs/Parameters2"}, {"type": "null"}]},
                "faces": {"items": {"$ref": "#/$defs/Face"}},
                "mirror": {"$ref": "#/$defs/Face2"},
                "open": {"$ref": "#/$defs/Face2"}
            },
            "$defs": {
                "Parameters2": {"description": "Push \\[Pa\\], see [`Arc`]."},
                "Face": {},
                "Face2": {}
            }
        });
        after_things(&mut schema);
        let names: Vec<&String> = schema["$defs"].as_object().unwrap().keys().collect();
        assert_eq!(names, ["ArcPressure", "Face", "Face2"]);
        assert_eq!(
            schema["properties"]["arc_pressure"]["anyOf"][0]["$ref"],
            "#/$defs/ArcPressure"
        );
        assert_eq!(
            schema["$defs"]["ArcPressure"]["description"],
            "Push [Pa], see `Arc`."
        );
    }
}
