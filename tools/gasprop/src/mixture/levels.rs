//! Energy levels of atoms, ions and the electron: Q(T) = sum over levels of g exp(-E/kT).
//!
//! The sum runs over the levels that are stored, all below the ionisation energy of the free atom (the highest Rydberg
//! levels, which crowd below it without end, are not tabulated and would be cut by the plasma anyway; `shells.rs` fills
//! shells that are tabulated in part).
//! With means weighted by g exp(-E/kT), the energy is the mean of E and the heat capacity is its variance over kT^2: the
//! exact derivatives of the same sum.

use super::internal::Internal;
use crate::constants::BOLTZMANN;

/// Levels of a species: energy above the ground state in J, and statistical weight.
#[derive(Debug, Clone)]
pub(super) struct Levels {
    levels: Vec<(f64, f64)>,
}

impl Levels {
    /// Levels as (energy in J, weight); the lowest must lie at 0 and have a positive weight.
    pub(super) fn new(levels: Vec<(f64, f64)>) -> Self {
        Self { levels }
    }

    /// Energies in J with their weights.
    pub(super) fn iter(&self) -> impl Iterator<Item = (f64, f64)> {
        self.levels.iter().copied()
    }

    /// Weight of the levels below an energy in J.
    pub(super) fn weight_below(&self, energy: f64) -> f64 {
        let below = self.iter().filter(|(own, _)| *own < energy);
        below.map(|(_, weight)| weight).sum()
    }

    pub(super) fn internal(&self, t: f64) -> Internal {
        let thermal = BOLTZMANN * t;
        let (mut sum, mut first, mut second) = (0.0, 0.0, 0.0);
        for &(energy, weight) in &self.levels {
            let x = energy / thermal;
            let share = weight * (-x).exp();
            sum += share;
            first += share * x;
            second += share * x * x;
        }
        let mean = first / sum;
        Internal {
            ln_partition: sum.ln(),
            energy: thermal * mean,
            heat_capacity: BOLTZMANN * (second / sum - mean * mean),
        }
    }
}
