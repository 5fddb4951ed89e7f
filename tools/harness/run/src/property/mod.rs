//! Properties as a person states them: a number, a table over temperature, or an expression.

mod expression;
mod operation;
mod parser;
mod range;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

pub use expression::Expression;
pub use range::Bounds;

use crate::fault::Fault;

/// What a property can depend on.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Arguments {
    /// Position \[m\].
    pub x: f64,
    /// Position \[m\].
    pub y: f64,
    /// Position \[m\].
    pub z: f64,
    /// Distance from the axis \[m\].
    pub r: f64,
    /// Temperature \[K\].
    pub temperature: f64,
    /// Time \[s\].
    pub time: f64,
    /// Mass fraction of what a gas carries.
    pub fraction: f64,
    /// Magnetic flux density \[T\].
    pub flux_density: f64,
}

impl Arguments {
    /// Only a temperature \[K\].
    #[must_use]
    pub fn at_temperature(temperature: f64) -> Self {
        Self {
            temperature,
            ..Self::default()
        }
    }

    /// A position \[m\] and a time \[s\]; `r` is the distance from the z axis.
    #[must_use]
    pub fn at(position: [f64; 3], time: f64) -> Self {
        let [x, y, z] = position;
        Self {
            x,
            y,
            z,
            r: x.hypot(y),
            time,
            ..Self::default()
        }
    }
}

/// What a table does beyond its ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Extrapolate {
    /// A temperature beyond the ends stops the run.
    #[default]
    Error,
    /// The value at the end is kept.
    Constant,
}

/// A table over temperature, linear between its rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "table over temperature")]
pub struct TemperatureTable {
    /// Temperatures in rising order.
    #[schemars(extend("x-unit" = "K"), length(min = 2))]
    pub t_k: Vec<f64>,
    /// Value at each temperature, in the unit of the property.
    #[schemars(length(min = 2))]
    pub value: Vec<f64>,
    /// What happens beyond the ends of the table.
    #[serde(default)]
    pub extrapolate: Extrapolate,
}

/// A formula in x, y, z, r (m), T (K), t (s).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "expression")]
pub struct Formula {
    /// For example `1 + 2*sin(pi*x)*sin(pi*y)`.
    pub expr: String,
}

/// A property of a scene: `7800.0`, `{"t_k": [300, 1800], "value": [60, 30]}`, or
/// `{"expr": "300 + 1e3*x"}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Property {
    /// The same everywhere.
    Constant(f64),
    /// A table over temperature.
    Table(TemperatureTable),
    /// A formula.
    Formula(Formula),
}

impl From<f64> for Property {
    fn from(value: f64) -> Self {
        Self::Constant(value)
    }
}

/// What a formula may be below 0 K by rounding \[K\].
const ROUNDED_K: f64 = 1e-9;

/// A temperature beyond the ends of a table, or a formula without a finite value.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum OutOfRange {
    /// Beyond the ends of the table.
    #[error("temperature {found} K is outside of the table, {from} K to {to} K")]
    Table {
        /// Temperature \[K\].
        found: f64,
        /// First temperature of the table \[K\].
        from: f64,
        /// Last temperature of the table \[K\].
        to: f64,
    },
    /// A temperature below 0 K.
    #[error(
        "{value} K is out of range: at least 0 K; temperatures are in kelvin, and {value} degrees Celsius are {} K",
        value + 273.15
    )]
    Cold {
        /// The temperature \[K\].
        value: f64,
    },
    /// Not a finite number.
    #[error("the formula gives {value} at x = {}, y = {}, z = {} m, T = {} K, t = {} s", .at.x, .at.y, .at.z, .at.temperature, .at.time)]
    Formula {
        /// What it gives.
        value: f64,
        /// Where.
        at: Arguments,
    },
}

impl Property {
    /// Checks the property and makes it ready for fast evaluation; `at` is its JSON pointer,
    /// `names` what a formula may depend on here, for example `&["x", "y", "z", "t"]`.
    ///
    /// # Errors
    /// A [`Fault`] at the very key that is wrong.
    pub fn compile(&self, at: &str, names: &[&str]) -> Result<Curve, Fault> {
        match self {
            Self::Constant(value) if value.is_finite() => Ok(Curve::Constant(*value)),
            Self::Constant(value) => Err(Fault::at(at, format!("{value} is not a finite number"))),
            Self::Table(table) => table.compile(at, names).map(Curve::Table),
            Self::Formula(formula) => {
                let expression = Expression::parse(&formula.expr, names).map_err(|what| {
                    Fault::at(
                        &format!("{at}/expr"),
                        format!("\"{}\": {what}", formula.expr),
                    )
                })?;
                Ok(expression
                    .constant()
                    .map_or(Curve::Formula(expression), Curve::Constant))
            }
        }
    }
}

impl Property {
    /// As [`Property::compile`], for a quantity that must be above zero, such as a density:
    /// numbers and rows that are not are refused. A formula is known only where it is evaluated.
    ///
    /// # Errors
    /// A [`Fault`] at the very key that is wrong.
    pub fn compile_positive(&self, at: &str, names: &[&str], unit: &str) -> Result<Curve, Fault> {
        let refuse = |at: &str, value: f64| {
            Fault::at(
                at,
                format!("{value} {unit} is out of range: above 0 {unit}"),
            )
        };
        let curve = self.compile(at, names)?;
        match &curve {
            Curve::Constant(value) if *value <= 0.0 => Err(refuse(at, *value)),
            Curve::Table(rows) => match rows.value.iter().position(|value| *value <= 0.0) {
                Some(row) => Err(refuse(&format!("{at}/value/{row}"), rows.value[row])),
                None => Ok(curve),
            },
            _ => Ok(curve),
        }
    }
}

