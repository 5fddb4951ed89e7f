//! The species that are there at one temperature, with the logarithms of their partition functions per volume.
//!
//! In equilibrium ln n_s = ln q_s + sum over elements of a_se lambda_e + z_s lambda_q, with
//! ln q_s = 3/2 ln(2 pi m_s kT/h^2) + ln Q_s(T) - E_s/kT and E_s the energy of formation from neutral atoms.

use super::species::Species;
use super::{Element, Mixture};
use crate::constants::{BOLTZMANN, PLANCK};

/// The most constraints that there can be: four elements and the charge.
pub(super) const CONSTRAINTS: usize = 5;

/// Moles of cold gas and of iron in one mole of the mixture; both may be as small as 1e-250.
#[derive(Debug, Clone, Copy)]
pub(super) struct Recipe {
    /// Moles of the cold gas, 1 - x.
    pub(super) gas: f64,
    /// Moles of iron, x.
    pub(super) iron: f64,
}

/// One species at one temperature.
#[derive(Debug, Clone)]
pub(super) struct Member {
    /// Where it stands among the mixture's species.
    pub(super) index: usize,
    /// Nuclei of each constraint's element in one particle; the last is the charge.
    pub(super) content: [f64; CONSTRAINTS],
    /// ln q.
    pub(super) ln_partition: f64,
    /// d ln q/dT, 1/K.
    pub(super) ln_partition_by_temperature: f64,
    /// Energy above neutral atoms at rest without that of flight, J.
    pub(super) energy: f64,
    /// Heat capacity of the internal modes, J/K.
    pub(super) heat_capacity: f64,
    /// Mass, kg.
    pub(super) mass: f64,
}

/// The species with elements that are present, at one temperature.
#[derive(Debug, Clone)]
pub(super) struct System {
    /// Temperature, K.
    pub(super) temperature: f64,
    /// Elements that are present.
    pub(super) elements: Vec<Element>,
    /// Moles of each constraint's element in one mole of the mixture; 0 for the charge, which is the last.
    pub(super) moles: [f64; CONSTRAINTS],
    /// Moles of cold gas and of iron.
    pub(super) recipe: Recipe,
    /// What the cold gas is mixed of: content of one particle, and mole fraction.
    pub(super) cold: Vec<([f64; CONSTRAINTS], f64)>,
    /// The species.
    pub(super) members: Vec<Member>,
}

impl System {
    /// The species of `mixture` at `temperature` whose elements `recipe` brings.
    pub(super) fn new(mixture: &Mixture, temperature: f64, recipe: Recipe) -> Self {
        let mut moles = [0.0; CONSTRAINTS];
        let mut elements = Vec::with_capacity(CONSTRAINTS - 1);
        for (element, base) in mixture.elements.iter().zip(&mixture.base) {
            let added = f64::from(u8::from(*element == Element::Fe));
            let amount = base * recipe.gas + added * recipe.iron;
            if amount > 0.0 {
                moles[elements.len()] = amount;
                elements.push(*element);
            }
        }
        let members = mixture
            .species
            .iter()
            .enumerate()
            .filter(|(_, species)| {
                species
                    .elements
                    .iter()
                    .all(|(element, _)| elements.contains(element))
            })
            .map(|(index, species)| Member::new(index, species, &elements, temperature))
            .collect();
        let present = mixture.cold.iter().filter(|_| recipe.gas > 0.0);
        let cold = present
            .map(|(species, fraction)| (content(species, &elements), *fraction))
            .collect();
        Self {
            temperature,
            elements,
            moles,
            recipe,
            cold,
            members,
        }
    }

    /// How many constraints there are: elements and charge.
    pub(super) fn constraints(&self) -> usize {
        self.elements.len() + 1
    }
}

impl Member {
    fn new(index: usize, species: &Species, elements: &[Element], temperature: f64) -> Self {
        let thermal = BOLTZMANN * temperature;
        let internal = species.internal(temperature);
        let energy = species.formation + internal.energy;
        let flight = 2.0 * std::f64::consts::PI * species.mass * thermal / (PLANCK * PLANCK);
        Self {
            index,
            content: content(species, elements),
            ln_partition: 1.5 * flight.ln() + internal.ln_partition - species.formation / thermal,
            ln_partition_by_temperature: (1.5 + energy / thermal) / temperature,
            energy,
            heat_capacity: internal.heat_capacity,
            mass: species.mass,
        }
    }

    /// Square of the charge.
    pub(super) fn charge_squared(&self, system: &System) -> f64 {
        self.content[system.elements.len()].powi(2)
    }
}

/// Nuclei of each element in one particle, and its charge behind them.
fn content(species: &Species, elements: &[Element]) -> [f64; CONSTRAINTS] {
    let mut content = [0.0; CONSTRAINTS];
    for (slot, element) in content.iter_mut().zip(elements) {
        *slot = f64::from(species.count(*element));
    }
    content[elements.len()] = f64::from(species.charge);
    content
}
