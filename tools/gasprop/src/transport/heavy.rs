//! Heavy particles: viscosity at first order, conduction of heat by flight at second order.
//!
//! Viscosity (Hirschfelder, Curtiss and Bird 1954, eqs. 8.2-22 to 8.2-24), the full system of all species:
//!
//! ```text
//! H_ii = x_i^2/eta_ii + sum over k /= i of 2 x_i x_k/eta_ik m_i m_k/(m_i + m_k)^2 (5/(3 A*_ik) + m_k/m_i)
//! H_ij = -2 x_i x_j/eta_ij m_i m_j/(m_i + m_j)^2 (5/(3 A*_ij) - 1)
//! H b = x,   eta = sum of x_i b_i,   eta_ij = 5/16 sqrt(2 pi mu_ij k T) / Q^(2,2)_ij         [Pa s]
//! ```
//!
//! Conduction of heat at zero diffusion (Muckenfuss and Curtiss 1958, J. Chem. Phys. 29, 1273; elements as in Monchick,
//! Pereira and Mason 1965, J. Chem. Phys. 42, 3241):
//!
//! ```text
//! L_ii = -4 x_i^2/l_ii - sum over k /= i of 2 x_i x_k [15/2 m_i^2 + 25/4 m_k^2 - 3 m_k^2 B*_ik + 4 m_i m_k A*_ik]
//!                                           / ((m_i + m_k)^2 A*_ik l_ik)
//! L_ij = 2 x_i x_j m_i m_j [55/4 - 3 B*_ij - 4 A*_ij] / ((m_i + m_j)^2 A*_ij l_ij)
//! L a = x,   kappa = -4 sum of x_i a_i,   l_ij = 75/64 k sqrt(pi k T/(2 mu_ij)) / Q^(2,2)_ij  [W/(m K)]
//! ```
//!
//! Both systems are solved with row i divided by x_i: nothing then depends on how rare a species is, and one that is
//! absent weighs nothing, without any threshold.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::collision::Pairs;
use crate::constants::BOLTZMANN;

/// A gas of heavy particles at one temperature.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Heavy<'a> {
    /// Masses [kg].
    pub(crate) mass: &'a [f64],
    /// Mole fractions among them (or any multiple of them).
    pub(crate) fraction: &'a [f64],
    /// Collision integrals of their pairs.
    pub(crate) pairs: &'a Pairs,
    /// Temperature [K].
    pub(crate) temperature: f64,
}

