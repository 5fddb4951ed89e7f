//! What the cells of points hold.
//!
//! ```text
//! E_i(T) = sum_m V_im f_m integral of g_m(T) dT,    rho c = f_m(x) g_m(T) in material m
//! ```
//!
//! Where rho c depends on temperature the heat of a cell is what a march takes through time, and its temperature
//! follows from that: no peak of rho c, however narrow, is stepped over, and heat is conserved to rounding.

use crate::material::enthalpy::Enthalpy;

/// Iterations for the temperature of a cell of several materials.
const ITERATIONS: usize = 200;

/// What the cells of points hold.
#[derive(Debug, Clone, PartialEq)]
pub enum Storage {
    /// Heat capacity of each, the same at all temperatures \[J/K\].
    Fixed(Vec<f64>),
    /// Heat as a function of temperature.
    Varies(Content),
}

/// Heat of each cell as a sum of functions of temperature.
#[derive(Debug, Clone, PartialEq)]
pub struct Content {
    functions: Vec<Enthalpy>,
    /// First share of each cell.
    begin: Vec<u32>,
    /// Number of a function and how much there is of it: a volume \[m3\] times the factor of place.
    shares: Vec<(u32, f64)>,
}

impl Storage {
    /// What a march keeps of heat; nothing where temperature says it all.
    #[must_use]
    pub fn varies(&self) -> Option<&Content> {
        match self {
            Self::Fixed(_) => None,
            Self::Varies(content) => Some(content),
        }
    }

    /// Heat capacity of cell `i` at a temperature \[J/K\].
    #[inline]
    #[must_use]
    pub fn capacity(&self, i: usize, temperature: f64) -> f64 {
        match self {
            Self::Fixed(capacity) => capacity[i],
            Self::Varies(content) => content.at(i, temperature).0,
        }
    }

    /// Heat that cell `i` takes up from one temperature to another \[J\].
    #[inline]
    #[must_use]
    pub fn rise(&self, i: usize, from: f64, to: f64) -> f64 {
        match self {
            Self::Fixed(capacity) => capacity[i] * (to - from),
            Self::Varies(content) => content.at(i, to).1 - content.at(i, from).1,
        }
    }

    /// The same for all temperatures, with the capacities at the given ones: for a steady state, which stores nothing.
    #[must_use]
    pub fn still(self, temperature: &[f64]) -> Self {
        let each = temperature.iter().enumerate();
        Self::Fixed(each.map(|(i, t)| self.capacity(i, *t)).collect())
    }
}

impl Content {
    /// Cells with the given shares of functions.
    #[must_use]
    pub fn new(functions: Vec<Enthalpy>, cells: Vec<Vec<(u32, f64)>>) -> Self {
        let mut content = Self {
            functions,
            begin: vec![0],
            shares: Vec::new(),
        };
        for own in cells {
            content.shares.extend(own);
            content.begin.push(content.shares.len() as u32);
        }
        content
    }

    #[inline]
    fn own(&self, i: usize) -> &[(u32, f64)] {
        &self.shares[self.begin[i] as usize..self.begin[i + 1] as usize]
    }

    /// Heat capacity of cell `i` \[J/K\] and its heat above that at the first temperature \[J\].
    #[inline]
    #[must_use]
    pub fn at(&self, i: usize, temperature: f64) -> (f64, f64) {
        let (mut capacity, mut heat) = (0.0, 0.0);
        for (function, amount) in self.own(i) {
            let (c, h) = self.functions[*function as usize].at(temperature);
            capacity += amount * c;
            heat += amount * h;
        }
        (capacity, heat)
    }

    /// Heats of all cells \[J\].
    #[must_use]
    pub fn heats(&self, temperature: &[f64]) -> Vec<f64> {
        let each = temperature.iter().enumerate();
        each.map(|(i, t)| self.at(i, *t).1).collect()
    }

    /// The temperature of cell `i` that holds `heat` \[J\]; `near` is one that is not far \[K\].
    #[must_use]
    pub fn temperature(&self, i: usize, heat: f64, near: f64) -> f64 {
        match self.own(i) {
            [(function, amount)] => self.functions[*function as usize].temperature(heat / amount),
            _ => solve(heat, near, |t| self.at(i, t)),
        }
    }

    /// Makes the tables span from `low` to `high` \[K\]; whether one has grown.
    ///
    /// # Errors
    /// Where a property has no value.
    pub fn widen(&mut self, low: f64, high: f64) -> Result<bool, run::property::OutOfRange> {
        let mut grown = false;
        for function in &mut self.functions {
            let (from, to) = function.span();
            if low < from || high > to {
                grown |= function.widen(low.min(from), high.max(to))?;
            }
        }
        Ok(grown)
    }

    /// Whether all peaks of rho c were found.
    #[must_use]
    pub fn is_resolved(&self) -> bool {
        self.functions.iter().all(Enthalpy::is_resolved)
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let tables: u64 = self.functions.iter().map(Enthalpy::bytes).sum();
        tables + (4 * self.begin.len() + 16 * self.shares.len()) as u64
    }
}

/// Where a rising function with the given slope and value becomes `wanted`: Newton's method, by halves where it leads
/// badly.
pub(crate) fn solve(wanted: f64, near: f64, of: impl Fn(f64) -> (f64, f64)) -> f64 {
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    let (mut t, mut before) = (near, f64::INFINITY);
    for _ in 0..ITERATIONS {
        let (slope, value) = of(t);
        let miss = value - wanted;
        if miss > 0.0 {
            high = t;
        } else {
            low = t;
        }
        let newton = t - miss / slope;
        if !newton.is_finite() || (newton - t).abs() <= f64::EPSILON * t.abs() {
            break;
        }
        let middle = 0.5 * (low + high);
        let led = newton >= low && newton <= high && miss.abs() <= 0.5 * before;
        before = miss.abs();
        t = if led || !middle.is_finite() {
            newton
        } else {
            middle
        };
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::volumetric::Volumetric;
    use run::property::Property;

    fn function(text: &str) -> Enthalpy {
        let property: Property = serde_json::from_str(text).unwrap();
        let law = Volumetric {
            factors: vec![property.compile("/c", &["T"]).unwrap()],
            place: [0.0; 3],
        };
        Enthalpy::new(law, (300.0, 2000.0)).unwrap()
    }

    #[test]
    fn the_temperature_of_a_cell_of_several_materials_is_found() {
        let peak = r#"{"expr": "500 + 2e9*exp(-((T - 1500)/1e-4)^2)"}"#;
        let functions = vec![
            function(peak),
            function(r#"{"expr": "300 + 0.2*T"}"#),
            Enthalpy::even(300.0),
        ];
        let content = Content::new(
            functions,
            vec![vec![(0, 1e-3), (1, 2e-3), (2, 0.5)], vec![(1, 1.0)]],
        );
        for cell in [0, 1] {
            let wanted = [301.0, 1499.0, 1499.9999, 1500.0, 1500.00001, 1501.0, 1999.0];
            for wanted in wanted {
                for near in [300.0, 1499.0, 1500.0, 1990.0] {
                    let heat = content.at(cell, wanted).1;
                    let found = content.temperature(cell, heat, near);
                    assert!(
                        (found - wanted).abs() < 1e-9,
                        "{cell} {wanted} {near}: {found}"
                    );
                }
            }
        }
    }
}
