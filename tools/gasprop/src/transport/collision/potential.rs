//! Neutral pairs and ion-neutral pairs without tables of their own: the phenomenological potential.
//!
//! Laricchiuta, Colonna, Bruno, Celiberto, Gorse, Pirani and Capitelli (2007), Chem. Phys. Lett. 445, 133. The
//! potential's depth and place of minimum follow from polarisabilities `a` [A3] and effective electrons `N`:
//!
//! ```text
//! neutral-neutral (m = 6): r_e = 1.767 (a1^1/3 + a2^1/3) / (a1 a2)^0.095,
//!     C6 = 15.7 a1 a2 / (sqrt(a1/N1) + sqrt(a2/N2)),  eps0 = 0.72 C6 / r_e^6
//! ion-neutral (m = 4): rho = a_i / (Z^2 (1 + (2 a_i/a_n)^2/3) sqrt(a_n)),
//!     r_e = 1.767 (a_i^1/3 + a_n^1/3) / (a_i a_n (1 + 1/rho))^0.095,  eps0 = 5.2 Z^2 a_n (1 + rho) / r_e^4
//! beta = 6 + 5/(s1 + s2),  s = a^1/3 x multiplicity of an open shell
//! ```
//!
//! (A, eV); the integrals are `Q = pi sigma^2 Omega*(beta, ln kT/eps0)`, `sigma = x0(beta) r_e`, with the fits of
//! Omega* of their tables 1 to 3.

use std::f64::consts::PI;

use serde_json::Value;

use super::Integrals;
use super::particle::Particle;
use crate::constants::{BOLTZMANN, ELECTRON_VOLT};

/// The integrals of a pair, in the order of [`Integrals`].
const ORDERS: [&str; 8] = ["1,1", "1,2", "1,3", "1,4", "1,5", "2,2", "2,3", "2,4"];

/// A pair under the phenomenological potential.
#[derive(Debug, Clone)]
pub(super) struct Potential {
    /// Depth, J.
    depth: f64,
    /// pi sigma^2, m2.
    area: f64,
    /// The seven numbers of each fit.
    fits: [[f64; 7]; 8],
}

/// The table of coefficients: for both forms, each order, seven quadratics in beta.
#[derive(Debug, Clone)]
pub(super) struct Fits {
    neutral: [[[f64; 3]; 7]; 8],
    ion: [[[f64; 3]; 7]; 8],
}

impl Fits {
    /// Reads the block `phenomenological_potential`; None where it is not as expected.
    pub(super) fn read(block: &Value) -> Option<Self> {
        let read = |form: &str| {
            let mut fits = [[[0.0; 3]; 7]; 8];
            for (fit, order) in fits.iter_mut().zip(ORDERS) {
                let rows = block["coeffs_c0_c1_c2"][form][order].clone();
                *fit = serde_json::from_value(rows).ok()?;
            }
            Some(fits)
        };
        Some(Self {
            neutral: read("m6_neutral_neutral")?,
            ion: read("m4_ion_neutral")?,
        })
    }
}

impl Potential {
    /// The potential of two particles of which at most one is charged.
    pub(super) fn new(fits: &Fits, one: &Particle, two: &Particle) -> Self {
        let softness = |p: &Particle| p.polarisability.cbrt() * p.multiplicity;
        let beta = 6.0 + 5.0 / (softness(one) + softness(two));
        let charged = one.charge != 0 || two.charge != 0;
        let (place, depth, reduced, table) = if charged {
            let (ion, neutral) = if one.charge != 0 {
                (one, two)
            } else {
                (two, one)
            };
            let (place, depth) = ion_neutral(ion, neutral);
            (place, depth, 0.7564 * beta.powf(0.064_605), &fits.ion)
        } else {
            let (place, depth) = neutral_neutral(one, two);
            (place, depth, 0.8002 * beta.powf(0.049_256), &fits.neutral)
        };
        let sigma = reduced * place * 1e-10;
        Self {
            depth: depth * ELECTRON_VOLT,
            area: PI * sigma * sigma,
            fits: table.map(|fit| fit.map(|[c0, c1, c2]| c0 + beta * (c1 + beta * c2))),
        }
    }

    /// Integrals [m2] at `temperature` [K].
    pub(super) fn at(&self, temperature: f64) -> Integrals {
        let x = (BOLTZMANN * temperature / self.depth).ln();
        let q = self.fits.map(|fit| self.area * reduced(&fit, x).exp());
        Integrals {
            first: [q[0], q[1], q[2], q[3], q[4]],
            second: [q[5], q[6], q[7]],
        }
    }
}

