//! Electrons: conduction of current and heat, third order of the Chapman-Enskog method.
//!
//! Heavy particles are so much slower that the electrons' equations stand alone (Devoto 1967, Phys. Fluids 10, 2105).
//! With the Sonine polynomials to the third (order counts as in his paper), number densities n [1/m3], electrons e and
//! heavy species j:
//!
//! ```text
//! q^00 = 8 n_e S{ Q11 }
//! q^01 = 8 n_e S{ 5/2 Q11 - 3 Q12 }
//! q^02 = 8 n_e S{ 35/8 Q11 - 21/2 Q12 + 6 Q13 }
//! q^11 = 8 n_e S{ 25/4 Q11 - 15 Q12 + 12 Q13 }                       + 8 sqrt2 n_e^2 Q22
//! q^12 = 8 n_e S{ 175/16 Q11 - 315/8 Q12 + 57 Q13 - 30 Q14 }         + 8 sqrt2 n_e^2 (7/4 Q22 - 2 Q23)
//! q^22 = 8 n_e S{ 1225/64 Q11 - 735/8 Q12 + 399/2 Q13 - 210 Q14 + 90 Q15 }
//!                                                                    + 8 sqrt2 n_e^2 (77/16 Q22 - 7 Q23 + 5 Q24)
//! S{.} = sum over j of n_j times . with Q1s = Q^(1,s)_ej;  Q2s = Q^(2,s)_ee
//!
//! sigma   = 3/2 e^2 n_e^2 sqrt(2 pi / (m_e k T)) |q^11 q^12; q^12 q^22| / |q|          [S/m]
//! kappa_e = 75/8 n_e^2 k sqrt(2 pi k T / m_e) q^22 / (q^11 q^22 - q^12^2)             [W/(m K)]
//! ```
//!
//! kappa_e is at zero diffusion of electrons, as it stands in the balance of heat beside `sum of h_s J_s`. The code
//! works with `q / (8 n_e)`, which stays finite however few electrons there are.

use std::f64::consts::{PI, SQRT_2};

use super::collision::Integrals;
use crate::constants::{BOLTZMANN, ELECTRON_MASS, ELEMENTARY_CHARGE};

/// The matrix `q^mp / (8 n_e)` [1/m], m, p = 0, 1, 2.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Electrons {
    matrix: [[f64; 3]; 3],
}

impl Electrons {
    /// From the integrals with each heavy species and its number density [1/m3], and those among electrons.
    pub(crate) fn new<'a>(
        heavy: impl Iterator<Item = (f64, &'a Integrals)>,
        electrons: f64,
        like: &Integrals,
    ) -> Self {
        let mut q = [0.0; 5];
        for (number, integrals) in heavy {
            for (sum, value) in q.iter_mut().zip(integrals.first) {
                *sum += number * value;
            }
        }
        let [q22, q23, q24] = like.second.map(|value| SQRT_2 * electrons * value);
        let m01 = 2.5 * q[0] - 3.0 * q[1];
        let m02 = 4.375 * q[0] - 10.5 * q[1] + 6.0 * q[2];
        let m11 = 6.25 * q[0] - 15.0 * q[1] + 12.0 * q[2] + q22;
        let m12 = 175.0 / 16.0 * q[0] - 315.0 / 8.0 * q[1] + 57.0 * q[2] - 30.0 * q[3] + 1.75 * q22
            - 2.0 * q23;
        let m22 = 1225.0 / 64.0 * q[0] - 735.0 / 8.0 * q[1] + 199.5 * q[2] - 210.0 * q[3]
            + 90.0 * q[4]
            + 77.0 / 16.0 * q22
            - 7.0 * q23
            + 5.0 * q24;
        Self {
            matrix: [[q[0], m01, m02], [m01, m11, m12], [m02, m12, m22]],
        }
    }

    /// Electrical conductivity [S/m] of `electrons` [1/m3] at `temperature` [K].
    pub(crate) fn electric_conductivity(&self, temperature: f64, electrons: f64) -> f64 {
        let [[a, b, c], [_, d, e], [_, _, f]] = self.matrix;
        // Elimination of the higher polynomials leaves the resistance of the first.
        let minor = d * f - e * e;
        let resistance = a - (b * (b * f - c * e) + c * (c * d - b * e)) / minor;
        let thermal = ELECTRON_MASS * BOLTZMANN * temperature;
        1.5 * ELEMENTARY_CHARGE.powi(2) * electrons * (2.0 * PI / thermal).sqrt()
            / (8.0 * resistance)
    }

    /// Conduction of heat [W/(m K)] by `electrons` [1/m3] at `temperature` [K].
    pub(crate) fn thermal_conductivity(&self, temperature: f64, electrons: f64) -> f64 {
        let [_, [_, d, e], [_, _, f]] = self.matrix;
        let speed = (2.0 * PI * BOLTZMANN * temperature / ELECTRON_MASS).sqrt();
        75.0 / 64.0 * electrons * BOLTZMANN * speed / (d - e * e / f)
    }

