//! The values of parameters, and how they meet.

use serde_json::{Number, Value};

use crate::plan::{Parameter, Range};

/// A value with its name.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Named {
    /// As it stands in names of folders.
    pub(crate) name: String,
    /// What templates get.
    pub(crate) value: Value,
}

impl Named {
    /// Its name; of a number that is its own name the number, however it is written.
    pub(crate) fn meant(&self) -> String {
        match self
            .value
            .as_f64()
            .filter(|_| named(&self.value).name == self.name)
        {
            Some(number) => format!("{number:e}"),
            None => self.name.clone(),
        }
    }
}

/// The values of a parameter.
///
/// # Errors
/// With the place below the parameter, and what is wrong.
pub(crate) fn of(parameter: &Parameter) -> Result<Vec<Named>, (String, String)> {
    let range = |range: &Range, key: &str, spread: fn(&Range, f64) -> f64| {
        let ends = [range.from, range.to];
        if key == "log" && ends.iter().any(|end| *end <= 0.0) {
            let what = format!("goes from {} to {}: both must be above 0", ends[0], ends[1]);
            return Err((format!("/{key}"), what));
        }
        if range.from.to_bits() == range.to.to_bits() {
            return Err((format!("/{key}"), format!("begins and ends at {}", ends[0])));
        }
        let last = range.count.saturating_sub(1).max(1) as f64;
        let steps = (0..range.count).map(|i| spread(range, i as f64 / last));
        Ok(steps.map(|v| named(&number(rounded(v)))).collect())
    };
    match (&parameter.values, &parameter.even, &parameter.log) {
        (Some(values), None, None) if values.is_empty() => {
            Err(("/values".to_owned(), "holds no value".to_owned()))
        }
        (Some(values), None, None) => listed(values),
        (None, Some(even), None) => range(even, "even", |r, u| r.from + u * (r.to - r.from)),
        (None, None, Some(log)) => range(log, "log", |r, u| r.from * (r.to / r.from).powf(u)),
        _ => {
            let what = "must have one of \"values\", \"even\" and \"log\"".to_owned();
            Err((String::new(), what))
        }
    }
}

fn listed(values: &[Value]) -> Result<Vec<Named>, (String, String)> {
    let mut all: Vec<Named> = Vec::new();
    for (i, value) in values.iter().enumerate() {
        let at = format!("/values/{i}");
        let entry = match value {
            Value::Object(map) => match (map.get("name"), map.get("value"), map.len()) {
                (Some(Value::String(name)), Some(value), 2) => Named {
                    name: name.clone(),
                    value: value.clone(),
                },
                _ => {
                    let what = "a value that is no number and no word has the form {\"name\": \"thin\", \"value\": ...}";
                    return Err((at, what.to_owned()));
                }
            },
            Value::Number(_) | Value::String(_) => named(value),
            other => {
                let what = format!(
                    "is {other}: give it a name, {{\"name\": \"...\", \"value\": {other}}}"
                );
                return Err((at, what));
            }
        };
        let plain = |c: char| c.is_ascii_alphanumeric() || "._+-".contains(c);
        if entry.name.is_empty()
            || !entry.name.chars().all(plain)
            || entry.name.starts_with(['.', '-', '+']) && entry.name.parse::<f64>().is_err()
        {
            let what = format!(
                "'{}' becomes the name of a folder: letters, digits, '.', '_', '+' and '-', and it begins with a letter or digit",
                entry.name
            );
            return Err((at, what));
        }
        all.push(entry);
    }
    Ok(all)
}

/// A number or a word as its own name.
fn named(value: &Value) -> Named {
    let name = match value {
        Value::String(word) => word.clone(),
        other => other.to_string(),
    };
    Named {
        name,
        value: value.clone(),
    }
}

/// Twelve digits: 0.1 + 2 * 0.1 is 0.3.
fn rounded(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

/// A whole number without a full stop.
fn number(value: f64) -> Value {
    let whole = value.abs() < 1e15 && value.fract().abs() < f64::MIN_POSITIVE;
    #[allow(clippy::cast_possible_truncation, reason = "it is whole and small")]
    let exact = whole.then(|| Number::from(value as i64));
    exact
        .or_else(|| Number::from_f64(value))
        .map_or(Value::Null, Value::Number)
}

/// For each point, which value each parameter has: every value of one with every value of the others, the last parameter
/// fastest; one that goes with another has the index of that one.
pub(crate) fn points(counts: &[usize], with: &[Option<usize>]) -> Vec<Vec<usize>> {
    let mut all = vec![Vec::new()];
    for (count, with) in counts.iter().zip(with) {
        all = match with {
            Some(other) => all
                .into_iter()
                .map(|point: Vec<usize>| {
                    let own = point[*other];
                    [point, vec![own]].concat()
                })
                .collect(),
            None => all
                .iter()
                .flat_map(|point| (0..*count).map(|i| [point.clone(), vec![i]].concat()))
                .collect(),
        };
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn parameter(value: Value) -> Parameter {
        serde_json::from_value(value).unwrap()
    }

    fn names(value: Value) -> Vec<String> {
        let all = of(&parameter(value)).unwrap();
        all.into_iter().map(|v| v.name).collect()
    }

    #[test]
    fn ranges_have_both_ends_and_short_names() {
        let even = json!({"name": "s", "even": {"from": 0.1, "to": 0.5, "count": 5}});
        assert_eq!(names(even), ["0.1", "0.2", "0.3", "0.4", "0.5"]);
        let down = json!({"name": "s", "even": {"from": 500, "to": 100, "count": 3}});
        assert_eq!(names(down), ["500", "300", "100"]);
        let log = json!({"name": "s", "log": {"from": 1e-3, "to": 10, "count": 5}});
        assert_eq!(names(log), ["0.001", "0.01", "0.1", "1", "10"]);
    }

    #[test]
    fn words_and_named_values_stand_beside_numbers() {
        let mixed =
            json!({"name": "g", "values": [300, "argon", {"name": "thin", "value": [1, 2]}]});
        let all = of(&parameter(mixed)).unwrap();
        assert_eq!(all[2].value, json!([1, 2]));
        assert_eq!(all[0].name, "300");
    }

    #[test]
    fn what_is_no_list_of_values_is_told() {
        for (wrong, at) in [
            (json!({"name": "s"}), ""),
            (json!({"name": "s", "values": [], }), "/values"),
            (json!({"name": "s", "values": [[1]]}), "/values/0"),
            (json!({"name": "s", "values": ["../x"]}), "/values/0"),
            (
                json!({"name": "s", "log": {"from": 0, "to": 1, "count": 2}}),
                "/log",
            ),
            (
                json!({"name": "s", "even": {"from": 1, "to": 1, "count": 2}}),
                "/even",
            ),
            (
                json!({"name": "s", "values": [1], "even": {"from": 1, "to": 2, "count": 2}}),
                "",
            ),
        ] {
            assert_eq!(of(&parameter(wrong.clone())).unwrap_err().0, at, "{wrong}");
        }
    }

    #[test]
    fn every_value_meets_every_other_but_those_that_go_together() {
        assert_eq!(
            points(&[2, 2], &[None, None]),
            [[0, 0], [0, 1], [1, 0], [1, 1]]
        );
        assert_eq!(points(&[2, 2], &[None, Some(0)]), [[0, 0], [1, 1]]);
        assert_eq!(points(&[2, 2, 2], &[None, None, Some(0)])[1], [0, 1, 0]);
    }
}
