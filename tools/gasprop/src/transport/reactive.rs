//! What diffusing species carry: enthalpy (the reactive conduction of heat), and iron.
//!
//! Under a gradient of temperature the equilibrium composition at constant pressure and elements drives fluxes J_s of
//! particles (`diffusion.rs`), and
//!
//! ```text
//! kappa_r = - sum over s of h_s J_s / grad T                             [W/(m K)]
//! ```
//!
//! with h_s the enthalpy of a particle with its energy of formation. In a gas of one element, or of one reaction, this is
//! the expression of Butler and Brokaw (1957), J. Chem. Phys. 26, 1636. Where there are several elements, the same
//! gradient also drives them apart, and the sum then depends on where each element's enthalpy is counted from.
//! [`Separation`] says which of two answers is given.
//!
//! Under a gradient of the iron fraction x at constant temperature the same equations give the combined ordinary diffusion
//! coefficient of iron (Murphy 1993, Phys. Rev. E 48, 3594): `J_Fe = -rho D grad Y` with the mass flux of all iron nuclei,
//! free or bound, and their mass fraction `Y = x M_Fe / (x M_Fe + (1 - x) M_base)`.

use super::Separation;
use super::diffusion::{Diffusion, Gas};
use crate::constants::BOLTZMANN;
use crate::mixture::{Element, Library, Mixture, Species, State, Thermodynamics};

/// The two components of a mixture, base gas and iron, in its species.
#[derive(Debug, Clone)]
pub(crate) struct Components {
    /// Mass of one cold particle of the base gas, kg.
    base_mass: f64,
    /// Mass of an iron atom, kg.
    iron_mass: f64,
    /// Cold particles of the base gas, by one of its elements, in one particle of each species.
    base: Vec<f64>,
    /// Iron nuclei in one particle of each species, where there is iron.
    iron: Option<Vec<f64>>,
    /// Amounts in each species whose flow would separate the elements of the base gas.
    base_held: Vec<Vec<f64>>,
}

impl Components {
    /// The components of `mixture`.
    pub(crate) fn new(mixture: &Mixture, library: &Library) -> Self {
        let atom = |element: Element| {
            library
                .get(element.as_str())
                .map_or(0.0, |species| species.mass)
        };
        let nuclei = |element: Element| -> Vec<f64> {
            mixture
                .species
                .iter()
                .map(|species| f64::from(species.count(element)))
                .collect()
        };
        let gas: Vec<(Element, f64)> = mixture
            .elements
            .iter()
            .zip(&mixture.base)
            .map(|(element, moles)| (*element, *moles))
            .filter(|(_, moles)| *moles > 0.0)
            .collect();
        // Counted by the last element, oxygen if any: cold molecules then hold nothing that could separate.
        let (base, others) = match gas.split_last() {
            Some(((element, moles), others)) => {
                (nuclei(*element).iter().map(|n| n / moles).collect(), others)
            }
            None => (vec![0.0; mixture.species.len()], &gas[..]),
        };
        let held = others.iter().map(|(element, moles)| {
            nuclei(*element)
                .iter()
                .zip(&base)
                .map(|(count, base)| count - moles * base)
                .collect()
        });
        Self {
            base_mass: gas
                .iter()
                .map(|(element, moles)| atom(*element) * moles)
                .sum(),
            iron_mass: atom(Element::Fe),
            iron: mixture
                .elements
                .contains(&Element::Fe)
                .then(|| nuclei(Element::Fe)),
            base_held: held.collect(),
            base,
        }
    }

    /// Reactive conduction of heat [W/(m K)]; None where the equations are singular.
    pub(crate) fn conduction(
        &self,
        species: &[Species],
        gas: &Gas<'_>,
        state: &State,
        thermodynamics: &Thermodynamics,
        separation: Separation,
    ) -> Option<f64> {
        let held = match separation {
            Separation::Held => self.held(state.iron),
            Separation::Free => Vec::new(),
        };
        let fluxes = Diffusion::new(gas, &held).fluxes(&gradients(
            &state.number,
            &thermodynamics.number_by_temperature,
        ))?;
        let flight = 2.5 * BOLTZMANN * state.temperature;
        let enthalpy = |species: &Species| {
            flight + species.internal(state.temperature).energy + species.formation
        };
        let carried = species
            .iter()
            .zip(fluxes)
            .map(|(species, flux)| enthalpy(species) * flux);
        Some(-gas.number * carried.sum::<f64>())
    }

    /// Combined diffusion coefficient of iron [m2/s]; None in a mixture without iron.
    pub(crate) fn iron_diffusion(
        &self,
        gas: &Gas<'_>,
        state: &State,
        thermodynamics: &Thermodynamics,
    ) -> Option<f64> {
        let iron = self.iron.as_ref()?;
        let fluxes = Diffusion::new(gas, &[])
            .fluxes(&gradients(&state.number, &thermodynamics.number_by_iron))?;
        let nuclei: f64 = iron
            .iter()
            .zip(fluxes)
            .map(|(count, flux)| count * flux)
            .sum();
        let mean = state.iron * self.iron_mass + (1.0 - state.iron) * self.base_mass;
        let slope = self.iron_mass * self.base_mass / (mean * mean);
        Some(-self.iron_mass * gas.number * nuclei / (thermodynamics.density * slope))
    }

    /// Amounts of which none flows where the elements stay together, at the iron fraction `x`: in the whole gas there is
    /// none of them.
    fn held(&self, x: f64) -> Vec<Vec<f64>> {
        let iron = self.iron.iter().map(|iron| {
            iron.iter()
                .zip(&self.base)
                .map(|(iron, base)| (1.0 - x) * iron - x * base)
                .collect()
        });
        self.base_held.iter().cloned().chain(iron).collect()
    }
}

/// Derivatives of the mole fractions from those of the number densities; they sum to zero.
fn gradients(number: &[f64], slopes: &[f64]) -> Vec<f64> {
    let (total, slope) = (number.iter().sum::<f64>(), slopes.iter().sum::<f64>());
    number
        .iter()
        .zip(slopes)
        .map(|(n, s)| (s - n / total * slope) / total)
        .collect()
}
