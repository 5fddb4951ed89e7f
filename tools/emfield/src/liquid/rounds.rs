//! Pressure and friction of a stage in turn.

use krylov::{Anderson, System};
use rayon::prelude::*;
use run::Failure;
use wls::Stencils;

use super::effort::{Effort, failed};
use super::friction::{Friction, Ground, stretch};
use super::matter::{Matter, Way};
use super::operators::divergence;
use super::points::Liquid;
use super::pressure::{Conditions, Equations, bending};
use super::room::images::Images;
use super::surface::Patch;
use super::vector::{along, difference, dot};

/// Rounds at most, and those that are remembered.
const ROUNDS: usize = 40;
const WINDOW: usize = 8;
/// Change of the normal stress that ends them, over the pressure.
const SETTLED: f64 = 1e-7;

/// What the rounds of a stage share.
pub(super) struct Rounds<'a, const D: usize> {
    pub(super) matter: &'a Matter<D>,
    /// Points with their images behind them.
    pub(super) place: &'a [[f64; D]],
    pub(super) patches: &'a [Patch<D>],
    pub(super) rows: &'a Stencils<D>,
    pub(super) images: &'a Images<D>,
    pub(super) tau: f64,
    pub(super) way: &'a Way,
}

/// Factors of the pressure and of friction: those of the first stage of a step serve the second where rows are near, as they are
/// where points take their fits with them ([`super::borne`]).
#[derive(Default)]
pub(super) struct Factors {
    pressure: Option<System<f64, f64>>,
    friction: Option<System<f64, f64>>,
}

/// Equations of the pressure and of friction.
struct Pair<'a, 'b, const D: usize> {
    equations: &'a mut Equations<'b, D>,
    friction: &'a mut Friction,
}

impl<const D: usize> Liquid<D> {
    /// What pressure and friction do to velocities `free` of both; the velocity is what comes of it, about.
    pub(super) fn push(
        &mut self,
        rounds: &Rounds<'_, D>,
        free: &[[f64; D]],
        right: &[f64],
        factors: &mut Factors,
        effort: &mut Effort,
    ) -> Result<(), Failure> {
        let (matter, tau) = (rounds.matter, rounds.tau);
        let held = self.room.held.clone();
        let conditions = Conditions {
            rows: rounds.rows,
            patches: rounds.patches,
            spacing: rounds.way.spacing,
            stiffness: matter.tension * tau * tau / matter.density,
            images: rounds.images,
            held: &held,
            fall: self.room.borne(&matter.gravity).map(|g| g * tau * tau),
        };
        let nearby = factors.pressure.take();
        let equations = Equations::served(conditions, rounds.images.own(), nearby);
        let mut equations = equations.map_err(|e| failed(&e))?;
        let Some(viscosity) = matter.viscosity else {
            effort.add(&equations.solve(right, &mut self.pressure, rounds.way.rule()))?;
            self.velocity = rounds.pushed(free, &self.pressure);
            factors.pressure = Some(equations.into_system());
            return Ok(());
        };
        let ground = Ground {
            inside: rounds.rows,
            patches: rounds.patches,
            images: rounds.images,
            held: held.len(),
            through: self.fits(false).through,
        };
        let diffusion = tau * viscosity / matter.density;
        let nearby = factors.friction.take();
        let friction = Friction::new(rounds.place, ground, rounds.way, diffusion, nearby);
        let mut friction = friction.map_err(|e| failed(&e))?;
        let mut pair = Pair {
            equations: &mut equations,
            friction: &mut friction,
        };
        self.rub(rounds, &mut pair, free, right, effort)?;
        factors.pressure = Some(equations.into_system());
        factors.friction = Some(friction.into_system());
        Ok(())
    }

