//! Exchange of an electron between an atom and its own ion: resonant, so it transfers the whole momentum.
//!
//! With the exchange cross-section `Q_ex(g) = (A - B ln g)^2 / 2` at relative speed g, the momentum transfer
//! cross-section is `Q^(1) = 2 Q_ex = (A - B ln g)^2` (Devoto 1967, Phys. Fluids 10, 354). Its Maxwellian moments are
//! closed: with `x = mu g^2 / 2kT` weighted by `x^(s+1) e^-x / (s+1)!`, the mean of ln x is the digamma function
//! `psi(s+2)` and its variance `psi'(s+2)`, so
//!
//! ```text
//! Q^(1,s) = (A - B L)^2 + B^2 psi'(s+2) / 4,    L = ln sqrt(2kT/mu) + psi(s+2)/2.
//! ```
//!
//! Momentum lost by scattering in the potential and by exchange combine as `sqrt(Q_el^2 + Q_ex^2)` (Murphy 1995, Plasma
//! Chem. Plasma Process. 15, 279).

use std::f64::consts::PI;

use crate::constants::BOLTZMANN;

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

/// Resonant exchange of one pair.
#[derive(Debug, Clone)]
pub(super) struct Exchange {
    /// A [m].
    a: f64,
    /// B [m].
    b: f64,
    /// Reduced mass [kg].
    reduced_mass: f64,
    /// Multiplies the cross-section.
    factor: f64,
}

impl Exchange {
    /// Exchange between an atom of `ionisation` energy [eV] and its ion: an empirical fit over many atoms,
    /// `A = sqrt(pi) 9.8187e-9 / I^0.72922`, `B = sqrt(pi) 4.7826e-10 / I^0.65701` (m, with g in m/s), whose authors
    /// mark it as to be checked; `factor` multiplies the cross-section.
    pub(super) fn empirical(ionisation: f64, reduced_mass: f64, factor: f64) -> Self {
        Self {
            a: PI.sqrt() * 9.8187e-9 / ionisation.powf(0.729_22),
            b: PI.sqrt() * 4.7826e-10 / ionisation.powf(0.657_01),
            reduced_mass,
            factor,
        }
    }

    /// `Q^(1,1)` to `Q^(1,5)` [m2] at `temperature` [K].
    pub(super) fn at(&self, temperature: f64) -> [f64; 5] {
        let speed = 0.5 * (2.0 * BOLTZMANN * temperature / self.reduced_mass).ln();
        [1, 2, 3, 4, 5].map(|s| {
            let (digamma, trigamma) = polygamma(s + 2);
            let mean = self.a - self.b * (speed + 0.5 * digamma);
            self.factor * (mean * mean + 0.25 * self.b * self.b * trigamma)
        })
    }
}

/// `psi(n)` and `psi'(n)` of a positive whole number.
fn polygamma(n: u32) -> (f64, f64) {
    let steps = (1..n).map(f64::from);
    (
        steps.clone().map(|k| 1.0 / k).sum::<f64>() - EULER,
        PI * PI / 6.0 - steps.map(|k| 1.0 / (k * k)).sum::<f64>(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_those_of_quadrature() {
        let exchange = Exchange::empirical(7.9, 4.64e-26, 1.0);
        let t = 8000.0;
        let closed = exchange.at(t);
        let thermal = (2.0 * BOLTZMANN * t / exchange.reduced_mass).sqrt();
        for s in 1..=5 {
            let (mut sum, mut weights) = (0.0, 0.0);
            for i in 0..60_000 {
                let x = (f64::from(i) + 0.5) * 1e-3;
                let weight = x.powi(s + 1) * (-x).exp();
                sum += weight * (exchange.a - exchange.b * (thermal * x.sqrt()).ln()).powi(2);
                weights += weight;
            }
            let q = closed[usize::try_from(s).unwrap() - 1];
            assert!((sum / weights / q - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn the_fit_is_of_the_size_of_known_tables() {
        // Ar 32.20 pi, C 29.99 pi A2 at 10,000 K (Wright et al. 2005, 2007).
        let unit = crate::constants::ATOMIC_MASS;
        for (ionisation, mass, table, expected) in
            [(15.76, 39.948, 32.20, 1.33), (11.26, 12.011, 29.99, 2.13)]
        {
            let exchange = Exchange::empirical(ionisation, 0.5 * mass * unit, 1.0);
            let ratio = exchange.at(10_000.0)[0] / (table * PI * 1e-20);
            assert!((ratio - expected).abs() < 0.03, "{ratio}");
        }
    }
}
