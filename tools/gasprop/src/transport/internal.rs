//! Conduction of heat by what particles hold inside: excited electrons, vibration, rotation.
//!
//! Internal energy diffuses with its carriers (Hirschfelder 1957, J. Chem. Phys. 26, 282, after Eucken):
//!
//! ```text
//! kappa_int = sum over i of n_i c_i / (sum over j of x_j / D_ij)          [W/(m K)]
//! ```
//!
//! with the internal heat capacity c_i [J/K] of one particle, and the binary coefficients of first order
//! `D_ij = 3/16 sqrt(2 pi k T / mu_ij) / (n Q^(1,1)_ij)`, self-diffusion for j = i. It neglects that collisions change
//! internal energy into flight.

use super::diffusion::binary;
use super::heavy::Heavy;

/// Conduction by internal energy [W/(m K)]: a gas with `number` [1/m3] particles in all and the internal heat
/// capacities [J/K] of one particle of each species.
pub(crate) fn thermal_conductivity(gas: &Heavy<'_>, number: f64, capacity: &[f64]) -> f64 {
    let n = gas.mass.len();
    (0..n)
        .map(|i| {
            // n D_ij does not depend on n.
            let hindrance: f64 = (0..n)
                .map(|j| {
                    gas.fraction[j]
                        / binary(
                            gas.mass[i],
                            gas.mass[j],
                            gas.pairs.get(i, j).first[0],
                            number,
                            gas.temperature,
                        )
                })
                .sum();
            number * gas.fraction[i] * capacity[i] / hindrance
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constants::{ATOMIC_MASS, BOLTZMANN};
    use crate::transport::collision::{Integrals, Pairs};

    #[test]
    fn a_pure_gas_is_euckens() {
        // kappa_int = rho D c/m = (6/5) A* eta c/m for one species.
        let m = 28.0 * ATOMIC_MASS;
        let pairs = Pairs::from_fn(2, |_, _| Integrals::hard(3e-19));
        for fraction in [[1.0, 0.0], [0.4, 0.6]] {
            let masses = [m; 2];
            let gas = Heavy {
                mass: &masses,
                fraction: &fraction,
                pairs: &pairs,
                temperature: 500.0,
            };
            let kappa = thermal_conductivity(&gas, 1e25, &[BOLTZMANN; 2]);
            let exact = 1.2 * gas.viscosity().unwrap() * BOLTZMANN / m;
            assert!((kappa / exact - 1.0).abs() < 1e-12);
        }
    }
}
