//! Electrons and neutral particles.
//!
//! Where the momentum transfer cross-section `Q_m(E)` is known, its Maxwellian moments are taken directly
//! (Hirschfelder, Curtiss and Bird 1954; Devoto 1967, Phys. Fluids 10, 2105):
//!
//! ```text
//! Q^(1,s) = 1/(s+1)! integral of Q_m(x kT) x^(s+1) e^-x dx from 0 to infinity,   s = 1 ... 5.
//! ```

use serde_json::Value;

use super::{FIRST_ORDERS, Integrals};
use crate::constants::{BOLTZMANN, ELECTRON_VOLT};

/// Nodes and weights of Gauss's quadrature over -1 to 1, six points: exact for polynomials of degree 11.
const GAUSS: [(f64, f64); 6] = [
    (-0.932_469_514_203_152, 0.171_324_492_379_170_35),
    (-0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (-0.238_619_186_083_196_9, 0.467_913_934_572_691),
    (0.238_619_186_083_196_9, 0.467_913_934_572_691),
    (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (0.932_469_514_203_152, 0.171_324_492_379_170_35),
];
/// Where the Maxwellian has died: `x^6 e^-x / 6!` is below 1e-12 of its peak.
const TAIL: f64 = 60.0;
/// No step of the quadrature is longer than this in x.
const STEP: f64 = 1.0;

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
        let mut sums = [0.0; FIRST_ORDERS];
        let mut from = 0.0;
        let ends = self
            .energy
            .iter()
            .map(|e| e / thermal)
            .filter(|&x| x < TAIL);
        for to in ends.chain([TAIL]) {
            let pieces = ((to - from) / STEP).ceil().max(1.0);
            let width = (to - from) / pieces;
            let mut start = from;
            // Counted in whole steps: at most 60 and one for each point of the table.
            while start < to - 0.5 * width {
                self.add(&mut sums, thermal, [start, start + width]);
                start += width;
            }
            from = to;
        }
        let mut factorial = 1.0;
        for (order, sum) in (2..).zip(&mut sums) {
            factorial *= f64::from(order);
            *sum /= factorial;
        }
        Integrals {
            first: sums,
            second: [sums[0]; 3],
        }
    }

    fn add(&self, sums: &mut [f64; FIRST_ORDERS], thermal: f64, [from, to]: [f64; 2]) {
        let half = 0.5 * (to - from);
        for (node, weight) in GAUSS {
            let x = from + half * (1.0 + node);
            let mut term = half * weight * self.at(x * thermal) * (-x).exp() * x;
            for sum in sums.iter_mut() {
                term *= x;
                *sum += term;
            }
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