    /// Pressure and friction in turn, until the normal stress of friction on the surface, and on walls what it adds to the slope
    /// of the pressure, is that of the velocity.
    fn rub(
        &mut self,
        rounds: &Rounds<'_, D>,
        pair: &mut Pair<'_, '_, D>,
        free: &[[f64; D]],
        right: &[f64],
        effort: &mut Effort,
    ) -> Result<(), Failure> {
        let (matter, surface) = (rounds.matter, rounds.patches.len());
        let rule = rounds.way.rule();
        let viscosity = matter.viscosity.unwrap_or(0.0);
        let walls = self.walls();
        let mut anderson = Anderson::new(WINDOW);
        for _ in 0..ROUNDS {
            let mut with = right.to_vec();
            for (r, s) in with.iter_mut().zip(&self.stress) {
                *r += s;
            }
            effort.add(&pair.equations.solve(&with, &mut self.pressure, rule))?;
            let mut pushed = rounds.pushed(free, &self.pressure);
            pushed[walls.clone()].copy_from_slice(&self.velocity[walls.clone()]);
            if !self.drag.is_empty() {
                pair.friction
                    .drag(&mut pushed, |i| self.drag[i].map(|t| t / viscosity));
            }
            effort.add(&pair.friction.solve(&pushed, &mut self.velocity, rule))?;
            let slid: Vec<f64> = (0..surface)
                .map(|s| {
                    let more = difference(&self.velocity[s], &pushed[s]);
                    rounds.tau * dot(&rounds.patches[s].normal, &more)
                })
                .collect();
            let wide = rounds.images.vectors(&self.velocity);
            let mut found: Vec<f64> = (0..surface)
                .map(|s| {
                    let bent = bending(&rounds.patches[s], s, |j| slid[rounds.images.origin(j)]);
                    2.0 * viscosity * stretch(&rounds.patches[s], &wide) + matter.tension * bent
                })
                .collect();
            let mut whole = norm(&found) + norm(&right[..surface]);
            if !walls.is_empty() {
                found.extend(rounds.rubbed(&wide, &self.room.held));
                let speed = norm(self.velocity.as_flattened());
                whole += norm(&right[walls.clone()]) + viscosity / rounds.way.spacing * speed;
            }
            let lack: Vec<f64> = found.iter().zip(&self.stress).map(|(a, b)| a - b).collect();
            let size = norm(&lack);
            anderson.next(&mut found, &lack);
            self.stress = found;
            if size <= SETTLED * whole {
                return Ok(());
            }
        }
        effort.unsettled += 1;
        Ok(())
    }
}

impl<const D: usize> Rounds<'_, D> {
    /// `u* - tau/rho grad p`.
    pub(super) fn pushed(&self, free: &[[f64; D]], pressure: &[f64]) -> Vec<[f64; D]> {
        let push = -self.tau / self.matter.density;
        let pressure = self.images.scalars(pressure);
        (0..free.len())
            .into_par_iter()
            .map(|i| along(&free[i], push, &self.rows.gradient_of(&pressure, i)))
            .collect()
    }

    /// `h mu n . (div grad u - grad div u)` on walls \[Pa\]; `velocity` has its images behind it.
    fn rubbed(&self, velocity: &[[f64; D]], held: &[[f64; D]]) -> Vec<f64> {
        let sources: Vec<f64> = (0..self.images.own())
            .into_par_iter()
            .map(|i| divergence(self.rows, velocity, i))
            .collect();
        let sources = self.images.scalars(&sources);
        let scale = self.way.spacing * self.matter.viscosity.unwrap_or(0.0);
        let at = |(k, normal): (usize, &[f64; D])| {
            let i = self.patches.len() + k;
            let laplacian = self.rows.laplacian(i);
            let spread: [f64; D] =
                std::array::from_fn(|c| laplacian.apply_with(|j| velocity[j][c]));
            let rise = self.rows.gradient_of(&sources, i);
            scale * dot(normal, &difference(&spread, &rise))
        };
        held.iter().enumerate().map(at).collect()
    }
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}
