//! What a run must tell: totals that agree or stay small, words that it says, and no warning but those that are expected.

use serde::Deserialize;
use serde_json::Value;

/// A sum of totals of the closing block that comes near a value.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Near {
    /// Names of totals; one after `-` counts as negative.
    pub sum: Vec<String>,
    /// What it should be.
    #[serde(default)]
    pub value: f64,
    /// Totals whose largest size the difference is divided by; by 1 where there are none.
    #[serde(default)]
    pub over: Vec<String>,
    /// Greatest difference.
    pub within: f64,
}

/// What a run must tell.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Told {
    /// Totals of a run that finished.
    #[serde(default)]
    pub totals: Vec<Near>,
    /// Words that stand in what it said on stderr, however it ended.
    #[serde(default)]
    pub says: Vec<String>,
    /// Beginnings of warnings that may come; any may where this is absent.
    pub warns: Option<Vec<String>>,
}

impl Told {
    /// These and others together.
    pub(super) fn and(&self, other: &Self) -> Self {
        let both = |a: &[String], b: &[String]| [a, b].concat();
        Self {
            totals: [self.totals.clone(), other.totals.clone()].concat(),
            says: both(&self.says, &other.says),
            warns: match (&self.warns, &other.warns) {
                (Some(a), Some(b)) => Some(both(a, b)),
                (a, b) => a.clone().or_else(|| b.clone()),
            },
        }
    }

    /// What is not as it should be; totals are looked at where the run `finished`.
    pub(super) fn broken(&self, stderr: &str, record: &Value, finished: bool) -> Vec<String> {
        let mut broken = Vec::new();
        for words in &self.says {
            if !stderr.contains(words.as_str()) {
                broken.push(format!("does not say \"{words}\""));
            }
        }
        if finished {
            broken.extend(self.totals.iter().filter_map(|near| near.broken(record)));
        }
        let warnings = record["warnings"].as_array().into_iter().flatten();
        for warning in warnings.filter_map(Value::as_str) {
            let expected = |allowed: &Vec<String>| allowed.iter().any(|a| warning.starts_with(a));
            if !self.warns.as_ref().is_none_or(expected) {
                broken.push(format!("warns: {warning}"));
            }
        }
        broken
    }
}

impl Near {
    fn broken(&self, record: &Value) -> Option<String> {
        let total = |name: &str| {
            let all = record["closing"].as_array()?;
            all.iter().find(|t| t["name"] == name)?["value"].as_f64()
        };
        let mut sum = 0.0;
        for name in &self.sum {
            let (sign, name) = match name.strip_prefix('-') {
                Some(name) => (-1.0, name),
                None => (1.0, name.as_str()),
            };
            match total(name) {
                Some(value) => sum += sign * value,
                None => return Some(format!("tells no number {name}")),
            }
        }
        let mut over = if self.over.is_empty() { 1.0 } else { 0.0_f64 };
        for name in &self.over {
            match total(name) {
                Some(value) => over = over.max(value.abs()),
                None => return Some(format!("tells no number {name}")),
            }
        }
        let error = (sum - self.value).abs() / over;
        let text = self.sum.join(" + ").replace("+ -", "- ");
        let scale = match self.over.as_slice() {
            [] => String::new(),
            names => format!(" of {}", names.join(", ")),
        };
        // A division by nothing is no agreement.
        let good = error <= self.within;
        (!good).then(|| {
            format!(
                "{text} is {sum:.6e}, not within {:e}{scale} of {:e}: {error:.3e}",
                self.within, self.value
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn told(text: Value) -> Told {
        serde_json::from_value(text).unwrap()
    }

    #[test]
    fn totals_agree_or_are_told() {
        let record = json!({"closing": [
            {"name": "force_a", "value": 2.0}, {"name": "force_b", "value": -1.9}, {"name": "lost", "value": null}
        ]});
        let near = |within: f64| {
            json!({"totals": [
                {"sum": ["force_a", "force_b"], "over": ["force_b", "force_a"], "within": within}
            ]})
        };
        assert!(told(near(0.051)).broken("", &record, true).is_empty());
        let said = told(near(0.049)).broken("", &record, true);
        assert!(
            said[0].contains("force_a + force_b is 1.000000e-1"),
            "{said:?}"
        );
        assert!(told(near(0.049)).broken("", &record, false).is_empty());
        let less =
            json!({"totals": [{"sum": ["force_a", "-force_b"], "value": 3.9, "within": 1e-12}]});
        assert!(told(less).broken("", &record, true).is_empty());
        for name in ["lost", "absent"] {
            let none = json!({"totals": [{"sum": [name], "within": 1e9}]});
            assert_eq!(
                told(none).broken("", &record, true),
                [format!("tells no number {name}")]
            );
        }
        let nothing =
            json!({"totals": [{"sum": ["force_a"], "value": 2, "over": [], "within": 0}]});
        assert!(told(nothing).broken("", &record, true).is_empty());
    }

    #[test]
    fn words_are_said_and_warnings_expected() {
        let record = json!({"warnings": ["unresolved: skin", "stagnated"]});
        let wanted = told(json!({"says": ["skin"], "warns": ["unresolved"]}));
        let said = wanted.broken("warning: unresolved: skin", &record, true);
        assert_eq!(said, ["warns: stagnated"]);
        let more = told(json!({"says": ["place"], "warns": ["stag"]}));
        assert_eq!(
            wanted.and(&more).broken("skin", &record, false),
            ["does not say \"place\""]
        );
        assert!(Told::default().broken("", &record, true).is_empty());
    }
}
