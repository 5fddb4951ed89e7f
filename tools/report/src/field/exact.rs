//! An exact solution along the lines of a scene, and its totals.

use std::path::Path;

use run::Failure;
use serde::Deserialize;

use super::columns::Columns;

/// The kind of such a file.
const KIND: &str = "field-exact";

/// A column of a line.
#[derive(Debug, Clone, Deserialize)]
struct Column {
    name: String,
    unit: String,
    values: Vec<f64>,
}

/// A line by name.
#[derive(Debug, Clone, Deserialize)]
struct Line {
    name: String,
    columns: Vec<Column>,
}

/// A total by name.
#[derive(Debug, Clone, Deserialize)]
struct Total {
    name: String,
    value: f64,
}

/// What such a file holds.
#[derive(Debug, Clone, Deserialize)]
struct File {
    kind: String,
    source: String,
    lines: Vec<Line>,
    #[serde(default)]
    totals: Vec<Total>,
}

/// The exact solution of a scene.
#[derive(Debug, Clone)]
pub(crate) struct Exact {
    /// Where it comes from.
    pub(crate) source: String,
    lines: Vec<(String, Columns)>,
    totals: Vec<Total>,
}

impl Exact {
    /// Reads a file.
    ///
    /// # Errors
    /// When it cannot be read, or is no exact solution.
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let text = std::fs::read_to_string(path).map_err(|source| Failure::Io {
            path: path.to_owned(),
            action: "read",
            source,
        })?;
        let wrong = |what: String| Failure::Other(format!("{}: {what}", path.display()));
        let file: File = serde_json::from_str(&text).map_err(|e| wrong(e.to_string()))?;
        if file.kind != KIND {
            return Err(wrong(format!("kind '{}', wanted is '{KIND}'", file.kind)));
        }
        let columns = |line: Line| {
            let each = line.columns.into_iter();
            let all = each.map(|c| (c.name, c.unit, c.values)).collect();
            (line.name, Columns::of(all))
        };
        Ok(Self {
            source: file.source,
            lines: file.lines.into_iter().map(columns).collect(),
            totals: file.totals,
        })
    }

    /// Fields along a line.
    pub(crate) fn line(&self, name: &str) -> Option<&Columns> {
        self.lines.iter().find(|(n, _)| n == name).map(|(_, c)| c)
    }

    /// A total.
    pub(crate) fn total(&self, name: &str) -> Option<f64> {
        let found = self.totals.iter().find(|t| t.name == name);
        found.map(|t| t.value)
    }
}
