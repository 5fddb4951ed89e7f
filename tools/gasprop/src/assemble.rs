//! From the scene to the gas: the only place that asks what the scene contains.

use crate::constants::{AVOGADRO, BOLTZMANN};
use crate::mixture::{Library, Mixture, Species};
use crate::properties::{Gas, GasError, ZERO, Zero};
use crate::radiation::Radiation;
use crate::scene::{Levels, Scene};
use crate::transport::{Transport, Uncertain};

impl Gas {
    /// The gas of a scene.
    ///
    /// # Errors
    /// A cold gas that cannot be, or data that cannot be read.
    pub fn new(scene: &Scene) -> Result<Self, GasError> {
        let library = Library::embedded()?;
        let base: Vec<(String, f64)> = scene
            .gas
            .iter()
            .map(|(name, x)| (name.clone(), *x))
            .collect();
        let with_iron = scene.iron_mole_fraction.is_some();
        let mixture = with_levels(Mixture::new(&library, &base, with_iron)?, scene)?;
        let radiation = match scene.radiation {
            Some(_) => Some(Radiation::new(library.data(), &mixture.species)?),
            None => None,
        };
        let mut mass = 0.0;
        let mut energy = 0.0;
        for (name, fraction) in &base {
            if let Some(species) = library.get(name) {
                mass += fraction * species.mass;
                energy += fraction * enthalpy(species);
            }
        }
        let iron = library.get("Fe").filter(|_| with_iron);
        Ok(Self {
            transport: Transport::new(&mixture, &library, uncertain(scene))?,
            radiation,
            absorption_length: scene
                .radiation
                .and_then(|radiation| radiation.absorption_length_m),
            pressure: scene.pressure_pa,
            molar_mass: mass * AVOGADRO,
            iron: iron.map(|species| species.mass * AVOGADRO),
            zero: Zero {
                base: energy / mass,
                iron: iron.map_or(0.0, |species| enthalpy(species) / species.mass),
            },
            mixture,
            library,
        })
    }
}

/// The mixture with the excited levels that the scene asks for.
fn with_levels(mixture: Mixture, scene: &Scene) -> Result<Mixture, GasError> {
    let given = scene.uncertain;
    if given.is_some_and(|given| given.levels == Some(Levels::Listed)) {
        return Ok(mixture);
    }
    Ok(match given.and_then(|given| given.filled_to_shell) {
        Some(last) => mixture.with_shells(last),
        None => mixture.with_shells_among_charges(scene.pressure_pa)?,
    })
}

/// Enthalpy of one particle of the cold gas at [`ZERO`], J above separate neutral atoms.
fn enthalpy(species: &Species) -> f64 {
    2.5 * BOLTZMANN * ZERO + species.internal(ZERO).energy + species.formation
}

/// Cross-sections that are known badly, as the scene has them.
fn uncertain(scene: &Scene) -> Uncertain {
    let usual = Uncertain::default();
    let Some(given) = scene.uncertain else {
        return usual;
    };
    Uncertain {
        electron_iron_m2: given
            .electron_iron_cross_section_m2
            .unwrap_or(usual.electron_iron_m2),
        electron_other_m2: given
            .electron_other_cross_section_m2
            .unwrap_or(usual.electron_other_m2),
        iron_exchange_factor: given
            .iron_charge_exchange_factor
            .unwrap_or(usual.iron_exchange_factor),
        iron_effective_electrons: given
            .iron_effective_electrons
            .unwrap_or(usual.iron_effective_electrons),
    }
}
