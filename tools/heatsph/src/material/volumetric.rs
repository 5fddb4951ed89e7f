//! Heat capacity of the unit volume, rho c, as a product of properties.

use run::property::{Arguments, Bounds, Curve, OutOfRange};
use shapes::frame::Vector;

use super::arguments;

/// rho c at a place, or the part of it that depends on temperature: a product.
#[derive(Debug, Clone, PartialEq)]
pub struct Volumetric {
    /// The factors.
    pub factors: Vec<Curve>,
    /// Where \[m\].
    pub place: Vector,
}

impl Volumetric {
    pub(super) fn value(&self, temperature: f64) -> Result<f64, OutOfRange> {
        let at = arguments(self.place, temperature, 0.0);
        let mut product = 1.0;
        for factor in &self.factors {
            let value = factor.value(&at)?;
            if value <= 0.0 {
                return Err(OutOfRange::Formula { value, at });
            }
            product *= value;
        }
        Ok(product)
    }

    pub(super) fn bounds(&self, [from, to]: [f64; 2]) -> Bounds {
        let ends = [from, to].map(|t| arguments(self.place, t, 0.0));
        let [a, b]: [&Arguments; 2] = [&ends[0], &ends[1]];
        // All factors are positive where they have a value.
        let product = |p: Bounds, f: &Curve| {
            let b = f.bounds(a, b);
            Bounds {
                low: p.low * b.low.max(0.0),
                high: p.high * b.high,
            }
        };
        self.factors.iter().fold(Bounds::at(1.0), product)
    }

    /// Temperatures between which it is defined \[K\].
    pub(super) fn range(&self) -> (f64, f64) {
        let all = (f64::NEG_INFINITY, f64::INFINITY);
        let own = self.factors.iter().filter_map(Curve::range_k);
        own.fold(all, |(low, high), (a, b)| (low.max(a), high.min(b)))
    }

    pub(super) fn constant(&self) -> Option<f64> {
        self.factors.iter().map(Curve::constant).product()
    }

    /// Temperatures of rows of its tables \[K\].
    pub(super) fn rows(&self) -> impl Iterator<Item = f64> + '_ {
        let own = |curve: &Curve| match curve {
            Curve::Table(rows) => rows.temperatures().to_vec(),
            _ => Vec::new(),
        };
        self.factors.iter().flat_map(own)
    }
}
