//! Every fault of a scene against its schema, in words a person can act on.

use artefact::unit_of_key;
use jsonschema::error::{TypeKind, ValidationErrorKind as Kind};
use jsonschema::{JsonType, ValidationError};
use serde_json::{Map, Value};

use super::choice::{best_branch, no_form};
use super::suggest::instead_of;
use super::words::{none_of, show, type_of};
use crate::fault::Fault;

/// All faults of `scene` against `schema`.
pub(crate) fn faults(schema: &Value, scene: &Value) -> Vec<Fault> {
    let validator = match jsonschema::validator_for(schema) {
        Ok(validator) => validator,
        Err(e) => {
            return vec![Fault::at(
                "",
                format!("the schema of this tool is not valid: {e}"),
            )];
        }
    };
    let mut found = Vec::new();
    for error in validator.iter_errors(scene) {
        explain(schema, scene, &error, &mut found);
    }
    found
}

fn explain(schema: &Value, scene: &Value, error: &ValidationError<'_>, found: &mut Vec<Fault>) {
    let path = error.instance_path().as_str();
    let node = parent_node(schema, error.schema_path().as_str());
    let unit = node
        .and_then(|n| n.get("x-unit"))
        .and_then(Value::as_str)
        .or_else(|| unit_of_key(last_key(path)));
    let at = |what: String| Fault::at(path, what);
    match error.kind() {
        Kind::AdditionalProperties { unexpected } | Kind::UnevaluatedProperties { unexpected } => {
            let known = known_keys(node);
            let object = scene.pointer(path).and_then(Value::as_object);
            found.extend(
                unexpected
                    .iter()
                    .map(|key| unknown(path, key, object, &known)),
            );
        }
        Kind::Required { property } => {
            let key = property.as_str().unwrap_or_default();
            found.push(at(missing(key, node)));
        }
        Kind::AnyOf { context } | Kind::OneOfNotValid { context } => {
            match best_branch(path, context) {
                Some(branch) => branch.iter().for_each(|e| explain(schema, scene, e, found)),
                None => found.push(no_form(schema, path, error.instance(), node)),
            }
        }
        Kind::Type { kind } => found.push(at(format!(
            "is {} ({}), wanted is {}{}",
            show(error.instance()),
            type_of(error.instance()),
            wanted(kind),
            unit.map(|u| format!(" in {u}")).unwrap_or_default(),
        ))),
        Kind::Minimum { .. }
        | Kind::ExclusiveMinimum { .. }
        | Kind::Maximum { .. }
        | Kind::ExclusiveMaximum { .. } => {
            let unit = unit.map(|u| format!(" {u}")).unwrap_or_default();
            found.push(at(format!(
                "{}{unit} is out of range: {}",
                show(error.instance()),
                range(node, &unit)
            )));
        }
        Kind::Enum { options } => found.push(at(none_of(error.instance(), options))),
        Kind::MinItems { limit } => {
            found.push(at(entries(error.instance(), "at least", *limit, node)))
        }
        Kind::MaxItems { limit } => {
            found.push(at(entries(error.instance(), "at most", *limit, node)))
        }
        Kind::Constant { expected_value } => {
            found.push(at(format!(
                "is {}, wanted is {expected_value}",
                show(error.instance())
            )));
        }
        _ => found.push(at(error.to_string())),
    }
}

fn unknown(path: &str, key: &str, object: Option<&Map<String, Value>>, known: &[&str]) -> Fault {
    let value = object.and_then(|map| map.get(key));
    let hint =
        instead_of(key, value, known).unwrap_or_else(|| format!("known are: {}", known.join(", ")));
    Fault::of_key(path, key, format!("unknown key; {hint}"))
}

fn missing(key: &str, node: Option<&Value>) -> String {
    let described = node
        .and_then(|n| n.pointer(&format!("/properties/{key}/description")))
        .and_then(Value::as_str)
        .map(|text| format!(" ({})", plain(text.lines().next().unwrap_or_default())))
        .unwrap_or_default();
    let unit = unit_of_key(key)
        .map(|u| format!(" in {u}"))
        .unwrap_or_default();
    format!("has no key '{key}'{unit}{described}")
}

/// A description without the escapes that its documentation needs.
fn plain(text: &str) -> String {
    text.replace("\\[", "[").replace("\\]", "]")
}

fn entries(list: &Value, word: &str, limit: u64, node: Option<&Value>) -> String {
    let bound = |key: &str| node?.get(key)?.as_u64();
    let fixed = bound("minItems").is_some() && bound("minItems") == bound("maxItems");
    let word = if fixed { "exactly" } else { word };
    let found = list.as_array().map_or(0, Vec::len);
    format!(
        "{} has {found} entries, wanted are {word} {limit}",
        show(list)
    )
}

/// The schema that holds the keyword at `keyword`.
fn parent_node<'a>(schema: &'a Value, keyword: &str) -> Option<&'a Value> {
    let end = keyword.rfind('/')?;
    let node = schema.pointer(&keyword[..end])?;
    // `required` errors carry the index of the key as well.
    if node.is_array() {
        parent_node(schema, &keyword[..end])
    } else {
        Some(node)
    }
}

fn known_keys(node: Option<&Value>) -> Vec<&str> {
    let properties = node
        .and_then(|n| n.get("properties"))
        .and_then(Value::as_object);
    properties
        .into_iter()
        .flat_map(|map| map.keys().map(String::as_str))
        .collect()
}

fn last_key(path: &str) -> &str {
    path.rsplit('/')
        .find(|part| !part.is_empty() && part.parse::<usize>().is_err())
        .unwrap_or_default()
}

fn range(node: Option<&Value>, unit: &str) -> String {
    let bound = |key: &str, word: &str| {
        let limit = node.and_then(|n| n.get(key)).and_then(Value::as_f64)?;
        Some(format!("{word} {limit}{unit}"))
    };
    let parts = [
        bound("minimum", "at least"),
        bound("exclusiveMinimum", "above"),
        bound("maximum", "at most"),
        bound("exclusiveMaximum", "below"),
    ];
    parts
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .join(" and ")
}

fn wanted(kind: &TypeKind) -> String {
    let name = |t: JsonType| match t {
        JsonType::Number => "a number",
        JsonType::Integer => "a whole number",
        JsonType::String => "a text",
        JsonType::Boolean => "true or false",
        JsonType::Array => "a list",
        JsonType::Object => "an object",
        JsonType::Null => "nothing",
    };
    match kind {
        TypeKind::Single(t) => name(*t).to_owned(),
        TypeKind::Multiple(set) => set
            .iter()
            .filter(|t| *t != JsonType::Null)
            .map(name)
            .collect::<Vec<_>>()
            .join(" or "),
    }
}
