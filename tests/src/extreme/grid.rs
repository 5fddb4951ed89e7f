//! A case over a grid of two parameters: each pair of values makes a scene.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::Outcome;
use super::check::{Checks, Name};
use super::told::Told;
use crate::lab::LabError;

/// What stands for the value in a template.
const SLOT: &str = "{}";

/// A grid of runs over one or two parameters.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grid {
    /// Across.
    pub x: Axis,
    /// Upward; a grid may have one row.
    pub y: Option<Axis>,
    /// Merge patch on the scene, before any value is set.
    #[serde(default)]
    pub patch: Value,
    /// Merge patch for a short run that tells a limit which an axis asks for.
    #[serde(default)]
    pub probe: Value,
    /// Ends that are good, where a value does not tell its own.
    pub expect: Vec<Outcome>,
}

/// A parameter and its values.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// What the map calls it.
    pub name: String,
    /// JSON pointers into the scene at which the value is set.
    #[serde(default)]
    pub set: Places,
    /// What is set, with `{}` for the number: `"{}"`, `{"expr": "exp({}*T)"}`.
    #[serde(default = "slot", rename = "as")]
    pub template: Value,
    /// What the value is multiplied with before it is set.
    #[serde(default = "one")]
    pub times: f64,
    /// A limit of the run record that the value is multiplied with too: `step_explicit`.
    pub of_limit: Option<String>,
    /// The values, in order.
    pub values: Vec<Point>,
}

/// One or several JSON pointers.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(untagged)]
pub enum Places {
    /// No place: the values bring patches.
    #[default]
    None,
    /// One place.
    One(String),
    /// Several places that hold the same value.
    Many(Vec<String>),
}

/// A value of a parameter.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
pub enum Point {
    /// A number.
    Plain(f64),
    /// A number or a name, with what is special about it.
    Special(Special),
}

/// A value with what is special about it.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Special {
    /// The number that is set.
    pub value: Option<f64>,
    /// How the map calls it, if not by its number.
    pub label: Option<String>,
    /// Merge patch for this value.
    #[serde(default)]
    pub patch: Value,
    /// Ends that are good here.
    pub expect: Option<Vec<Outcome>>,
    /// What a run with this value must tell besides.
    #[serde(default)]
    pub told: Told,
}

fn slot() -> Value {
    Value::String(SLOT.to_owned())
}

fn one() -> f64 {
    1.0
}

/// The axes of a map in the record.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scales {
    x: Scale,
    #[serde(skip_serializing_if = "Option::is_none")]
    y: Option<Scale>,
}

/// An axis of a map in the record.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scale {
    name: String,
    values: Vec<String>,
}

/// A node of the grid, ready to be run.
#[derive(Debug, Clone)]
pub(super) struct Node {
    pub(super) at: [usize; 2],
    pub(super) name: String,
    pub(super) scene: Value,
    pub(super) parameters: Value,
    pub(super) expect: Vec<Outcome>,
    pub(super) checks: Checks,
}

impl Axis {
    fn special(&self, index: usize) -> Special {
        match self.values.get(index) {
            Some(Point::Plain(value)) => Special {
                value: Some(*value),
                ..Special::default()
            },
            Some(Point::Special(special)) => special.clone(),
            None => Special::default(),
        }
    }

    fn label(&self, index: usize) -> String {
        let special = self.special(index);
        let number = special.value.map(|value| value.to_string());
        special.label.or(number).unwrap_or_default()
    }

    fn scale(&self) -> Scale {
        Scale {
            name: self.name.clone(),
            values: (0..self.values.len()).map(|i| self.label(i)).collect(),
        }
    }

    /// Puts a value into a scene; `limit` multiplies it where the axis asks for one.
    fn apply(&self, index: usize, limit: Option<f64>, scene: &mut Value) -> Result<(), String> {
        let special = self.special(index);
        merge(scene, &special.patch);
        let places: &[String] = match &self.set {
            Places::None => &[],
            Places::One(place) => std::slice::from_ref(place),
            Places::Many(places) => places,
        };
        let Some(value) = special.value.filter(|_| !places.is_empty()) else {
            return Ok(());
        };
        let number = value * self.times * limit.unwrap_or(1.0);
        places
            .iter()
            .try_for_each(|place| set(scene, place, &filled(&self.template, number)))
    }
}

