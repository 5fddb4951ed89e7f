//! Materials: where each is, what it stores and how it conducts.

pub mod cells;
pub mod conductor;
pub mod enthalpy;
mod holds;
mod meetings;
pub mod path;
pub mod setup;
mod stored;
mod stretches;
pub mod volumetric;

use run::property::{Arguments, Curve, OutOfRange};

use conductor::Conductor;
use enthalpy::Enthalpy;
pub use meetings::Meetings;
use shapes::Body;
use shapes::frame::Vector;
use stored::Stored;

/// What a property of place may depend on.
pub const PLACE: [&str; 4] = ["x", "y", "z", "r"];

/// One term of a conductivity: a function of place times one of temperature.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// The factor that depends on place.
    pub fraction: Curve,
    /// Number of the factor that depends on temperature.
    pub conductor: usize,
}

/// Conductivity of a material.
#[derive(Debug, Clone, PartialEq)]
pub enum Law {
    /// A sum of products of a function of place and one of temperature.
    Sum(Vec<Part>),
    /// Any formula of place and temperature.
    Formula(Curve),
}

/// A material of a body.
#[derive(Debug, Clone, PartialEq)]
struct Kind {
    region: Option<Body>,
    stored: Stored,
    law: Law,
}

/// All materials of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Materials {
    kinds: Vec<Kind>,
    /// All functions of temperature.
    pub conductors: Vec<Conductor>,
    /// All functions of temperature of what is stored.
    enthalpies: Vec<Enthalpy>,
    /// First range of temperature \[K\].
    range: (f64, f64),
    /// Resistance between materials i and j \[m2 K/W\] at `i * kinds + j`.
    contact: Vec<f64>,
    dimensions: usize,
}

impl Materials {
    /// Number of materials.
    #[must_use]
    pub fn len(&self) -> usize {
        self.kinds.len()
    }

    /// True without materials.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// The material at a place; the last where no region holds it.
    #[must_use]
    pub fn at(&self, x: Vector) -> usize {
        let holds = |kind: &Kind| kind.region.as_ref().is_none_or(|region| region.holds(x));
        self.kinds
            .iter()
            .position(holds)
            .unwrap_or(self.kinds.len() - 1)
    }

    /// Conductivity of a material.
    #[must_use]
    pub fn law(&self, material: usize) -> &Law {
        &self.kinds[material].law
    }

    /// Where a material is; nothing for one that is elsewhere.
    pub(crate) fn region(&self, material: usize) -> Option<&Body> {
        self.kinds[material].region.as_ref()
    }

    /// Resistance between two materials \[m2 K/W\].
    #[must_use]
    pub fn contact(&self, a: usize, b: usize) -> f64 {
        self.contact[a * self.kinds.len() + b]
    }

    /// Normal of the interface of two materials that meet at `x`.
    #[must_use]
    pub fn interface(&self, a: usize, b: usize, x: Vector, step: f64) -> Vector {
        // The first of the two has the region that bounds the other.
        let region = self.kinds[a.min(b)].region.as_ref();
        region.map_or([0.0; 3], |region| region.normal(x, step))
    }

    /// Whether conductivity depends on temperature anywhere.
    #[must_use]
    pub fn nonlinear(&self) -> bool {
        self.kinds.iter().any(|kind| match &kind.law {
            Law::Sum(parts) => parts
                .iter()
                .any(|p| self.conductors[p.conductor].constant().is_none()),
            Law::Formula(_) => true,
        })
    }

    /// Conductivity at a place and temperature \[W/(m K)\].
    ///
    /// # Errors
    /// Where a property has no value.
    pub fn conductivity(
        &self,
        material: usize,
        x: Vector,
        temperature: f64,
    ) -> Result<f64, OutOfRange> {
        match self.law(material) {
            Law::Sum(parts) => {
                let mut sum = 0.0;
                for part in parts {
                    let k = self.conductors[part.conductor].value(temperature);
                    sum += k * part.fraction.value(&Arguments::at(x, 0.0))?;
                }
                Ok(sum)
            }
            Law::Formula(curve) => curve.value(&arguments(x, temperature, 0.0)),
        }
    }

    /// Whether an interface may cross the cell of the given edge about `x`.
    pub(crate) fn crossed(&self, x: Vector, edge: f64) -> bool {
        let near = 0.5 * edge * (self.dimensions as f64).sqrt();
        let close = |kind: &Kind| {
            let region = kind.region.as_ref();
            region.is_some_and(|region| region.distance(x).abs() < near)
        };
        self.kinds.len() > 1 && self.kinds.iter().any(close)
    }

    /// rho c of a material at a place, or its factor that depends on place alone \[J/(m3 K)\].
    pub(crate) fn stored(&self, material: usize, x: Vector) -> Result<f64, OutOfRange> {
        self.kinds[material].stored.factor(x)
    }

    /// Whether what is stored depends on temperature anywhere.
    #[must_use]
    pub fn stores_by_temperature(&self) -> bool {
        self.kinds.iter().any(|kind| kind.stored.varies())
    }

    /// Number of the function of temperature of what a material stores, where all places share one.
    fn enthalpy(&self, material: usize) -> Option<usize> {
        self.kinds[material].stored.temperature
    }

    /// That of one place, where each has its own.
    fn own_enthalpy(&self, material: usize, x: Vector) -> Option<Result<Enthalpy, OutOfRange>> {
        self.kinds[material].stored.own(x, self.range)
    }

    /// Heat at a temperature over what is gathered of a material; the temperature itself where it stores the same at
    /// all, and where each place has its own function.
    fn specific(&self, material: usize, temperature: f64) -> f64 {
        let stored = &self.kinds[material].stored;
        match stored.temperature {
            Some(function) => self.enthalpies[function].at(temperature).1,
            None if stored.varies() || !self.stores_by_temperature() => temperature,
            None => temperature - self.range.0,
        }
    }
}

/// Arguments of a property at a place, temperature and time.
#[must_use]
pub fn arguments(x: Vector, temperature: f64, time: f64) -> Arguments {
    Arguments {
        temperature,
        ..Arguments::at(x, time)
    }
}

#[cfg(test)]
mod tests;
