//! The balances of an equilibrium in logarithms, and their exact derivatives.
//!
//! Unknowns u: ln n of each component, ln N (N moles of mixture per volume, in particles per m3), and with
//! electrostatic lowering ln K (K the inverse Debye length). Of any species, with k_s its equilibrium constant of
//! formation from the components, nu_sj its reaction and w_s = z_s^2 - sum nu_sj z_j^2,
//!
//! - ln n_s = ln k_s + sum over components of nu_sj ln n_j + w_s L K/2, L = e^2/(4 pi eps0 kT).
//!
//! Residuals F(u) = 0, each a logarithm of a ratio, so that a trace balance weighs as much as any other:
//!
//! - of component j: ln(sum over nu_sj > 0 of nu_sj n_s) = ln(sum over nu_sj < 0 of |nu_sj| n_s + B_j N), with B_j the
//!   moles of component j in a mole of mixture (on the left instead where negative);
//! - of pressure: ln(sum of n_s) = ln(p/kT + K^3/24 pi);
//! - of screening: ln(4 pi L sum of z_s^2 n_s) = 2 ln K.
//!
//! Debye and Hueckel's limiting law (Landau and Lifshitz, Statistical Physics, sec. 78): each charge's potential is
//! lowered by z^2 e^2 K/8 pi eps0, the pressure by kT K^3/24 pi, the energy per volume by kT K^3/8 pi. All three come
//! from one free energy, so that thermodynamics stay consistent.

use super::basis::Basis;
use super::system::{CONSTRAINTS, System};
use super::{Conditions, Lowering};
use crate::constants::{BOLTZMANN, ELEMENTARY_CHARGE, PERMITTIVITY};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// The most unknowns that there can be.
const UNKNOWNS: usize = CONSTRAINTS + 2;

/// How a logarithm answers to the unknowns, and to the temperature with the unknowns held.
#[derive(Debug, Clone, Copy, Default)]
struct Slope {
    unknown: [f64; UNKNOWNS],
    temperature: f64,
}

impl Slope {
    fn add(&mut self, factor: f64, other: &Self) {
        self.temperature += factor * other.temperature;
        for (a, b) in self.unknown.iter_mut().zip(&other.unknown) {
            *a += factor * b;
        }
    }
}

/// The equations at one temperature in one basis.
pub(super) struct Balance<'a> {
    system: &'a System,
    basis: &'a Basis,
    conditions: Conditions,
    /// ln k_s and its derivative by temperature.
    constants: Vec<(f64, f64)>,
    /// w_s.
    charges: Vec<f64>,
}

/// The equations at one set of unknowns.
pub(super) struct Evaluation {
    /// ln n of each member.
    pub(super) logarithms: Vec<f64>,
    /// F.
    pub(super) residual: DVector<f64>,
    /// dF/du.
    pub(super) jacobian: DMatrix<f64>,
    /// dF/dT with the unknowns held, 1/K.
    pub(super) by_temperature: DVector<f64>,
    /// dF/dx with the unknowns held.
    pub(super) by_iron: DVector<f64>,
    slopes: Vec<Slope>,
}

impl<'a> Balance<'a> {
    pub(super) fn new(system: &'a System, basis: &'a Basis, conditions: Conditions) -> Self {
        let from_components =
            |own: f64, reaction: &[f64; CONSTRAINTS], value: &dyn Fn(usize) -> f64| {
                let components = basis.components.iter().zip(reaction);
                own - components.map(|(j, nu)| nu * value(*j)).sum::<f64>()
            };
        let members = &system.members;
        let reactions = || members.iter().zip(&basis.reactions);
        let constants = reactions()
            .map(|(member, reaction)| {
                let constant =
                    from_components(member.ln_partition, reaction, &|j| members[j].ln_partition);
                let slope = member.ln_partition_by_temperature;
                let slope =
                    from_components(slope, reaction, &|j| members[j].ln_partition_by_temperature);
                (constant, slope)
            })
            .collect();
        let squared = |j: usize| members[j].charge_squared(system);
        let charges = reactions()
            .map(|(member, reaction)| {
                from_components(member.charge_squared(system), reaction, &squared)
            })
            .collect();
        Self {
            system,
            basis,
            conditions,
            constants,
            charges,
        }
    }

    /// How many unknowns there are.
    pub(super) fn unknowns(&self) -> usize {
        self.basis.components.len()
            + 1
            + usize::from(self.conditions.lowering == Lowering::DebyeHueckel)
    }

    /// The name of an equation.
    pub(super) fn name(&self, mixture: &super::Mixture, row: usize) -> String {
        match self.basis.components.get(row) {
            Some(member) => format!(
                "balance of {}",
                mixture.species[self.system.members[*member].index].name
            ),
            None if row == self.basis.components.len() => "pressure".to_owned(),
            None => "screening length".to_owned(),
        }
    }

    /// The equations at `unknowns`.
    pub(super) fn evaluate(&self, unknowns: &[f64]) -> Evaluation {
        let size = self.unknowns();
        let (mut logarithms, mut slopes) = self.members(unknowns);
        let count = self.basis.components.len();
        // The moles of mixture stand behind the members as one more amount.
        let mut whole = Slope::default();
        whole.unknown[count] = 1.0;
        logarithms.push(unknowns[count]);
        slopes.push(whole);
        let mut evaluation = Evaluation {
            logarithms,
            residual: DVector::zeros(size),
            jacobian: DMatrix::zeros(size, size),
            by_temperature: DVector::zeros(size),
            by_iron: DVector::zeros(size),
            slopes,
        };
        for row in 0..count {
            self.component(row, &mut evaluation);
        }
        self.pressure(count, unknowns, &mut evaluation);
        if size > count + 1 {
            self.screening(count + 1, unknowns, &mut evaluation);
        }
        evaluation.logarithms.pop();
        evaluation.slopes.pop();
        evaluation
    }

