//! What a particle of the gas is: elements, charge, mass, and the energy that it can hold inside.

use super::internal::Internal;
use super::levels::Levels;
use super::nasa9::Nasa9;

/// A chemical element of the gas.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Element {
    /// Argon.
    Ar,
    /// Carbon.
    C,
    /// Oxygen.
    O,
    /// Iron.
    Fe,
}

impl Element {
    /// All elements, in their order.
    pub const ALL: [Self; 4] = [Self::Ar, Self::C, Self::O, Self::Fe];

    /// The chemical symbol.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Ar => "Ar",
            Self::C => "C",
            Self::O => "O",
            Self::Fe => "Fe",
        }
    }
}

impl std::str::FromStr for Element {
    type Err = UnknownElement;

    fn from_str(symbol: &str) -> Result<Self, UnknownElement> {
        Self::ALL
            .into_iter()
            .find(|element| element.as_str() == symbol)
            .ok_or_else(|| UnknownElement(symbol.to_owned()))
    }
}

/// A symbol that is no element of this library.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is none of the elements Ar, C, O, Fe")]
pub struct UnknownElement(pub String);

/// The sort of a particle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// The free electron.
    Electron,
    /// One nucleus, of any charge.
    Atom,
    /// Two nuclei or more, of any charge.
    Molecule,
}

/// Where the internal energy of a species comes from.
#[derive(Debug, Clone)]
pub(super) enum Modes {
    /// Energy levels.
    Levels(Levels),
    /// A fit of heat capacity, enthalpy and entropy.
    Nasa9(Nasa9),
}

/// A species of the gas.
#[derive(Debug, Clone)]
pub struct Species {
    /// Name, such as `Ar`, `Fe++`, `CO2+`, `e-`.
    pub name: String,
    /// Electron, atom or molecule.
    pub kind: Kind,
    /// Elements and how many nuclei of each; empty for the electron.
    pub elements: Vec<(Element, u32)>,
    /// Charge in units of the proton's.
    pub charge: i32,
    /// Mass m, kg.
    pub mass: f64,
    /// Energy of the ground state above separate neutral atoms in their ground states and electrons at rest, J.
    /// Positive for positive ions of atoms, negative for what binds.
    pub formation: f64,
    /// Static dipole polarisability, m3, where known.
    pub polarisability: Option<f64>,
    /// Effective number of electrons in the dispersion force, where known.
    pub effective_electrons: Option<f64>,
    /// Multiplicity 2S + 1 of the ground state's spin.
    pub ground_multiplicity: u32,
    pub(super) modes: Modes,
}

impl Species {
    /// Partition function, energy and heat capacity of the internal modes at `t` K.
    #[must_use]
    pub fn internal(&self, t: f64) -> Internal {
        match &self.modes {
            Modes::Levels(levels) => levels.internal(t),
            Modes::Nasa9(fit) => fit.internal(t),
        }
    }

    /// Nuclei of `element` in one particle.
    #[must_use]
    pub fn count(&self, element: Element) -> u32 {
        self.elements
            .iter()
            .find(|(e, _)| *e == element)
            .map_or(0, |(_, n)| *n)
    }
}
