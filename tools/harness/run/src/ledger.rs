//! What a run notes of itself while it goes on; kept in checkpoints, told in the run record.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Memory of a column or table.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Bytes {
    pub(crate) name: String,
    pub(crate) bytes: u64,
}

/// A limit, a total: a named number with its unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Limit {
    pub(crate) name: String,
    #[serde(with = "finite_or_null")]
    pub(crate) value: f64,
    pub(crate) unit: String,
}

/// Physics that a scene leaves out, and why.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct LeftOut {
    pub(crate) name: String,
    pub(crate) why: String,
}

/// A quantity over the course of the run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct History {
    pub(crate) name: String,
    pub(crate) unit: String,
    pub(crate) at: Vec<Number>,
    pub(crate) values: Vec<Number>,
}

/// A number that is `null` in JSON where it is not finite.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Number(#[serde(with = "finite_or_null")] pub(crate) f64);

/// What a run notes of itself while it goes on.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Ledger {
    pub(crate) steps: u64,
    /// Steps that were divided.
    pub(crate) divided: u64,
    /// Wall time of the runs that this one takes up \[s\].
    pub(crate) earlier_s: f64,
    pub(crate) resumed: u32,
    pub(crate) stages: Vec<(String, f64)>,
    pub(crate) memory: Vec<Bytes>,
    pub(crate) notes: Vec<String>,
    pub(crate) warnings: Vec<String>,
    pub(crate) left_out: Vec<LeftOut>,
    pub(crate) limits: Vec<Limit>,
    pub(crate) history: Vec<History>,
    pub(crate) closing: Vec<Limit>,
}

impl Ledger {
    pub(crate) fn memory(&mut self, name: &str, bytes: u64) {
        match self.memory.iter_mut().find(|m| m.name == name) {
            Some(known) => known.bytes = bytes,
            None => self.memory.push(Bytes {
                name: name.to_owned(),
                bytes,
            }),
        }
    }

    pub(crate) fn left_out(&mut self, name: &str, why: &str) {
        if let Some(known) = self.left_out.iter_mut().find(|l| l.name == name) {
            why.clone_into(&mut known.why);
        } else {
            self.left_out.push(LeftOut {
                name: name.to_owned(),
                why: why.to_owned(),
            });
        }
    }

    pub(crate) fn history(&mut self, name: &str, unit: &str, at: f64, value: f64) {
        let series = match self.history.iter().position(|h| h.name == name) {
            Some(i) => &mut self.history[i],
            None => {
                let (name, unit) = (name.to_owned(), unit.to_owned());
                self.history.push(History {
                    name,
                    unit,
                    at: Vec::new(),
                    values: Vec::new(),
                });
                let last = self.history.len() - 1;
                &mut self.history[last]
            }
        };
        series.at.push(Number(at));
        series.values.push(Number(value));
    }
}

/// Sets a named number, keeping the order of first mention.
pub(crate) fn set(all: &mut Vec<Limit>, name: &str, value: f64, unit: &str) {
    match all.iter_mut().find(|known| known.name == name) {
        Some(known) => known.value = value,
        None => all.push(Limit {
            name: name.to_owned(),
            value,
            unit: unit.to_owned(),
        }),
    }
}

mod finite_or_null {
    use super::{Deserialize, Deserializer, Serialize, Serializer};

    #[allow(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
    pub(super) fn serialize<S: Serializer>(x: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        x.is_finite().then_some(*x).serialize(serializer)
    }

    pub(super) fn deserialize<'a, D: Deserializer<'a>>(source: D) -> Result<f64, D::Error> {
        Ok(Option::deserialize(source)?.unwrap_or(f64::NAN))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ledger_survives_a_checkpoint_with_numbers_that_are_not_finite() {
        let mut ledger = Ledger::default();
        ledger.history("residual", "1", 0.0, f64::INFINITY);
        ledger.history("residual", "1", 1.0, 0.1);
        ledger.memory("columns", 8);
        ledger.memory("columns", 16);
        ledger.left_out("arc", "no key 'arc'");
        set(&mut ledger.limits, "step", 1e-3, "s");
        set(&mut ledger.limits, "step", 5e-4, "s");
        let text = serde_json::to_string(&ledger).expect("JSON");
        let back: Ledger = serde_json::from_str(&text).expect("a ledger");
        assert!(
            back.history[0].values[0].0.is_nan()
                && (back.history[0].values[1].0 - 0.1).abs() < 1e-15
        );
        assert_eq!(
            back.memory,
            [Bytes {
                name: "columns".to_owned(),
                bytes: 16
            }]
        );
        assert!(back.limits.len() == 1 && (back.limits[0].value - 5e-4).abs() < 1e-15);
        assert_eq!(back.left_out, ledger.left_out);
    }
}
