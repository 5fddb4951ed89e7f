//! Component species: as many as there are constraints, the most abundant that are independent, and every other
//! species as a reaction of them.
//!
//! The balances are then written per component, so that a trace balance is a sum of traces alone. In carbon monoxide
//! at 300 K, for example, carbon and oxygen are both held by CO to thirty decimals; with CO and CO2 as components the
//! second balance reads n(CO2) + 2 n(O2) + n(O) + ... = n(C) + 3 n(C3) + ..., where CO has dropped out exactly.

use super::Element;
use super::system::{CONSTRAINTS, System};
use nalgebra::DMatrix;

/// The least determinant-like remainder with which a species counts as independent of those chosen.
const INDEPENDENT: f64 = 1e-6;
/// Reaction coefficients below this are rounding: they are ratios of small integers.
const NO_COEFFICIENT: f64 = 1e-9;
/// Amounts below this many roundings of their terms are rounding.
const ROUNDINGS: f64 = 16.0;

/// Components and the reactions that make every species of them.
#[derive(Debug, Clone)]
pub(super) struct Basis {
    /// Which members are the components.
    pub(super) components: Vec<usize>,
    /// How many of each component make one particle of each member; the rest of a row is 0.
    pub(super) reactions: Vec<[f64; CONSTRAINTS]>,
    /// Moles of each component in one mole of the mixture, as though all were made of components.
    pub(super) moles: [f64; CONSTRAINTS],
    /// d moles / d x.
    pub(super) moles_by_iron: [f64; CONSTRAINTS],
}

impl Basis {
    /// The most abundant independent members by `logarithms`, their ln n.
    pub(super) fn most_abundant(system: &System, logarithms: &[f64]) -> Option<Self> {
        let mut order: Vec<usize> = (0..system.members.len()).collect();
        order.sort_by(|a, b| logarithms[*b].total_cmp(&logarithms[*a]).then(a.cmp(b)));
        let components = independent(system, &order);
        Self::new(system, components)
    }

    fn new(system: &System, components: Vec<usize>) -> Option<Self> {
        let count = system.constraints();
        if components.len() != count {
            return None;
        }
        let content = |member: usize, row: usize| system.members[member].content[row];
        let inverse =
            DMatrix::from_fn(count, count, |row, column| content(components[column], row))
                .try_inverse()?;
        let members = system.members.iter();
        let reactions = members
            .map(|member| reaction(&inverse, &member.content))
            .collect();
        let cold = cold_gas(system, &inverse);
        let iron = system
            .elements
            .iter()
            .position(|element| *element == Element::Fe);
        let iron = iron.map_or([0.0; CONSTRAINTS], |place| {
            let mut atom = [0.0; CONSTRAINTS];
            atom[place] = 1.0;
            reaction(&inverse, &atom)
        });
        let (mut moles, mut moles_by_iron) = ([0.0; CONSTRAINTS], [0.0; CONSTRAINTS]);
        for j in 0..count {
            moles[j] = system.recipe.gas * cold[j] + system.recipe.iron * iron[j];
            moles_by_iron[j] = iron[j] - cold[j];
        }
        Some(Self {
            components,
            reactions,
            moles,
            moles_by_iron,
        })
    }
}

/// How many of each component make a particle of this content.
fn reaction(inverse: &DMatrix<f64>, content: &[f64; CONSTRAINTS]) -> [f64; CONSTRAINTS] {
    let mut reaction = [0.0; CONSTRAINTS];
    for (j, slot) in reaction.iter_mut().enumerate().take(inverse.nrows()) {
        let value: f64 = (0..inverse.ncols())
            .map(|row| inverse[(j, row)] * content[row])
            .sum();
        *slot = if value.abs() < NO_COEFFICIENT {
            0.0
        } else {
            value
        };
    }
    reaction
}

/// Moles of each component in one mole of the cold gas. They are summed over what the gas was mixed of, not over its
/// elements: where a component of the basis is one of the gas, the others get nothing, to the last digit, and the
/// smallest trace of iron added later is not lost beside it.
fn cold_gas(system: &System, inverse: &DMatrix<f64>) -> [f64; CONSTRAINTS] {
    let (mut moles, mut sizes) = ([0.0; CONSTRAINTS], [0.0; CONSTRAINTS]);
    for (content, fraction) in &system.cold {
        for (j, coefficient) in reaction(inverse, content).into_iter().enumerate() {
            moles[j] += coefficient * fraction;
            sizes[j] += (coefficient * fraction).abs();
        }
    }
    for (amount, size) in moles.iter_mut().zip(sizes) {
        if amount.abs() <= ROUNDINGS * f64::EPSILON * size {
            *amount = 0.0;
        }
    }
    moles
}

/// The first members in `order` that are independent, by Gram and Schmidt on their contents.
fn independent(system: &System, order: &[usize]) -> Vec<usize> {
    let count = system.constraints();
    let mut directions: Vec<[f64; CONSTRAINTS]> = Vec::with_capacity(count);
    let mut components = Vec::with_capacity(count);
    for &member in order {
        let mut rest = system.members[member].content;
        for direction in &directions {
            let along: f64 = rest.iter().zip(direction).map(|(a, b)| a * b).sum();
            rest.iter_mut()
                .zip(direction)
                .for_each(|(a, b)| *a -= along * b);
        }
        let length = rest.iter().map(|a| a * a).sum::<f64>().sqrt();
        if length > INDEPENDENT {
            directions.push(rest.map(|a| a / length));
            components.push(member);
            if components.len() == count {
                break;
            }
        }
    }
    components
}
