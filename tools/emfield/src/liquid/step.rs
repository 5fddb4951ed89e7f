//! One step of the liquid in time.
//!
//! The two stages of Alexander (1977), each of length `tau = g dt`, `g = 1 - 1/sqrt 2`: of second order, and what a step does
//! not resolve dies away (L-stable), while an oscillation keeps its amplitude to `0.0037 (omega dt)^4` a step.
//!
//! A stage moves the liquid from `(x-, u-)`, where rates of the stage before have brought it, to
//! `x = x- + tau w`, `u = u- + tau (-grad p/rho + nu div grad u + g + ((w - u) . grad) u)` with `div u = 0` (2.38 to 2.50,
//! Matsuzawa 2017). Points move with the liquid, w = u. Where a force stirs it those inside follow the surface
//! ([`super::follow`]), and where there is a stream along a surface that stays its points move along its normal, w = (u . n) n.
//!
//! What divergence fits leave is not taken away at once but by the share `CLEANED` in each stage: divergence and gradient of
//! one-sided fits are no pair, and taking away all of it amplifies what they leave near the surface. Between faces all of it
//! goes, as the values of fits that do not pass through their points have it: they know no waves as short as the spacing,
//! which are what grows.

use std::borrow::Cow;

use rayon::prelude::*;
use run::Failure;
use wls::Stencils;

use super::drift::{self, Fitted};
use super::effort::{Effort, failed};
use super::friction::stretch;
use super::operators::{Fits, Points, derivatives, divergence, stretching, values};
use super::pressure::{Conditions, Equations, bending};
use super::room::images::Images;
use super::rounds::{Factors, Rounds};
use super::surface::{Bare, Patch, Sheet, beside};
use super::vector::{along, difference, dot};

pub use super::matter::{Matter, Step, Way};
pub use super::points::Liquid;

/// g of the stages.
pub(super) const PART: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
/// Share of the divergence that a stage takes away.
const CLEANED: f64 = 0.3;

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
    fn freed(&self, gravity: &[f64; D], drift: &[[f64; D]]) -> Vec<[f64; D]> {
        let mut free: Vec<[f64; D]> = (self.velocity.iter().zip(drift))
            .map(|(u, drift)| along(u, self.tau, &along(gravity, 1.0, drift)))
            .collect();
        for (free, own) in free.iter_mut().zip(&self.pushed) {
            *free = along(free, self.tau, own);
        }
        free
    }
}

/// Where the points of a stage come to lie, about, and what is fitted there.
struct There<'a, const D: usize> {
    base: &'a Base<D>,
    place: &'a [[f64; D]],
    /// Velocities that are expected, with those of images behind them.
    guess: Cow<'a, [[f64; D]]>,
    /// Velocities of the points.
    goes: &'a [[f64; D]],
    fitted: Fitted<'a, D>,
    patches: &'a [Patch<D>],
    images: &'a Images<D>,
    spacing: f64,
}

/// What a stage leaves for what follows it.
pub struct Ended<const D: usize> {
    /// Velocity at which the points have moved \[m/s\].
    pub moved: Vec<[f64; D]>,
    /// The surface.
    pub patches: Vec<Patch<D>>,
    /// Rows of derivatives.
    pub rows: Stencils<D>,
    /// Images that stand in them.
    pub images: Images<D>,
}

