//! Templates: `${name}` stands for the value of a parameter.

use serde_json::Value;

use crate::plan::Stage;

/// The names that a text calls, each with its `${...}`.
pub(crate) fn calls(text: &str) -> Vec<&str> {
    let mut all = Vec::new();
    let mut rest = text;
    while let Some(begin) = rest.find("${") {
        let inside = &rest[begin + 2..];
        let Some(end) = inside.find('}') else {
            // What is never closed is a name that nothing has.
            all.push(inside);
            break;
        };
        all.push(&inside[..end]);
        rest = &inside[end + 1..];
    }
    all
}

/// Every text of a value with its JSON pointer.
pub(crate) fn texts(value: &Value) -> Vec<(String, &str)> {
    let below = |key: &str, inner| {
        let key = key.replace('~', "~0").replace('/', "~1");
        texts(inner)
            .into_iter()
            .map(move |(at, text)| (format!("/{key}{at}"), text))
    };
    match value {
        Value::String(text) => vec![(String::new(), text.as_str())],
        Value::Array(items) => {
            let items = items.iter().enumerate();
            items.flat_map(|(i, v)| below(&i.to_string(), v)).collect()
        }
        Value::Object(map) => map.iter().flat_map(|(key, v)| below(key, v)).collect(),
        _ => Vec::new(),
    }
}

/// A text with its calls replaced by the names of the values.
pub(crate) fn text(template: &str, name: impl Fn(&str) -> String) -> String {
    let mut out = template.to_owned();
    for call in calls(template) {
        out = out.replace(&format!("${{{call}}}"), &name(call));
    }
    out
}

/// A template with its calls replaced: a text that is one call becomes the value itself, others take its name in.
pub(crate) fn filled(template: &Value, value: &impl Fn(&str) -> (String, Value)) -> Value {
    match template {
        Value::String(words) => match calls(words).as_slice() {
            [only] if words.len() == only.len() + 3 => value(only).1,
            _ => Value::String(text(words, |call| value(call).0)),
        },
        Value::Array(items) => items.iter().map(|v| filled(v, value)).collect(),
        Value::Object(map) => {
            let entries = map.iter();
            Value::Object(
                entries
                    .map(|(key, v)| (key.clone(), filled(v, value)))
                    .collect(),
            )
        }
        other => other.clone(),
    }
}

/// Parameters that a stage names itself.
pub(crate) fn named_by(stage: &Stage) -> Vec<&str> {
    let files = stage.inputs.iter().filter_map(|i| i.file.as_ref());
    let paths = [&stage.scene]
        .into_iter()
        .chain(&stage.patches)
        .chain(files);
    let template = stage.template.iter().flat_map(texts).map(|(_, text)| text);
    let all = paths.map(String::as_str).chain(template);
    all.flat_map(calls).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_call_alone_is_the_value_and_one_in_words_its_name() {
        let template = json!({"a": {"current_a": "${current}"}, "title": "${current} A in ${gas}", "b": [1, null]});
        let value = |name: &str| match name {
            "current" => ("300".to_owned(), json!(300)),
            _ => ("argon".to_owned(), json!("argon")),
        };
        assert_eq!(
            filled(&template, &value),
            json!({"a": {"current_a": 300}, "title": "300 A in argon", "b": [1, null]})
        );
    }

    #[test]
    fn calls_are_found_where_they_stand() {
        let template = json!({"a/b": ["x", "${one} ${two}"]});
        let found = texts(&template);
        assert_eq!(found[1], ("/a~1b/1".to_owned(), "${one} ${two}"));
        assert_eq!(calls(found[1].1), ["one", "two"]);
        assert_eq!(calls("${never closed"), ["never closed"]);
        assert!(calls("no call, 5 $").is_empty());
    }
}
