//! JSON artefacts: run records, evidence, gas tables.

use std::path::Path;

use artefact::{json_error, schema_faults};
use serde_json::Value;

use super::Streams;
use super::sheet::{Sheet, short};
use super::trouble::{Trouble, file_error};

/// Schemas of our JSON files by kind.
const SCHEMAS: [(&str, &str); 11] = [
    (
        "run-record",
        include_str!("../../../../../schemas/run-record.v1.json"),
    ),
    (
        "gas-table",
        include_str!("../../../../../schemas/gas-table.v1.json"),
    ),
    (
        "gas-reference",
        include_str!("../../../../../schemas/gas-reference.v1.json"),
    ),
    (
        "field-exact",
        include_str!("../../../../../schemas/field-exact.v1.json"),
    ),
    (
        "surface-profile",
        include_str!("../../../../../schemas/surface-profile.v1.json"),
    ),
    (
        "verification",
        include_str!("../../../../../schemas/verification.v1.json"),
    ),
    (
        "stability",
        include_str!("../../../../../schemas/stability.v1.json"),
    ),
    (
        "bench",
        include_str!("../../../../../schemas/bench.v1.json"),
    ),
    (
        "absence",
        include_str!("../../../../../schemas/absence.v1.json"),
    ),
    (
        "certificate",
        include_str!("../../../../../schemas/certificate.v1.json"),
    ),
    (
        "others",
        include_str!("../../../../../schemas/others.v1.json"),
    ),
];

/// What a JSON file is: what it states, or evidence by its keys.
fn kind(value: &Value) -> Option<&str> {
    let evidence = |list: &str| value.get("case").is_some() && value.get(list).is_some();
    match value["kind"].as_str() {
        Some(kind) => Some(kind),
        None if evidence("levels") => Some("verification"),
        None if evidence("runs") => Some("stability"),
        None => None,
    }
}

fn read(path: &Path) -> Result<Value, Trouble> {
    let text = std::fs::read_to_string(path).map_err(file_error(path, "read"))?;
    serde_json::from_str(&text).map_err(|e| json_error(path, &e).into())
}

/// All that is wrong with a JSON file, and what it is when nothing is.
pub(crate) fn findings(path: &Path) -> (Vec<String>, String) {
    let value = match read(path) {
        Ok(value) => value,
        Err(e) => return (vec![e.to_string()], String::new()),
    };
    let at = path.display().to_string();
    let Some(kind) = kind(&value) else {
        return (
            vec![format!("{at}: no artefact of ours: it states no \"kind\"")],
            String::new(),
        );
    };
    let Some((_, schema)) = SCHEMAS.iter().find(|(name, _)| *name == kind) else {
        let known: Vec<&str> = SCHEMAS.iter().map(|(name, _)| *name).collect();
        let what = match kind.strip_suffix(".scene") {
            Some(tool) => format!("a scene: '{tool} check FILE' validates it"),
            None => format!("unknown kind; known are {}", known.join(", ")),
        };
        return (vec![format!("{at}: '{kind}' is {what}")], String::new());
    };
    let mut found = Vec::new();
    match serde_json::from_str(schema)
        .map_err(|e| e.to_string())
        .and_then(|s: Value| jsonschema::validator_for(&s).map_err(|e| e.to_string()))
    {
        Ok(validator) => schema_faults(&validator, &value, &at, &mut found),
        Err(e) => found.push(format!("{at}: the schema of '{kind}': {e}")),
    }
    column_faults(&value, &at, &mut found);
    (found, kind.to_owned())
}

/// Columns that are not as long as the first.
fn column_faults(value: &Value, at: &str, found: &mut Vec<String>) {
    let columns = value["columns"].as_array().into_iter().flatten();
    let lengths: Vec<(&str, usize)> = columns
        .filter_map(|c| Some((c["name"].as_str()?, c["values"].as_array()?.len())))
        .collect();
    for (name, n) in lengths.iter().skip(1) {
        let (first, expected) = lengths[0];
        if *n != expected {
            found.push(format!(
                "{at}, column '{name}': has {n} entries, '{first}' has {expected}"
            ));
        }
    }
}

/// Says what a JSON file holds.
pub(crate) fn info(path: &Path, streams: &mut Streams<'_>) -> Result<(), Trouble> {
    let value = read(path)?;
    let out = &mut streams.out;
    writeln!(out, "file        {}", path.display())?;
    let version = match &value["version"] {
        Value::String(text) => format!(" {text}"),
        Value::Number(number) => format!(" {number}"),
        _ => String::new(),
    };
    writeln!(
        out,
        "kind        {}{version}",
        kind(&value).unwrap_or("not stated")
    )?;
    let Some(map) = value.as_object() else {
        return Ok(());
    };
    for (key, value) in map {
        match value {
            Value::Object(_) | Value::Array(_) => list(key, value, streams)?,
            Value::String(text) => writeln!(streams.out, "{key:<28} {text}")?,
            other => writeln!(streams.out, "{key:<28} {other}")?,
        }
    }
    Ok(())
}

/// At most this many entries of a list are shown.
const SHOWN: usize = 40;

/// One line per entry of a list of objects; columns of numbers by their length and range.
fn list(key: &str, value: &Value, streams: &mut Streams<'_>) -> Result<(), Trouble> {
    if key == "scene" {
        writeln!(streams.out, "{key:<28} (the scene as it ran)")?;
        return Ok(());
    }
    let items: Vec<(String, &Value)> = match value {
        Value::Array(items) => items.iter().map(|v| (String::new(), v)).collect(),
        Value::Object(map) => map.iter().map(|(k, v)| (k.clone(), v)).collect(),
        _ => Vec::new(),
    };
    if items.is_empty() {
        writeln!(streams.out, "{key:<28} none")?;
        return Ok(());
    }
    writeln!(streams.out, "{key}")?;
    for (name, item) in items.iter().take(SHOWN) {
        writeln!(streams.out, "  {}", line(name, item))?;
    }
    if items.len() > SHOWN {
        writeln!(streams.out, "  ... {} more", items.len() - SHOWN)?;
    }
    Ok(())
}

fn line(name: &str, item: &Value) -> String {
    if let (Some(name), Some(values)) = (item["name"].as_str(), item["values"].as_array()) {
        let unit = item["unit"].as_str().unwrap_or("1");
        return format!("{name:<32} {unit:<10} {} entries", values.len());
    }
    let sheet = Sheet::json(item);
    let unit = item["unit"].as_str().unwrap_or_default();
    let texts = sheet.texts.iter().filter(|(k, _)| k != "unit");
    let texts = texts.map(|(key, text)| match key.as_str() {
        "" | "name" | "why" => text.clone(),
        key => format!("{key} {text}"),
    });
    let numbers = sheet.columns.iter().map(|c| {
        let x = c.values.to_f64()[0];
        match c.name.as_str() {
            "" => short(x),
            "value" => format!("{} {unit}", short(x)),
            "bytes" => format!("{x} bytes"),
            "share" => format!("{:.1} %", 100.0 * x),
            "wall_s" => format!("{} s", short(x)),
            key => format!("{key} {}", short(x)),
        }
    });
    let mut parts: Vec<String> = texts.chain(numbers).collect();
    if !name.is_empty() {
        parts.insert(0, name.to_owned());
    }
    // What comes first is a name where more follows.
    if parts.len() > 1 {
        parts[0] = format!("{:<26}", parts[0]);
    }
    parts.join("  ")
}