    /// ln n of the members and how they answer.
    fn members(&self, unknowns: &[f64]) -> (Vec<f64>, Vec<Slope>) {
        let count = self.basis.components.len();
        let half = unknowns.get(count + 1).map_or(0.0, |log| {
            0.5 * landau_length(self.system.temperature) * log.exp()
        });
        let members = self
            .basis
            .reactions
            .iter()
            .zip(&self.constants)
            .zip(&self.charges);
        members
            .map(|((reaction, (constant, slope)), charge)| {
                let made: f64 = reaction
                    .iter()
                    .zip(&unknowns[..count])
                    .map(|(nu, y)| nu * y)
                    .sum();
                let lowering = charge * half;
                let mut answer = Slope {
                    unknown: [0.0; UNKNOWNS],
                    temperature: slope - lowering / self.system.temperature,
                };
                answer.unknown[..count].copy_from_slice(&reaction[..count]);
                answer.unknown[count + 1] = lowering;
                (constant + made + lowering, answer)
            })
            .unzip()
    }

    fn component(&self, row: usize, evaluation: &mut Evaluation) {
        let moles = self.basis.moles[row];
        let whole = self.basis.reactions.len();
        let side = |sign: f64, moles: f64| -> Vec<(usize, f64)> {
            let reactions = self.basis.reactions.iter().enumerate();
            reactions
                .map(|(member, reaction)| (member, sign * reaction[row]))
                .chain([(whole, moles)])
                .filter(|(_, factor)| *factor > 0.0)
                .collect()
        };
        let (left, left_slope) = evaluation.log_sum(&side(1.0, -moles));
        let (right, right_slope) = evaluation.log_sum(&side(-1.0, moles));
        let held = if moles < 0.0 { left } else { right };
        evaluation.by_iron[row] =
            -self.basis.moles_by_iron[row] * (evaluation.logarithms[whole] - held).exp();
        evaluation.set(row, left - right, &left_slope, &right_slope);
    }

    fn pressure(&self, row: usize, unknowns: &[f64], evaluation: &mut Evaluation) {
        let temperature = self.system.temperature;
        let ideal = self.conditions.pressure / (BOLTZMANN * temperature);
        let lowered = unknowns
            .get(row + 1)
            .map_or(0.0, |log| (3.0 * log).exp() / (24.0 * PI));
        let mut right = Slope {
            temperature: -ideal / (temperature * (ideal + lowered)),
            ..Slope::default()
        };
        right.unknown[row + 1] = 3.0 * lowered / (ideal + lowered);
        let members: Vec<(usize, f64)> = (0..self.system.members.len())
            .map(|member| (member, 1.0))
            .collect();
        let (left, left_slope) = evaluation.log_sum(&members);
        evaluation.set(row, left - (ideal + lowered).ln(), &left_slope, &right);
    }

    fn screening(&self, row: usize, unknowns: &[f64], evaluation: &mut Evaluation) {
        let members = self.system.members.iter().enumerate();
        let charged: Vec<(usize, f64)> = members
            .map(|(member, s)| (member, s.charge_squared(self.system)))
            .filter(|(_, squared)| *squared > 0.0)
            .collect();
        let (left, left_slope) = evaluation.log_sum(&charged);
        let mut right = Slope {
            temperature: 1.0 / self.system.temperature,
            ..Slope::default()
        };
        right.unknown[row] = 2.0;
        let value =
            left + (4.0 * PI * landau_length(self.system.temperature)).ln() - 2.0 * unknowns[row];
        evaluation.set(row, value, &left_slope, &right);
    }
}

/// e^2/(4 pi eps0 kT), m.
pub(super) fn landau_length(temperature: f64) -> f64 {
    ELEMENTARY_CHARGE * ELEMENTARY_CHARGE / (4.0 * PI * PERMITTIVITY * BOLTZMANN * temperature)
}

impl Evaluation {
    /// ln of a sum of factors times amounts, and its slope.
    fn log_sum(&self, terms: &[(usize, f64)]) -> (f64, Slope) {
        let top = terms
            .iter()
            .map(|(i, _)| self.logarithms[*i])
            .fold(f64::NEG_INFINITY, f64::max);
        let mut sum = 0.0;
        let mut slope = Slope::default();
        for (i, factor) in terms {
            let term = factor * (self.logarithms[*i] - top).exp();
            if term > 0.0 {
                sum += term;
                slope.add(term, &self.slopes[*i]);
            }
        }
        let mut mean = Slope::default();
        mean.add(1.0 / sum, &slope);
        (top + sum.ln(), mean)
    }

    fn set(&mut self, row: usize, residual: f64, left: &Slope, right: &Slope) {
        self.residual[row] = residual;
        self.by_temperature[row] = left.temperature - right.temperature;
        for column in 0..self.jacobian.ncols() {
            self.jacobian[(row, column)] = left.unknown[column] - right.unknown[column];
        }
    }

    /// d ln n_s of each member when the unknowns move by `unknowns` and the temperature by `temperature`.
    pub(super) fn answer(&self, unknowns: &DVector<f64>, temperature: f64) -> Vec<f64> {
        let moved = |slope: &Slope| -> f64 {
            let by_unknowns: f64 = slope
                .unknown
                .iter()
                .zip(unknowns.iter())
                .map(|(a, b)| a * b)
                .sum();
            by_unknowns + temperature * slope.temperature
        };
        self.slopes.iter().map(moved).collect()
    }
}
