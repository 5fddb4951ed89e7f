//! The species that the crate knows, read from its data file.
//!
//! Atoms and their positive ions are made of energy levels; molecules and negative ions of nine-coefficient fits.
//! All energies meet at one zero: separate neutral atoms in their ground states and electrons at rest. A fit's
//! enthalpies count from the elements at 298.15 K; its ground state lies at
//! Hf(298.15) - [H(298.15) - H(0)] on that scale, and its energy above the atoms, from the same source's atoms, is
//! formation = ground(species) - sum of ground(atoms) + charge x ground(electron): the electron has enthalpy 0 at
//! 298.15 K, so its rest lies below that scale's zero.

use super::levels::Levels;
use super::nasa9::{Nasa9, Range};
use super::species::{Element, Kind, Modes, Species};
use crate::constants::{ATOMIC_MASS, AVOGADRO, ELECTRON_MASS, ELECTRON_VOLT};
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;
use thiserror::Error;

/// The data file, with the source of every block.
const EMBEDDED: &str = include_str!("../../data/species.json");

/// Why the data of the species cannot be used.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DataError {
    /// The file is not JSON, or a block has another form.
    #[error("species data: {0}")]
    Form(String),
    /// A species lacks something that it needs.
    #[error("species data: {species} has no {missing}")]
    Missing {
        /// The species.
        species: String,
        /// What it lacks.
        missing: String,
    },
}

/// All species that the crate knows.
#[derive(Debug, Clone)]
pub struct Library {
    species: Vec<Species>,
    data: Value,
}

/// A species as written in the file.
#[derive(Deserialize)]
struct Written {
    kind: String,
    elements: BTreeMap<String, u32>,
    charge: i32,
    mass_u: f64,
    #[serde(rename = "formation_eV_from_atoms")]
    formation: Option<f64>,
    #[serde(rename = "polarisability_A3")]
    polarisability: Option<f64>,
    effective_electrons: Option<f64>,
    ground_multiplicity: Option<u32>,
    #[serde(rename = "levels_eV_g")]
    levels: Option<Vec<(f64, f64)>>,
    #[serde(rename = "Q_T_K", default)]
    table_temperatures: Vec<f64>,
    #[serde(rename = "Q_BC2016", default)]
    table_partition: Vec<f64>,
}

/// A fit as written in the file.
#[derive(Deserialize)]
struct Fit {
    #[serde(rename = "Hf298_J_mol")]
    enthalpy: f64,
    #[serde(rename = "H298_minus_H0_J_mol")]
    thermal: Option<f64>,
    ranges: Vec<FitRange>,
}

/// One range of a fit as written in the file.
#[derive(Deserialize)]
struct FitRange {
    #[serde(rename = "T")]
    span: [f64; 2],
    a: [f64; 7],
    b: [f64; 2],
}

impl Library {
    /// The library of the crate's own data.
    ///
    /// # Errors
    /// A file that does not hold what a species needs; the tests show that the embedded one does.
    pub fn embedded() -> Result<Self, DataError> {
        let data: Value =
            serde_json::from_str(EMBEDDED).map_err(|error| DataError::Form(error.to_string()))?;
        let written: Vec<(String, Written)> = entries(&data["species"])?;
        let fits: BTreeMap<String, Fit> = entries::<Fit>(&data["thermo_nasa9"]["data"])?
            .into_iter()
            .collect();
        let mut species = written
            .into_iter()
            .map(|(name, written)| assembled(name, written, &fits))
            .collect::<Result<Vec<_>, _>>()?;
        species.sort_by_key(|species| species.kind != Kind::Electron);
        Ok(Self { species, data })
    }

    /// All species, the electron first.
    #[must_use]
    pub fn species(&self) -> &[Species] {
        &self.species
    }

    /// The species of this name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Species> {
        self.species.iter().find(|species| species.name == name)
    }

    /// The whole data file, for blocks of collisions and radiation.
    #[must_use]
    pub fn data(&self) -> &Value {
        &self.data
    }
}

