//! The way through the values of a scene.

use serde_json::{Number, Value};

use super::origin::escaped;

/// Tells every key of every object with its JSON pointer and its value, outer ones first.
pub(super) fn keys(scene: &Value, each: &mut impl FnMut(&str, &str, &Value)) {
    within(scene, "", each);
}

fn within(value: &Value, at: &str, each: &mut impl FnMut(&str, &str, &Value)) {
    match value {
        Value::Array(list) => {
            for (i, value) in list.iter().enumerate() {
                within(value, &format!("{at}/{i}"), each);
            }
        }
        Value::Object(map) => {
            for (key, value) in map {
                let path = format!("{at}/{}", escaped(key));
                each(&path, key, value);
                within(value, &path, each);
            }
        }
        _ => {}
    }
}

/// Tells the numbers of a quantity: those under keys that `is` names, in lists there, and as the `value` of an object there.
pub(super) fn numbers(
    scene: &Value,
    is: &impl Fn(&str) -> bool,
    each: &mut impl FnMut(&str, &Number),
) {
    of(scene, "", false, is, each);
}

fn of(
    value: &Value,
    at: &str,
    own: bool,
    is: &impl Fn(&str) -> bool,
    each: &mut impl FnMut(&str, &Number),
) {
    match value {
        Value::Number(number) if own => each(at, number),
        Value::Array(list) => {
            for (i, value) in list.iter().enumerate() {
                of(value, &format!("{at}/{i}"), own, is, each);
            }
        }
        Value::Object(map) => {
            for (key, value) in map {
                let own = is(key) || (own && key == "value");
                of(value, &format!("{at}/{}", escaped(key)), own, is, each);
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn keys_are_told_outer_ones_first_with_their_pointers() {
        let scene = json!({"a": [{"b/c": 1}, 2], "d": {"e": {}}});
        let mut found = Vec::new();
        keys(&scene, &mut |path, key, _| {
            found.push(format!("{key} {path}"));
        });
        assert_eq!(found, ["a /a", "b/c /a/0/b~1c", "d /d", "e /d/e"]);
    }

    #[test]
    fn numbers_are_those_of_the_quantity_alone() {
        let scene = json!({
            "t_k": [1, 2], "wall": {"t_k": {"value": 3, "other": 4}}, "value": 5, "name": "t_k"
        });
        let mut found = Vec::new();
        numbers(&scene, &|key| key == "t_k", &mut |path, number| {
            found.push(format!("{path} {number}"));
        });
        assert_eq!(found, ["/t_k/0 1", "/t_k/1 2", "/wall/t_k/value 3"]);
    }
}
