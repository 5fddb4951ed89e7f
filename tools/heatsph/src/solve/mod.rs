//! Linear and Newton solves of `shift C (T - T0) = W(T)`, or `shift (E(T) - E0) = W(T)` where heat is what is stored.
//!
//! A stage of the implicit march has a shift of one over its step; the steady state has none.

mod near;
mod point;

use krylov::{Aggregation, Jacobi, Rule, Scratch, Sparse, conjugate_gradient, gmres};
use rayon::prelude::*;
use run::property::OutOfRange;

use self::near::Near;
use self::point::Own;
use crate::system::storage::Storage;
use crate::system::{Rates, System};

/// Own part of the diagonal above which its inverse alone is a good preconditioner: a hierarchy of grids costs as
/// much as some sixty products before it is used.
const DOMINANT: f64 = 0.003;
/// Columns of GMRES between restarts.
const RESTART: usize = 40;
/// Most products of a linear solve: 500 of its steps, and one for the first residual.
const PRODUCTS: usize = 501;
/// Roundings in the heat of a point, on average.
const ROUNDING: f64 = 2.0;
/// Part of the residual that a step with an older matrix may leave before the matrix is taken anew.
const LED: f64 = 0.2;
/// Reduction of the residual in the filter of an estimate.
const FILTER: f64 = 1e-2;
/// Halvings of a Newton step.
const HALVINGS: usize = 12;
/// Points that one task moves.
const POINTS: usize = 256;

/// Why a solve failed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// A property has no value.
    #[error(transparent)]
    Property(#[from] OutOfRange),
    /// The linear solver failed.
    #[error(transparent)]
    Linear(#[from] krylov::Error),
    /// Newton's method did not converge.
    #[error(
        "Newton's method stands at a residual of {residual:.1e} of the heat that passes after {steps} steps"
    )]
    NotConverged {
        /// Residual over the heat that passes.
        residual: f64,
        /// Steps done.
        steps: usize,
    },
}

/// What is to be solved.
#[derive(Debug, Clone, Copy)]
pub struct Problem<'a> {
    /// One over a time \[1/s\]; 0 for the steady state.
    pub shift: f64,
    /// T0 \[K\], or E0 \[J\] where capacities depend on temperature.
    pub from: &'a [f64],
    /// Time at which properties are taken \[s\].
    pub time: f64,
}

/// When a solve is done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goal {
    /// Largest residual over the heat that passes.
    pub residual: f64,
    /// Most Newton steps.
    pub steps: usize,
}

/// How a solve went.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effort {
    /// Newton steps.
    pub newton: usize,
    /// Iterations of the linear solver.
    pub iterations: usize,
    /// Residual over the heat that passes.
    pub residual: f64,
}

/// Norms over all free points \[W\].
#[derive(Debug, Clone, Copy, Default)]
struct Norm {
    residual: f64,
    /// Heat that passes.
    passing: f64,
    /// What rounding may leave of a residual.
    rounding: f64,
}

/// What the matrix is good for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Hold {
    /// Nothing: it is that of another step, or of none.
    Nothing,
    /// To filter with, but Newton's method asks for a newer one.
    Filter,
    /// All.
    Newton,
}

/// Matrix, preconditioner and scratch columns, kept between solves.
#[derive(Debug)]
pub struct Solver {
    matrix: Sparse,
    hold: Hold,
    near: Near,
    scratch: Scratch<f64>,
    symmetric: bool,
    /// Conductivity of each point where the unknown is Kirchhoff's transform, with which the matrix is symmetric.
    scale: Vec<f64>,
    residual: Vec<f64>,
    change: Vec<f64>,
    trial: Vec<f64>,
}

impl Solver {
    /// A solver for a system.
    #[must_use]
    pub fn new(system: &System) -> Self {
        Self {
            matrix: system.matrix(),
            hold: Hold::Nothing,
            near: Near::Nothing,
            scratch: Scratch::default(),
            symmetric: system.conduction().is_symmetric(),
            scale: Vec::new(),
            residual: Vec::new(),
            change: Vec::new(),
            trial: Vec::new(),
        }
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let matrix = 8 * (self.matrix.values().len() + self.matrix.diagonal().len());
        let near = match &self.near {
            Near::Grid(grid) => grid.bytes(),
            _ => 0,
        };
        (matrix + near) as u64
    }

