//! Published tables of a gas, and how far ours is from them.

use std::path::Path;

use serde::Deserialize;

use super::Gas;

/// A column of numbers.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Column {
    pub(crate) name: String,
    pub(crate) unit: String,
    pub(crate) values: Vec<f64>,
}

/// How far a column may be from the published one.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Bound {
    pub(crate) column: String,
    pub(crate) from_k: f64,
    pub(crate) to_k: f64,
    /// Greatest relative deviation.
    pub(crate) worst: f64,
    /// Mean relative deviation.
    #[serde(default)]
    pub(crate) mean: Option<f64>,
}

/// A published table against temperature.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Published {
    pub(crate) source: String,
    pub(crate) columns: Vec<Column>,
    pub(crate) bounds: Vec<Bound>,
}

/// A published value: of a column at a temperature, or its peak.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Value {
    pub(crate) column: String,
    #[serde(default)]
    pub(crate) at_k: Option<f64>,
    #[serde(default)]
    pub(crate) peak: bool,
    pub(crate) value: f64,
    pub(crate) tolerance: f64,
    pub(crate) source: String,
}

/// Published properties of a gas (kind `gas-reference`, version 1).
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Reference {
    pub(crate) title: String,
    pub(crate) tables: Vec<Published>,
    #[serde(default)]
    pub(crate) values: Vec<Value>,
}

/// How far a column is from the published one over a range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Deviation {
    /// Greatest relative deviation, with its sign.
    pub(crate) worst: f64,
    /// Where \[K\].
    pub(crate) at: f64,
    /// Mean of the absolute relative deviation.
    pub(crate) mean: f64,
}

impl Reference {
    /// Reads published properties.
    ///
    /// # Errors
    /// When the file cannot be read, is of another kind or version, or does not fit.
    pub(crate) fn read(path: &Path) -> artefact::Result<Self> {
        artefact::json_artefact(path, "gas-reference", 1)
    }
}

impl Published {
    /// Temperature and value of each row of a column.
    pub(crate) fn rows(&self, name: &str) -> Vec<[f64; 2]> {
        let values = |name: &str| {
            self.columns
                .iter()
                .find(|c| c.name == name)
                .map(|c| &c.values)
        };
        match (values("temperature_k"), values(name)) {
            (Some(t), Some(y)) => t.iter().zip(y).map(|(t, y)| [*t, *y]).collect(),
            _ => Vec::new(),
        }
    }

    /// The columns that are not the temperature.
    pub(crate) fn properties(&self) -> impl Iterator<Item = &Column> {
        self.columns.iter().filter(|c| c.name != "temperature_k")
    }

    /// Whether a table of `gas` has the column, and reaches as far as the published rows between two temperatures.
    pub(crate) fn is_met(&self, gas: &Gas, name: &str, [from, to]: [f64; 2]) -> bool {
        let rows = self.rows(name).into_iter();
        let mut own = rows
            .map(|[t, _]| t)
            .filter(|t| (from..=to).contains(t))
            .peekable();
        own.peek().is_some() && own.all(|t| gas.at(name, 0, t).is_some())
    }

    /// How far `gas` without iron is from a column between two temperatures; nothing where they do not meet.
    pub(crate) fn deviation(
        &self,
        gas: &Gas,
        name: &str,
        [from, to]: [f64; 2],
    ) -> Option<Deviation> {
        let mut found = Deviation {
            worst: 0.0,
            at: from,
            mean: 0.0,
        };
        let mut count = 0.0;
        for [t, published] in self.rows(name) {
            let Some(ours) = gas.at(name, 0, t).filter(|_| (from..=to).contains(&t)) else {
                continue;
            };
            // Where 0 is published, nothing but 0 agrees.
            let same = ours.abs() <= 0.0 && published.abs() <= 0.0;
            let off = if same { 0.0 } else { ours / published - 1.0 };
            if off.abs() > found.worst.abs() {
                (found.worst, found.at) = (off, t);
            }
            found.mean += off.abs();
            count += 1.0;
        }
        found.mean /= count;
        (count > 0.0).then_some(found)
    }
}

impl Value {
    /// What `gas` without iron has for it, and where \[K\].
    pub(crate) fn of(&self, gas: &Gas) -> Option<(f64, f64)> {
        match self.at_k {
            Some(t) => Some((gas.at(&self.column, 0, t)?, t)),
            None if self.peak => {
                let row = gas.row(&gas.table, &self.column, 0)?;
                let pairs = row.iter().copied().zip(gas.temperatures.iter().copied());
                pairs.max_by(|a, b| a.0.total_cmp(&b.0))
            }
            None => None,
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]

    use super::*;
    use crate::gas::tests::gas;

    fn published(values: &[f64]) -> Published {
        let column = |name: &str, values: &[f64]| Column {
            name: name.to_owned(),
            unit: "1".to_owned(),
            values: values.to_vec(),
        };
        Published {
            source: String::new(),
            columns: vec![
                column("temperature_k", &[1500.0, 2500.0, 3500.0]),
                column("v", values),
            ],
            bounds: Vec::new(),
        }
    }

    #[test]
    fn a_deviation_has_its_sign_place_and_mean() {
        let ours = gas("v", &[0.0, 1.0], |t, _| t);
        let table = published(&[1500.0, 2500.0 / 0.9, 3500.0 / 1.05]);
        let all = table.deviation(&ours, "v", [0.0, 1e5]).unwrap();
        assert!((all.worst + 0.1).abs() < 1e-12 && (all.at - 2500.0).abs() < 1e-9);
        assert!((all.mean - 0.05).abs() < 1e-12);
        let warm = table.deviation(&ours, "v", [3000.0, 1e5]).unwrap();
        assert!((warm.worst - 0.05).abs() < 1e-12);
        assert_eq!(table.deviation(&ours, "v", [1e5, 2e5]), None);
        assert_eq!(table.deviation(&ours, "absent", [0.0, 1e5]), None);
    }

    #[test]
    fn a_range_that_is_met_in_part_is_not_met_and_a_published_zero_is_not_passed_over() {
        let ours = gas("v", &[0.0, 1.0], |t, _| t);
        let table = published(&[1500.0, 2500.0, 3500.0]);
        assert!(table.is_met(&ours, "v", [0.0, 1e5]));
        assert!(
            !table.is_met(&ours, "misspelt", [0.0, 1e5]) && !table.is_met(&ours, "v", [1e5, 2e5])
        );
        let mut longer = table.clone();
        longer.columns[0].values.push(1e9);
        longer.columns[1].values.push(1e9);
        assert!(!longer.is_met(&ours, "v", [0.0, 2e9]));
        let zero = published(&[1500.0, 0.0, 3500.0]);
        let found = zero.deviation(&ours, "v", [0.0, 1e5]).unwrap();
        assert!(found.worst.is_infinite() && found.mean.is_infinite());
    }

    #[test]
    fn a_peak_is_found_with_its_temperature() {
        let ours = gas("v", &[0.0], |t, _| 1.0 - ((t - 7000.0) / 1e4).powi(2));
        let value = Value {
            column: "v".to_owned(),
            at_k: None,
            peak: true,
            value: 1.0,
            tolerance: 0.1,
            source: String::new(),
        };
        assert_eq!(value.of(&ours), Some((1.0, 7000.0)));
    }
}
