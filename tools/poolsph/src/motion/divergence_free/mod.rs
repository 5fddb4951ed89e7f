//! A pressure that leaves the velocity without divergence, on particles that are kept even.
//!
//! With the forces, gravity and viscosity of the prediction u*, a step solves
//!
//! ```text
//! div (dt/rho grad p) = div u* - e/dt,   u = u* - dt/rho grad p      (Chorin 1968; Cummins and Rudman 1999)
//! p = p_s at the free surface,   dp/dn = rho f.n at walls
//! ```
//!
//! where e is a small part of the excess of density (Pozorski and Wawrenczuk 2002), so that the volume does not drift.
//! The pressure p_s upon the surface is that of `Near::outer`, with the tension's (`pull`), or zero; its mean is taken
//! from all pressures until the end, so that one that is the same everywhere moves nothing, however it comes and goes.
//! What bears the weight of the liquid is known beforehand (`weight`) and added at the end. The sign of p is free: nothing
//! locks. A condition on the density itself makes layers of particles that slide over one another lift the weight above
//! them, and they bear a stress of 0.4 % of the pressure as a solid does; a velocity without divergence asks nothing of
//! them.
//!
//! The gradient is that of differences of p, exact where p is linear (`operators`; Bonet and Lok 1999): a pressure
//! that is the same everywhere exerts nothing, and one of constant slope no more than its slope, however the particles
//! lie. Forms that are antisymmetric in pairs were tried (closed area vectors by harmonic coordinates, with moments of
//! both sides). They err by the strain of the cloud times grad p, and in a closed box at rest that error made the
//! disorder from which it came grow, e-fold in 25 ms at 0.8 mm. What differences lack in action and reaction is given
//! back to what touches no wall (`islands`).
//!
//! The equation of p is compact, and leaves a divergence, which is damped (`grad_div`). Without a surface p pushes twice
//! but for a rest (`reflection`). Along streamlines particles come to lie in rows; they are shifted back each step
//! (`shift`; Lind et al. 2012).
//! Neighbours that a particle of the surface lacks count as points beyond it (Nair and Tomar 2014), as many as the
//! lattice has more, mirrored across the surface half a spacing away. Solid particles move as the mirror images of the
//! liquid beside them: the wall stands half a spacing before their first layer.

mod closing;
mod cohesion;
mod excess;
mod filled;
mod grad_div;
mod gradient;
mod interface;
mod islands;
mod normals;
mod openness;
mod operators;
mod poisson;
mod pull;
mod reflection;
mod ripples;
mod shift;
mod slip;
mod traction;
mod weight;

use particles::Matter;
use rayon::prelude::*;
use shapes::frame::{difference, squared};

use super::step::{Solved, Step, Tolerance};
use super::viscosity::Viscosity;
use crate::forces::capillary;
use crate::near::{Near, Role};
use crate::sweep::GRAIN;

pub use self::closing::Closing;
use self::cohesion::Cohesion;
use self::excess::Excess;
use self::filled::Filled;
use self::grad_div::GradDiv;
use self::interface::Interface;
use self::islands::Islands;
use self::normals::Normals;
use self::operators::Sums;
use self::poisson::Poisson;
use self::pull::Pull;
use self::ripples::Ripples;
use self::shift::{Shift, Surfaces};
use self::traction::Traction;
use self::weight::Weight;

/// Least weight of what tells the pressure of a particle, in parts of the lattice's. One in the corner of three walls has 0.4 of liquid.
const LEAST: f64 = 0.25;
/// Particles of the least surface; a single one is no less.
const FEWEST: f64 = 0.999;
/// Way of the fastest particle in a step, in spacings, from which on the tolerance is that of the scene; slower flow
/// is solved as much more closely.
const BRISK: f64 = 0.1;
/// Least part of the tolerance.
const CLOSEST: f64 = 1e-3;

/// The solver with its scratch; all slices `[m]` in the order of [`Near`].
#[derive(Debug, Clone)]
pub struct DivergenceFree {
    /// p, counted from the mean upon the surface and without that of the weight \[Pa\].
    pub pressure: Vec<f32>,
    cohesion: Cohesion,
    filled: Filled,
    grad_div: GradDiv,
    rows: Vec<Sums>,
    poisson: Poisson,
    /// u*, and what the prediction has changed in u, images beyond faces included \[m/s\].
    moved: Vec<[f64; 3]>,
    change: Vec<[f64; 3]>,
    /// p of the last step \[Pa\].
    last: Vec<f32>,
    /// p of the liquid, and at solid particles what their liquid neighbours make of it \[Pa\].
    total: Vec<f64>,
    /// The same for the p that pushes without a surface; empty otherwise.
    pushing: Vec<f64>,
    weight: Weight,
    /// grad p \[Pa/m\].
    slope: Vec<[f64; 3]>,
    interface: Interface,
    islands: Islands,
    normals: Normals,
    pull: Pull,
    ripples: Ripples,
    shift: Shift,
    traction: Traction,
}

