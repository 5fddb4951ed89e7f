//! One step of the liquid in time.
//!
//! The two stages of Alexander (1977), each of length `tau = g dt`, `g = 1 - 1/sqrt 2`: of second order, and what a step does
//! not resolve dies away (L-stable), while an oscillation keeps its amplitude to `0.0037 (omega dt)^4` a step.
//!
//! A stage moves the liquid from `(x-, u-)`, where rates of the stage before have brought it, to
//! `x = x- + tau w`, `u = u- + tau (-grad p/rho + nu div grad u + g + ((w - u) . grad) u)` with `div u = 0` (2.38 to 2.50,
//! Matsuzawa 2017). Points inside move with the liquid, w = u, or follow the surface ([`super::follow`]); those of the surface move along
//! its normal, w = (u . n) n.
//!
//! What divergence fits leave is not taken away at once but by the share `CLEANED` in each stage: divergence and gradient of
//! one-sided fits are no pair, and taking away all of it amplifies what they leave near the surface.

use krylov::{Anderson, Rule};
use rayon::prelude::*;
use run::Failure;
use wls::Stencils;

use super::drift;
use super::effort::{Effort, failed};
use super::friction::{Friction, stretch};
use super::operators::{derivatives, divergence, operators, stretching};
use super::pressure::{Conditions, Equations, bending};
use super::surface::{Patch, patches};
use super::vector::{along, difference, dot};

pub use super::matter::{Matter, Way};

/// g of the stages.
pub(super) const PART: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
/// Share of the divergence that a stage takes away.
const CLEANED: f64 = 0.3;
/// Rounds of pressure and friction at most, and those that are remembered.
const ROUNDS: usize = 40;
const WINDOW: usize = 8;
/// Change of the normal stress that ends them, over the pressure.
const SETTLED: f64 = 1e-7;

/// Points of the liquid, those of the surface first, and what they carry.
#[derive(Debug, Clone, PartialEq)]
pub struct Liquid<const D: usize> {
    /// Places \[m\].
    pub position: Vec<[f64; D]>,
    /// Velocity \[m/s\].
    pub velocity: Vec<[f64; D]>,
    /// Pressure \[Pa\].
    pub pressure: Vec<f64>,
    /// Rate of the velocity of each point along its way, in the last stage \[m/s2\].
    pub rate: Vec<[f64; D]>,
    /// Velocities of points that follow the surface, in the last stage; nothing where those inside go with the liquid \[m/s\].
    pub follow: Vec<[f64; D]>,
    /// Unit normals of the points of the surface.
    pub normal: Vec<[f64; D]>,
    /// Normal stress of friction on the surface, and what friction adds to its tension within a stage \[Pa\].
    pub stress: Vec<f64>,
    /// Traction of fields on the surface, outward, and how fast it changes \[Pa, Pa/s\]; none where there is no field.
    pub pull: [Vec<f64>; 2],
    /// Traction of a field along the surface \[Pa\]; nothing where there is none.
    pub drag: Vec<[f64; D]>,
    /// Force density of fields beside that traction, which stirs alone (see [`super::stirred`]), by point, and how fast it
    /// changes \[N/m3, N/(m3 s)\]; none where there is none.
    pub force: [Vec<[f64; D]>; 2],
}

/// Where a stage begins, and how long it is.
struct Base<const D: usize> {
    position: Vec<[f64; D]>,
    velocity: Vec<[f64; D]>,
    tau: f64,
    /// Traction of fields at the end of the stage \[Pa\].
    pull: Vec<f64>,
    /// Acceleration by their force then \[m/s2\]; nothing where there is none.
    pushed: Vec<[f64; D]>,
}

impl<const D: usize> Base<D> {
    /// Velocities at the end of the stage without pressure and friction.
    fn freed(&self, matter: &Matter<D>, drift: &[[f64; D]]) -> Vec<[f64; D]> {
        let mut free: Vec<[f64; D]> = (self.velocity.iter().zip(drift))
            .map(|(u, drift)| along(u, self.tau, &along(&matter.gravity, 1.0, drift)))
            .collect();
        for (free, own) in free.iter_mut().zip(&self.pushed) {
            *free = along(free, self.tau, own);
        }
        free
    }
}

/// What a stage leaves for what follows it.
pub struct Ended<const D: usize> {
    /// Velocity at which the points have moved \[m/s\].
    pub moved: Vec<[f64; D]>,
    /// The surface.
    pub patches: Vec<Patch<D>>,
    /// Rows of derivatives.
    pub rows: Stencils<D>,
}

/// What the rounds of a stage share.
struct Rounds<'a, const D: usize> {
    matter: &'a Matter<D>,
    patches: &'a [Patch<D>],
    rows: &'a Stencils<D>,
    tau: f64,
    rule: Rule<'a>,
}

impl<const D: usize> Liquid<D> {
    /// Number of points on the surface.
    #[must_use]
    pub fn surface(&self) -> usize {
        self.normal.len()
    }

