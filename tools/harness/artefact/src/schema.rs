//! What in a JSON value does not fit its schema.

use jsonschema::Validator;
use serde_json::Value;

/// What in `value` does not fit its schema, with the names of column and row where there are such.
pub fn schema_faults(validator: &Validator, value: &Value, at: &str, found: &mut Vec<String>) {
    for error in validator.iter_errors(value) {
        let path = error.instance_path().as_str();
        let what = match error.instance().as_ref() {
            Value::Null => "null is not a finite number".to_owned(),
            _ => error.to_string(),
        };
        found.push(format!("{at}, {}: {what}", place(value, path)));
    }
}

/// A JSON pointer in the words of tables: column and row.
fn place(value: &Value, path: &str) -> String {
    let parts: Vec<&str> = path.split('/').skip(1).collect();
    let name = |list: &str, i: &str| {
        let item = value.pointer(&format!("/{list}/{i}/name"));
        item.and_then(Value::as_str).map(str::to_owned)
    };
    let words = match parts.as_slice() {
        [list @ ("columns" | "axes"), i, "values", row] => {
            name(list, i).map(|name| format!("column '{name}', row {row}"))
        }
        ["values", i, "value"] => name("values", i).map(|name| format!("column '{name}', row 0")),
        ["attributes", name, "value"] => Some(format!("attribute '{name}'")),
        _ => None,
    };
    words.unwrap_or_else(|| match path {
        "" => "the whole message".to_owned(),
        path => format!("at {path}"),
    })
}
