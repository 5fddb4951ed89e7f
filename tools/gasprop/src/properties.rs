//! A gas, and what it is at a temperature and iron fraction.

use thiserror::Error;

use crate::columns::{Column, Part};
use crate::mixture::{
    DataError, Element, EquilibriumError, Library, Mixture, MixtureError, State, Thermodynamics,
};
use crate::radiation::{Radiation, RadiationError};
use crate::transport::{Coefficients, Transport, TransportError};

/// Temperature at which the enthalpy of the cold gas, and that of iron atoms, counts as zero, K.
pub const ZERO: f64 = 300.0;

/// Why a gas cannot be made or evaluated.
#[derive(Debug, Error)]
pub enum GasError {
    /// The data of the species.
    #[error(transparent)]
    Data(#[from] DataError),
    /// The cold gas.
    #[error(transparent)]
    Mixture(#[from] MixtureError),
    /// The data of radiation.
    #[error(transparent)]
    Radiation(#[from] RadiationError),
    /// The data of collisions, or a system of equations that has no solution.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// The composition.
    #[error(transparent)]
    Equilibrium(#[from] EquilibriumError),
    /// A column that no gas can have.
    #[error("{column} is {value} {unit} at {temperature} K, iron mole fraction {iron}")]
    Value {
        /// The column.
        column: &'static str,
        /// Its value.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// Temperature, K.
        temperature: f64,
        /// Iron mole fraction.
        iron: f64,
    },
}

/// Zero of enthalpy of each group of elements that the gas keeps, J/kg above separate neutral atoms.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Zero {
    /// The cold gas as its components are named, at [`ZERO`].
    pub(crate) base: f64,
    /// Iron as a gas of atoms, at [`ZERO`].
    pub(crate) iron: f64,
}

/// A gas as a scene asks for it.
#[derive(Debug, Clone)]
pub struct Gas {
    pub(crate) library: Library,
    pub(crate) mixture: Mixture,
    pub(crate) transport: Transport,
    pub(crate) radiation: Option<Radiation>,
    pub(crate) absorption_length: Option<f64>,
    pub(crate) pressure: f64,
    pub(crate) molar_mass: f64,
    pub(crate) iron: Option<f64>,
    pub(crate) zero: Zero,
}

/// What the gas is at a temperature and iron fraction.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Values of [`Gas::columns`].
    pub values: Vec<f64>,
    /// Parts of thermal conductivity, as [`PARTS`] names them, W/(m K).
    pub parts: Vec<f64>,
    /// Mole fraction of each species.
    pub fractions: Vec<f64>,
    /// How well elements and charge are kept.
    pub kept: Kept,
}

/// How well a composition keeps what no reaction changes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Kept {
    /// Greatest deviation of an element's part of all nuclei from what was put in, relative to that.
    pub element: f64,
    /// Net charge over the sum of positive and negative charge.
    pub charge: f64,
}

impl Kept {
    /// The worse of both.
    #[must_use]
    pub fn worse(self, other: Self) -> Self {
        Self {
            element: self.element.max(other.element),
            charge: self.charge.max(other.charge),
        }
    }
}

impl Gas {
    /// The species and elements.
    #[must_use]
    pub fn mixture(&self) -> &Mixture {
        &self.mixture
    }

    /// The data of the species.
    #[must_use]
    pub fn library(&self) -> &Library {
        &self.library
    }

    /// The lines, where the scene asks for net emission.
    #[must_use]
    pub fn radiation(&self) -> Option<&Radiation> {
        self.radiation.as_ref()
    }

    /// Pressure, Pa.
    #[must_use]
    pub fn pressure(&self) -> f64 {
        self.pressure
    }

    /// Molar mass of the cold gas without iron, kg/mol.
    #[must_use]
    pub fn molar_mass(&self) -> f64 {
        self.molar_mass
    }

    /// Molar mass of iron, kg/mol, where there is some.
    #[must_use]
    pub fn iron_molar_mass(&self) -> Option<f64> {
        self.iron
    }

    /// The columns of the table.
    #[must_use]
    pub fn columns(&self) -> Vec<Column> {
        Column::of(self.radiation.is_some(), self.iron.is_some())
    }

