//! An atom and its own ion, where slow ions have been measured.
//!
//! Ions that drift or fly through their own gas lose momentum by the exchange of an electron and by scattering alike, so
//! that what is measured holds both, and no rule is needed that joins them. Argon (Phelps 1994, J. Appl. Phys. 76, 747),
//! over the energy of the ion in the laboratory, which is twice that of the motion of both relative to each other:
//!
//! ```text
//! Q_m(E) = a E^-b (1 + c/E)^d,   E = 2 x kT.
//! ```
//!
//! Its moments are those of `moments.rs`. The second kind, which the exchange does not enter, comes from the table of the
//! pair.

use serde_json::Value;

use super::moments::moments;
use super::tabulated::Tabulated;
use super::{FIRST_ORDERS, Integrals};
use crate::constants::{BOLTZMANN, ELECTRON_VOLT};

/// Momentum that an ion loses to its own atom.
#[derive(Debug, Clone)]
pub(super) struct Resonant {
    /// a [m2], b, c [eV], d.
    fit: [f64; 4],
    /// The second kind.
    table: Tabulated,
}

impl Resonant {
    /// Reads the fit of a block; None where it is not as expected.
    pub(super) fn read(block: &Value, table: Tabulated) -> Option<Self> {
        let fit: [f64; 4] = serde_json::from_value(block["fit"].clone()).ok()?;
        fit.iter()
            .all(|value| *value > 0.0)
            .then_some(Self { fit, table })
    }

    /// Integrals [m2] at `temperature` [K].
    pub(super) fn at(&self, temperature: f64) -> Integrals {
        Integrals {
            first: self.first(temperature),
            ..self.table.at(temperature)
        }
    }

    fn first(&self, temperature: f64) -> [f64; FIRST_ORDERS] {
        let [a, b, c, d] = self.fit;
        let laboratory = 2.0 * BOLTZMANN * temperature / ELECTRON_VOLT;
        moments(std::iter::empty(), |x| {
            let energy = x * laboratory;
            a * energy.powf(-b) * (1.0 + c / energy).powf(d)
        })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::transport::testing;

    fn argon() -> Resonant {
        let data = testing::data();
        let pairs = data["collision_integrals"]["pairs"].as_array().unwrap();
        let entry = pairs
            .iter()
            .find(|e| e["pair"] == serde_json::json!(["Ar", "Ar+"]))
            .unwrap();
        let table = Tabulated::read(entry, true).unwrap();
        Resonant::read(&data["Ar_Ar+_momentum_transfer"], table).unwrap()
    }

    /// Without the term of slow ions `Q^(1,s) = a (2kT)^-b Gamma(s+2-b)/(s+1)!`, here with b = 1/2: the ratio of neighbours
    /// is `(s+3/2)/(s+2)`, and `Q^(1,1) = a (2kT)^-1/2 3 sqrt(pi)/8`.
    #[test]
    fn a_power_of_energy_has_its_exact_moments() {
        let resonant = Resonant {
            fit: [1e-18, 0.5, 1e-300, 1.0],
            ..argon()
        };
        let t = 12_000.0;
        let q = resonant.at(t).first;
        let exact = 1e-18 / (2.0 * BOLTZMANN * t / ELECTRON_VOLT).sqrt() * 3.0 * PI.sqrt() / 8.0;
        assert!((q[0] / exact - 1.0).abs() < 1e-4, "{} {exact}", q[0]);
        for s in 1..FIRST_ORDERS {
            let ratio = (s as f64 + 1.5) / (s as f64 + 2.0);
            assert!((q[s] / q[s - 1] / ratio - 1.0).abs() < 1e-4);
        }
    }

    /// Ions in their own gas at 300 K drift at 1.53 cm2/(V s) in a weak field (Ellis et al. 1976, At. Data Nucl. Data Tables
    /// 17, 177, +- 2 %): `K = 3/16 e/N sqrt(2 pi/(mu k T)) / Q^(1,1)`, N = 2.6868e25 1/m3.
    #[test]
    fn slow_ions_drift_as_measured() {
        let (t, charge) = (300.0, 1.602_176_634e-19);
        let reduced = 0.5 * 39.948 * crate::constants::ATOMIC_MASS;
        let drift = 3.0 / 16.0 * charge / 2.6868e25 * (2.0 * PI / (reduced * BOLTZMANN * t)).sqrt();
        let mobility = drift / argon().at(t).first[0];
        assert!((mobility / 1.53e-4 - 1.0).abs() < 0.03, "{mobility}");
    }

    #[test]
    fn another_table_agrees_within_its_error() {
        // Wright et al. (2005), +- 25 %: 41.51, 32.20 and 30.89 pi A2.
        for (t, q11) in [(1000.0, 41.51), (10_000.0, 32.20), (15_000.0, 30.89)] {
            let ratio = argon().at(t).first[0] / (q11 * PI * 1e-20);
            assert!((ratio - 1.0).abs() < 0.02, "{t} {ratio}");
        }
    }
}
