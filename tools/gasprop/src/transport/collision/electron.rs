//! Electrons and neutral particles.
//!
//! Where the momentum transfer cross-section `Q_m(E)` is known, its Maxwellian moments are taken directly (`moments.rs`).

use serde_json::Value;

use super::Integrals;
use super::moments::moments;
use crate::constants::{BOLTZMANN, ELECTRON_VOLT};

/// A momentum transfer cross-section over energy.
#[derive(Debug, Clone)]
pub(super) struct CrossSection {
    /// Energy, J.
    energy: Vec<f64>,
    /// Cross-section, m2.
    area: Vec<f64>,
}

impl CrossSection {
    /// Reads pairs of energy [eV] and cross-section [A2]; None where they are not as expected.
    pub(super) fn read(block: &Value) -> Option<Self> {
        let rows: Vec<[f64; 2]> = serde_json::from_value(block["data"].clone()).ok()?;
        let rising = rows.windows(2).all(|w| w[1][0] > w[0][0]);
        (rows.len() > 2 && rising && rows[0][0] > 0.0).then(|| Self {
            energy: rows.iter().map(|row| row[0] * ELECTRON_VOLT).collect(),
            area: rows.iter().map(|row| row[1] * 1e-20).collect(),
        })
    }

    /// Cross-section [m2] at `energy` [J]: linear between the points. Below the first, linear in the square root of
    /// energy, as the theory of effective range says of slow electrons (O'Malley 1963, Phys. Rev. 130, 1020: linear in
    /// wave number); above the last, falling as 1/E.
    fn at(&self, energy: f64) -> f64 {
        let last = self.energy.len() - 1;
        let (x0, x1) = (self.energy[0], self.energy[1]);
        if energy < x0 {
            let slope = (self.area[1] - self.area[0]) / (x1.sqrt() - x0.sqrt());
            return (self.area[0] + slope * (energy.sqrt() - x0.sqrt())).max(0.0);
        }
        if energy > self.energy[last] {
            return self.area[last] * self.energy[last] / energy;
        }
        let i = self.energy.partition_point(|&e| e <= energy).clamp(1, last) - 1;
        let share = (energy - self.energy[i]) / (self.energy[i + 1] - self.energy[i]);
        self.area[i] + share * (self.area[i + 1] - self.area[i])
    }

    /// Integrals [m2] at `temperature` [K]. Electrons do not need the second kind, which is set to the first.
    pub(super) fn moments(&self, temperature: f64) -> Integrals {
        let thermal = BOLTZMANN * temperature;
        let kinks = self.energy.iter().map(|e| e / thermal);
        let first = moments(kinks, |x| self.at(x * thermal));
        Integrals {
            first,
            second: [first[0]; 3],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::testing;

    #[test]
    fn simple_laws_have_their_exact_moments() {
        let energy: Vec<f64> = (1..2000)
            .map(|i| f64::from(i) * 0.05 * ELECTRON_VOLT)
            .collect();
        let flat = CrossSection {
            area: vec![3e-20; energy.len()],
            energy: energy.clone(),
        };
        for q in flat.moments(10_000.0).first {
            assert!((q / 3e-20 - 1.0).abs() < 1e-9);
        }
        // Q = c E: Q^(1,s) = c kT (s + 2).
        let rising = CrossSection {
            area: energy.iter().map(|e| e * 1e-1).collect(),
            energy,
        };
        let t = 10_000.0;
        for (s, q) in (1..).zip(rising.moments(t).first) {
            let exact = 1e-1 * BOLTZMANN * t * (f64::from(s) + 2.0);
            // The square root below the first point takes part of the difference.
            assert!((q / exact - 1.0).abs() < 1e-4, "{s} {q} {exact}");
        }
    }

    #[test]
    fn argon_is_near_its_table_of_another_source() {
        // Wright et al. (2005), +- 15 %, from other cross-sections.
        let argon = CrossSection::read(&testing::data()["e_Ar_momentum_transfer"]).unwrap();
        for (t, q11) in [(5000.0, 0.55), (10_000.0, 1.12), (20_000.0, 2.23)] {
            let ratio = argon.moments(t).first[0] / (q11 * std::f64::consts::PI * 1e-20);
            assert!((ratio - 1.0).abs() < 0.2, "{t} {ratio}");
        }
    }

    #[test]
    fn moments_keep_the_recursion() {
        let argon = CrossSection::read(&testing::data()["e_Ar_momentum_transfer"]).unwrap();
        for t in [400.0, 2000.0, 12_000.0] {
            let step = 1e-3;
            let (low, high) = (
                argon.moments(t * (1.0 - step)).first,
                argon.moments(t * (1.0 + step)).first,
            );
            let q = argon.moments(t).first;
            for s in 1..5 {
                let slope = (high[s - 1] - low[s - 1]) / (2.0 * step);
                let expected = q[s - 1] + slope / (s as f64 + 2.0);
                assert!((expected / q[s] - 1.0).abs() < 1e-4, "{t} {s}");
            }
        }
    }
}
