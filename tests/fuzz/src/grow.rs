//! Values that a schema allows, or nearly: what a seed does not hold is reached from the schema.

use serde_json::{Map, Value, json};

use crate::chance::Chance;

/// Deeper than this only what is required is grown.
const DEEP: usize = 6;

/// A schema with the definitions that it refers to.
#[derive(Debug, Clone)]
pub(crate) struct Schema(Value);

impl Schema {
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        serde_json::from_str(text)
            .map(Self)
            .map_err(|e| format!("a schema is no JSON: {e}"))
    }

    fn followed<'a>(&'a self, mut node: &'a Value) -> &'a Value {
        while let Some(target) = node["$ref"].as_str().and_then(|r| r.strip_prefix('#')) {
            match self.0.pointer(target) {
                Some(found) => node = found,
                None => break,
            }
        }
        node
    }

    /// Adds a key that the scene leaves out, in a place where the schema knows it.
    pub(crate) fn extend(&self, scene: &mut Value, chance: &mut Chance) {
        let mut open = Vec::new();
        self.open(&self.0, scene, String::new(), &mut open);
        let Some((at, key, node)) = chance.pick(&open) else {
            return;
        };
        let grown = self.grow(node, 0, chance);
        if let Some(Value::Object(map)) = scene.pointer_mut(at) {
            map.insert(key.clone(), grown);
        }
    }

    /// Keys that could be added, each with its place and schema.
    fn open<'a>(
        &'a self,
        node: &'a Value,
        value: &Value,
        at: String,
        found: &mut Vec<(String, String, &'a Value)>,
    ) {
        let node = self.followed(node);
        for list in ["oneOf", "anyOf", "allOf"] {
            for branch in node[list].as_array().into_iter().flatten() {
                self.open(branch, value, at.clone(), found);
            }
        }
        match value {
            Value::Object(map) => {
                let known = node["properties"].as_object();
                for (key, child) in known.into_iter().flatten() {
                    let below = format!("{at}/{key}");
                    match map.get(key) {
                        Some(value) => self.open(child, value, below, found),
                        None => found.push((at.clone(), key.clone(), child)),
                    }
                }
            }
            Value::Array(list) => {
                for (i, value) in list.iter().enumerate() {
                    self.open(&node["items"], value, format!("{at}/{i}"), found);
                }
            }
            _ => {}
        }
    }

    /// A value of a schema.
    fn grow(&self, node: &Value, depth: usize, chance: &mut Chance) -> Value {
        let node = self.followed(node);
        if let Some(fixed) = node.get("const") {
            return fixed.clone();
        }
        if let Some(choices) = node["enum"].as_array() {
            return chance.pick(choices).cloned().unwrap_or_default();
        }
        for list in ["oneOf", "anyOf"] {
            if let Some(branches) = node[list].as_array() {
                let branch = chance.pick(branches).cloned().unwrap_or_default();
                let mut grown = self.grow(&branch, depth + 1, chance);
                if let (Value::Object(own), Some(_)) = (&mut grown, node.get("properties")) {
                    own.extend(self.object(node, depth, chance));
                }
                return grown;
            }
        }
        match kind(node, chance) {
            "object" => Value::Object(self.object(node, depth, chance)),
            "array" => {
                let least = node["minItems"].as_u64().unwrap_or(0) as usize;
                let most = node["maxItems"].as_u64().unwrap_or(3).max(1) as usize;
                let n = (least + chance.below(3)).min(most);
                (0..n)
                    .map(|_| self.grow(&node["items"], depth + 1, chance))
                    .collect()
            }
            "string" => json!(["a", "x", "liquid", "1 + x", "sin(t)"][chance.below(5)]),
            "boolean" => json!(chance.one_in(2)),
            "integer" => json!(bounded(node, chance).round() as i64),
            "number" => json!(bounded(node, chance)),
            _ => Value::Null,
        }
    }

    fn object(&self, node: &Value, depth: usize, chance: &mut Chance) -> Map<String, Value> {
        let required = node["required"].as_array();
        let needed = |key: &str| required.is_some_and(|r| r.iter().any(|k| k == key));
        let mut map = Map::new();
        for (key, child) in node["properties"].as_object().into_iter().flatten() {
            if needed(key) || (depth < DEEP && chance.one_in(4)) {
                map.insert(key.clone(), self.grow(child, depth + 1, chance));
            }
        }
        if let Some(child) = node.get("additionalProperties").filter(|c| c.is_object()) {
            map.insert("Ar".to_owned(), self.grow(child, depth + 1, chance));
        }
        map
    }
}

fn kind<'a>(node: &'a Value, chance: &mut Chance) -> &'a str {
    match &node["type"] {
        Value::String(one) => one,
        Value::Array(several) => chance
            .pick(several)
            .and_then(Value::as_str)
            .unwrap_or_default(),
        _ if node.get("properties").is_some() => "object",
        _ => "",
    }
}

/// A number near an end of its range, or of any size.
fn bounded(node: &Value, chance: &mut Chance) -> f64 {
    let end = |keys: [&str; 2]| keys.iter().find_map(|key| node[*key].as_f64());
    let low = end(["minimum", "exclusiveMinimum"]);
    let high = end(["maximum", "exclusiveMaximum"]);
    let any = 10_f64.powf(12.0 * chance.share() - 6.0);
    match (low, high) {
        (Some(low), Some(high)) => low + (high - low) * chance.share(),
        (Some(low), None) => low + any,
        (None, Some(high)) => high - any,
        (None, None) if chance.one_in(2) => -any,
        (None, None) => any,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_that_is_left_out_is_added_where_the_schema_knows_it() {
        let schema = r##"{"type": "object", "properties": {"a": {"type": "number"}, "b": {"$ref": "#/$defs/B"}},
            "$defs": {"B": {"type": "object", "required": ["c"],
            "properties": {"c": {"type": "integer", "minimum": 3, "maximum": 3}}}}}"##;
        let schema = Schema::parse(schema).unwrap();
        let mut scene = json!({"a": 1});
        schema.extend(&mut scene, &mut Chance::of(1, 1));
        assert_eq!(scene, json!({"a": 1, "b": {"c": 3}}));
    }
}
