//! Transport: viscosity, conduction of heat and of current, diffusion of iron, from collisions by the
//! Chapman-Enskog method.
//!
//! - `collision` holds how strongly each pair of species hinders each other's flight;
//! - `electron` conducts current and heat by electrons, to third order (Devoto 1967);
//! - `heavy` gives viscosity at first and conduction by flight at second order, the full systems of all heavy species;
//! - `internal` conducts what particles hold inside (Eucken, Hirschfelder);
//! - `diffusion` moves species through each other without current: with the enthalpies that they carry it is the
//!   reactive conduction, under a gradient of iron the combined diffusion of iron (`reactive`).
//!
//! All assume one temperature, no magnetic field, and a composition that follows temperature at once. Thermal diffusion
//! is left out of the fluxes of species.

mod collision;
mod diffusion;
mod electron;
mod heavy;
mod internal;
mod reactive;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;

use crate::mixture::{Library, Mixture, Species, State, Thermodynamics};
use collision::{Collisions, Pairs, Particle};
use diffusion::Gas;
use electron::Electrons;
use heavy::Heavy;
use reactive::Components;
use thiserror::Error;

/// What nobody has measured or published well; a study can vary it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uncertain {
    /// Momentum transfer cross-section of electrons with iron atoms (and iron oxide), the same at all energies, m2. No
    /// measured or calculated set is public; 40 A2 is an estimate, good to a factor of two.
    pub electron_iron_m2: f64,
    /// The same for the rare neutral species without data of their own (ozone), m2.
    pub electron_other_m2: f64,
    /// Multiplies the cross-section for the exchange of an electron between an iron atom and its ion, 1. The empirical
    /// fit that it multiplies gives 1.3 times the tabulated value for argon and 2.1 times that for carbon at 10,000 K, so
    /// that iron's may well be below 1.
    pub iron_exchange_factor: f64,
    /// Effective electrons of the iron atom in the force of dispersion: 3.2 by the rule of Cambi et al. (1991)
    /// stretched to an open d shell, 8 by counting all outer electrons.
    pub iron_effective_electrons: f64,
}

impl Default for Uncertain {
    fn default() -> Self {
        Self {
            electron_iron_m2: 40e-20,
            electron_other_m2: 10e-20,
            iron_exchange_factor: 1.0,
            iron_effective_electrons: 3.207,
        }
    }
}

/// Whether the elements separate while heat is conducted by diffusing species.
///
/// A gradient of temperature drives the elements of a mixture apart even where their shares are uniform. A pure gas
/// knows no difference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Separation {
    /// No element flows: gradients of the elements stand against the gradient of temperature, as Butler and Brokaw
    /// (1957) have it. The conduction is then positive and independent of where enthalpies are counted from.
    #[default]
    Held,
    /// The shares of the elements are uniform and their flows are what they are; enthalpies count from separate neutral
    /// atoms at rest. With this, a model must carry the flows of the elements as well.
    Free,
}

/// Why the transport of a mixture cannot be computed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum TransportError {
    /// A block of the data file has another form.
    #[error("collision data: the block {0} is missing or has another form")]
    Block(&'static str),
    /// A table of one pair has another form.
    #[error("collision data: the table of the pair {0}, {1} has another form")]
    Pair(String, String),
    /// An uncertain quantity that is no positive number.
    #[error("uncertain input {name} is {value}; it must be positive and finite")]
    Uncertain {
        /// Its name.
        name: &'static str,
        /// What was given.
        value: String,
    },
}

/// Conduction of heat, by what carries it, W/(m K).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Conduction {
    /// Flight of electrons.
    pub electron: f64,
    /// Flight of heavy particles.
    pub heavy: f64,
    /// Internal energy of particles.
    pub internal: f64,
    /// Enthalpy of species that diffuse and react.
    pub reactive: f64,
}

impl Conduction {
    /// The thermal conductivity kappa, W/(m K).
    #[must_use]
    pub fn total(&self) -> f64 {
        self.electron + self.heavy + self.internal + self.reactive
    }
}

/// Transport coefficients at one state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficients {
    /// Viscosity eta, Pa s.
    pub viscosity: f64,
    /// Thermal conductivity by its parts, W/(m K).
    pub thermal: Conduction,
    /// Electrical conductivity sigma, S/m.
    pub electric_conductivity: f64,
    /// Combined ordinary diffusion coefficient D of iron, m2/s, by `J_Fe = -rho D grad Y_Fe` with the flux of all iron
    /// nuclei, free or bound, and their mass fraction Y; none in a mixture without iron.
    pub iron_diffusion: Option<f64>,
}