    /// Whether the matrix is positive definite, as the loss of order by collisions demands.
    #[cfg(test)]
    pub(crate) fn is_positive(&self) -> bool {
        let [[a, b, c], [_, d, e], [_, _, f]] = self.matrix;
        let minor = d * f - e * e;
        a > 0.0 && f > 0.0 && minor > 0.0 && a * minor > b * (b * f - c * e) + c * (c * d - b * e)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const N: f64 = 1e22;
    const T: f64 = 10_000.0;

    fn first_order(q11: f64) -> f64 {
        3.0 / 16.0 * ELEMENTARY_CHARGE.powi(2) * (2.0 * PI / (ELECTRON_MASS * BOLTZMANN * T)).sqrt()
            / q11
    }

    /// Coulomb integrals where the logarithm outweighs all else.
    fn coulomb(q: f64) -> Integrals {
        Integrals {
            first: [q, q / 3.0, q / 6.0, q / 10.0, q / 15.0],
            second: [q, q / 2.0, 0.3 * q],
        }
    }

    #[test]
    fn full_ionisation_is_braginskii() {
        // Braginskii (1965), Reviews of Plasma Physics 1, table 1, Z = 1, the same order of polynomials:
        // sigma = e^2 n tau / (0.5129 m), kappa = 3.1616 n k (kT) tau / m; Spitzer (1962) has 1.975 and 3.20.
        let ions = coulomb(1e-17);
        let electrons = Electrons::new([(N, &ions)].into_iter(), N, &coulomb(1e-17));
        let sigma = electrons.electric_conductivity(T, N);
        let first = first_order(1e-17);
        assert!(
            (sigma / first * 0.5129 - 1.0).abs() < 2e-4,
            "{}",
            sigma / first
        );
        assert!((sigma / first / 1.975 - 1.0).abs() < 0.02);
        let tau = first * ELECTRON_MASS / (ELEMENTARY_CHARGE.powi(2) * N);
        let braginskii = 3.1616 * N * BOLTZMANN * BOLTZMANN * T * tau / ELECTRON_MASS;
        let kappa = electrons.thermal_conductivity(T, N);
        assert!(
            (kappa / braginskii - 1.0).abs() < 2e-4,
            "{}",
            kappa / braginskii
        );
        assert!(electrons.is_positive());
    }

    #[test]
    fn lorentz_gas_of_maxwell_molecules_is_exact_at_first_order() {
        // Q ~ 1/g: Q^(1,s) = Q^(1,1) Gamma(s+3/2) / Gamma(5/2) x 2 / (s+1)!.
        let mut first = [1e-19; 5];
        for s in 2..6usize {
            first[s - 1] = first[s - 2] * (s as f64 + 0.5) / (s as f64 + 1.0);
        }
        let maxwell = Integrals {
            first,
            second: [0.0; 3],
        };
        let electrons = Electrons::new([(N, &maxwell)].into_iter(), 0.0, &maxwell);
        let sigma = electrons.electric_conductivity(T, N);
        assert!((sigma / (first_order(1e-19)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn lorentz_gas_of_hard_spheres_approaches_the_exact_integral() {
        // Exact mobility over the first order: 32/(9 pi) = 1.1318; the orders give 1, 13/12, 1.1068, ...
        let hard = Integrals::hard(1e-19);
        let electrons = Electrons::new([(N, &hard)].into_iter(), 0.0, &hard);
        let ratio = electrons.electric_conductivity(T, N) / first_order(1e-19);
        assert!(ratio > 13.0 / 12.0 && ratio < 32.0 / (9.0 * PI), "{ratio}");
        assert!((ratio - 1.1068).abs() < 1e-3, "{ratio}");
    }

    #[test]
    fn electrons_alone_conduct_as_a_pure_gas_of_hard_spheres() {
        // Chapman and Cowling (1970), sect. 10.21: third order 1.0244 (second 45/44) of the first for heat.
        let hard = Integrals::hard(1e-19);
        let electrons = Electrons::new(std::iter::empty(), N, &hard);
        let first = 75.0 / 64.0 * BOLTZMANN * (PI * BOLTZMANN * T / ELECTRON_MASS).sqrt() / 1e-19;
        let ratio = electrons.thermal_conductivity(T, N) / first;
        assert!((ratio - 45.0 / 44.0).abs() < 1e-12, "{ratio}");
    }

    #[test]
    fn traces_do_no_harm() {
        let hard = Integrals::hard(1e-19);
        let electrons = Electrons::new([(2.4e25, &hard)].into_iter(), 1e-300, &hard);
        let sigma = electrons.electric_conductivity(300.0, 1e-300);
        assert!(sigma.is_finite() && sigma >= 0.0);
        assert!(electrons.thermal_conductivity(300.0, 1e-300).is_finite());
    }
}
