//! JSON that is no longer what it was: numbers, keys, types, lists and texts, one change at a time.

use serde_json::{Map, Value, json};

use crate::chance::Chance;

/// A text that stands for what is no value of JSON's own, until the file is written.
const RAW: &str = "@raw@";
/// What writers of other people, and their mistakes, put where a number stands.
const TOKENS: [&str; 16] = [
    "2.0",
    "1e3",
    "1E0",
    "-0",
    "-0.0",
    "1e999",
    "-1e999",
    "1e-400",
    "18446744073709551616",
    "9223372036854775808",
    "-1",
    "0x10",
    "007",
    "NaN",
    "Infinity",
    "1_000",
];
/// Texts that no key wants.
const TEXTS: [&str; 14] = [
    "",
    " ",
    "\u{1b}[2J\u{1b}[31m",
    "a\u{7}b\u{8}\u{0}c",
    "\u{202e}desrever",
    "line\nof two",
    "../../../etc/passwd",
    "1/0",
    "x^x^x^x",
    "((((((((((((((((",
    "sqrt(-1)",
    "0*t + 1e308*1e308",
    "\u{fffd}\u{10ffff}",
    "%s%n{}",
];

/// JSON pointers of a value and of all in it.
pub(crate) fn places(value: &Value) -> Vec<String> {
    fn walk(value: &Value, at: String, found: &mut Vec<String>) {
        match value {
            Value::Object(map) => {
                for (key, value) in map {
                    let key = key.replace('~', "~0").replace('/', "~1");
                    walk(value, format!("{at}/{key}"), found);
                }
            }
            Value::Array(list) => {
                for (i, value) in list.iter().enumerate() {
                    walk(value, format!("{at}/{i}"), found);
                }
            }
            _ => {}
        }
        found.push(at);
    }
    let mut found = Vec::new();
    walk(value, String::new(), &mut found);
    found
}

/// Gives a number another size: what most often leads further than the schema.
pub(crate) fn rescale(value: &mut Value, chance: &mut Chance) {
    let numbers: Vec<String> = places(value)
        .into_iter()
        .filter(|at| value.pointer(at).is_some_and(Value::is_number))
        .collect();
    let powers = [1e-6, 1e-2, 0.1, 0.3, 0.9, 1.1, 3.0, 10.0, 100.0, 1e6];
    let power = chance.pick(&powers).copied().unwrap_or(1.0);
    let place = chance.pick(&numbers).and_then(|at| value.pointer_mut(at));
    if let Some(here) = place {
        let x = here.as_f64().unwrap_or(0.0) * power;
        // What counts things goes on to count them.
        *here = if here.is_f64() {
            json!(x)
        } else {
            json!(x.ceil() as i64)
        };
    }
}

/// Changes one thing; what is grafted comes from `donor`.
pub(crate) fn change(value: &mut Value, donor: &Value, chance: &mut Chance) {
    let all = places(value);
    let numbers: Vec<&String> = all
        .iter()
        .filter(|at| value.pointer(at).is_some_and(Value::is_number))
        .collect();
    // Numbers are what scenes are made of.
    let at = match chance.pick(&numbers) {
        Some(at) if !chance.one_in(3) => (*at).clone(),
        _ => chance.pick(&all).cloned().unwrap_or_default(),
    };
    let grafts = places(donor);
    let graft = chance.pick(&grafts).and_then(|at| donor.pointer(at));
    let Some(here) = value.pointer_mut(&at) else {
        return;
    };
    if chance.one_in(8) {
        *here = graft.cloned().unwrap_or_default();
        return;
    }
    match here {
        Value::Number(_) => *here = number(here.as_f64().unwrap_or(0.0), chance),
        Value::String(text) => {
            *text = match chance.below(3) {
                0 => "long ".repeat(1 + chance.below(2000)),
                1 => format!("{text}{}", chance.pick(&TEXTS).copied().unwrap_or_default()),
                _ => chance.pick(&TEXTS).copied().unwrap_or_default().to_owned(),
            }
        }
        Value::Object(map) => object(map, chance),
        Value::Array(list) => array(list, chance),
        Value::Bool(flag) => *flag = !*flag,
        Value::Null => *here = other(chance),
    }
}