/// The transport of one mixture.
#[derive(Debug, Clone)]
pub struct Transport {
    species: Vec<Species>,
    mass: Vec<f64>,
    charge: Vec<i32>,
    collisions: Collisions,
    components: Components,
    separation: Separation,
}

impl Transport {
    /// The transport of `mixture` from the collision data of `library`.
    ///
    /// # Errors
    /// Data that are missing, or uncertain inputs that are not positive.
    pub fn new(
        mixture: &Mixture,
        library: &Library,
        uncertain: Uncertain,
    ) -> Result<Self, TransportError> {
        uncertain.check()?;
        let particles: Vec<Particle> = mixture
            .species
            .iter()
            .map(|s| Particle::new(s, &uncertain))
            .collect();
        Ok(Self {
            collisions: Collisions::new(library.data(), &particles, &uncertain)?,
            mass: particles.iter().map(|p| p.mass).collect(),
            charge: particles.iter().map(|p| p.charge).collect(),
            species: mixture.species.clone(),
            components: Components::new(mixture, library),
            separation: Separation::default(),
        })
    }

    /// The same with another answer to the separation of elements.
    #[must_use]
    pub fn with_separation(mut self, separation: Separation) -> Self {
        self.separation = separation;
        self
    }

    /// All coefficients at `state`, whose composition answers to temperature and iron as `thermodynamics` says.
    #[must_use]
    pub fn at(&self, state: &State, thermodynamics: &Thermodynamics) -> Coefficients {
        let electrons = state.number[0];
        let pairs = self.collisions.at(state.temperature, electrons);
        let swarm = self.electrons(state, &pairs);
        let heavy_pairs = Pairs::from_fn(self.mass.len() - 1, |i, j| *pairs.get(i + 1, j + 1));
        let total: f64 = state.number.iter().sum();
        let fraction: Vec<f64> = state.number.iter().map(|n| n / total).collect();
        let gas = Heavy {
            mass: &self.mass[1..],
            fraction: &fraction[1..],
            pairs: &heavy_pairs,
            temperature: state.temperature,
        };
        let capacity: Vec<f64> = self.species[1..]
            .iter()
            .map(|species| species.internal(state.temperature).heat_capacity)
            .collect();
        let all = Gas {
            mass: &self.mass,
            charge: &self.charge,
            fraction: &fraction,
            pairs: &pairs,
            temperature: state.temperature,
            number: total,
        };
        Coefficients {
            viscosity: gas.viscosity().unwrap_or(f64::NAN),
            thermal: Conduction {
                electron: swarm.thermal_conductivity(state.temperature, electrons),
                heavy: gas.thermal_conductivity().unwrap_or(f64::NAN),
                internal: internal::thermal_conductivity(&gas, total, &capacity),
                reactive: self
                    .components
                    .conduction(&self.species, &all, state, thermodynamics, self.separation)
                    .unwrap_or(f64::NAN),
            },
            electric_conductivity: swarm.electric_conductivity(state.temperature, electrons),
            iron_diffusion: self.components.iron_diffusion(&all, state, thermodynamics),
        }
    }

    fn electrons(&self, state: &State, pairs: &Pairs) -> Electrons {
        let heavy = state
            .number
            .iter()
            .enumerate()
            .skip(1)
            .map(|(i, n)| (*n, pairs.get(i, 0)));
        Electrons::new(heavy, state.number[0], pairs.get(0, 0))
    }
}

impl Uncertain {
    fn check(&self) -> Result<(), TransportError> {
        let inputs = [
            ("electron_iron_m2", self.electron_iron_m2),
            ("electron_other_m2", self.electron_other_m2),
            ("iron_exchange_factor", self.iron_exchange_factor),
            ("iron_effective_electrons", self.iron_effective_electrons),
        ];
        match inputs
            .into_iter()
            .find(|(_, value)| !(value.is_finite() && *value > 0.0))
        {
            Some((name, value)) => Err(TransportError::Uncertain {
                name,
                value: value.to_string(),
            }),
            None => Ok(()),
        }
    }
}