    /// The middle of the points of the surface \[m\].
    #[must_use]
    pub fn middle(&self) -> [f64; D] {
        let share = (self.surface() as f64).recip();
        let surface = self.position[..self.surface()].iter();
        surface.fold([0.0; D], |sum, x| along(&sum, share, x))
    }

    /// Takes a step of `dt` \[s\].
    ///
    /// # Errors
    /// Where fits or equations cannot be made.
    pub fn advance(
        &mut self,
        matter: &Matter<D>,
        (way, dt): (&Way, f64),
        effort: &mut Effort,
    ) -> Result<Ended<D>, Failure> {
        let tau = PART * dt;
        let base = Base {
            position: self.position.clone(),
            velocity: self.velocity.clone(),
            tau,
            pull: self.pulled(tau),
            pushed: self.pushed(matter, tau),
        };
        let first = self.stage(matter, way, &base, effort)?;
        // The rates of the first stage act for what is left of the step.
        let rest = dt - tau;
        let base = Base {
            position: stepped(&base.position, rest, &first.moved),
            velocity: stepped(&base.velocity, rest, &self.rate),
            tau,
            pull: self.pulled(dt),
            pushed: self.pushed(matter, dt),
        };
        drop(first);
        self.stage(matter, way, &base, effort)
    }

    /// The pressure of the liquid as it is, and the rates that go with it; gives its surface.
    ///
    /// # Errors
    /// Where fits or equations cannot be made.
    pub fn balance(
        &mut self,
        matter: &Matter<D>,
        way: &Way,
        effort: &mut Effort,
    ) -> Result<Vec<Patch<D>>, Failure> {
        let (n, surface) = (self.position.len(), self.surface());
        let how = (way.spacing, way.order);
        let rows = operators(&self.position, how).map_err(|e| failed(&e))?;
        let made = patches(&self.position[..surface], &self.normal, way.spacing);
        let patches = made.map_err(|e| failed(&e))?;
        self.normal = patches.iter().map(|p| p.normal).collect();
        let drawn = 2.0 * matter.viscosity.unwrap_or(0.0);
        let pushed = self.pushed(matter, 0.0);
        let right: Vec<f64> = (0..n)
            .map(|i| match patches.get(i) {
                Some(patch) => {
                    let stress = drawn * stretch(patch, &self.velocity);
                    matter.gas + matter.tension * patch.curvature + stress
                        - self.pull[0].get(i).copied().unwrap_or(0.0)
                }
                None => -matter.density * stretching(&rows, &self.velocity, i),
            })
            .collect();
        let conditions = Conditions {
            rows: &rows,
            patches: &patches,
            spacing: way.spacing,
            stiffness: 0.0,
        };
        let mut equations = Equations::new(conditions, n).map_err(|e| failed(&e))?;
        effort.add(&equations.solve(&right, &mut self.pressure, way.rule()))?;
        let push = -matter.density.recip();
        self.rate = (0..n)
            .map(|i| along(&matter.gravity, push, &rows.gradient_of(&self.pressure, i)))
            .collect();
        for (rate, own) in self.rate.iter_mut().zip(&pushed) {
            *rate = along(rate, 1.0, own);
        }
        Ok(patches)
    }

    fn stage(
        &mut self,
        matter: &Matter<D>,
        way: &Way,
        base: &Base<D>,
        effort: &mut Effort,
    ) -> Result<Ended<D>, Failure> {
        let (n, surface, tau) = (base.position.len(), self.surface(), base.tau);
        let guess = stepped(&base.velocity, tau, &self.rate);
        let goes = self.moved(&guess);
        let place = stepped(&base.position, tau, &goes);
        let follows = !self.follow.is_empty();
        let rows = derivatives(&place, (way.spacing, way.order), follows);
        let rows = rows.map_err(|e| failed(&e))?;
        let patches =
            patches(&place[..surface], &self.normal, way.spacing).map_err(|e| failed(&e))?;
        let drift = self.drift((&guess, &goes), (&rows, &patches), way.spacing);
        let free = base.freed(matter, &drift);
        let right = right(matter, base, [&place, &free, &guess], (&rows, &patches));
        let conditions = Conditions {
            rows: &rows,
            patches: &patches,
            spacing: way.spacing,
            stiffness: matter.tension * tau * tau / matter.density,
        };
        let mut equations = Equations::new(conditions, n).map_err(|e| failed(&e))?;
        let rounds = Rounds {
            matter,
            patches: &patches,
            rows: &rows,
            tau,
            rule: way.rule(),
        };
        if let Some(viscosity) = matter.viscosity {
            let diffusion = tau * viscosity / matter.density;
            let how = (way.spacing, way.order);
            let friction = Friction::new(&place, (&rows, &patches), how, diffusion);
            let mut friction = friction.map_err(|e| failed(&e))?;
            self.velocity = guess;
            self.rub(
                &rounds,
                (&mut equations, &mut friction),
                (&free, right),
                effort,
            )?;
        } else {
            effort.add(&equations.solve(&right, &mut self.pressure, rounds.rule))?;
            self.velocity = rounds.pushed(&free, &self.pressure);
        }
        self.rate = (0..n)
            .map(|i| difference(&self.velocity[i], &base.velocity[i]).map(|d| d / tau))
            .collect();
        self.normal = patches.iter().map(|p| p.normal).collect();
        let moved = self.moved(&self.velocity);
        self.position = stepped(&base.position, tau, &moved);
        if follows {
            let how = (way.spacing, way.rule());
            self.follow_surface(&rows, &moved[..surface], how, effort)?;
        }
        Ok(Ended {
            moved,
            patches,
            rows,
        })
    }

