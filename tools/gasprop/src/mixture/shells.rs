//! Levels that lists of spectra lack: shells of highly excited atoms, filled up to a chosen one.
//!
//! The lists hold what has been observed: of argon a third to three quarters of the states of shells 5 to 10, and hardly any
//! beyond. A shell of principal quantum number n has `2 n^2 g` states, g the weight of the ground term of the next
//! ion, and lies at `z^2 R/n^2` below the ionisation energy, z that ion's charge (Griem 1964, Plasma Spectroscopy; Drawin
//! and Felenbok 1965, Data for Plasmas in Local Thermodynamic Equilibrium). Where charges stand close, high shells are
//! no bound states: fields of ions merge them with the continuum from n on, with
//! `log10(n_e cm^3) = 23.26 - 7.5 log10 n + 4.5 log10 z` (Inglis and Teller 1939, Astrophys. J. 90, 439): argon at 1 atm
//! has 9 shells at 9,500 K and 6 at 14,500 to 25,000 K.
//!
//! The last shell is given, and does not follow from the charges: sums over levels then depend on the temperature
//! alone, and density, enthalpy and specific heat stay consistent.

use super::levels::Levels;
use super::species::{Kind, Modes, Species};
use crate::constants::{ELECTRON_VOLT, RYDBERG};

/// Lists are taken to be whole below this shell.
const FIRST: u32 = 5;
/// Levels of a ground term lie within this energy \[J\]: 0.195 eV of doubly charged argon is the farthest.
const TERM: f64 = 0.2 * ELECTRON_VOLT;

/// The species, with the shells of every atom filled up to number `last` of a neutral one; ions of charge z - 1 have
/// `z^(3/5)` times as many (Inglis and Teller). Levels listed above the last shell are left out, and ions of the
/// greatest charge stay as they are.
pub(super) fn filled(species: &[Species], last: u32) -> Vec<Species> {
    let next = |own: &Species| {
        species
            .iter()
            .find(|s| s.elements == own.elements && s.charge == own.charge + 1)
    };
    let filled = species.iter().map(|own| {
        let mut filled = own.clone();
        if let (Kind::Atom, Modes::Levels(levels), Some(ion)) = (own.kind, &own.modes, next(own))
            && let (true, Modes::Levels(core)) = (own.charge >= 0, &ion.modes)
        {
            let series = Series {
                limit: ion.formation - own.formation,
                charge: f64::from(ion.charge),
                core: core.weight_below(TERM),
            };
            filled.modes = Modes::Levels(series.filled(levels, last));
        }
        filled
    });
    filled.collect()
}

/// The shells that lead to one ionisation energy.
struct Series {
    /// Ionisation energy, J.
    limit: f64,
    /// Charge of what the electron leaves.
    charge: f64,
    /// Weight of its ground term.
    core: f64,
}

impl Series {
    /// Energy at a principal quantum number, which need not be whole, J.
    fn energy(&self, n: f64) -> f64 {
        self.limit - RYDBERG * (self.charge / n).powi(2)
    }

    fn filled(&self, listed: &Levels, last: u32) -> Levels {
        let last = (f64::from(last) * self.charge.powf(0.6)).floor();
        let top = self.energy(last + 0.5);
        let mut levels: Vec<(f64, f64)> =
            listed.iter().filter(|(energy, _)| *energy < top).collect();
        let mut n = f64::from(FIRST);
        while n <= last {
            let [from, to] = [n - 0.5, n + 0.5].map(|edge| self.energy(edge));
            let there: f64 = listed
                .iter()
                .filter(|(energy, _)| (from..to).contains(energy))
                .map(|(_, weight)| weight)
                .sum();
            let lacking = 2.0 * n * n * self.core - there;
            if lacking > 0.0 {
                levels.push((self.energy(n), lacking));
            }
            n += 1.0;
        }
        Levels::new(levels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constants::BOLTZMANN;
    use crate::mixture::Library;

    fn sum(species: &[Species], name: &str, t: f64) -> f64 {
        let own = species.iter().find(|s| s.name == name).unwrap();
        own.internal(t).ln_partition.exp()
    }

    /// Shells 5 to 7 of argon have 300, 432 and 588 states, of which 232, 267 and 184 are listed, and lie 0.5442, 0.3779
    /// and 0.2777 eV below 15.7596 eV; what lies above 0.2419 eV below (shell 7.5) is left out.
    #[test]
    fn argon_gains_what_its_list_lacks() {
        let library = Library::embedded().unwrap();
        let thermal = BOLTZMANN * 20_000.0 / ELECTRON_VOLT;
        let at = |energy: f64, weight: f64| weight * (-energy / thermal).exp();
        let listed: f64 = library.data()["species"]["Ar"]["levels_eV_g"]
            .as_array()
            .unwrap()
            .iter()
            .map(|level| (level[0].as_f64().unwrap(), level[1].as_f64().unwrap()))
            .filter(|(energy, _)| *energy < 15.7596 - 0.2419)
            .map(|(energy, weight)| at(energy, weight))
            .sum();
        let expected = listed
            + at(15.7596 - 0.5442, 68.0)
            + at(15.7596 - 0.3779, 165.0)
            + at(15.7596 - 0.2777, 404.0);
        let found = sum(&filled(library.species(), 7), "Ar", 20_000.0);
        assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
    }

    #[test]
    fn cold_atoms_molecules_and_the_last_ions_stay_as_they_are() {
        let library = Library::embedded().unwrap();
        let filled = filled(library.species(), 10);
        for (name, t) in [
            ("Ar", 3000.0),
            ("Fe", 1000.0),
            ("CO", 8000.0),
            ("Ar+++", 3e4),
            ("O-", 8000.0),
        ] {
            let (own, plain) = (sum(&filled, name, t), sum(library.species(), name, t));
            assert!((own / plain - 1.0).abs() < 1e-12, "{name} {own} {plain}");
        }
        let charge = 20_000.0;
        assert!(sum(&filled, "Ar+", charge) > sum(library.species(), "Ar+", charge));
    }
}