impl Property {
    /// As [`Property::compile`], for a temperature: what is below 0 K is refused. That of a formula is told by
    /// [`Curve::kelvin`].
    ///
    /// # Errors
    /// A [`Fault`] at the very key that is wrong.
    pub fn compile_temperature(&self, at: &str, names: &[&str]) -> Result<Curve, Fault> {
        let curve = self.compile(at, names)?;
        let (place, found) = match &curve {
            Curve::Constant(value) => (at.to_owned(), Some(*value).filter(|t| *t < 0.0)),
            Curve::Table(rows) => match rows.value.iter().position(|t| *t < 0.0) {
                Some(row) => (format!("{at}/value/{row}"), Some(rows.value[row])),
                None => (at.to_owned(), None),
            },
            Curve::Formula(_) => (at.to_owned(), None),
        };
        match found {
            Some(value) => Err(Fault::at(&place, OutOfRange::Cold { value }.to_string())),
            None => Ok(curve),
        }
    }
}

impl TemperatureTable {
    fn compile(&self, at: &str, names: &[&str]) -> Result<Rows, Fault> {
        if !names.contains(&"T") {
            return Err(Fault::at(
                at,
                "a table over temperature cannot stand here: nothing depends on T",
            ));
        }
        let (n, m) = (self.t_k.len(), self.value.len());
        if n < 2 || n != m {
            let what =
                format!("{n} temperatures and {m} values; wanted are equally many, at least 2");
            return Err(Fault::at(at, what));
        }
        if self.t_k[0].is_nan() || self.t_k[0] < 0.0 {
            let what = format!("{} K is out of range: at least 0 K", self.t_k[0]);
            return Err(Fault::at(&format!("{at}/t_k/0"), what));
        }
        if let Some(i) = (1..n).find(|&i| self.t_k[i] <= self.t_k[i - 1]) {
            let what = format!(
                "{} K does not rise above {} K before it",
                self.t_k[i],
                self.t_k[i - 1]
            );
            return Err(Fault::at(&format!("{at}/t_k/{i}"), what));
        }
        Ok(Rows {
            t: self.t_k.clone(),
            value: self.value.clone(),
            extrapolate: self.extrapolate,
        })
    }
}

/// The rows of a checked table.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows {
    t: Vec<f64>,
    value: Vec<f64>,
    extrapolate: Extrapolate,
}

impl Rows {
    /// Temperatures \[K\], rising.
    #[must_use]
    pub fn temperatures(&self) -> &[f64] {
        &self.t
    }

    /// Value at each temperature.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.value
    }

    /// What happens beyond the ends.
    #[must_use]
    pub fn extrapolate(&self) -> Extrapolate {
        self.extrapolate
    }

    #[inline]
    fn value(&self, t: f64) -> Result<f64, OutOfRange> {
        let last = self.t.len() - 1;
        let (from, to) = (self.t[0], self.t[last]);
        // A NaN is in no range.
        if t >= from && t <= to {
            let i = self.t.partition_point(|&row| row <= t).clamp(1, last);
            let (t0, t1, v0, v1) = (self.t[i - 1], self.t[i], self.value[i - 1], self.value[i]);
            return Ok(v0 + (v1 - v0) * ((t - t0) / (t1 - t0)));
        }
        match self.extrapolate {
            Extrapolate::Constant if t < from => Ok(self.value[0]),
            Extrapolate::Constant if t > to => Ok(self.value[last]),
            _ => Err(OutOfRange::Table { found: t, from, to }),
        }
    }
}

/// A property that is ready for evaluation: no allocation, a constant costs a branch.
#[derive(Debug, Clone, PartialEq)]
pub enum Curve {
    /// The same everywhere.
    Constant(f64),
    /// A table over temperature.
    Table(Rows),
    /// A formula.
    Formula(Expression),
}

impl Curve {
    /// The value at a place, temperature and time.
    ///
    /// # Errors
    /// [`OutOfRange`] beyond the ends of a table, or where a formula is not finite.
    #[inline]
    pub fn value(&self, at: &Arguments) -> Result<f64, OutOfRange> {
        match self {
            Self::Constant(value) => Ok(*value),
            Self::Table(rows) => rows.value(at.temperature),
            Self::Formula(expression) => {
                let value = expression.value(at);
                if value.is_finite() {
                    Ok(value)
                } else {
                    Err(OutOfRange::Formula { value, at: *at })
                }
            }
        }
    }

    /// The value where it is a temperature \[K\], which is not below 0 K but for rounding.
    ///
    /// # Errors
    /// As [`Curve::value`], and below 0 K.
    #[inline]
    pub fn kelvin(&self, at: &Arguments) -> Result<f64, OutOfRange> {
        let value = self.value(at)?;
        if value < -ROUNDED_K {
            Err(OutOfRange::Cold { value })
        } else {
            Ok(value)
        }
    }

    /// The value at a temperature \[K\], for a property that depends on nothing else.
    ///
    /// # Errors
    /// As [`Curve::value`].
    #[inline]
    pub fn at_temperature(&self, temperature: f64) -> Result<f64, OutOfRange> {
        self.value(&Arguments::at_temperature(temperature))
    }

    /// The value, if it is the same everywhere.
    #[must_use]
    pub fn constant(&self) -> Option<f64> {
        match self {
            Self::Constant(value) => Some(*value),
            _ => None,
        }
    }

    /// The temperatures between which the curve is defined \[K\]; `None`: everywhere.
    #[must_use]
    pub fn range_k(&self) -> Option<(f64, f64)> {
        match self {
            Self::Table(rows) if rows.extrapolate == Extrapolate::Error => {
                Some((rows.t[0], rows.t[rows.t.len() - 1]))
            }
            _ => None,
        }
    }
}
