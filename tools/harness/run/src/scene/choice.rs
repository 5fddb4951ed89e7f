//! A value that fits none of the forms it may have: which form was meant, and what to say.

use std::cmp::Reverse;

use jsonschema::ValidationError;
use jsonschema::error::ValidationErrorKind as Kind;
use serde_json::Value;

use super::suggest::instead_of;
use super::words::{none_of, show, type_of};
use crate::fault::Fault;

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
    // Where each form lacks one key, none of them is the one that was meant.
    let lacks = |e: &ValidationError<'_>| matches!(e.kind(), Kind::Required { .. });
    let all_lack = first.is_some_and(|branch| branch.iter().all(lacks));
    if best.next().is_some() && (fewest > (1, 1) || all_lack) {
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
            all => format!(
                "{shown} fits none of: {}{}",
                all.join(" | "),
                keys_and_nearest(schema, found, &branches)
            ),
        },
    )
}

/// The branches of a choice, references followed, without the one for absence.
fn branches<'a>(schema: &'a Value, node: Option<&'a Value>) -> Vec<&'a Value> {
    let all = node
        .and_then(|n| n.get("anyOf").or_else(|| n.get("oneOf")))
        .and_then(Value::as_array);
    let absence = Value::from("null");
    all.into_iter()
        .flatten()
        .map(|branch| followed(schema, branch))
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

/// Which keys an object has, and which form has most of them.
fn keys_and_nearest(schema: &Value, found: &Value, branches: &[&Value]) -> String {
    let Some(object) = found.as_object() else {
        return String::new();
    };
    if object.is_empty() {
        return "; it has no key".to_owned();
    }
    let own: Vec<String> = object.keys().map(|key| format!("'{key}'")).collect();
    let own = format!("; it has {}", own.join(", "));
    // Of those with the most of its keys, the one with the fewest others.
    let weight = |branch: &Value| {
        let known = keys_of(schema, branch, 2);
        let shared = object.keys().filter(|key| known.contains(*key)).count();
        (shared, Reverse(known.len()))
    };
    let most = branches.iter().map(|b| weight(b)).max();
    let mut best = branches.iter().filter(|b| Some(weight(b)) == most);
    match (most, best.next(), best.next()) {
        (Some((1.., _)), Some(branch), None) => {
            format!("{own}; nearest is {}", spread(schema, branch))
        }
        _ => own,
    }
}

/// A schema with its reference followed.
fn followed<'a>(schema: &'a Value, node: &'a Value) -> &'a Value {
    match node.get("$ref").and_then(Value::as_str) {
        Some(reference) => schema
            .pointer(reference.trim_start_matches('#'))
            .unwrap_or(node),
        None => node,
    }
}

/// Keys of a form and, to some depth, of the objects in it: `{"box": {"min_m", "max_m"}}` has three.
fn keys_of(schema: &Value, node: &Value, depth: usize) -> Vec<String> {
    let properties = followed(schema, node)
        .get("properties")
        .and_then(Value::as_object);
    let mut keys = Vec::new();
    for (key, child) in properties.into_iter().flatten() {
        keys.push(key.clone());
        if depth > 1 {
            keys.extend(keys_of(schema, child, depth - 1));
        }
    }
    keys
}

/// A form with the keys of the objects in it: `{"box": {"min_m", "max_m"}}`.
fn spread(schema: &Value, branch: &Value) -> String {
    let properties = branch.get("properties").and_then(Value::as_object);
    let one = |(key, child): (&String, &Value)| {
        let inner = keys_of(schema, child, 1);
        let constant = child.get("const");
        match constant {
            Some(value) => format!("\"{key}\": {value}"),
            None if inner.is_empty() => format!("\"{key}\""),
            None => format!("\"{key}\": {{\"{}\"}}", inner.join("\", \"")),
        }
    };
    let all: Vec<String> = properties.into_iter().flatten().map(one).collect();
    if all.is_empty() {
        form(branch)
    } else {
        format!("{{{}}}", all.join(", "))
    }
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
