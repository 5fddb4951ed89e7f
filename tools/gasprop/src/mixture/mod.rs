//! The gas in local thermodynamic equilibrium: which species there are, how many of each, and what they hold.
//!
//! - [`Library`] reads the species from the data of the crate; [`Species`] is one of them;
//! - [`Mixture`] is a cold gas with or without iron and all species that its elements can form;
//! - [`Mixture::equilibrium`] finds how many there are of each at a temperature, pressure and iron content;
//! - [`Mixture::thermodynamics`] finds density, enthalpy, specific heat and the derivatives of the composition.
//!
//! One temperature rules the gas and reactions are infinitely fast. Charges attract each other by Debye and
//! Hueckel's limiting law, unless an ideal gas is asked for ([`Lowering`]). Condensation is left out: cold iron
//! is a gas here, whatever its vapour pressure.

mod balance;
mod basis;
mod composition;
mod internal;
mod levels;
pub mod library;
mod nasa9;
mod shells;
pub mod species;
mod system;
pub mod thermodynamics;

pub use internal::Internal;
pub use library::{DataError, Library};
pub use species::{Element, Kind, Species, UnknownElement};
pub use thermodynamics::Thermodynamics;

use thiserror::Error;

/// Temperatures at which the species' data hold, K.
pub const TEMPERATURE_RANGE: [f64; 2] = [298.15, 31_000.0];

/// A cold gas, with or without iron, and all species that its elements can form.
#[derive(Debug, Clone)]
pub struct Mixture {
    /// The species; the electron is the first.
    pub species: Vec<Species>,
    /// The elements that occur, in order; iron, if any, is the last.
    pub elements: Vec<Element>,
    /// Moles of each of `elements` in one mole of the cold gas without iron.
    pub base: Vec<f64>,
    /// The components of the cold gas and their mole fractions.
    cold: Vec<(Species, f64)>,
    with_iron: bool,
    lowering: Lowering,
}

/// How charges change the energy of each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Lowering {
    /// Not at all: an ideal gas of all species.
    None,
    /// By Debye and Hueckel's limiting law: ionisation takes less energy by (z + 1) e^2/(4 pi eps0 Debye length).
    #[default]
    DebyeHueckel,
}

/// What holds besides temperature and recipe.
#[derive(Debug, Clone, Copy)]
struct Conditions {
    /// Pressure, Pa.
    pressure: f64,
    lowering: Lowering,
}

/// How many of each species there are.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Temperature T, K.
    pub temperature: f64,
    /// Pressure p, Pa.
    pub pressure: f64,
    /// Moles of iron per mole of iron and cold gas, 0 to 1.
    pub iron: f64,
    /// Number density of each species, in the order of [`Mixture::species`], 1/m3. Never negative; a species whose
    /// element is absent has 0, a rare one any value down to 0 by underflow.
    pub number: Vec<f64>,
}

/// Why a mixture cannot be formed.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MixtureError {
    /// A component that the library does not have.
    #[error("the cold gas names {0:?}, which is not in the library of species")]
    Unknown(String),
    /// A component that is charged.
    #[error("the cold gas names {name:?} of charge {charge}; only neutral species make a cold gas")]
    Charged {
        /// The component.
        name: String,
        /// Its charge.
        charge: i32,
    },
    /// A component that brings the iron that its own axis brings.
    #[error("the cold gas names {0:?}, which holds iron; iron is added by its own fraction")]
    Iron(String),
    /// A mole fraction that is no positive number.
    #[error("the mole fraction of {name:?} is {fraction}; it must be positive and finite")]
    Fraction {
        /// The component.
        name: String,
        /// Its fraction.
        fraction: f64,
    },
    /// No component at all.
    #[error("the cold gas has no component")]
    Empty,
    /// Fractions that do not add up to one.
    #[error("the mole fractions of the cold gas sum to {sum}, not to 1")]
    Sum {
        /// Their sum.
        sum: f64,
    },
}

