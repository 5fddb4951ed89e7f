//! Speed: whatever figures a record of `make bench` lists.

use serde::Deserialize;
use serde_json::{Map, Value};

use crate::html::{Rows, escape};
use crate::records::figure as digits;

/// A record of `make bench`: scalars, and lists of objects that become tables.
#[derive(Debug, Clone, Deserialize)]
#[serde(transparent)]
pub(super) struct Bench {
    entries: Map<String, Value>,
}

/// The scalars in a line, the lists as tables.
pub(super) fn section(bench: &Bench) -> String {
    let mut facts = Vec::new();
    let mut title = String::new();
    let mut tables = String::new();
    for (key, value) in &bench.entries {
        match value {
            Value::Array(rows) if rows.iter().any(Value::is_object) => tables += &table(rows),
            Value::String(name) if key == "name" => title = format!("<h3>{}</h3>\n", escape(name)),
            Value::String(_) if matches!(key.as_str(), "kind" | "version") => {}
            Value::Null => {}
            other => facts.push(format!("{}: {}", key.replace('_', " "), shown(other))),
        }
    }
    let facts = if facts.is_empty() {
        String::new()
    } else {
        format!("<p>{}</p>\n", escape(&facts.join(" \u{b7} ")))
    };
    title + &facts + &tables
}

fn table(rows: &[Value]) -> String {
    let objects: Vec<&Map<String, Value>> = rows.iter().filter_map(Value::as_object).collect();
    let mut keys: Vec<&str> = Vec::new();
    for key in objects.iter().flat_map(|o| o.keys()) {
        if !keys.contains(&key.as_str()) {
            keys.push(key);
        }
    }
    let number = |key: &&str| {
        objects
            .iter()
            .all(|o| o.get(*key).is_none_or(|v| v.is_number() || v.is_null()))
    };
    let head: Vec<String> = keys
        .iter()
        .map(|key| {
            format!(
                "{}{}",
                if number(key) { "#" } else { "" },
                key.replace('_', " ")
            )
        })
        .collect();
    let mut table = Rows::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
    for object in objects {
        table.row(keys.iter().map(|key| {
            object
                .get(*key)
                .map_or_else(String::new, |v| escape(&shown(v)))
        }));
    }
    table.render()
}

fn shown(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        Value::Number(n) if n.is_i64() || n.is_u64() => n.to_string(),
        Value::Number(n) => n.as_f64().map_or_else(|| n.to_string(), digits),
        Value::Array(parts) => parts.iter().map(shown).collect::<Vec<_>>().join(", "),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_becomes_a_column_once() {
        let bench: Bench = serde_json::from_value(serde_json::json!({
            "name": "cores", "threads": 2, "rows": [{"name": "sweep", "ns": 3.5}, {"name": "sort", "ns": 8.25, "note": "x"}]}))
        .unwrap();
        let html = section(&bench);
        assert!(html.contains("<h3>cores</h3>") && html.contains("threads: 2"));
        assert_eq!(html.matches("<th").count(), 3 + 1);
        assert!(html.contains("8.250") && html.contains("sweep"));
    }
}