impl DivergenceFree {
    /// A solver for particles of `metal`.
    #[must_use]
    pub fn new(metal: Matter) -> Self {
        Self {
            pressure: Vec::new(),
            cohesion: Cohesion::new(metal),
            filled: Filled::of(metal),
            grad_div: GradDiv::default(),
            rows: Vec::new(),
            poisson: Poisson::default(),
            moved: Vec::new(),
            change: Vec::new(),
            last: Vec::new(),
            total: Vec::new(),
            pushing: Vec::new(),
            weight: Weight::default(),
            slope: Vec::new(),
            interface: Interface::default(),
            islands: Islands::default(),
            normals: Normals::new(metal),
            pull: Pull::new(metal),
            ripples: Ripples::default(),
            shift: Shift::default(),
            traction: Traction::default(),
        }
    }

    /// Finds what hangs together and where the surface faces, at the beginning of a step.
    pub fn begin(&mut self, near: &Near, viscosity: &Viscosity) {
        self.islands.find(near);
        // Asked for by the traction, and by shifts where no tension acts.
        if viscosity.acts() || near.tension.is_empty() {
            self.normals.find(near);
        }
    }

    /// Adds to `predicted` what viscosity does at the surface in `dt` \[s\].
    pub fn slacken(
        &mut self,
        near: &Near,
        viscosity: &Viscosity,
        dt: f64,
        predicted: &mut [[f64; 3]],
    ) {
        if viscosity.acts() {
            let pull = self.traction.pull(near, viscosity, &self.normals);
            self.islands.balance(pull, |_| 1.0, |_| [0.0; 3]);
            self.traction.apply(near, dt, predicted);
        }
    }

    /// Finds p for the predicted velocities and turns these into the final ones; `borne` is what they hold of an
    /// acceleration that walls bear \[m/s2\]. `near.virial` gets the share of p in the pressure which the metal carries.
    pub fn solve(
        &mut self,
        near: &mut Near,
        predicted: &mut [[f64; 3]],
        borne: [f64; 3],
        step: Step,
        tolerance: Tolerance,
    ) -> Solved {
        if near.is_empty() {
            return Solved::default();
        }
        self.weight
            .lift(near, &self.islands, predicted, borne, step);
        if let Some(middle) = self.interface.find(near, step.metal) {
            self.weight.about(middle);
        }
        self.look(near);
        let (islands, weight, rows) = (&self.islands, &self.weight, &self.rows);
        (self.interface).meet(near, islands, weight, rows, self.filled);
        self.interface.take_sides(&self.rows);
        let between = (near.liquids.as_ref()).is_some_and(|liquids| liquids.tension > 0.0);
        let free = !near.tension.is_empty();
        if free || between {
            let part = step.dt / capillary::limit(near, step.metal);
            let (rows, interface) = (&self.rows, &self.interface);
            let surface =
                |a: usize| (free && rows[a].missing > 0.0) || (between && interface.beside(a));
            (self.ripples).damp(near, surface, interface, part, predicted);
        }
        if free {
            self.cohesion.pull(near, self.filled, step.dt, predicted);
        }
        self.sum(near, predicted);
        let gas = self.weight.settle(near, &self.islands, &self.rows);
        if !near.tension.is_empty() {
            self.pull.press(near, &self.rows);
            self.weight.settle(near, &self.islands, &self.rows);
        }
        let fastest = predicted
            .iter()
            .fold(0.0_f64, |most, u| most.max(squared(*u)));
        let way = fastest.sqrt() * step.dt / step.metal.spacing;
        self.equations(near, step);
        let tolerance = Tolerance {
            density: tolerance.density * (way / BRISK).clamp(CLOSEST, 1.0),
            ..tolerance
        };
        self.last.clone_from(&self.pressure);
        let solved = self.poisson.solve(near, &mut self.pressure, tolerance);
        self.reach_walls(near, step);
        if self.reflects(near) {
            self.reflect(near, step);
        }
        self.differ(near);
        self.balance(near, gas);
        self.push(near, predicted, step);
        let (d, interface) = (self.filled.spacing, &mut self.interface);
        (self.grad_div).damp(near, &self.rows, d, interface, predicted);
        self.pull.release(near);
        solved
    }