impl Grid {
    /// The axes for the record.
    pub(super) fn scales(&self) -> Scales {
        Scales {
            x: self.x.scale(),
            y: self.y.as_ref().map(Axis::scale),
        }
    }

    /// The limit that the x axis asks for.
    pub(super) fn limit(&self) -> Option<&str> {
        self.x.of_limit.as_deref()
    }

    fn rows(&self) -> usize {
        self.y.as_ref().map_or(1, |y| y.values.len())
    }

    /// All nodes, row by row. `limit` runs a scene for a limit of that name.
    ///
    /// # Errors
    /// When a place is not in the scene or a limit cannot be told.
    pub(super) fn nodes(
        &self,
        base: &Value,
        checks: &Checks,
        limit: impl Fn(usize, &str, &Value) -> Result<f64, LabError>,
    ) -> Result<Vec<Node>, LabError> {
        let wrong = |what: String| LabError::Content {
            path: Path::new("grid").to_owned(),
            what,
        };
        let mut nodes = Vec::new();
        for j in 0..self.rows() {
            let mut row = base.clone();
            merge(&mut row, &self.patch);
            if let Some(y) = &self.y {
                y.apply(j, None, &mut row).map_err(wrong)?;
            }
            let told = match self.limit() {
                Some(name) => {
                    let mut probe = row.clone();
                    merge(&mut probe, &self.probe);
                    Some(limit(j, name, &probe)?)
                }
                None => None,
            };
            for i in 0..self.x.values.len() {
                let mut scene = row.clone();
                self.x.apply(i, told, &mut scene).map_err(wrong)?;
                nodes.push(self.node([i, j], scene, checks));
            }
        }
        Ok(nodes)
    }

    fn node(&self, at: [usize; 2], scene: Value, checks: &Checks) -> Node {
        let axes = [Some(&self.x), self.y.as_ref()];
        let mut parameters = Map::new();
        let mut expect = self.expect.clone();
        let mut checks = checks.clone();
        for (axis, index) in axes.into_iter().zip(at) {
            let Some(axis) = axis else { continue };
            parameters.insert(axis.name.clone(), axis.label(index).into());
            let special = axis.special(index);
            checks.told = checks.told.and(&special.told);
            if let Some(own) = special.expect {
                expect = own;
            }
        }
        let factor = |name: Name| {
            let (axis, index) = match name {
                Name::X => (Some(&self.x), at[0]),
                Name::Y => (self.y.as_ref(), at[1]),
            };
            axis.and_then(|axis| axis.special(index).value)
                .unwrap_or(1.0)
        };
        checks.bounds = checks.bounds.map(|b| match b.times {
            Some(name) => b.scaled(factor(name)),
            None => b,
        });
        Node {
            at,
            name: format!("x{}-y{}", at[0], at[1]),
            scene,
            parameters: Value::Object(parameters),
            expect,
            checks,
        }
    }
}

/// JSON Merge Patch (RFC 7386).
pub(crate) fn merge(target: &mut Value, patch: &Value) {
    let Value::Object(changes) = patch else {
        if !patch.is_null() {
            *target = patch.clone();
        }
        return;
    };
    if !target.is_object() {
        *target = Value::Object(Map::new());
    }
    let Some(object) = target.as_object_mut() else {
        return;
    };
    for (key, change) in changes {
        if change.is_null() {
            object.shift_remove(key);
        } else {
            merge(object.entry(key.clone()).or_insert(Value::Null), change);
        }
    }
}

/// The template with its slots filled: a string that is only a slot becomes the number itself.
fn filled(template: &Value, number: f64) -> Value {
    match template {
        Value::String(text) if text == SLOT => number.into(),
        Value::String(text) => text.replace(SLOT, &format!("({number:e})")).into(),
        Value::Array(parts) => parts.iter().map(|part| filled(part, number)).collect(),
        Value::Object(parts) => {
            let parts = parts.iter();
            parts
                .map(|(key, part)| (key.clone(), filled(part, number)))
                .collect()
        }
        other => other.clone(),
    }
}