impl Heavy<'_> {
    /// Viscosity [Pa s]; None where the gas is empty.
    pub(crate) fn viscosity(&self) -> Option<f64> {
        self.transported(|i, j| self.momentum(i, j))
    }

    /// Conduction of heat by flight [W/(m K)] at zero diffusion; None where the gas is empty.
    pub(crate) fn thermal_conductivity(&self) -> Option<f64> {
        self.transported(|i, j| self.heat(i, j))
            .map(|kappa| 4.0 * kappa)
    }

    /// `sum of x_i a_i` of the system `M_ij a_j = 1`, with `M_ii = x_i p_ii + sum of x_k d_ik` and `M_ij = x_j o_ij`, where
    /// `entry(i, j)` gives d and o for two species, and p and nothing for one.
    fn transported(&self, entry: impl Fn(usize, usize) -> (f64, f64)) -> Option<f64> {
        let n = self.mass.len();
        let x = self.fraction;
        let mut matrix = DMatrix::zeros(n, n);
        for i in 0..n {
            matrix[(i, i)] += x[i] * entry(i, i).0;
            for j in (0..n).filter(|&j| j != i) {
                let (diagonal, other) = entry(i, j);
                matrix[(i, i)] += x[j] * diagonal;
                matrix[(i, j)] = x[j] * other;
            }
        }
        let solution = matrix.lu().solve(&DVector::from_element(n, 1.0))?;
        Some(solution.iter().zip(x).map(|(a, x)| a * x).sum())
    }

    /// Entries of H: what k does to the diagonal of i, and the other one.
    fn momentum(&self, i: usize, k: usize) -> (f64, f64) {
        let (mi, mk) = (self.mass[i], self.mass[k]);
        let q = self.pairs.get(i, k);
        let reduced = mi * mk / (mi + mk);
        let eta =
            5.0 / 16.0 * (2.0 * PI * reduced * BOLTZMANN * self.temperature).sqrt() / q.second[0];
        if i == k {
            return (1.0 / eta, 0.0);
        }
        let share = 2.0 / eta * mi * mk / (mi + mk).powi(2);
        let ratio = 5.0 / (3.0 * q.a_star());
        (share * (ratio + mk / mi), -share * (ratio - 1.0))
    }

    /// Entries of -L: what k does to the diagonal of i, and the other one.
    fn heat(&self, i: usize, k: usize) -> (f64, f64) {
        let (mi, mk) = (self.mass[i], self.mass[k]);
        let q = self.pairs.get(i, k);
        let twice_reduced = 2.0 * mi * mk / (mi + mk);
        let kappa =
            75.0 / 64.0 * BOLTZMANN * (PI * BOLTZMANN * self.temperature / twice_reduced).sqrt()
                / q.second[0];
        if i == k {
            return (4.0 / kappa, 0.0);
        }
        let (a, b) = (q.a_star(), q.b_star());
        let share = 2.0 / ((mi + mk).powi(2) * a * kappa);
        (
            share * (7.5 * mi * mi + 6.25 * mk * mk - 3.0 * mk * mk * b + 4.0 * mi * mk * a),
            -share * mi * mk * (13.75 - 3.0 * b - 4.0 * a),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constants::ATOMIC_MASS;
    use crate::transport::collision::Integrals;

    const T: f64 = 1000.0;
    const AREA: f64 = 4e-19;

    fn gas<'a>(mass: &'a [f64], fraction: &'a [f64], pairs: &'a Pairs) -> Heavy<'a> {
        Heavy {
            mass,
            fraction,
            pairs,
            temperature: T,
        }
    }

    #[test]
    fn hard_spheres_have_their_known_values() {
        let (m, pairs) = (
            40.0 * ATOMIC_MASS,
            Pairs::from_fn(1, |_, _| Integrals::hard(AREA)),
        );
        let one = gas(std::slice::from_ref(&m), &[1.0], &pairs);
        let eta = one.viscosity().unwrap();
        let exact = 5.0 / 16.0 * (PI * m * BOLTZMANN * T).sqrt() / AREA;
        assert!((eta / exact - 1.0).abs() < 1e-12);
        let eucken = one.thermal_conductivity().unwrap() * m / (BOLTZMANN * eta);
        assert!((eucken - 15.0 / 4.0).abs() < 1e-12);
    }

    #[test]
    fn equal_particles_under_several_names_are_one_gas() {
        let integrals = Integrals {
            first: [4e-19, 3.6e-19, 3.4e-19, 3.2e-19, 3.1e-19],
            second: [4.5e-19, 4.2e-19, 4.0e-19],
        };
        let m = 40.0 * ATOMIC_MASS;
        let one = Pairs::from_fn(1, |_, _| integrals);
        let pure = gas(std::slice::from_ref(&m), &[1.0], &one);
        let three = Pairs::from_fn(3, |_, _| integrals);
        for fraction in [[0.2, 0.3, 0.5], [1e-300, 1.0, 0.0], [1e-14, 1e-15, 1.0]] {
            let masses = [m; 3];
            let mixed = gas(&masses, &fraction, &three);
            let total: f64 = fraction.iter().sum();
            assert!((total - 1.0).abs() < 1e-12);
            let eta = mixed.viscosity().unwrap() / pure.viscosity().unwrap();
            let kappa =
                mixed.thermal_conductivity().unwrap() / pure.thermal_conductivity().unwrap();
            assert!((eta - 1.0).abs() < 1e-12 && (kappa - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn matrices_are_symmetric() {
        let masses = [12.0, 40.0, 56.0].map(|m| m * ATOMIC_MASS);
        let pairs = Pairs::from_fn(3, |i, j| Integrals::hard(AREA * (1.0 + (i + 2 * j) as f64)));
        let mixed = gas(&masses, &[0.3, 0.3, 0.4], &pairs);
        for i in 0..3 {
            for j in 0..i {
                // H_ij = x_i x_j o_ij and the same for heat.
                let (h, g) = (mixed.momentum(i, j).1, mixed.momentum(j, i).1);
                assert!((h / g - 1.0).abs() < 1e-14);
                let (h, g) = (mixed.heat(i, j).1, mixed.heat(j, i).1);
                assert!((h / g - 1.0).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn heavy_and_light_hard_spheres_are_between_bounds() {
        // A trace of light gas leaves the heavy gas as it is; viscosity of the mixture is continuous in it.
        let masses = [4.0, 56.0].map(|m| m * ATOMIC_MASS);
        let pairs = Pairs::from_fn(2, |_, _| Integrals::hard(AREA));
        let at = |x: f64| gas(&masses, &[x, 1.0 - x], &pairs).viscosity().unwrap();
        assert!((at(1e-12) / at(0.0) - 1.0).abs() < 1e-10);
        assert!(at(0.5) > at(1.0) && at(0.5) < at(0.0));
    }
}
