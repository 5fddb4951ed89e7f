//! A value that fits none of the forms it may have: which form was meant, and what to say.

use jsonschema::ValidationError;
use jsonschema::error::ValidationErrorKind as Kind;
use serde_json::Value;

use super::fault::Fault;
use super::suggest::instead_of;
use super::validate::{none_of, show, type_of};

/// The branch of a choice that the person meant: not excluded by type or tag, with fewest faults.
pub(super) fn best_branch<'a>(
    path: &str,
    context: &'a [Vec<ValidationError<'static>>],
) -> Option<&'a Vec<ValidationError<'static>>> {
    let excluded = |e: &ValidationError<'_>| {
        let own = e.instance_path().as_str();
        match e.kind() {
            Kind::Type { .. } | Kind::Enum { .. } => own == path,
            // A tag, such as "shape": "box", is a constant directly in the object.
            Kind::Constant { .. } => own
                .strip_prefix(path)
                .is_some_and(|rest| rest.matches('/').count() <= 1),
            _ => false,
        }
    };
    let left: Vec<_> = context
        .iter()
        .filter(|branch| !branch.iter().any(excluded))
        .collect();
    // A fault within the value says less against a branch than one of the value itself.
    let weight = |branch: &[ValidationError<'_>]| {
        let own = branch.iter().filter(|e| e.instance_path().as_str() == path);
        (
            own.map(faults_in).sum::<usize>(),
            branch.iter().map(faults_in).sum::<usize>(),
        )
    };
    let fewest = left.iter().map(|branch| weight(branch)).min()?;
    let mut best = left.into_iter().filter(|branch| weight(branch) == fewest);
    let first = best.next();
    if best.next().is_some() && fewest > (1, 1) {
        None
    } else {
        first
    }
}

/// How many faults an error stands for: each key that a branch does not know counts.
fn faults_in(error: &ValidationError<'_>) -> usize {
    match error.kind() {
        Kind::AdditionalProperties { unexpected } | Kind::UnevaluatedProperties { unexpected } => {
            unexpected.len()
        }
        _ => 1,
    }
}

/// The fault of a value that fits no form of a choice.
pub(super) fn no_form(schema: &Value, path: &str, found: &Value, node: Option<&Value>) -> Fault {
    let branches = branches(schema, node);
    let words: Vec<Value> = branches
        .iter()
        .filter_map(|b| b.get("const").cloned())
        .collect();
    if words.len() == branches.len() {
        return Fault::at(path, none_of(found, &Value::Array(words)));
    }
    if let Some(fault) = mistyped_tag(path, found, &branches) {
        return fault;
    }
    let forms: Vec<String> = branches.iter().map(|branch| form(branch)).collect();
    let (shown, kind) = (show(found), type_of(found));
    Fault::at(
        path,
        match forms.as_slice() {
            [only] if !found.is_object() => format!("is {shown} ({kind}), wanted is {only}"),
            [only] => format!("{shown} does not fit {only}"),
            all => format!("{shown} fits none of: {}", all.join(" | ")),
        },
    )
}

/// The branches of a choice, references followed, without the one for absence.
fn branches<'a>(schema: &'a Value, node: Option<&'a Value>) -> Vec<&'a Value> {
    let all = node
        .and_then(|n| n.get("anyOf").or_else(|| n.get("oneOf")))
        .and_then(Value::as_array);
    let followed = |branch: &'a Value| match branch.get("$ref").and_then(Value::as_str) {
        Some(reference) => schema
            .pointer(reference.trim_start_matches('#'))
            .unwrap_or(branch),
        None => branch,
    };
    let absence = Value::from("null");
    all.into_iter()
        .flatten()
        .map(followed)
        .filter(|branch| branch.get("type") != Some(&absence))
        .collect()
}

/// An object whose keys no form knows, but one is near to a known one: `{"spere": {..}}`.
fn mistyped_tag(path: &str, found: &Value, branches: &[&Value]) -> Option<Fault> {
    let object = found.as_object()?;
    let keys = |branch: &&'_ Value| branch.get("properties").and_then(Value::as_object).cloned();
    let known: Vec<String> = branches
        .iter()
        .filter_map(keys)
        .flat_map(|map| map.into_iter().map(|(key, _)| key))
        .collect();
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    object.iter().find_map(|(key, value)| {
        let hint = if known.contains(&key.as_str()) {
            None
        } else {
            instead_of(key, Some(value), &known)
        };
        Some(Fault::of_key(path, key, format!("unknown key; {}", hint?)))
    })
}

/// A form in a few words: tag, constant, keys, title or type.
fn form(branch: &Value) -> String {
    let properties = branch.get("properties").and_then(Value::as_object);
    let tag = properties.and_then(|all| {
        all.iter()
            .find_map(|(key, p)| p.get("const").map(|c| format!("{{\"{key}\": {c}, ...}}")))
    });
    let keys = || {
        let quoted = properties?.keys().map(|key| format!("\"{key}\""));
        Some(format!("{{{}}}", quoted.collect::<Vec<_>>().join(", ")))
    };
    let text = |key: &str| branch.get(key).and_then(Value::as_str).map(str::to_owned);
    let constant = || {
        branch
            .get("const")
            .or_else(|| branch.get("enum"))
            .map(Value::to_string)
    };
    tag.or_else(constant)
        .or_else(keys)
        .or_else(|| text("title"))
        .or_else(|| text("type"))
        .unwrap_or_default()
}