/// Why no equilibrium was found.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum EquilibriumError {
    /// A temperature beyond the data.
    #[error("temperature {temperature} K is outside {} to {} K, where the data of the species hold", TEMPERATURE_RANGE[0], TEMPERATURE_RANGE[1])]
    Temperature {
        /// The temperature, K.
        temperature: f64,
    },
    /// A pressure that is no positive number.
    #[error("pressure {pressure:?} Pa must be positive and finite")]
    Pressure {
        /// The pressure, Pa.
        pressure: f64,
    },
    /// An iron fraction that the mixture cannot have.
    #[error(
        "iron mole fraction {iron} must lie in 0 to 1, and at 0 in a mixture made without iron"
    )]
    Iron {
        /// The fraction.
        iron: f64,
    },
    /// A composition whose equations do not determine how it answers.
    #[error(
        "the composition at {temperature} K, {pressure:?} Pa, iron mole fraction {iron} has no derivatives"
    )]
    Singular {
        /// Temperature, K.
        temperature: f64,
        /// Pressure, Pa.
        pressure: f64,
        /// Iron mole fraction.
        iron: f64,
    },
    /// Newton's iteration stood still above its tolerance.
    #[error(
        "no equilibrium at {temperature} K, {pressure:?} Pa, iron mole fraction {iron}: after {iterations} iterations \
         the relative residual of {residual} is {value:e}, above {tolerance:e}"
    )]
    NotConverged {
        /// Temperature, K.
        temperature: f64,
        /// Pressure, Pa.
        pressure: f64,
        /// Iron mole fraction.
        iron: f64,
        /// Iterations done.
        iterations: usize,
        /// Which balance is not met: `charge`, `pressure` or `element Fe`.
        residual: String,
        /// Its relative residual.
        value: f64,
        /// What it should be below.
        tolerance: f64,
    },
}

impl Mixture {
    /// The mixture of a cold gas, given as names of neutral species with their mole fractions (argon: `Ar` 1; carbon
    /// dioxide in argon: `Ar` 0.8, `CO2` 0.2), with iron to be added or without.
    ///
    /// # Errors
    /// Components that are unknown, charged or hold iron, fractions that are not positive or do not sum to 1.
    pub fn new(
        library: &Library,
        base: &[(String, f64)],
        with_iron: bool,
    ) -> Result<Self, MixtureError> {
        let cold = cold_components(library, base)?;
        let mut moles = [0.0; Element::ALL.len()];
        for (slot, element) in moles.iter_mut().zip(Element::ALL) {
            *slot = cold
                .iter()
                .map(|(species, x)| x * f64::from(species.count(element)))
                .sum();
        }
        let elements: Vec<Element> = Element::ALL
            .into_iter()
            .zip(moles)
            .filter(|(element, moles)| *moles > 0.0 || (with_iron && *element == Element::Fe))
            .map(|(element, _)| element)
            .collect();
        let base = Element::ALL
            .into_iter()
            .zip(moles)
            .filter(|(element, _)| elements.contains(element))
            .map(|(_, moles)| moles)
            .collect();
        let species = library
            .species()
            .iter()
            .filter(|species| {
                species
                    .elements
                    .iter()
                    .all(|(element, _)| elements.contains(element))
            })
            .cloned()
            .collect();
        Ok(Self {
            species,
            elements,
            base,
            cold,
            with_iron,
            lowering: Lowering::default(),
        })
    }

    /// The same mixture with charges that act on each other.
    #[must_use]
    pub fn with_lowering(mut self, lowering: Lowering) -> Self {
        self.lowering = lowering;
        self
    }

    /// Where the species of this name stands in [`Mixture::species`].
    #[must_use]
    pub fn index(&self, name: &str) -> Option<usize> {
        self.species.iter().position(|species| species.name == name)
    }
}

/// The components of a cold gas, checked.
fn cold_components(
    library: &Library,
    base: &[(String, f64)],
) -> Result<Vec<(Species, f64)>, MixtureError> {
    let mut cold = Vec::with_capacity(base.len());
    for (name, fraction) in base {
        let species = library
            .get(name)
            .ok_or_else(|| MixtureError::Unknown(name.clone()))?;
        if species.charge != 0 {
            return Err(MixtureError::Charged {
                name: name.clone(),
                charge: species.charge,
            });
        }
        if species.count(Element::Fe) > 0 {
            return Err(MixtureError::Iron(name.clone()));
        }
        if !(fraction.is_finite() && *fraction > 0.0) {
            return Err(MixtureError::Fraction {
                name: name.clone(),
                fraction: *fraction,
            });
        }
        cold.push((species.clone(), *fraction));
    }
    if cold.is_empty() {
        return Err(MixtureError::Empty);
    }
    let sum: f64 = cold.iter().map(|(_, fraction)| fraction).sum();
    if (sum - 1.0).abs() > 1e-9 {
        return Err(MixtureError::Sum { sum });
    }
    Ok(cold)
}