impl<const D: usize> Liquid<D> {
    /// Takes a step.
    ///
    /// # Errors
    /// Where fits or equations cannot be made.
    pub fn advance(
        &mut self,
        matter: &Matter<D>,
        step: Step<'_>,
        effort: &mut Effort,
    ) -> Result<Ended<D>, Failure> {
        let Step { way, dt } = step;
        let tau = PART * dt;
        let base = Base {
            position: self.position.clone(),
            velocity: self.velocity.clone(),
            tau,
            pull: self.pulled(tau),
            pushed: self.pushed(matter, tau),
        };
        let mut factors = Factors::default();
        let first = self.stage(matter, way, &base, &mut factors, effort)?;
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
        // Where fits are made anew rows may be others.
        if self.borne.is_none() {
            factors = Factors::default();
        }
        self.stage(matter, way, &base, &mut factors, effort)
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
        let n = self.position.len();
        let (all, images) = self.room.images(&self.position, way.spacing);
        let points = Points { all: &all, own: n };
        let rows = derivatives(points, way, self.fits(false)).map_err(|e| failed(&e))?;
        let patches = self.skin(way.spacing).map_err(|e| failed(&e))?;
        self.normal = patches.iter().map(|p| p.normal).collect();
        let drawn = 2.0 * matter.viscosity.unwrap_or(0.0);
        let pushed = self.pushed(matter, 0.0);
        let driving = self.room.driving(&matter.gravity);
        let velocity = images.vectors(&self.velocity);
        let right: Vec<f64> = (0..n)
            .map(|i| match (patches.get(i), self.wall(i)) {
                (Some(patch), _) => {
                    let stress = drawn * stretch(patch, &velocity);
                    let weight = self.room.potential(&matter.gravity, &self.position[i]);
                    matter.gas + matter.tension * patch.curvature + stress
                        - self.pull[0].get(i).copied().unwrap_or(0.0)
                        - matter.density * weight
                }
                (None, Some(normal)) => way.spacing * matter.density * dot(normal, &driving),
                (None, None) => -matter.density * stretching(&rows, &velocity, i),
            })
            .collect();
        let conditions = Conditions {
            rows: &rows,
            patches: &patches,
            spacing: way.spacing,
            stiffness: 0.0,
            images: &images,
            held: &self.room.held,
            fall: [0.0; D],
        };
        let mut equations = Equations::new(conditions, n).map_err(|e| failed(&e))?;
        effort.add(&equations.solve(&right, &mut self.pressure, way.rule()))?;
        let push = -matter.density.recip();
        let pressure = images.scalars(&self.pressure);
        self.rate = (0..n)
            .map(|i| along(&driving, push, &rows.gradient_of(&pressure, i)))
            .collect();
        for (rate, own) in self.rate.iter_mut().zip(&pushed) {
            *rate = along(rate, 1.0, own);
        }
        let walls = self.walls();
        self.rate[walls].fill([0.0; D]);
        Ok(patches)
    }

    fn stage(
        &mut self,
        matter: &Matter<D>,
        way: &Way,
        base: &Base<D>,
        factors: &mut Factors,
        effort: &mut Effort,
    ) -> Result<Ended<D>, Failure> {
        let (n, surface, tau) = (base.position.len(), self.surface(), base.tau);
        let guess = stepped(&base.velocity, tau, &self.rate);
        let goes = self.moved(&guess);
        let place = stepped(&base.position, tau, &goes);
        let follows = !self.follow.is_empty();
        let (all, images) = self.room.images(&place, way.spacing);
        let points = Points { all: &all, own: n };
        let rows = self.derivatives(points, way, self.fits(follows));
        let rows = rows.map_err(|e| failed(&e))?;
        // Fits through their own points smooth nothing.
        let apart = follows && self.room.bounds();
        let fits = apart.then(|| values(points, way)).transpose();
        let fits = fits.map_err(|e| failed(&e))?;
        let patches = self.patches(&place, way.spacing);
        let patches = patches.map_err(|e| failed(&e))?;
        let there = There {
            base,
            place: &place,
            guess: images.vectors(&guess),
            goes: &goes,
            fitted: Fitted {
                slopes: &rows,
                values: fits.as_ref().unwrap_or(&rows),
            },
            patches: &patches,
            images: &images,
            spacing: way.spacing,
        };
        let drift = self.drift(&there);
        let free = base.freed(&self.room.driving(&matter.gravity), &drift);
        let right = self.right(matter, &there, &free);
        let rounds = Rounds {
            matter,
            place: &all,
            patches: &patches,
            rows: &rows,
            images: &images,
            tau,
            way,
        };
        self.velocity = guess;
        self.push(&rounds, &free, &right, factors, effort)?;
        self.rate = (0..n)
            .map(|i| difference(&self.velocity[i], &base.velocity[i]).map(|d| d / tau))
            .collect();
        self.normal = patches.iter().map(|p| p.normal).collect();
        let moved = self.moved(&self.velocity);
        self.position = stepped(&base.position, tau, &moved);
        if follows {
            self.follow_surface(&rows, &images, &moved[..surface], way, effort)?;
        }
        Ok(Ended {
            moved,
            patches,
            rows,
            images,
        })
    }

