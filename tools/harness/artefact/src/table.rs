//! Small tables, dense grids and records of named scalars, with units.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::values::Precision;

/// A value with its unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Quantity {
    /// The value.
    pub value: f64,
    /// Its SI unit; `1` for a pure number.
    pub unit: String,
}

/// A named series of values with a unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Series {
    /// Name; ends in the unit (`radius_m`).
    pub name: String,
    /// SI unit; `1` for a pure number.
    pub unit: String,
    /// The values; for a grid row-major, last axis fastest.
    pub values: Vec<f64>,
}

/// Columns over one index (a table) or over one or two axes (a grid).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// `[n]`, or `[n0, n1]` row-major with the last index fastest.
    pub shape: Vec<usize>,
    /// Scalars that belong to the table, by name.
    #[serde(default)]
    pub attributes: BTreeMap<String, Quantity>,
    /// Axes of a grid, one per dimension; empty for a table.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub axes: Vec<Series>,
    /// The columns.
    pub columns: Vec<Series>,
    #[serde(skip)]
    frame_id: String,
    #[serde(skip)]
    narrow: bool,
    #[serde(skip)]
    origin: String,
}

/// Frame of reference of what names none.
pub(crate) const WORLD: &str = "world";

impl Table {
    /// A table of `rows` rows without columns.
    #[must_use]
    pub fn new(rows: usize) -> Self {
        Self {
            shape: vec![rows],
            ..Self::default()
        }
    }

    /// A grid over axes, each (name, unit, values); the last axis runs fastest.
    #[must_use]
    pub fn grid(axes: &[(&str, &str, &[f64])]) -> Self {
        Self {
            shape: axes.iter().map(|(_, _, values)| values.len()).collect(),
            axes: axes
                .iter()
                .map(|(name, unit, values)| series(name, unit, values.to_vec()))
                .collect(),
            ..Self::default()
        }
    }

    /// Adds a column.
    #[must_use]
    pub fn column(mut self, name: &str, unit: &str, values: impl IntoIterator<Item = f64>) -> Self {
        self.columns
            .push(series(name, unit, values.into_iter().collect()));
        self
    }

    /// Adds a scalar that belongs to the table.
    #[must_use]
    pub fn attribute(mut self, name: &str, unit: &str, value: f64) -> Self {
        self.attributes.insert(
            name.to_owned(),
            Quantity {
                value,
                unit: unit.to_owned(),
            },
        );
        self
    }

    /// Says in which frame of reference a grid stands; `world` where nothing is said.
    #[must_use]
    pub fn in_frame(mut self, frame_id: &str) -> Self {
        let named = if frame_id == WORLD { "" } else { frame_id };
        named.clone_into(&mut self.frame_id);
        self
    }

    /// Frame of reference in which a grid stands.
    #[must_use]
    pub fn frame_id(&self) -> &str {
        if self.frame_id.is_empty() {
            WORLD
        } else {
            &self.frame_id
        }
    }

    /// Says how wide the values of a packed grid are; 8 bytes where nothing is said.
    #[must_use]
    pub fn in_precision(mut self, precision: Precision) -> Self {
        self.narrow = precision == Precision::F32;
        self
    }

    /// How wide the values of a packed grid are.
    #[must_use]
    pub fn precision(&self) -> Precision {
        if self.narrow {
            Precision::F32
        } else {
            Precision::F64
        }
    }

    /// Number of entries of each column.
    #[must_use]
    pub fn len(&self) -> usize {
        self.shape.iter().product()
    }

