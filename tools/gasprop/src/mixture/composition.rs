//! Composition by Newton's method on the logarithms of component species.
//!
//! The first equilibrium is found at 10,000 K, where atoms, ions and electrons are all plenty; from there the
//! temperature walks to the one asked for, each step foretold by van 't Hoff's law d ln n/d(1/T) and corrected by
//! Newton, with components chosen anew. Cold states, whose traces span three hundred decades, are so never far from
//! one that is known, and the answer depends on nothing but its arguments.

use super::balance::{Balance, Evaluation, landau_length};
use super::basis::Basis;
use super::system::{CONSTRAINTS, Member, Recipe, System};
use super::{Conditions, EquilibriumError, Kind, Mixture, State, TEMPERATURE_RANGE};
use crate::constants::BOLTZMANN;
use nalgebra::DVector;
use std::f64::consts::PI;

/// The temperature of the first equilibrium, K.
const START_TEMPERATURE: f64 = 10_000.0;
/// The share of electrons from which that is sought.
const START_ELECTRONS: f64 = 0.01;
/// The largest ratio of temperatures in one step.
const LARGEST_RATIO: f64 = 1.25;
/// The smallest, below which the walk gives up.
const SMALLEST_RATIO: f64 = 1.001;
/// Largest change of a logarithm in one iteration.
const LONGEST_STEP: f64 = 4.0;
/// Iterations before Newton gives up.
const ITERATIONS: usize = 80;
/// Residuals (of logarithms, so relative) at which the iteration is in its quadratic end.
const NEAR: f64 = 1e-7;
/// Iterations after that, which bring it to rounding.
const POLISH: usize = 2;
/// Largest relative residual of an equilibrium.
pub(super) const TOLERANCE: f64 = 2e-12;

/// An equilibrium with its equations.
pub(super) struct Solution {
    pub(super) pressure: f64,
    pub(super) system: System,
    pub(super) basis: Basis,
    pub(super) unknowns: DVector<f64>,
    pub(super) evaluation: Evaluation,
}

/// An iteration that stopped above its tolerance.
struct Stalled {
    iterations: usize,
    residual: String,
    value: f64,
}

impl Mixture {
    /// How many of each species there are at `t` K, `pressure` Pa and `x_iron` moles of iron per mole of iron and
    /// cold gas.
    ///
    /// The model is that of thin plasmas, to some hundred atmospheres; below 1e-20 Pa and above 1e9 Pa the iteration
    /// itself may find no equilibrium, and says so.
    ///
    /// # Errors
    /// Arguments out of range, or an iteration that does not converge.
    pub fn equilibrium(
        &self,
        t: f64,
        pressure: f64,
        x_iron: f64,
    ) -> Result<State, EquilibriumError> {
        self.check(t, pressure, x_iron)?;
        let recipe = Recipe {
            gas: 1.0 - x_iron,
            iron: x_iron,
        };
        let solution = self.solve(t, pressure, recipe)?;
        let mut number = vec![0.0; self.species.len()];
        for (member, log) in solution
            .system
            .members
            .iter()
            .zip(&solution.evaluation.logarithms)
        {
            number[member.index] = log.exp();
        }
        Ok(State {
            temperature: t,
            pressure,
            iron: x_iron,
            number,
        })
    }

    fn check(&self, temperature: f64, pressure: f64, iron: f64) -> Result<(), EquilibriumError> {
        if !(TEMPERATURE_RANGE[0]..=TEMPERATURE_RANGE[1]).contains(&temperature) {
            return Err(EquilibriumError::Temperature { temperature });
        }
        if !(pressure.is_finite() && pressure > 0.0) {
            return Err(EquilibriumError::Pressure { pressure });
        }
        let most = if self.with_iron { 1.0 } else { 0.0 };
        if !(0.0..=most).contains(&iron) {
            return Err(EquilibriumError::Iron { iron });
        }
        Ok(())
    }

    /// The equilibrium of a recipe.
    pub(super) fn solve(
        &self,
        target: f64,
        pressure: f64,
        recipe: Recipe,
    ) -> Result<Solution, EquilibriumError> {
        self.walk(START_TEMPERATURE, target, pressure, recipe)
            .map_err(|stalled| EquilibriumError::NotConverged {
                temperature: target,
                pressure,
                iron: recipe.iron,
                iterations: stalled.iterations,
                residual: stalled.residual,
                value: stalled.value,
                tolerance: TOLERANCE,
            })
    }