/// A number at another size, sign or spelling.
fn number(x: f64, chance: &mut Chance) -> Value {
    let powers = [1e-12, 1e-3, 0.1, 0.5, 0.999, 1.001, 2.0, 10.0, 1e3, 1e12];
    match chance.below(16) {
        0 => raw(chance.pick(&TOKENS).copied().unwrap_or_default()),
        1 => json!(-x),
        2 => json!(0),
        3 => {
            let ends = [1e-300, 1e300, -1e300, 4e9, f64::MIN_POSITIVE, f64::MAX];
            json!(chance.pick(&ends))
        }
        4 => json!(x.round() as i64 + [-1, 1][chance.below(2)]),
        5 => other(chance),
        _ => json!(x * chance.pick(&powers).copied().unwrap_or(1.0)),
    }
}

fn object(map: &mut Map<String, Value>, chance: &mut Chance) {
    let keys: Vec<String> = map.keys().cloned().collect();
    let Some(key) = chance.pick(&keys) else {
        map.insert("added".to_owned(), other(chance));
        return;
    };
    let value = map.shift_remove(key).unwrap_or_default();
    let renamed = match chance.below(5) {
        0 => return,
        1 => format!("{key}{}", chance.pick(&TEXTS).copied().unwrap_or_default()),
        2 => key.chars().rev().collect(),
        3 => key.trim_end_matches("_m").to_owned() + "_mm",
        _ => {
            let own = chance.pick(&keys).cloned().unwrap_or_default();
            map.insert(own, value.clone());
            key.clone()
        }
    };
    map.insert(renamed, value);
}

fn array(list: &mut Vec<Value>, chance: &mut Chance) {
    let n = list.len();
    match chance.below(6) {
        0 => list.clear(),
        1 => list.truncate(chance.below(n)),
        2 => list.reverse(),
        3 if n > 0 => {
            let twice = list[chance.below(n)].clone();
            list.insert(chance.below(n), twice);
        }
        4 if n > 0 => {
            list.swap(0, chance.below(n));
        }
        _ => list.push(other(chance)),
    }
}

/// A small value of any type.
fn other(chance: &mut Chance) -> Value {
    match chance.below(8) {
        0 => Value::Null,
        1 => json!(true),
        2 => json!([]),
        3 => json!({}),
        4 => json!([0, 0, 0]),
        5 => json!({"expr": chance.pick(&TEXTS)}),
        6 => json!({"t_k": [300, 200], "value": [1]}),
        _ => json!(chance.pick(&TEXTS)),
    }
}

fn raw(token: &str) -> Value {
    Value::String(format!("{RAW}{token}"))
}

/// The text of a value, raw tokens as they are.
pub(crate) fn text(value: &Value) -> String {
    let text = serde_json::to_string_pretty(value).unwrap_or_default();
    let mark = format!("\"{RAW}");
    let mut parts = text.split(&mark);
    let mut whole = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (token, rest) = part.split_once('"').unwrap_or((part, ""));
        whole += token;
        whole += rest;
    }
    whole
}

/// The bytes of a text with a fault that no value can have.
pub(crate) fn spoilt(text: &str, chance: &mut Chance) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    let at = chance.below(bytes.len());
    match chance.below(7) {
        0 => bytes.truncate(at),
        1 => bytes[at] = chance.next() as u8,
        2 => {
            bytes.splice(
                at..at,
                [b"\x1b[7m".as_slice(), b"\0", b"\xff\xfe", b",,"][chance.below(4)].to_vec(),
            );
        }
        3 => {
            let depth = 1 << chance.below(20);
            bytes = [b'[', b'{'][chance.below(2)..][..1].repeat(depth);
        }
        4 => {
            bytes.splice(0..0, *b"\xef\xbb\xbf");
        }
        5 => {
            let second = br#"{"kind": "poolsph.scene", "kind": 7,"#;
            bytes.splice(0..1, *second);
        }
        _ => bytes.extend_from_within(at..),
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_change_and_raw_tokens_are_written_raw() {
        let scene = json!({"kind": "x.scene", "spacing_m": 1e-3, "list": [1, 2], "flag": true});
        let changed = (0..200).filter(|trial| {
            let mut own = scene.clone();
            change(&mut own, &scene, &mut Chance::of(7, *trial));
            own != scene
        });
        assert!(changed.count() > 180);
        assert_eq!(text(&json!({"n": raw("1e999")})), "{\n  \"n\": 1e999\n}");
    }
}