    /// Rows of derivatives at points with their images behind them. Only points that go with the liquid take their fits with
    /// them: those that a stream passes have values of fits too, which are not carried.
    fn derivatives(
        &mut self,
        points: Points<'_, D>,
        way: &Way,
        like: Fits,
    ) -> Result<Stencils<D>, wls::Error> {
        let loose = self.loose();
        match self.borne.as_mut().filter(|_| loose) {
            Some(borne) => borne.rows(points.all, way),
            None => derivatives(points, way, like),
        }
    }

    /// The surface as it is.
    ///
    /// # Errors
    /// Where too few points are near.
    pub fn skin(&self, spacing: f64) -> Result<Vec<Patch<D>>, Bare> {
        self.patches(&self.position, spacing)
    }

    /// The surface with points at `place`.
    fn patches(&self, place: &[[f64; D]], spacing: f64) -> Result<Vec<Patch<D>>, Bare> {
        let (n, surface) = (place.len(), self.surface());
        let (all, images) = self.room.images(&place[..surface], spacing);
        let normals = images.vectors(&self.normal);
        let sheet = Sheet {
            points: &all,
            normals: &normals,
        };
        let mut patches = beside(sheet, surface, spacing)?;
        // Images of the surface are the first of all images.
        for j in patches.iter_mut().flat_map(|p| &mut p.neighbours) {
            if *j as usize >= surface {
                *j += (n - surface) as u32;
            }
        }
        Ok(patches)
    }

    /// What a liquid that moves at u brings to points that move at w \[m/s2\].
    fn drift(&self, there: &There<'_, D>) -> Vec<[f64; D]> {
        let (u, spacing) = (&there.guess, there.spacing);
        let back = |i: usize| difference(&there.goes[i], &u[i]);
        let (n, walled) = (there.goes.len(), self.walls().end);
        if self.loose() {
            return vec![[0.0; D]; n];
        }
        let mut drift = drift::along_surface(there.patches, u, back);
        if !self.follow.is_empty() {
            drift.resize(walled, [0.0; D]);
            drift.extend(drift::inside(there.fitted, u, back, walled..n, spacing));
            if !self.room.bounds() {
                let (values, time) = (there.fitted.values, there.base.tau / PART);
                drift::bound(&mut drift, values, there.place, u, time, spacing);
            }
        }
        drift.resize(n, [0.0; D]);
        drift
    }

    /// The right sides of the pressure for velocities `free` of pressure and friction: see [`super::pressure`].
    fn right(&self, matter: &Matter<D>, there: &There<'_, D>, free: &[[f64; D]]) -> Vec<f64> {
        let There {
            base,
            place,
            patches,
            images,
            ..
        } = *there;
        let Fitted { slopes, values } = there.fitted;
        let ahead = |j: usize| {
            let i = images.origin(j);
            let end = along(&base.position[i], base.tau, &free[i]);
            dot(&patches[i].normal, &difference(&end, &place[i]))
        };
        let source = matter.density / base.tau;
        let borne = self.room.borne(&matter.gravity);
        let wide = images.vectors(free);
        let bounds = self.room.bounds();
        let cleaned = if bounds { 1.0 } else { CLEANED };
        let each = (0..place.len()).into_par_iter();
        let mut sources: Vec<f64> = each.map(|i| divergence(slopes, &wide, i)).collect();
        if bounds {
            let wide = images.scalars(&sources);
            let each = (0..place.len()).into_par_iter();
            sources = each.map(|i| values.value(i).apply(&wide)).collect();
        }
        (0..place.len())
            .into_par_iter()
            .map(|i| match (patches.get(i), self.wall(i)) {
                (Some(patch), _) => {
                    let weight = self.room.potential(&matter.gravity, &place[i])
                        + dot(&borne, &patch.normal) * ahead(i);
                    matter.gas + matter.tension * (patch.curvature + bending(patch, i, ahead))
                        - base.pull.get(i).copied().unwrap_or(0.0)
                        - matter.density * weight
                }
                (None, Some(normal)) => {
                    let lack = difference(&free[i], &base.velocity[i]);
                    there.spacing * source * dot(normal, &lack)
                }
                (None, None) => {
                    cleaned * source * sources[i]
                        - (1.0 - cleaned) * matter.density * stretching(slopes, &there.guess, i)
                }
            })
            .collect()
    }
}

/// `x + time v`, point by point.
fn stepped<const D: usize>(x: &[[f64; D]], time: f64, v: &[[f64; D]]) -> Vec<[f64; D]> {
    x.iter().zip(v).map(|(x, v)| along(x, time, v)).collect()
}