    /// The equations of a state that was found before; none if they do not agree with it.
    pub(super) fn again(&self, state: &State, recipe: Recipe) -> Option<Solution> {
        let system = System::new(self, state.temperature, recipe);
        let number = |member: &Member| state.number[member.index];
        let nuclei =
            |amounts: &[f64; CONSTRAINTS]| amounts[..system.elements.len()].iter().sum::<f64>();
        let held: f64 = system
            .members
            .iter()
            .map(|s| number(s) * nuclei(&s.content))
            .sum();
        let charges: f64 = system
            .members
            .iter()
            .map(|s| number(s) * s.charge_squared(&system))
            .sum();
        let screening = 4.0 * PI * landau_length(state.temperature) * charges;
        let guess = Guess {
            logarithms: system
                .members
                .iter()
                .map(|member| number(member).ln())
                .collect(),
            rest: vec![(held / nuclei(&system.moles)).ln(), 0.5 * screening.ln()],
        };
        let conditions = Conditions {
            pressure: state.pressure,
            lowering: self.lowering,
        };
        self.newton(system, &guess, conditions).ok()
    }

    fn walk(
        &self,
        from: f64,
        target: f64,
        pressure: f64,
        recipe: Recipe,
    ) -> Result<Solution, Stalled> {
        let conditions = Conditions {
            pressure,
            lowering: self.lowering,
        };
        let system = System::new(self, from, recipe);
        let guess = first_guess(self, &system, conditions);
        let mut here = self.newton(system, &guess, conditions)?;
        let mut ratio = LARGEST_RATIO;
        while (here.system.temperature - target).abs() > f64::EPSILON * target {
            let now = here.system.temperature;
            let next = if target > now {
                target.min(now * ratio)
            } else {
                target.max(now / ratio)
            };
            let foretold = here.foretold(next);
            let system = System::new(self, next, recipe);
            match foretold
                .ok_or(None)
                .and_then(|guess| self.newton(system, &guess, conditions).map_err(Some))
            {
                Ok(there) => here = there,
                Err(stalled) if ratio.sqrt() < SMALLEST_RATIO => {
                    return Err(stalled.unwrap_or_else(Stalled::singular));
                }
                Err(_) => ratio = ratio.sqrt(),
            }
        }
        Ok(here)
    }

    /// Newton's iteration at the temperature of `system`.
    fn newton(
        &self,
        system: System,
        guess: &Guess,
        conditions: Conditions,
    ) -> Result<Solution, Stalled> {
        let basis =
            Basis::most_abundant(&system, &guess.logarithms).ok_or_else(Stalled::singular)?;
        let balance = Balance::new(&system, &basis, conditions);
        let mut unknowns = DVector::zeros(balance.unknowns());
        for (j, component) in basis.components.iter().enumerate() {
            unknowns[j] = guess.logarithms[*component];
        }
        let rest = basis.components.len();
        unknowns
            .iter_mut()
            .skip(rest)
            .zip(&guess.rest)
            .for_each(|(slot, value)| *slot = *value);
        let mut polished = 0;
        for iteration in 0..ITERATIONS {
            let evaluation = balance.evaluate(unknowns.as_slice());
            let value = evaluation.residual.amax();
            polished += usize::from(value < NEAR);
            if polished > POLISH && value <= TOLERANCE {
                return Ok(Solution {
                    pressure: conditions.pressure,
                    unknowns,
                    evaluation,
                    basis,
                    system,
                });
            }
            let step = evaluation.jacobian.clone().lu().solve(&evaluation.residual);
            match step {
                Some(step) if step.amax().is_finite() && iteration + 1 < ITERATIONS => {
                    unknowns -= &step * (LONGEST_STEP / step.amax()).min(1.0);
                }
                _ => {
                    return Err(Stalled {
                        iterations: iteration + 1,
                        residual: balance.name(self, evaluation.residual.iamax()),
                        value,
                    });
                }
            }
        }
        Err(Stalled::singular())
    }
}

impl Stalled {
    /// No independent components, or equations that do not determine the unknowns.
    fn singular() -> Self {
        Self {
            iterations: 0,
            residual: "components".to_owned(),
            value: f64::INFINITY,
        }
    }
}

/// Where Newton's iteration starts.
struct Guess {
    /// ln n of each member.
    logarithms: Vec<f64>,
    /// ln N and ln K.
    rest: Vec<f64>,
}