    /// Moves particles to where they lie evenly, after a step of `dt` \[s\].
    pub fn even(&mut self, near: &mut Near, dt: f64) {
        let surfaces = Surfaces {
            rows: &self.rows,
            normals: &self.normals,
            interface: &self.interface,
        };
        let change = self.shift.find(near, self.filled, surfaces, dt);
        (self.islands).balance(change, |b| near.heaviness(b), |_| [0.0; 3]);
        self.shift.apply(near);
        self.cohesion.part(near);
    }

    /// Particles of the surface whose curvature is bounded.
    #[must_use]
    pub fn bounded(&self) -> usize {
        self.pull.bounded()
    }

    /// What the places tell the operators of each row.
    fn look(&mut self, near: &Near) {
        let filled = self.filled;
        self.rows.resize(near.len(), Sums::default());
        near.each_row(
            &mut self.rows,
            #[inline(always)]
            |a, row, out| {
                *out = match near.role[a] {
                    Role::Liquid => Sums::of(near, a, row, filled),
                    _ => Sums::default(),
                };
            },
        );
        self.close();
    }

    /// What the predicted velocities tell them.
    fn sum(&mut self, near: &Near, predicted: &[[f64; 3]]) {
        self.moved.clear();
        self.moved.extend_from_slice(predicted);
        near.complete(&mut self.moved, |u, _, turn| turn.vector(u));
        self.change.clear();
        let changes = predicted.iter().zip(&near.velocity);
        self.change
            .extend(changes.map(|(to, from)| difference(*to, *from)));
        near.complete(&mut self.change, |u, _, turn| turn.vector(u));
        let moved = &self.moved;
        near.each_row(
            &mut self.rows,
            #[inline(always)]
            |a, row, sums| {
                if near.role[a] == Role::Liquid {
                    sums.flow(near, moved, a, row);
                }
            },
        );
        self.interface.slip(near, &self.moved, &mut self.rows);
    }

    /// A surface of less than a few particles is none: it would bear all that the volume of a closed box is in error.
    fn close(&mut self) {
        let sure: f64 = self.rows.iter().map(|row| row.sure).sum();
        if sure < FEWEST {
            for row in &mut self.rows {
                (row.missing, row.open) = (0.0, [0.0; 3]);
            }
        }
    }

    /// sum of w (p_a - p_b) + 2 w_missing (p_a - p_s) = rho m/2 (e/dt^2 - div u*/dt).
    fn equations(&mut self, near: &Near, step: Step) {
        let (rows, filled, upon) = (&self.rows, self.filled, self.weight.upon());
        let scale = 2.0 * step.dt * step.dt / (step.metal.density * filled.moment);
        self.poisson.resize(near.len(), scale);
        self.poisson.closed = rows.iter().all(|row| row.missing <= 0.0);
        let excess = Excess::of(near, filled, step, self.poisson.closed);
        let interface = &self.interface;
        self.pressure.resize(near.len(), 0.0);
        let columns = self.poisson.equations.par_iter_mut();
        let columns = columns.zip(&mut self.pressure).zip(rows).enumerate();
        columns
            .with_min_len(GRAIN)
            .for_each(|(a, ((equation, pressure), row))| {
                if near.role[a] != Role::Liquid {
                    (*equation, *pressure) = ([0.0; 2], 0.0);
                    return;
                }
                let gone = excess.goes(near, a, row) - step.dt * row.divergence;
                // What walls enclose so that no liquid tells its pressure is as far from the surface as from the liquid.
                let enclosed = (LEAST * filled.weight - row.liquid - 2.0 * row.missing).max(0.0);
                let beyond = (2.0 * row.missing + enclosed) / near.heaviness(a);
                let [liquid, jump] = interface.terms(a, row);
                let diagonal = liquid + beyond;
                let right = gone * row.moment / (filled.moment * scale) + beyond * upon[a] + jump;
                *equation = [diagonal as f32, right as f32];
            });
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        (size_of::<Sums>() + 3 * 24 + 8 + 4) * self.rows.capacity()
            + 4 * self.last.capacity()
            + 8 * self.pushing.capacity()
            + self.poisson.bytes()
            + self.interface.bytes()
            + self.islands.bytes()
            + self.normals.bytes()
            + self.cohesion.bytes()
            + self.grad_div.bytes()
            + self.pull.bytes()
            + self.ripples.bytes()
            + self.weight.bytes()
            + self.shift.bytes()
            + self.traction.bytes()
    }
}

#[cfg(test)]
mod drops;
#[cfg(test)]
mod tests;
