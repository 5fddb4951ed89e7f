//! The permeability of a body: a number, or how its field rises with its flux density.

use run::Fault;
use run::property::{Arguments, Curve, Formula, Property};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::magnetic::source::MU0;

/// Slope of B over H, in that of vacuum, below which the last rows of a table are no magnetisation: 1 but for what tables
/// are rounded by.
const VACUUM: f64 = 0.98;
/// Where formulas are read: so many even steps up to this flux density \[T\].
const READ: (usize, f64) = (4000, 10.0);

/// A curve of magnetisation, without hysteresis.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "curve of magnetisation")]
pub struct BhTable {
    /// Flux densities, rising from 0.
    #[schemars(extend("x-unit" = "T"), length(min = 2))]
    pub b_t: Vec<f64>,
    /// The field at each, rising from 0: smooth between the rows, and as in vacuum beyond the last, dB/dH = mu_0.
    #[schemars(extend("x-unit" = "A/m"), length(min = 2))]
    pub h_a_m: Vec<f64>,
}

/// Permeability over that of vacuum: `5000`, a curve of magnetisation `{"b_t": [0, 1, 2], "h_a_m": [0, 100, 20000]}`, or a
/// formula in the flux density B (T), `{"expr": "1 + 999/(1 + (B/1.5)^8)"}`, which is read every 2.5 mT up to 10 T; beyond,
/// dB/dH = mu_0.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Permeability {
    /// The same at all fields.
    Constant(#[schemars(range(max = 1e7), extend("exclusiveMinimum" = 0.0))] f64),
    /// A curve of magnetisation.
    Table(BhTable),
    /// A formula in B.
    Formula(Formula),
}

impl Default for Permeability {
    fn default() -> Self {
        Self::Constant(1.0)
    }
}

/// A curve of magnetisation as rows: flux densities \[T\] and fields \[A/m\].
pub(crate) type Rows = (Vec<f64>, Vec<f64>);

impl Permeability {
    /// Whether it depends on the field.
    #[must_use]
    pub fn saturates(&self) -> bool {
        !matches!(self, Self::Constant(_))
    }

    /// The permeability in weak fields, over that of vacuum; 1 of what is none.
    #[must_use]
    pub fn initial(&self) -> f64 {
        let found = match self {
            Self::Constant(value) => return *value,
            Self::Table(table) => {
                let rows = table.b_t.iter().zip(&table.h_a_m).nth(1);
                rows.map_or(1.0, |(b, h)| b / (MU0 * h))
            }
            Self::Formula(formula) => {
                let curve = Property::Formula(formula.clone()).compile("", &["B"]);
                let value = curve.map(|c| c.value(&Arguments::default()));
                value.map_or(1.0, |value| value.unwrap_or(1.0))
            }
        };
        if found > 0.0 && found.is_finite() {
            found
        } else {
            1.0
        }
    }

    /// The rows of a curve; none of a number.
    ///
    /// # Errors
    /// Where they are no magnetisation.
    pub(crate) fn rows(&self, at: &str) -> Result<Option<Rows>, Fault> {
        match self {
            Self::Constant(_) => Ok(None),
            Self::Table(table) => table.rows(at).map(Some),
            Self::Formula(formula) => read(formula, at).map(Some),
        }
    }
}

impl BhTable {
    fn rows(&self, at: &str) -> Result<Rows, Fault> {
        let (n, m) = (self.b_t.len(), self.h_a_m.len());
        if n < 2 || n != m {
            let what =
                format!("{n} flux densities and {m} fields; wanted are equally many, at least 2");
            return Err(Fault::at(at, what));
        }
        for (key, unit, column) in [("b_t", "T", &self.b_t), ("h_a_m", "A/m", &self.h_a_m)] {
            if column[0] != 0.0 {
                let what = format!(
                    "{} {unit} is out of range: 0 {unit} in the first row, as without a field nothing is left of one; a magnet that keeps its own is not computed",
                    column[0]
                );
                return Err(Fault::at(&format!("{at}/{key}/0"), what));
            }
            let fall = (1..n).find(|&k| !(column[k] > column[k - 1] && column[k].is_finite()));
            if let Some(k) = fall {
                let what = format!(
                    "{} {unit} does not rise above {} {unit} before it: H rises with B",
                    column[k],
                    column[k - 1]
                );
                return Err(Fault::at(&format!("{at}/{key}/{k}"), what));
            }
        }
        for k in 1..n {
            let (b, h) = (
                self.b_t[k] - self.b_t[k - 1],
                self.h_a_m[k] - self.h_a_m[k - 1],
            );
            if b < VACUUM * MU0 * h {
                let what = format!(
                    "{} A/m is out of range: at most {:.6e} A/m at {} T, as B rises by at least mu_0 times the rise of H from the row before",
                    self.h_a_m[k],
                    self.h_a_m[k - 1] + b / MU0,
                    self.b_t[k]
                );
                return Err(Fault::at(&format!("{at}/h_a_m/{k}"), what));
            }
        }
        Ok((self.b_t.clone(), self.h_a_m.clone()))
    }
}

/// The rows of a formula of the permeability.
fn read(formula: &Formula, at: &str) -> Result<Rows, Fault> {
    let property = Property::Formula(formula.clone());
    let curve = property.compile(at, &["B"])?;
    let at = format!("{at}/expr");
    if let Curve::Constant(value) = curve {
        let what = format!("\"{}\" does not depend on B: write {value}", formula.expr);
        return Err(Fault::at(&at, what));
    }
    let (mut b, mut h) = (vec![0.0], vec![0.0]);
    for k in 1..=READ.0 {
        let flux = READ.1 * k as f64 / READ.0 as f64;
        let place = Arguments {
            flux_density: flux,
            ..Arguments::default()
        };
        let value = curve.value(&place).ok().filter(|mu| *mu > 0.0);
        let Some(value) = value else {
            let what = format!(
                "\"{}\" is no permeability at B = {flux} T: above 0 is wanted up to {} T",
                formula.expr, READ.1
            );
            return Err(Fault::at(&at, what));
        };
        let field = flux / (MU0 * value);
        let (rise, last) = (field - h[k - 1], flux - b[k - 1]);
        if rise <= 0.0 || last < VACUUM * MU0 * rise {
            let what = format!(
                "\"{}\" gives {:.6e} A/m at B = {} T and {field:.6e} A/m at {flux} T: H rises with B, and B by at least mu_0 times the rise of H",
                formula.expr,
                h[k - 1],
                b[k - 1]
            );
            return Err(Fault::at(&at, what));
        }
        b.push(flux);
        h.push(field);
    }
    Ok((b, h))
}
