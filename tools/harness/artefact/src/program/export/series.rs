//! Scalars over time: one row per message, columns by name.

use crate::program::sheet::Sheet;

/// The scalars of a channel over time.
#[derive(Debug, Default)]
pub(super) struct Series {
    sheets: Vec<Sheet>,
    /// Name and unit of each column, in the order in which they came.
    pub(super) columns: Vec<(String, String)>,
    /// Names of the texts.
    pub(super) texts: Vec<String>,
}

impl Series {
    pub(super) fn push(&mut self, sheet: Sheet) {
        for column in &sheet.columns {
            if !self.columns.iter().any(|(name, _)| *name == column.name) {
                self.columns
                    .push((column.name.clone(), column.unit.clone()));
            }
        }
        for (name, _) in &sheet.texts {
            if !self.texts.contains(name) {
                self.texts.push(name.clone());
            }
        }
        self.sheets.push(sheet);
    }

    pub(super) fn is_empty(&self) -> bool {
        self.sheets.is_empty()
    }

    /// Simulated time of each row \[s\].
    pub(super) fn times(&self) -> Vec<f64> {
        self.sheets.iter().map(|s| s.time_s).collect()
    }

    /// A column; `None` where a message does not have it.
    pub(super) fn column(&self, name: &str) -> Vec<Option<f64>> {
        let of = |sheet: &Sheet| {
            let column = sheet.columns.iter().find(|c| c.name == name)?;
            column.values.to_f64().first().copied()
        };
        self.sheets.iter().map(of).collect()
    }

    /// A text column; empty where a message does not have it.
    pub(super) fn text(&self, name: &str) -> Vec<&str> {
        let of = |sheet: &'_ Sheet| sheet.texts.iter().position(|(n, _)| n == name);
        self.sheets
            .iter()
            .map(|s| of(s).map_or("", |i| s.texts[i].1.as_str()))
            .collect()
    }
}