    /// Takes the matrix of a problem at `rates`, and what it is preconditioned with.
    fn linearise(
        &mut self,
        system: &System,
        problem: Problem<'_>,
        temperature: &[f64],
        rates: &Rates,
    ) -> Result<(), SolveError> {
        let (shift, time) = (problem.shift, problem.time);
        system.fill(&mut self.matrix, shift, time, temperature, rates)?;
        system.scale(rates, &mut self.scale);
        let scale = |i: usize| self.scale.get(i).copied().unwrap_or(1.0);
        let dominance = |i: usize| {
            problem.shift * system.storage.capacity(i, temperature[i])
                / (scale(i) * self.matrix.diagonal()[i])
        };
        let least = (0..system.len())
            .filter(|i| !system.is_held(*i))
            .map(dominance)
            .fold(f64::INFINITY, f64::min);
        self.near = if least > DOMINANT {
            Near::Diagonal(Jacobi::new(&self.matrix)?)
        } else {
            match std::mem::replace(&mut self.near, Near::Nothing) {
                Near::Grid(mut grid) => {
                    grid.renew(&self.matrix)?;
                    Near::Grid(grid)
                }
                _ => Near::Grid(Box::new(Aggregation::new(&self.matrix, self.symmetric)?)),
            }
        };
        self.hold = Hold::Newton;
        Ok(())
    }

    /// Forgets matrix and preconditioner, so that what follows does not depend on what came before; to be called
    /// between problems of unlike shift.
    pub fn forget(&mut self) {
        self.hold = Hold::Nothing;
        self.near = Near::Nothing;
    }

    /// `matrix x = rhs` from a first guess of zero; gives the iterations.
    fn linear(&mut self, rhs: &[f64], reduction: f64) -> Result<usize, SolveError> {
        self.change.clear();
        self.change.resize(rhs.len(), 0.0);
        let (matrix, change, near) = (&self.matrix, &mut self.change, &mut self.near);
        let scratch = &mut self.scratch;
        let solved = if self.symmetric {
            let rule = Rule::to(reduction, PRODUCTS);
            conjugate_gradient(matrix, rhs, change, near, rule, scratch)
        } else {
            // Each cycle ends with a residual.
            let rule = Rule::to(reduction, PRODUCTS + PRODUCTS / RESTART).restarted(RESTART);
            gmres(matrix, rhs, change, near, rule, scratch)
        };
        let steps = solved.sound()?.steps;
        for (change, k) in self.change.iter_mut().zip(&self.scale) {
            *change /= k;
        }
        Ok(steps)
    }

    /// Filters `values` \[W\] by the matrix of the last solve: what a stiff part would become within its step. A solve
    /// that had nothing to do has left none; it is then taken at `temperature` and `rates`, which it ended with.
    ///
    /// # Errors
    /// As the linear solver.
    pub fn filter(
        &mut self,
        system: &System,
        problem: Problem<'_>,
        temperature: &[f64],
        rates: &Rates,
        values: &[f64],
    ) -> Result<&[f64], SolveError> {
        if self.hold == Hold::Nothing {
            self.linearise(system, problem, temperature, rates)?;
        }
        self.linear(values, FILTER)?;
        Ok(&self.change)
    }

    /// Residual `W - shift C (T - T0)` of free points; gives its norm.
    fn weigh(
        &mut self,
        system: &System,
        problem: Problem<'_>,
        temperature: &[f64],
        rates: &Rates,
    ) -> Norm {
        self.residual.resize(system.len(), 0.0);
        let mut norm = Norm::default();
        for (i, residual) in self.residual.iter_mut().enumerate() {
            if system.is_held(i) {
                *residual = 0.0;
                continue;
            }
            let (shift, stored) = match &system.storage {
                Storage::Fixed(capacity) => {
                    let shift = problem.shift * capacity[i];
                    (shift, shift * (temperature[i] - problem.from[i]))
                }
                Storage::Varies(content) => {
                    let (capacity, heat) = content.at(i, temperature[i]);
                    let stored = problem.shift * (heat - problem.from[i]);
                    (problem.shift * capacity, stored)
                }
            };
            *residual = rates.heat[i] - stored;
            norm.residual += *residual * *residual;
            norm.passing += stored * stored;
            let gross = (rates.stiffness[i] + shift) * temperature[i];
            norm.rounding += gross * gross;
        }
        for entry in &rates.entries {
            norm.passing += entry * entry;
        }
        norm.passing += rates.source * rates.source;
        Norm {
            residual: norm.residual.sqrt(),
            passing: norm.passing.sqrt(),
            rounding: ROUNDING * f64::EPSILON * norm.rounding.sqrt(),
        }
    }