    /// Whether there are no entries.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether a column exists: whether the physics that fills it was active.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.columns.iter().any(|c| c.name == name)
    }

    /// Values of a column.
    ///
    /// # Errors
    /// [`Error::NoColumn`] when it is absent.
    pub fn values(&self, name: &str) -> Result<&[f64]> {
        find(&self.columns, name, &self.origin)
    }

    /// Values of an axis of a grid.
    ///
    /// # Errors
    /// [`Error::NoColumn`] when it is absent.
    pub fn axis(&self, name: &str) -> Result<&[f64]> {
        find(&self.axes, name, &self.origin)
    }

    /// A scalar that belongs to the table.
    ///
    /// # Errors
    /// [`Error::NoColumn`] when it is absent.
    pub fn scalar(&self, name: &str) -> Result<f64> {
        self.attributes
            .get(name)
            .map(|q| q.value)
            .ok_or_else(|| Error::NoColumn {
                origin: format!("{} (attributes)", self.origin),
                column: name.to_owned(),
                present: self
                    .attributes
                    .keys()
                    .cloned()
                    .collect::<Vec<_>>()
                    .join(", "),
            })
    }

    pub(crate) fn with_origin(mut self, origin: &str) -> Self {
        origin.clone_into(&mut self.origin);
        self
    }

    /// What is wrong with the table: lengths that differ from the shape.
    pub(crate) fn fault(&self) -> Option<String> {
        if !self.axes.is_empty() && self.axes.len() != self.shape.len() {
            return Some(format!(
                "{} axes for {} dimensions",
                self.axes.len(),
                self.shape.len()
            ));
        }
        for (axis, &n) in self.axes.iter().zip(&self.shape) {
            if axis.values.len() != n {
                return Some(format!(
                    "axis '{}' has {} entries, the shape says {n}",
                    axis.name,
                    axis.values.len()
                ));
            }
        }
        let n = self.len();
        let short = self.columns.iter().find(|c| c.values.len() != n)?;
        Some(format!(
            "column '{}' has {} entries, the shape says {n}",
            short.name,
            short.values.len()
        ))
    }

    /// First value that is not finite as wide as it will be: column, entry, value.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "whether it is lost is the question"
    )]
    pub(crate) fn not_finite(&self) -> Option<(String, usize, f64)> {
        let lost = |x: f64| !x.is_finite() || (self.narrow && !(x as f32).is_finite());
        let attributes = self.attributes.iter().filter(|(_, q)| !q.value.is_finite());
        let mut found = attributes.map(|(name, q)| (name.clone(), 0, q.value));
        found.next().or_else(|| {
            self.axes.iter().chain(&self.columns).find_map(|c| {
                c.values
                    .iter()
                    .position(|x| lost(*x))
                    .map(|i| (c.name.clone(), i, c.values[i]))
            })
        })
    }

    /// Unit of each axis, column and attribute.
    pub(crate) fn units(&self) -> BTreeMap<String, String> {
        let columns = self
            .axes
            .iter()
            .chain(&self.columns)
            .map(|c| (c.name.clone(), c.unit.clone()));
        columns
            .chain(
                self.attributes
                    .iter()
                    .map(|(n, q)| (n.clone(), q.unit.clone())),
            )
            .collect()
    }
}

fn series(name: &str, unit: &str, values: Vec<f64>) -> Series {
    Series {
        name: name.to_owned(),
        unit: unit.to_owned(),
        values,
    }
}

fn find<'a>(all: &'a [Series], name: &str, origin: &str) -> Result<&'a [f64]> {
    all.iter()
        .find(|c| c.name == name)
        .map(|c| c.values.as_slice())
        .ok_or_else(|| Error::NoColumn {
            origin: origin.to_owned(),
            column: name.to_owned(),
            present: all
                .iter()
                .map(|c| c.name.as_str())
                .collect::<Vec<_>>()
                .join(", "),
        })
}

/// A named scalar of a [`Record`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// Name; ends in the unit (`voltage_v`).
    pub name: String,
    /// SI unit; `1` for a pure number.
    pub unit: String,
    /// The value.
    pub value: f64,
}

/// Named scalars with units at one instant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// The scalars in order.
    pub values: Vec<Entry>,
    #[serde(skip)]
    origin: String,
}

impl Record {
    /// A record without scalars.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a scalar.
    #[must_use]
    pub fn with(mut self, name: &str, unit: &str, value: f64) -> Self {
        self.values.push(Entry {
            name: name.to_owned(),
            unit: unit.to_owned(),
            value,
        });
        self
    }

    /// Whether a scalar exists.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.values.iter().any(|e| e.name == name)
    }

    /// A scalar by name.
    ///
    /// # Errors
    /// [`Error::NoColumn`] when it is absent.
    pub fn get(&self, name: &str) -> Result<f64> {
        self.values
            .iter()
            .find(|e| e.name == name)
            .map(|e| e.value)
            .ok_or_else(|| Error::NoColumn {
                origin: self.origin.clone(),
                column: name.to_owned(),
                present: self
                    .values
                    .iter()
                    .map(|e| e.name.as_str())
                    .collect::<Vec<_>>()
                    .join(", "),
            })
    }

    pub(crate) fn with_origin(mut self, origin: &str) -> Self {
        origin.clone_into(&mut self.origin);
        self
    }

    /// A name that two scalars have.
    pub(crate) fn fault(&self) -> Option<String> {
        let names = self.values.iter().enumerate();
        let mut twins = names.filter(|(i, e)| self.values[..*i].iter().any(|o| o.name == e.name));
        twins
            .next()
            .map(|(_, e)| format!("scalar '{}' stands twice", e.name))
    }

    /// First value that is not finite: name, entry, value.
    pub(crate) fn not_finite(&self) -> Option<(String, usize, f64)> {
        let i = self.values.iter().position(|e| !e.value.is_finite())?;
        Some((self.values[i].name.clone(), i, self.values[i].value))
    }

    /// Unit of each scalar.
    pub(crate) fn units(&self) -> BTreeMap<String, String> {
        self.values
            .iter()
            .map(|e| (e.name.clone(), e.unit.clone()))
            .collect()
    }
}