/// The entries of a JSON object, in their order.
fn entries<T: serde::de::DeserializeOwned>(block: &Value) -> Result<Vec<(String, T)>, DataError> {
    let object = block
        .as_object()
        .ok_or_else(|| DataError::Form("a block of species is missing".to_owned()))?;
    object
        .iter()
        .map(|(name, value)| {
            T::deserialize(value)
                .map(|entry| (name.clone(), entry))
                .map_err(|error| DataError::Form(format!("{name}: {error}")))
        })
        .collect()
}

/// The species of the written entry, with its energy levels or its fit.
fn assembled(
    name: String,
    written: Written,
    fits: &BTreeMap<String, Fit>,
) -> Result<Species, DataError> {
    let lacks = |missing: &str| DataError::Missing {
        species: name.clone(),
        missing: missing.to_owned(),
    };
    let elements = written
        .elements
        .iter()
        .map(|(symbol, count)| {
            Ok((
                symbol
                    .parse::<Element>()
                    .map_err(|error| DataError::Form(error.to_string()))?,
                *count,
            ))
        })
        .collect::<Result<Vec<_>, DataError>>()?;
    let kind = kind_of(&written.kind)
        .ok_or_else(|| DataError::Form(format!("{name}: unknown kind {:?}", written.kind)))?;
    let mass = if kind == Kind::Electron {
        ELECTRON_MASS
    } else {
        written.mass_u * ATOMIC_MASS
    };
    let (modes, formation) = if let Some(levels) = &written.levels {
        let formation = match kind {
            Kind::Electron => 0.0,
            _ => {
                written
                    .formation
                    .ok_or_else(|| lacks("energy of formation"))?
                    * ELECTRON_VOLT
            }
        };
        (Modes::Levels(levels_in_joules(levels)), formation)
    } else {
        let fit = fits
            .get(&name)
            .ok_or_else(|| lacks("energy levels or fit"))?;
        let formation = fitted_formation(fit, &elements, written.charge, fits)
            .ok_or_else(|| lacks("enthalpy of its atoms"))?;
        (
            Modes::Nasa9(
                fitted(fit, mass, &written).ok_or_else(|| lacks("enthalpy at absolute zero"))?,
            ),
            formation,
        )
    };
    Ok(Species {
        kind,
        elements,
        charge: written.charge,
        mass,
        formation,
        polarisability: written.polarisability.map(|volume| volume * 1e-30),
        effective_electrons: written.effective_electrons,
        ground_multiplicity: written.ground_multiplicity.unwrap_or(1),
        modes,
        name,
    })
}

/// The kind of the word in the file.
fn kind_of(word: &str) -> Option<Kind> {
    match word {
        "electron" => Some(Kind::Electron),
        "atom" => Some(Kind::Atom),
        "molecule" => Some(Kind::Molecule),
        _ => None,
    }
}

/// Levels in J from levels in eV.
fn levels_in_joules(levels: &[(f64, f64)]) -> Levels {
    Levels::new(
        levels
            .iter()
            .map(|(energy, weight)| (energy * ELECTRON_VOLT, *weight))
            .collect(),
    )
}

/// Enthalpy of the ground state on the fits' scale, J/mol.
fn ground(fit: &Fit) -> Option<f64> {
    Some(fit.enthalpy - fit.thermal?)
}

/// Energy of the ground state above the atoms, J: see the head of this file.
fn fitted_formation(
    fit: &Fit,
    elements: &[(Element, u32)],
    charge: i32,
    fits: &BTreeMap<String, Fit>,
) -> Option<f64> {
    let mut molar = ground(fit)? + f64::from(charge) * ground(fits.get("e-")?)?;
    for (element, count) in elements {
        molar -= f64::from(*count) * ground(fits.get(element.as_str())?)?;
    }
    Some(molar / AVOGADRO)
}

/// The fit, continued above its last range by the partition functions of the second source where they reach farther.
fn fitted(fit: &Fit, mass: f64, written: &Written) -> Option<Nasa9> {
    let ranges = fit
        .ranges
        .iter()
        .map(|range| Range {
            span: range.span,
            a: range.a,
            b: range.b,
        })
        .collect();
    let table = written
        .table_temperatures
        .iter()
        .copied()
        .zip(written.table_partition.iter().copied());
    Some(Nasa9::new(
        ranges,
        ground(fit)?,
        mass,
        &table.collect::<Vec<_>>(),
    ))
}
