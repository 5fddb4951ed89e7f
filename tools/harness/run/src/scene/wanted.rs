//! What the schema of a scene wants at a place.

use serde_json::Value;

/// The forms that a value at a JSON pointer may have; none where the schema knows no such place.
pub(super) fn forms<'a>(schema: &'a Value, pointer: &str) -> Vec<&'a Value> {
    let mut nodes = open(schema, schema);
    for token in pointer.split('/').skip(1) {
        let token = token.replace("~1", "/").replace("~0", "~");
        let within = nodes.into_iter().flat_map(|node| step(node, &token));
        nodes = within.flat_map(|node| open(schema, node)).collect();
    }
    nodes
}

/// Whether one of the forms is a text.
pub(super) fn text(forms: &[&Value]) -> bool {
    let is = |node: &&Value| {
        let named = |value: &Value| match value {
            Value::String(word) => word == "string",
            Value::Array(words) => words.iter().any(|word| word == "string"),
            _ => false,
        };
        let words = node.get("enum").and_then(Value::as_array);
        node.get("type").is_some_and(named)
            || node.get("const").is_some_and(Value::is_string)
            || words.is_some_and(|words| words.iter().any(Value::is_string))
    };
    forms.iter().any(is)
}

/// The keys that the forms know, with what each of them may be.
pub(super) fn keys<'a>(forms: &[&'a Value]) -> Vec<(&'a str, &'a Value)> {
    let maps = forms
        .iter()
        .filter_map(|node| node.get("properties")?.as_object());
    maps.flatten()
        .map(|(key, node)| (key.as_str(), node))
        .collect()
}

/// What may stand at a key or number within a node.
fn step<'a>(node: &'a Value, token: &str) -> Option<&'a Value> {
    if let Some(found) = node.get("properties").and_then(|p| p.get(token)) {
        return Some(found);
    }
    if let Ok(number) = token.parse::<usize>() {
        let first = node.get("prefixItems").and_then(|items| items.get(number));
        if let Some(found) = first.or_else(|| node.get("items")) {
            return Some(found);
        }
    }
    node.get("additionalProperties").filter(|n| n.is_object())
}

/// A node with its references followed and its choices laid open.
pub(super) fn open<'a>(schema: &'a Value, node: &'a Value) -> Vec<&'a Value> {
    let mut found = vec![node];
    if let Some(target) = node.get("$ref").and_then(Value::as_str) {
        let target = target
            .strip_prefix('#')
            .and_then(|path| schema.pointer(path));
        found.extend(
            target
                .into_iter()
                .flat_map(|n| open(schema, n))
                .collect::<Vec<_>>(),
        );
    }
    for word in ["anyOf", "oneOf", "allOf"] {
        let choices = node.get(word).and_then(Value::as_array);
        for choice in choices.into_iter().flatten() {
            found.extend(open(schema, choice));
        }
    }
    found
}