    /// What a liquid that moves at u brings to points that move at w \[m/s2\].
    fn drift(
        &self,
        (u, w): (&[[f64; D]], &[[f64; D]]),
        (rows, patches): (&Stencils<D>, &[Patch<D>]),
        spacing: f64,
    ) -> Vec<[f64; D]> {
        let back = |i: usize| difference(&w[i], &u[i]);
        let mut drift = drift::along_surface(patches, u, back);
        if !self.follow.is_empty() {
            drift.extend(drift::inside(rows, u, back, (patches.len(), spacing)));
        }
        drift.resize(u.len(), [0.0; D]);
        drift
    }

    /// Pressure and friction in turn, until the normal stress of friction on the surface is that of the velocity.
    fn rub(
        &mut self,
        rounds: &Rounds<'_, D>,
        (equations, friction): (&mut Equations<'_, D>, &mut Friction),
        (free, right): (&[[f64; D]], Vec<f64>),
        effort: &mut Effort,
    ) -> Result<(), Failure> {
        let (matter, surface) = (rounds.matter, rounds.patches.len());
        let viscosity = matter.viscosity.unwrap_or(0.0);
        let mut anderson = Anderson::new(WINDOW);
        for _ in 0..ROUNDS {
            let mut with = right.clone();
            for (r, s) in with.iter_mut().zip(&self.stress) {
                *r += s;
            }
            effort.add(&equations.solve(&with, &mut self.pressure, rounds.rule))?;
            let mut pushed = rounds.pushed(free, &self.pressure);
            if !self.drag.is_empty() {
                friction.drag(&mut pushed, |i| self.drag[i].map(|t| t / viscosity));
            }
            effort.add(&friction.solve(&pushed, &mut self.velocity, rounds.rule))?;
            let slid: Vec<f64> = (0..surface)
                .map(|s| {
                    let more = difference(&self.velocity[s], &pushed[s]);
                    rounds.tau * dot(&rounds.patches[s].normal, &more)
                })
                .collect();
            let mut found: Vec<f64> = (0..surface)
                .map(|s| {
                    let bent = bending(&rounds.patches[s], s, |j| slid[j]);
                    2.0 * viscosity * stretch(&rounds.patches[s], &self.velocity)
                        + matter.tension * bent
                })
                .collect();
            let lack: Vec<f64> = found.iter().zip(&self.stress).map(|(a, b)| a - b).collect();
            let size = norm(&lack);
            let whole = norm(&found) + norm(&right[..surface]);
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
    fn pushed(&self, free: &[[f64; D]], pressure: &[f64]) -> Vec<[f64; D]> {
        let push = -self.tau / self.matter.density;
        (0..free.len())
            .into_par_iter()
            .map(|i| along(&free[i], push, &self.rows.gradient_of(pressure, i)))
            .collect()
    }
}

/// The right sides of the pressure: see [`super::pressure`].
fn right<const D: usize>(
    matter: &Matter<D>,
    base: &Base<D>,
    [place, free, guess]: [&[[f64; D]]; 3],
    (rows, patches): (&Stencils<D>, &[Patch<D>]),
) -> Vec<f64> {
    let ahead = |i: usize| {
        let end = along(&base.position[i], base.tau, &free[i]);
        dot(&patches[i].normal, &difference(&end, &place[i]))
    };
    let source = matter.density / base.tau;
    (0..place.len())
        .into_par_iter()
        .map(|i| match patches.get(i) {
            Some(patch) => {
                matter.gas + matter.tension * (patch.curvature + bending(patch, i, ahead))
                    - base.pull.get(i).copied().unwrap_or(0.0)
            }
            None => {
                CLEANED * source * divergence(rows, free, i)
                    - (1.0 - CLEANED) * matter.density * stretching(rows, guess, i)
            }
        })
        .collect()
}

/// `x + time v`, point by point.
fn stepped<const D: usize>(x: &[[f64; D]], time: f64, v: &[[f64; D]]) -> Vec<[f64; D]> {
    x.iter().zip(v).map(|(x, v)| along(x, time, v)).collect()
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}
