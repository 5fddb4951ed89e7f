//! Bodies with a curve of magnetisation in static fields, whose exact fields need no more than the curve.

use std::f64::consts::PI;

use serde_json::Value;

use super::MU0;
use crate::heat::formula::{At, Formula};

/// Halvings of an interval.
const HALVINGS: usize = 200;

/// How the field of a body follows its flux density.
#[derive(Debug, Clone)]
pub enum Law {
    /// Permeability over that of vacuum, a number or a formula in B.
    Formula(Formula),
    /// Rows of B and H.
    Table(Vec<[f64; 2]>),
}

impl Law {
    /// Reads a permeability as a scene writes it.
    ///
    /// # Errors
    /// What is not understood.
    pub fn read(value: &Value) -> Result<Self, String> {
        if let Some(number) = value.as_f64() {
            return Ok(Self::Formula(Formula::number(number)));
        }
        if let Some(text) = value["expr"].as_str() {
            // The reference's formulas know a place, not B.
            return Formula::parse(&text.replace('B', "x")).map(Self::Formula);
        }
        let numbers = |key: &str| -> Option<Vec<f64>> {
            value[key].as_array()?.iter().map(Value::as_f64).collect()
        };
        match (numbers("b_t"), numbers("h_a_m")) {
            (Some(b), Some(h)) if b.len() == h.len() && b.len() > 1 => {
                let rows = b.into_iter().zip(h).map(|(b, h)| [b, h]);
                Ok(Self::Table(rows.collect()))
            }
            _ => Err(format!("{value} is no number, formula or table")),
        }
    }

    /// Field at a flux density \[A/m\].
    #[must_use]
    pub fn field(&self, b: f64) -> f64 {
        match self {
            Self::Formula(mu) => b / (MU0 * mu.value(&At::place([b, 0.0, 0.0]))),
            Self::Table(rows) => between(rows, b),
        }
    }

    /// Flux density at a field \[T\].
    #[must_use]
    pub fn flux(&self, h: f64) -> f64 {
        solve(|b| self.field(b) - h)
    }

    /// The flux density inside a body whose magnetisation M adds `-share M` to the field, in an applied flux density: 1/2
    /// of a cylinder across its axis, 1/3 of a sphere (Jackson 1999, section 5.11).
    #[must_use]
    pub fn inside(&self, share: f64, applied: f64) -> f64 {
        solve(|b| share * b + (1.0 - share) * MU0 * self.field(b) - applied)
    }
}

