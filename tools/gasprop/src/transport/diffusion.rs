//! Diffusion of all species through each other, without current and without flow of mass.
//!
//! The equations of Stefan and Maxwell with the force of the electric field that keeps electrons and ions together, at
//! constant pressure; x mole fractions, v diffusion velocities, Z charges:
//!
//! ```text
//! sum over j of x_i x_j (v_j - v_i) / D_ij + x_i Z_i e E / (k T) = grad x_i,
//! sum of m_i x_i v_i = 0,    sum of Z_i x_i v_i = 0,
//! D_ij = 3/16 sqrt(2 pi k T / mu_ij) / (n Q^(1,1)_ij)                    [m2/s]
//! ```
//!
//! (Hirschfelder, Curtiss and Bird 1954, eq. 8.2-44 and sect. 7.4.) Diffusion by gradients of temperature itself is
//! left out. The unknowns are `w_i = x_i v_i`, so that nothing depends on how rare a species is: an absent one with a
//! gradient diffuses as it does in the limit. The equation of the weightiest species, which the others imply, gives
//! way to the balance of mass.
//!
//! Where elements are to stay together, gradients of their chemical potentials stand on the left as the field does:
//! `x_i a_i lambda` with the amount a_i in one particle, and one more balance, `sum of a_i x_i v_i = 0`.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector, Dyn, LU};

use super::collision::Pairs;
use crate::constants::BOLTZMANN;

/// Binary diffusion coefficient of first order [m2/s] from two masses [kg], `Q^(1,1)` [m2], the number density of all
/// particles [1/m3] and temperature [K].
pub(crate) fn binary(mass: f64, other: f64, q11: f64, number: f64, temperature: f64) -> f64 {
    let reduced = mass * other / (mass + other);
    3.0 / 16.0 * (2.0 * PI * BOLTZMANN * temperature / reduced).sqrt() / (number * q11)
}

/// All species of a gas, electrons with them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Gas<'a> {
    /// Masses [kg].
    pub(crate) mass: &'a [f64],
    /// Charges in elementary charges.
    pub(crate) charge: &'a [i32],
    /// Mole fractions.
    pub(crate) fraction: &'a [f64],
    /// Collision integrals of their pairs.
    pub(crate) pairs: &'a Pairs,
    /// Temperature [K].
    pub(crate) temperature: f64,
    /// Particles of all species [1/m3].
    pub(crate) number: f64,
}

/// The equations of diffusion, factorised.
#[derive(Debug, Clone)]
pub(crate) struct Diffusion {
    factors: LU<f64, Dyn, Dyn>,
    /// The heavy species whose equation gave way to the balance of mass.
    frequent: usize,
    /// The diffusion coefficient that the factors count in [m2/s].
    unit: f64,
}

impl Diffusion {
    /// The equations of `gas`. Each of `held` is an amount of something in one particle of each species, of which none may
    /// flow; the sum of x times it is zero (for elements: `a_i1 b_2 - a_i2 b_1` where the gas has b_1 and b_2 of them, as
    /// then the gradients of the elements that hold it back leave the pressure as it is).
    pub(crate) fn new(gas: &Gas<'_>, held: &[Vec<f64>]) -> Self {
        let n = gas.mass.len();
        let heaviest = gas.mass.iter().fold(0.0, |a: f64, &b| a.max(b));
        let unit = binary(heaviest, heaviest, 1e-19, gas.number, gas.temperature);
        let mut matrix = DMatrix::zeros(n + 1 + held.len(), n + 1 + held.len());
        gas.friction(unit, &mut matrix);
        let charges: Vec<f64> = gas.charge.iter().map(|&z| f64::from(z)).collect();
        for (place, amount) in (n..).zip(std::iter::once(&charges).chain(held)) {
            gas.balance(amount, place, &mut matrix);
        }
        let weight = |i: usize| gas.fraction[i] * gas.mass[i];
        let frequent = (0..n)
            .max_by(|&i, &j| weight(i).total_cmp(&weight(j)))
            .unwrap_or(0);
        matrix.row_mut(frequent).fill(0.0);
        for (i, mass) in gas.mass.iter().enumerate() {
            matrix[(frequent, i)] = mass / heaviest;
        }
        Self {
            factors: matrix.lu(),
            frequent,
            unit,
        }
    }

    /// `w_i = x_i v_i` of each species [m2/s times the unit of the gradients] under gradients of the mole fractions, which
    /// sum to zero. None where the equations are singular.
    pub(crate) fn fluxes(&self, gradients: &[f64]) -> Option<Vec<f64>> {
        let n = gradients.len();
        let mut right = DVector::zeros(self.factors.l().nrows());
        for (i, gradient) in gradients
            .iter()
            .enumerate()
            .filter(|(i, _)| *i != self.frequent)
        {
            right[i] = *gradient;
        }
        let solution = self.factors.solve(&right)?;
        Some(solution.iter().take(n).map(|w| w * self.unit).collect())
    }
}