/// ln Omega* of one fit at x = ln(kT/eps0); `e^u / (e^u + e^-u) = 1 / (1 + e^-2u)`.
fn reduced(&[a1, a2, a3, a4, a5, a6, a7]: &[f64; 7], x: f64) -> f64 {
    let step = |centre: f64, width: f64| 1.0 / (1.0 + (-2.0 * (x - centre) / width).exp());
    (a1 + a2 * x) * step(a3, a4) + a5 * step(a6, a7)
}

/// Place [A] and depth [eV] of the minimum between neutral particles.
fn neutral_neutral(one: &Particle, two: &Particle) -> (f64, f64) {
    let (a1, a2) = (one.polarisability, two.polarisability);
    let place = 1.767 * (a1.cbrt() + a2.cbrt()) / (a1 * a2).powf(0.095);
    let c6 = 15.7 * a1 * a2
        / ((a1 / one.effective_electrons).sqrt() + (a2 / two.effective_electrons).sqrt());
    (place, 0.72 * c6 / place.powi(6))
}

/// Place [A] and depth [eV] of the minimum between an ion and a neutral particle.
fn ion_neutral(ion: &Particle, neutral: &Particle) -> (f64, f64) {
    let (ai, an) = (ion.polarisability, neutral.polarisability);
    let charge = f64::from(ion.charge).powi(2);
    let rho = ai / (charge * (1.0 + (2.0 * ai / an).powf(2.0 / 3.0)) * an.sqrt());
    let place = 1.767 * (ai.cbrt() + an.cbrt()) / (ai * an * (1.0 + 1.0 / rho)).powf(0.095);
    (place, 5.2 * charge * an * (1.0 + rho) / place.powi(4))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::testing;

    #[test]
    fn argon_is_near_its_own_table() {
        let data = testing::data();
        let fits = Fits::read(&data["phenomenological_potential"]).unwrap();
        let argon = testing::particle("Ar");
        let potential = Potential::new(&fits, &argon, &argon);
        // Known minimum of Ar2: 3.76 A, 12.3 meV (Aziz 1993).
        let (place, depth) = neutral_neutral(&argon, &argon);
        assert!((place - 3.76).abs() < 0.1 && (depth - 12.3e-3).abs() < 1.5e-3);
        // Wright et al. (2005), +- 5 %; the potential claims 10 %.
        for (t, q11, q22) in [
            (1000.0, 8.61, 9.66),
            (5000.0, 6.16, 7.23),
            (10_000.0, 5.22, 6.20),
        ] {
            let q = potential.at(t);
            assert!((q.first[0] / (q11 * PI * 1e-20) - 1.0).abs() < 0.12);
            assert!((q.second[0] / (q22 * PI * 1e-20) - 1.0).abs() < 0.12);
        }
    }

    #[test]
    fn ions_polarise_as_langevin_says() {
        // Cold: Q11 = pi 1.1046 Gamma(5/2)/2 sqrt(2 a e^2/(4 pi eps0 kT)) for momentum transfer in the r^-4 field.
        let fits = Fits::read(&testing::data()["phenomenological_potential"]).unwrap();
        let (ion, neutral) = (testing::particle("Fe+"), testing::particle("Ar"));
        let potential = Potential::new(&fits, &ion, &neutral);
        let t = 300.0;
        let langevin =
            PI * 0.7343 * (2.0 * 1.642 * 14.3996 / (BOLTZMANN * t / ELECTRON_VOLT)).sqrt() * 1e-20;
        let ratio = potential.at(t).first[0] / langevin;
        assert!((ratio - 1.0).abs() < 0.15, "{ratio}");
    }

    #[test]
    fn orders_keep_the_recursion() {
        // Q(l,s+1) = Q(l,s) (1 + dlnQ/dlnT / (s+2)), to the accuracy of the separate fits.
        let fits = Fits::read(&testing::data()["phenomenological_potential"]).unwrap();
        let iron = testing::particle("Fe");
        let potential = Potential::new(&fits, &iron, &testing::particle("Ar"));
        for t in [1000.0, 3000.0, 10_000.0] {
            let (low, q, high) = (
                potential.at(t * 0.99),
                potential.at(t),
                potential.at(t * 1.01),
            );
            for s in 1..4 {
                let slope = (high.first[s - 1] / low.first[s - 1]).ln() / (1.01f64 / 0.99).ln();
                let expected = q.first[s - 1] * (1.0 + slope / (s as f64 + 2.0));
                assert!((expected / q.first[s] - 1.0).abs() < 0.02);
            }
        }
    }
}