/// Sets a value at a JSON pointer. Keys that are not there are made; entries of lists are not.
fn set(scene: &mut Value, pointer: &str, value: &Value) -> Result<(), String> {
    let mut at = scene;
    for word in pointer.split('/').skip(1) {
        let word = word.replace("~1", "/").replace("~0", "~");
        if let Value::Array(list) = at {
            let entry = word.parse::<usize>().ok().and_then(|i| list.get_mut(i));
            at = entry.ok_or_else(|| format!("the scene has no entry {word} at {pointer}"))?;
            continue;
        }
        if at.is_null() {
            *at = Value::Object(Map::new());
        }
        let object = at.as_object_mut();
        let object = object.ok_or_else(|| format!("{pointer} goes through what holds nothing"))?;
        at = object.entry(word).or_insert(Value::Null);
    }
    *at = value.clone();
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn grid() -> Grid {
        serde_json::from_value(json!({
            "x": {"name": "step over limit", "set": "/time/step_s", "of_limit": "step",
                  "values": [0.5, {"value": 2, "expect": ["refused"]}]},
            "y": {"name": "scale", "set": ["/faces/0/k", "/faces/1/k"], "times": 10,
                  "values": [1, {"value": 100, "label": "hot", "patch": {"mark": true}}]},
            "patch": {"time": {"end_s": 1}},
            "expect": ["stable"]
        }))
        .unwrap()
    }

    #[test]
    fn every_pair_of_values_makes_a_scene() {
        let base = json!({"time": {"end_s": 9}, "faces": [{"k": 0}, {"k": 0}]});
        let bounds = serde_json::from_value(
            json!({"column": "temperature", "min": 0, "max": 1, "times": "y"}),
        );
        let checks = Checks {
            bounds: bounds.ok(),
            ..Checks::default()
        };
        // The limit falls as the coefficient rises, which only the row's own scene can tell.
        let limit = |_: usize, name: &str, scene: &Value| {
            assert_eq!(name, "step");
            Ok(1.0 / scene["faces"][1]["k"].as_f64().unwrap())
        };
        let nodes = grid().nodes(&base, &checks, limit).unwrap();
        assert_eq!(nodes.len(), 4);
        assert_eq!(
            nodes[0].scene,
            json!({"time": {"end_s": 1, "step_s": 0.05}, "faces": [{"k": 10.0}, {"k": 10.0}]})
        );
        let last = &nodes[3];
        assert_eq!(last.at, [1, 1]);
        assert_eq!(last.scene["time"]["step_s"], 2e-3);
        assert_eq!(last.scene["mark"], true);
        assert_eq!(last.expect, [Outcome::Refused]);
        assert_eq!(
            last.parameters,
            json!({"step over limit": "2", "scale": "hot"})
        );
        assert!((last.checks.bounds.as_ref().unwrap().max - 100.0).abs() < 1e-12);
    }

    #[test]
    fn a_template_is_filled_in_text_and_in_place() {
        let template = json!({"expr": "exp({}*T)", "n": ["{}", 1]});
        assert_eq!(
            filled(&template, 8.0),
            json!({"expr": "exp((8e0)*T)", "n": [8.0, 1]})
        );
    }

    #[test]
    fn a_place_that_is_not_there_is_named() {
        let mut scene = json!({"list": [1], "leaf": 2});
        assert!(
            set(&mut scene, "/list/1", &json!(0))
                .unwrap_err()
                .contains("/list/1")
        );
        assert!(set(&mut scene, "/leaf/a", &json!(0)).is_err());
        set(&mut scene, "/new/key", &json!(3)).unwrap();
        assert_eq!(scene["new"]["key"], 3);
    }

    #[test]
    fn a_patch_merges_and_removes() {
        let mut scene = json!({"a": {"b": 1, "c": 2}, "d": [1, 2]});
        merge(
            &mut scene,
            &json!({"a": {"b": null, "e": {"f": null, "g": 3}}, "d": [0]}),
        );
        assert_eq!(scene, json!({"a": {"c": 2, "e": {"g": 3}}, "d": [0]}));
    }
}
