//! Whole numbers as others write them: `2.0` and `1e3` are integers in JSON, and too large ones are found by the schema.

use serde::de::DeserializeOwned;
use serde_json::{Number, Value, json};

/// Reads a scene; where it wants integers, floats that are whole are taken for them.
pub(super) fn read<S: DeserializeOwned>(scene: Value) -> Result<S, serde_json::Error> {
    serde_json::from_value(scene.clone())
        .or_else(|first| serde_json::from_value(whole(scene)).map_err(|_| first))
}

/// The value with every float that is whole as an integer.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "only within the range of the type"
)]
fn whole(value: Value) -> Value {
    match value {
        Value::Number(n) if n.is_f64() => Value::Number(match n.as_f64() {
            Some(x) if x.trunc() - x != 0.0 => n,
            Some(x) if (0.0..1.8e19).contains(&x) => Number::from(x as u64),
            Some(x) if (-9.2e18..0.0).contains(&x) => Number::from(x as i64),
            _ => n,
        }),
        Value::Array(list) => Value::Array(list.into_iter().map(whole).collect()),
        Value::Object(map) => {
            Value::Object(map.into_iter().map(|(key, v)| (key, whole(v))).collect())
        }
        other => other,
    }
}

/// The schema with the ends of the integer types of the machine, which it names and does not bound.
pub(super) fn bounded(mut schema: Value) -> Value {
    bound(&mut schema);
    schema
}

fn bound(node: &mut Value) {
    match node {
        Value::Object(map) => {
            let format = map.get("format").and_then(Value::as_str);
            let ends = match format {
                Some("uint8") => Some((json!(0), json!(u8::MAX))),
                Some("uint16") => Some((json!(0), json!(u16::MAX))),
                Some("uint32") => Some((json!(0), json!(u32::MAX))),
                Some("uint" | "uint64") => Some((json!(0), json!(u64::MAX))),
                Some("int32") => Some((json!(i32::MIN), json!(i32::MAX))),
                Some("int" | "int64") => Some((json!(i64::MIN), json!(i64::MAX))),
                _ => None,
            };
            if let Some((least, most)) = ends {
                if !map.contains_key("exclusiveMinimum") {
                    map.entry("minimum").or_insert(least);
                }
                if !map.contains_key("exclusiveMaximum") {
                    map.entry("maximum").or_insert(most);
                }
            }
            map.values_mut().for_each(bound);
        }
        Value::Array(list) => list.iter_mut().for_each(bound),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_floats_are_integers_and_others_are_not() {
        let read = |text: &str| read::<Vec<u32>>(serde_json::from_str(text).unwrap());
        assert_eq!(read("[2.0, 1e3, 4]").unwrap(), [2, 1000, 4]);
        assert!(read("[2.5]").is_err() && read("[-1.0]").is_err());
        let seeds: Vec<u64> = super::read(json!([1e19])).unwrap();
        assert_eq!(seeds, [10_000_000_000_000_000_000]);
    }

    #[test]
    fn integer_types_get_their_ends() {
        let schema =
            json!({"properties": {"n": {"type": "integer", "format": "uint32", "minimum": 1}}});
        let found = bounded(schema);
        assert_eq!(found["properties"]["n"]["maximum"], json!(u32::MAX));
        assert_eq!(found["properties"]["n"]["minimum"], json!(1));
    }
}