impl Gas<'_> {
    /// Friction between species, with resistances counted in 1/`unit`.
    fn friction(&self, unit: f64, matrix: &mut DMatrix<f64>) {
        let n = self.mass.len();
        for i in 0..n {
            for j in (0..n).filter(|&j| j != i) {
                let q11 = self.pairs.get(i, j).first[0];
                let resistance = unit
                    / binary(
                        self.mass[i],
                        self.mass[j],
                        q11,
                        self.number,
                        self.temperature,
                    );
                matrix[(i, j)] += self.fraction[i] * resistance;
                matrix[(i, i)] -= self.fraction[j] * resistance;
            }
        }
    }

    /// A row that lets no `amount` flow, and the column of the force that sees to it: the electric field on charges, a
    /// gradient of its potential on an element. The column is scaled to order one however rare the carriers are; without
    /// any there is no force.
    fn balance(&self, amount: &[f64], place: usize, matrix: &mut DMatrix<f64>) {
        let carriers: f64 = self
            .fraction
            .iter()
            .zip(amount)
            .map(|(x, a)| x * a * a)
            .sum();
        if carriers <= 0.0 {
            matrix[(place, place)] = 1.0;
            return;
        }
        for (i, a) in amount.iter().enumerate() {
            matrix[(i, place)] = self.fraction[i] / carriers * a;
            matrix[(place, i)] = *a;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constants::{ATOMIC_MASS, ELECTRON_MASS, ELECTRON_VOLT};
    use crate::transport::collision::Integrals;

    const T: f64 = 10_000.0;
    const N: f64 = 7e23;

    fn gas<'a>(
        mass: &'a [f64],
        charge: &'a [i32],
        fraction: &'a [f64],
        pairs: &'a Pairs,
    ) -> Gas<'a> {
        Gas {
            mass,
            charge,
            fraction,
            pairs,
            temperature: T,
            number: N,
        }
    }

    #[test]
    fn two_gases_diffuse_with_the_binary_coefficient() {
        let mass = [12.0, 56.0].map(|m| m * ATOMIC_MASS);
        let pairs = Pairs::from_fn(2, |i, j| {
            Integrals::hard(if i == j { 9e-19 } else { 3e-19 })
        });
        let d = binary(mass[0], mass[1], 3e-19, N, T);
        for x in [0.0, 1e-300, 0.3, 1.0] {
            let fraction = [x, 1.0 - x];
            let w = Diffusion::new(&gas(&mass, &[0, 0], &fraction, &pairs), &[])
                .fluxes(&[1.0, -1.0])
                .unwrap();
            // Without flow of mass: x1 v1 = -D m2/m grad x1, m the mean mass.
            let mean = x * mass[0] + (1.0 - x) * mass[1];
            assert!((w[0] / (-d * mass[1] / mean) - 1.0).abs() < 1e-12);
            assert!((w[1] / (d * mass[0] / mean) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn ions_drag_their_electrons_at_twice_the_pace() {
        // A trace of plasma in an atomic gas: ambipolar diffusion, D_a = 2 D_ion at one temperature.
        let mass = [ELECTRON_MASS, 40.0 * ATOMIC_MASS, 40.0 * ATOMIC_MASS];
        let pairs = Pairs::from_fn(3, |_, _| Integrals::hard(3e-19));
        let x = 1e-9;
        let fraction = [x, 1.0 - 2.0 * x, x];
        let w = Diffusion::new(&gas(&mass, &[-1, 0, 1], &fraction, &pairs), &[])
            .fluxes(&[1.0, -2.0, 1.0])
            .unwrap();
        let d = binary(mass[1], mass[2], 3e-19, N, T);
        assert!((w[2] / (-2.0 * d) - 1.0).abs() < 0.01, "{}", w[2] / d);
        assert!((w[0] / w[2] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn one_reaction_conducts_as_butler_and_brokaw_say() {
        // Butler and Brokaw (1957), J. Chem. Phys. 26, 1636: A2 = 2 A, with x1 atoms, x2 molecules:
        // kappa_r = n D k (H/kT)^2 x1 x2 / (2 x2 + x1)^2 ... per n_A2 -> 2 n_A of reaction heat H [J].
        let mass = [16.0, 32.0].map(|m| m * ATOMIC_MASS);
        let pairs = Pairs::from_fn(2, |_, _| Integrals::hard(3e-19));
        let heat = 5.1 * ELECTRON_VOLT;
        for x in [1e-6, 0.2, 0.7] {
            let fraction = [x, 1.0 - x];
            // Law of mass action at constant pressure: dln(x1^2/x2)/dT = H/(k T^2).
            let slope = heat / (BOLTZMANN * T * T) * x * (1.0 - x) / (2.0 - x);
            let w = Diffusion::new(&gas(&mass, &[0, 0], &fraction, &pairs), &[])
                .fluxes(&[slope, -slope])
                .unwrap();
            // Enthalpies: atoms H/2 each, molecules zero.
            let kappa = -N * w[0] * heat / 2.0;
            let d = binary(mass[0], mass[1], 3e-19, N, T);
            let brokaw =
                N * d * heat * heat / (BOLTZMANN * T * T) * x * (1.0 - x) / (2.0 - x).powi(2);
            assert!((kappa / brokaw - 1.0).abs() < 1e-10, "{}", kappa / brokaw);
        }
    }
}