/// Free atoms with a few electrons.
fn first_guess(mixture: &Mixture, system: &System, conditions: Conditions) -> Guess {
    let all = (conditions.pressure / (BOLTZMANN * system.temperature)).ln();
    let nuclei: f64 = system.moles.iter().sum();
    let electrons = all + START_ELECTRONS.ln();
    let logarithms = system
        .members
        .iter()
        .map(|member| {
            let species = &mixture.species[member.index];
            match (species.kind, species.charge) {
                (Kind::Electron, _) => electrons,
                (Kind::Atom, 0) => {
                    let amounts = member.content.iter().zip(&system.moles);
                    all + (amounts.map(|(nuclei, moles)| nuclei * moles).sum::<f64>() / nuclei).ln()
                }
                _ => f64::NEG_INFINITY,
            }
        })
        .collect();
    let screening = 0.5 * (electrons + (4.0 * PI * landau_length(system.temperature)).ln());
    Guess {
        logarithms,
        rest: vec![all - nuclei.ln(), screening],
    }
}

impl Solution {
    /// du/dT and d ln n/dT at constant pressure and recipe, 1/K.
    pub(super) fn by_temperature(&self) -> Option<(DVector<f64>, Vec<f64>)> {
        let move_ = self
            .evaluation
            .jacobian
            .clone()
            .lu()
            .solve(&self.evaluation.by_temperature)?;
        let unknowns = -move_;
        let logarithms = self.evaluation.answer(&unknowns, 1.0);
        Some((unknowns, logarithms))
    }

    /// d ln n/dx at constant pressure and temperature.
    pub(super) fn by_iron(&self) -> Option<Vec<f64>> {
        let unknowns = -self
            .evaluation
            .jacobian
            .clone()
            .lu()
            .solve(&self.evaluation.by_iron)?;
        Some(self.evaluation.answer(&unknowns, 0.0))
    }

    /// ln n at another temperature by van 't Hoff's law, straight in 1/T.
    fn foretold(&self, temperature: f64) -> Option<Guess> {
        let now = self.system.temperature;
        let (unknowns, logarithms) = self.by_temperature()?;
        let reach = -now * now * (1.0 / temperature - 1.0 / now);
        let shifted = self.evaluation.logarithms.iter().zip(&logarithms);
        let rest = self.basis.components.len();
        Some(Guess {
            logarithms: shifted.map(|(log, slope)| log + reach * slope).collect(),
            rest: (rest..unknowns.len())
                .map(|row| self.unknowns[row] + reach * unknowns[row])
                .collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mixture::Library;

    /// A walk from another first equilibrium ends in the same one, to rounding of logarithms of several hundred.
    #[test]
    fn the_answer_does_not_depend_on_where_the_walk_starts() {
        let library = Library::embedded().unwrap();
        let gas = [("CO".to_owned(), 0.4), ("Ar".to_owned(), 0.6)];
        let mixture = Mixture::new(&library, &gas, true).unwrap();
        let recipe = Recipe {
            gas: 0.8,
            iron: 0.2,
        };
        for target in [300.0, 1200.0, 4000.0, 9000.0, 16_000.0, 30_000.0] {
            let walk = |from: f64| {
                mixture
                    .walk(from, target, 1e5, recipe)
                    .ok()
                    .unwrap()
                    .evaluation
                    .logarithms
            };
            let expected = walk(START_TEMPERATURE);
            for from in [6000.0, 14_000.0, 25_000.0] {
                for (a, b) in walk(from).iter().zip(&expected) {
                    assert!(
                        (a - b).abs() < 1e-14 * a.abs().max(100.0),
                        "{target} K from {from} K: {a} {b}"
                    );
                }
            }
        }
    }

    /// What was found is found again without a walk.
    #[test]
    fn states_are_taken_up_again() {
        let library = Library::embedded().unwrap();
        let mixture = Mixture::new(&library, &[("CO2".to_owned(), 1.0)], true).unwrap();
        for (t, x) in [(300.0, 0.5), (2500.0, 0.01), (8000.0, 0.3), (30_000.0, 0.9)] {
            let state = mixture.equilibrium(t, 1e5, x).unwrap();
            let recipe = Recipe {
                gas: 1.0 - x,
                iron: x,
            };
            let again = mixture.again(&state, recipe).unwrap();
            for (member, log) in again
                .system
                .members
                .iter()
                .zip(&again.evaluation.logarithms)
            {
                let number = state.number[member.index];
                assert!(
                    (log.exp() - number).abs() <= 1e-11 * number,
                    "{t} K: {number}"
                );
            }
        }
    }
}