    /// Solves a problem; `temperature` is the first guess and becomes the solution, `rates` are those of it.
    /// The temperatures of held points must stand.
    ///
    /// The matrix of one Newton step serves the next ones, and those of the next problem of the same shift, as long
    /// as they lead well (the stages of a singly diagonally implicit method are made for it: Alexander 1977).
    ///
    /// # Errors
    /// [`SolveError`].
    pub fn newton(
        &mut self,
        system: &System,
        problem: Problem<'_>,
        temperature: &mut Vec<f64>,
        rates: &mut Rates,
        goal: Goal,
    ) -> Result<Effort, SolveError> {
        let mut effort = Effort::default();
        system.rates(problem.time, temperature, rates)?;
        let mut norm = self.weigh(system, problem, temperature, rates);
        // The heat that passed at the start stands for scenes in which nothing passes at the end.
        let first = norm.residual;
        // A far guess has much; what counts is then what the solution's own temperatures could pass.
        let own =
            |norm: &Norm| (1e-6 / (ROUNDING * f64::EPSILON) * norm.rounding).min(1e-3 * first);
        let scale = |norm: &Norm| norm.passing.max(own(norm)).max(f64::MIN_POSITIVE);
        let least = if system.is_linear() { 1e-14 } else { 1e-4 };
        for _ in 0..goal.steps {
            effort.residual = norm.residual / scale(&norm);
            let wanted = (goal.residual * scale(&norm)).max(norm.rounding);
            if norm.residual <= wanted {
                return Ok(effort);
            }
            let fresh = self.hold != Hold::Newton;
            if fresh {
                self.linearise(system, problem, temperature, rates)?;
            }
            let reduction = (0.1 * wanted / norm.residual).clamp(least, 0.1);
            let right = std::mem::take(&mut self.residual);
            let solved = self.linear(&right, reduction);
            self.residual = right;
            effort.iterations += solved?;
            effort.newton += 1;
            let before = norm.residual;
            norm = self.step(system, problem, temperature, rates, before)?;
            if norm.residual > LED * before {
                self.hold = Hold::Filter;
            }
            if fresh && norm.residual >= before * (1.0 - 1e-12) {
                break;
            }
        }
        effort.residual = norm.residual / scale(&norm);
        // What rounding leaves is no failure.
        let wanted = goal.residual.max(1e-9) * scale(&norm);
        if norm.residual <= wanted.max(10.0 * norm.rounding) {
            Ok(effort)
        } else {
            Err(SolveError::NotConverged {
                residual: effort.residual,
                steps: effort.newton,
            })
        }
    }

    /// A Newton step, halved until the residual falls (Armijo 1966).
    fn step(
        &mut self,
        system: &System,
        problem: Problem<'_>,
        temperature: &mut Vec<f64>,
        rates: &mut Rates,
        norm: f64,
    ) -> Result<Norm, SolveError> {
        let mut length = 1.0;
        let varies = system.storage.varies().is_some();
        let stiffness = if varies {
            rates.stiffness.clone()
        } else {
            Vec::new()
        };
        let own = Own {
            shift: problem.shift,
            stiffness: &stiffness,
        };
        for _ in 0..=HALVINGS {
            let each = temperature.par_iter().zip(&self.change).enumerate();
            let to = |(i, (t, change)): (usize, (&f64, &f64))| {
                let change = length * change;
                if system.is_held(i) || change == 0.0 {
                    *t
                } else {
                    own.moved(system, i, *t, change)
                }
            };
            each.with_min_len(POINTS)
                .map(to)
                .collect_into_vec(&mut self.trial);
            let trial = std::mem::take(&mut self.trial);
            let evaluated = system.rates(problem.time, &trial, rates);
            let weighed = evaluated.map(|()| self.weigh(system, problem, &trial, rates));
            self.trial = trial;
            match weighed {
                Ok(new) if new.residual <= (1.0 - 1e-4 * length) * norm => {
                    std::mem::swap(temperature, &mut self.trial);
                    return Ok(new);
                }
                Err(error) if length < 1e-3 => return Err(error.into()),
                _ => length *= 0.5,
            }
        }
        // Nothing better was found: stay.
        system.rates(problem.time, temperature, rates)?;
        Ok(self.weigh(system, problem, temperature, rates))
    }
}
