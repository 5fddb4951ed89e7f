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
//! One last shell holds for a whole table: the one that the densest charges of the cold gas at its pressure leave. Sums over
//! levels then depend on the temperature alone, and density, enthalpy and specific heat stay consistent. Where charges are
//! fewer than that, hardly any atom is excited so far: argon at 9,500 K and 1 atm has 2e-5 in shells 7 to 9.

use super::levels::Levels;
use super::species::{Kind, Modes, Species};
use super::{EquilibriumError, Mixture};
use crate::constants::{ELECTRON_VOLT, RYDBERG};

/// Lists are taken to be whole below this shell.
const FIRST: u32 = 5;
/// Levels of a ground term lie within this energy \[J\]: 0.195 eV of doubly charged argon is the farthest.
const TERM: f64 = 0.2 * ELECTRON_VOLT;

/// Temperatures at which the densest charges are sought \[K\]: from, to, step. The last shell goes as the power -2/15 of
/// them, and they vary by 4 % between two of these.
const SOUGHT: [u32; 3] = [8_000, 30_000, 500];
/// A gas without charges keeps this many shells.
const MOST: u32 = 30;

/// Number of the last shell of neutral atoms that fields of ions leave among `electrons` \[1/m3\] (Inglis and Teller).
fn left_among(electrons: f64) -> u32 {
    let last = 10f64.powf((23.26 - (electrons * 1e-6).max(1.0).log10()) / 7.5);
    (1..MOST).take_while(|n| f64::from(n + 1) <= last).count() as u32 + 1
}

impl Mixture {
    /// The same mixture with the excited shells of neutral atoms filled up to number `last`, those of ions accordingly
    /// farther, and no level above; without this, with the levels that lists of spectra hold.
    #[must_use]
    pub fn with_shells(mut self, last: u32) -> Self {
        self.species = filled(&self.species, last);
        self
    }

    /// The same with the last shell that the densest charges of the cold gas leave at `pressure` \[Pa\].
    ///
    /// # Errors
    /// No equilibrium.
    pub fn with_shells_among_charges(self, pressure: f64) -> Result<Self, EquilibriumError> {
        let [from, to, step] = SOUGHT;
        let mut densest = 0.0_f64;
        for k in 0..=(to - from) / step {
            let state = self.equilibrium(f64::from(from + k * step), pressure, 0.0)?;
            densest = densest.max(state.number[0]);
        }
        Ok(self.with_shells(left_among(densest)))
    }
}

/// The species, with the shells of every atom filled up to number `last` of a neutral one; ions of charge z - 1 have
/// `z^(3/5)` times as many (Inglis and Teller). Levels listed above the last shell are left out, and ions of the
/// greatest charge stay as they are.
fn filled(species: &[Species], last: u32) -> Vec<Species> {
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
    fn fields_of_ions_leave_the_shells_that_inglis_and_teller_say() {
        // 1.7e17 /cm3 leave log10 n = (23.26 - 17.23)/7.5, n = 6.37; a hundred times fewer 11.8; none as many as are kept.
        for (electrons, last) in [(1.7e23, 6), (1.7e21, 11), (1.7e25, 3), (0.0, MOST)] {
            assert_eq!(left_among(electrons), last);
        }
        let argon = |pressure: f64| {
            let library = Library::embedded().unwrap();
            let argon = Mixture::new(&library, &[("Ar".to_owned(), 1.0)], false).unwrap();
            let given =
                [6, 8, 4].map(|last| sum(&argon.clone().with_shells(last).species, "Ar", 2e4));
            let found = argon.with_shells_among_charges(pressure).unwrap();
            given.map(|given| (sum(&found.species, "Ar", 2e4) / given - 1.0).abs() < 1e-12)
        };
        assert_eq!(argon(101_325.0), [true, false, false]);
        assert_eq!(argon(10_132.5), [false, true, false]);
        assert_eq!(argon(1_013_250.0), [false, false, true]);
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