    /// Mass fraction of iron at `x` moles of iron per mole of iron and cold gas.
    #[must_use]
    pub fn iron_mass_fraction(&self, x: f64) -> f64 {
        let iron = x * self.iron.unwrap_or(0.0);
        iron / (iron + (1.0 - x) * self.molar_mass)
    }

    /// What the gas is at `t` K with `x` moles of iron per mole of iron and cold gas.
    ///
    /// # Errors
    /// No equilibrium, or a value that is no number.
    pub fn at(&self, t: f64, x: f64) -> Result<Point, GasError> {
        let state = self.mixture.equilibrium(t, self.pressure, x)?;
        let thermodynamics = self.mixture.thermodynamics(&state)?;
        let transport = self.transport.at(&state, &thermodynamics);
        let y = self.iron_mass_fraction(x);
        let thermodynamics = Thermodynamics {
            enthalpy: thermodynamics.enthalpy - (1.0 - y) * self.zero.base - y * self.zero.iron,
            ..thermodynamics
        };
        let emission = self.radiation.as_ref().map(|radiation| {
            let species = &self.mixture.species;
            radiation
                .net_emission(species, t, &state.number, self.absorption_length)
                .total()
        });
        let all: f64 = state.number.iter().sum();
        let columns = self.columns();
        let values = columns.iter().map(|column| match column.part {
            Part::Density => thermodynamics.density,
            Part::Enthalpy => thermodynamics.enthalpy,
            Part::SpecificHeat => thermodynamics.specific_heat,
            Part::Viscosity => transport.viscosity,
            Part::ThermalConductivity => transport.thermal.total(),
            Part::ElectricConductivity => transport.electric_conductivity,
            Part::NetEmission => emission.unwrap_or(0.0),
            Part::Electrons => state.number[0],
            Part::IronDiffusion => transport.iron_diffusion.unwrap_or(0.0),
        });
        let point = Point {
            values: values.collect(),
            parts: parts(&transport),
            fractions: state.number.iter().map(|n| n / all).collect(),
            kept: self.kept(&state),
        };
        self.checked(point, t, x)
    }

    /// Elements and charge of a composition, counted from the numbers themselves.
    fn kept(&self, state: &State) -> Kept {
        let species = &self.mixture.species;
        let pairs = || species.iter().zip(&state.number);
        let put: Vec<f64> = self
            .mixture
            .elements
            .iter()
            .zip(&self.mixture.base)
            .map(|(element, moles)| {
                let iron = if *element == Element::Fe {
                    state.iron
                } else {
                    0.0
                };
                (1.0 - state.iron) * moles + iron
            })
            .collect();
        let nuclei = |element: &Element| -> f64 {
            pairs().map(|(s, n)| f64::from(s.count(*element)) * n).sum()
        };
        let found: Vec<f64> = self.mixture.elements.iter().map(nuclei).collect();
        let (all_put, all_found): (f64, f64) = (put.iter().sum(), found.iter().sum());
        let element = put
            .iter()
            .zip(&found)
            .filter(|(put, _)| **put > 0.0)
            .map(|(put, found)| (found * all_put / (all_found * put) - 1.0).abs());
        let net: f64 = pairs().map(|(s, n)| f64::from(s.charge) * n).sum();
        let sum: f64 = pairs().map(|(s, n)| f64::from(s.charge.abs()) * n).sum();
        Kept {
            element: element.fold(0.0, f64::max),
            charge: if sum > 0.0 { (net / sum).abs() } else { 0.0 },
        }
    }

    fn checked(&self, point: Point, temperature: f64, iron: f64) -> Result<Point, GasError> {
        let columns = self.columns();
        match columns
            .iter()
            .zip(&point.values)
            .find(|(column, value)| !column.can_be(**value))
        {
            None => Ok(point),
            Some((column, value)) => Err(GasError::Value {
                column: column.name,
                value: *value,
                unit: column.unit,
                temperature,
                iron,
            }),
        }
    }
}

/// Names of the parts of thermal conductivity, as [`Point::parts`].
pub const PARTS: [&str; 4] = ["heavy", "electron", "internal", "reactive"];

fn parts(transport: &Coefficients) -> Vec<f64> {
    let parts = &transport.thermal;
    vec![parts.heavy, parts.electron, parts.internal, parts.reactive]
}