/// Where a rising function is zero.
fn solve(rising: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    while rising(high) < 0.0 {
        high *= 2.0;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if rising(middle) > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

/// A cubic between rows, with slopes after Fritsch and Butland (1984), odd at zero, and as in vacuum beyond the last.
fn between(rows: &[[f64; 2]], b: f64) -> f64 {
    let last = rows.len() - 1;
    if b >= rows[last][0] {
        return rows[last][1] + (b - rows[last][0]) / MU0;
    }
    let k = rows
        .iter()
        .position(|row| row[0] > b)
        .unwrap_or(last)
        .max(1);
    let wide = rows[k][0] - rows[k - 1][0];
    let t = (b - rows[k - 1][0]) / wide;
    let [from, to] = [k - 1, k].map(|row| slope(rows, row) * wide);
    let hermite = [
        (1.0 + 2.0 * t) * (1.0 - t).powi(2) * rows[k - 1][1],
        t * (1.0 - t).powi(2) * from,
        t * t * (3.0 - 2.0 * t) * rows[k][1],
        t * t * (t - 1.0) * to,
    ];
    hermite.iter().sum()
}

fn slope(rows: &[[f64; 2]], k: usize) -> f64 {
    let last = rows.len() - 1;
    let wide = |k: usize| rows[k + 1][0] - rows[k][0];
    let secant = |k: usize| (rows[k + 1][1] - rows[k][1]) / wide(k);
    if k == 0 {
        return 0.5 * (3.0 * secant(0) - slope(rows, 1));
    }
    if k < last {
        let share = (1.0 + wide(k) / (wide(k - 1) + wide(k))) / 3.0;
        return 1.0 / (share / secant(k - 1) + (1.0 - share) / secant(k));
    }
    let mut own = secant(last - 1);
    if last > 1 {
        let lean = wide(last - 1) / (wide(last - 2) + wide(last - 1));
        own = (own + lean * (own - secant(last - 2))).clamp(0.0, 3.0 * secant(last - 1));
    }
    own.min((1.0 / MU0).max(secant(last - 1)))
}

/// A round body in a uniform field, in a plane or in space.
#[derive(Debug, Clone)]
pub struct Round {
    /// Radius \[m\].
    pub radius: f64,
    /// Applied flux density \[T\], with its third component nothing in a plane.
    pub applied: [f64; 3],
    /// Flux density inside over that applied.
    pub ratio: f64,
    /// 2 of a cylinder, 3 of a sphere.
    pub dimensions: i32,
}

impl Round {
    /// A cylinder (2) or a sphere (3).
    #[must_use]
    pub fn new(law: &Law, dimensions: i32, radius: f64, applied: [f64; 3]) -> Self {
        let size = applied.iter().map(|b| b * b).sum::<f64>().sqrt();
        Self {
            radius,
            applied,
            ratio: law.inside(1.0 / f64::from(dimensions), size) / size,
            dimensions,
        }
    }

    /// Flux density at a place from the middle \[T\], on the surface from within: uniform inside, that of a dipole beside
    /// the applied one outside.
    #[must_use]
    pub fn field(&self, x: [f64; 3]) -> [f64; 3] {
        let r = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        if r <= self.radius * (1.0 + 1e-9) {
            return self.applied.map(|b| self.ratio * b);
        }
        let along: f64 = (0..3).map(|k| x[k] / r * self.applied[k]).sum();
        let n = f64::from(self.dimensions);
        let dipole = (self.ratio - 1.0) * (self.radius / r).powi(self.dimensions) / (n - 1.0);
        std::array::from_fn(|k| self.applied[k] + dipole * (n * x[k] / r * along - self.applied[k]))
    }
}

/// A tube about a straight wire along z.
#[derive(Debug, Clone)]
pub struct Tube {
    /// Current \[A\].
    pub current: f64,
    /// Inner and outer radius \[m\].
    pub radii: [f64; 2],
    /// Its magnetisation.
    pub law: Law,
}

impl Tube {
    /// Flux density around the wire \[T\]: by `H = I / (2 pi r)`, on its surfaces from within the tube.
    #[must_use]
    pub fn around(&self, r: f64) -> f64 {
        let field = self.current / (2.0 * PI * r);
        let [from, to] = self.radii;
        if r >= from * (1.0 - 1e-9) && r <= to * (1.0 + 1e-9) {
            self.law.flux(field)
        } else {
            MU0 * field
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// One permeability: `2 mu / (mu + 1)` in a cylinder, `3 mu / (mu + 2)` in a sphere; the normal part is continuous.
    #[test]
    fn one_permeability_gives_the_known_ratios() {
        let law = Law::read(&json!(50.0)).unwrap();
        let wanted = [(2, 100.0 / 51.0), (3, 150.0 / 52.0)];
        for (dimensions, ratio) in wanted {
            let round = Round::new(&law, dimensions, 2.0, [0.3, 0.0, 0.0]);
            assert!((round.ratio / ratio - 1.0).abs() < 1e-12);
            let [a, b] = [2.0, 2.0001].map(|r| round.field([r, 0.0, 0.0])[0]);
            assert!((a - b).abs() < 1e-3);
        }
    }

    #[test]
    fn rows_and_formulas_give_one_field() {
        let formula = Law::read(&json!({"expr": "1 + 999/(1 + (B/1.5)^4)"})).unwrap();
        let b: Vec<f64> = (0..=400).map(|k| 0.01 * f64::from(k)).collect();
        let h: Vec<f64> = b.iter().map(|b| formula.field(*b)).collect();
        let table = Law::read(&json!({"b_t": b, "h_a_m": h})).unwrap();
        for b in [0.003, 0.7, 1.493, 2.222, 3.995] {
            assert!(
                (table.field(b) / formula.field(b) - 1.0).abs() < 1e-4,
                "{b}"
            );
        }
        let field = table.field(1.7);
        assert!((table.flux(field) - 1.7).abs() < 1e-12);
    }
}
