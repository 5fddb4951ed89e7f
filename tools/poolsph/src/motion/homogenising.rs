//! Density homogenising (Komen 2019, section 3.3.4, fig. 3.15).
//!
//! Particles first go where inertia, viscosity and forces take them. Then they are moved along the
//! pressure gradient of eq. 3.94 alone, in steps dt' that are small against dt, until the density
//! is even; the velocity is the way gone in the whole step. With p = c^2 (rho - rho_0) and
//! e = rho/rho_0 - 1 a move is
//!
//! ```text
//! dx_a = -s d^2 nu/kappa sum_b (e_a + e_b) grad W_ab       s = (c dt'/d)^2 = 0.5
//! ```
//!
//! smoothed with A_ex = 0.48 (eq. 3.103). The density is taken at the centroid of the
//! neighbourhood (eqs 3.91 and 3.92), so that a free surface does not count as thin; e < 0, which
//! would pull, counts as zero: at the surface it is -8 % on the lattice, and pulling there bursts
//! the liquid. The smoothing is an exchange between pairs, `a + A_ex nu sum_b W (a_b - a_a)`,
//! which is the kernel mean inside and keeps momentum at the surface too.
//!
//! The number of sweeps K sets the stiffness: at rest the moves of a step undo the fall g dt^2, and
//! the liquid is one with the speed of sound d sqrt(s K)/dt and p = c^2 e, so that a tolerance on e
//! below g H/(2 c^2) is never met. The centroid is not the particle, so that moves do not follow the
//! gradient of an energy in e: without [`super::noise`] a tank of 216 particles at rest keeps 1.3 to
//! 1.7 % of sqrt(g H) from 0.15 s on (2 % with e at the particles); with it 0.15 % is left after 1 s.
//! In a finer tank of 512 particles 0.3 to 0.6 % is left at 0.5 to 0.8 s: the surface layer goes on
//! to pack for longer than in the projection. K = 10 in all three.
//!
//! Slower than [`super::projection`]; it is here because the published results are made with it.

use particles::Matter;
use rayon::prelude::*;

use neighbours::ROWS;
use shapes::frame::{along, difference, squared};

use super::lattice::Lattice;
use super::step::{Solved, Step, Tolerance};
use crate::near::{Near, Role};

/// s: half of what the stiffest mode of the lattice would stand.
const STRIDE: f64 = 0.5;
/// A_ex of eq. 3.103.
const EXCHANGE: f64 = 0.48;

/// Scratch of the method; all slices `[m]` in the order of [`Near`].
#[derive(Debug, Clone)]
pub struct Homogenising {
    lattice: Lattice,
    start: Vec<[f64; 3]>,
    error: Vec<f64>,
    shift: Vec<[f64; 3]>,
    smooth: Vec<[f64; 3]>,
}

impl Homogenising {
    /// The method for particles of `metal`.
    #[must_use]
    pub fn new(metal: Matter) -> Self {
        Self {
            lattice: Lattice::of(metal),
            start: Vec::new(),
            error: Vec::new(),
            shift: Vec::new(),
            smooth: Vec::new(),
        }
    }

    /// Evens out the density behind the predicted velocities and turns these into the final ones.
    /// `near.virial` gets the share of the pressure; the positions are those before the step again.
    pub fn solve(
        &mut self,
        near: &mut Near,
        predicted: &mut [[f64; 3]],
        step: Step,
        tolerance: Tolerance,
    ) -> Solved {
        let mut solved = Solved::default();
        if near.is_empty() {
            return solved;
        }
        let n = near.len();
        let lattice = self.lattice;
        self.start.clone_from(&near.position);
        self.error.resize(n, 0.0);
        self.shift.resize(n, [0.0; 3]);
        self.smooth.resize(n, [0.0; 3]);
        for (x, u) in near.position.iter_mut().zip(&*predicted) {
            *x = along(*x, step.dt, *u);
        }
        while solved.sweeps < tolerance.sweeps_max {
            near.weigh();
            solved.density_error = self.density(near, lattice);
            let enough = solved.sweeps >= tolerance.sweeps_min;
            if enough && solved.density_error <= tolerance.density {
                break;
            }
            self.shift(near, lattice, step);
            self.smooth(near, lattice);
            for (x, shift) in near.position.iter_mut().zip(&self.smooth) {
                *x = along(*x, 1.0, *shift);
            }
            solved.sweeps += 1;
        }
        let ends = near.position.iter().zip(&self.start).zip(&near.role);
        for (u, ((end, start), role)) in predicted.iter_mut().zip(ends) {
            if *role == Role::Liquid {
                *u = difference(*end, *start).map(|x| x / step.dt);
            }
        }
        near.position.clone_from(&self.start);
        solved
    }

    /// e at the centroids; returns the mean of its size over the liquid.
    fn density(&mut self, near: &Near, lattice: Lattice) -> f64 {
        let (kernel, position) = (near.kernel, &near.position);
        let own = kernel.value(0.0);
        near.each_row(&mut self.error, |a, row, error| {
            *error = 0.0;
            if near.role[a] == Role::Backing || row.index.is_empty() {
                return;
            }
            let (mut lever, mut weight) = ([0.0; 3], own);
            for (b, w) in row.values() {
                lever = along(lever, w, difference(position[b], position[a]));
                weight += w;
            }
            let centre = along(position[a], 1.0 / weight, lever);
            let at = |place| kernel.value(squared(difference(place, centre)).sqrt());
            let around = row.index.iter().map(|b| at(position[*b as usize]));
            let number = around.fold(at(position[a]), |sum, w| sum + w);
            *error = (number / lattice.number - 1.0).max(0.0);
        });
        let liquid = self.error.iter().zip(&near.role);
        let sum: f64 = liquid
            .filter(|(_, role)| **role == Role::Liquid)
            .map(|(error, _)| error.abs())
            .sum();
        sum / near.liquid_count().max(1) as f64
    }

    /// One move by eq. 3.94, and its share of the pressure.
    fn shift(&mut self, near: &mut Near, lattice: Lattice, step: Step) {
        let spacing = step.metal.spacing;
        let scale = STRIDE * spacing * spacing / (lattice.number * lattice.moment);
        let share = step.share * step.metal.density * scale / (6.0 * step.dt * step.dt);
        let (error, role, position) = (&self.error, &near.role, &near.position);
        self.shift
            .par_chunks_mut(ROWS)
            .zip(near.virial.par_chunks_mut(ROWS))
            .zip(near.lists.chunks())
            .zip(&near.pairs)
            .for_each(|(((shift, virial), chunk), pairs)| {
                for (k, (shift, virial)) in shift.iter_mut().zip(virial).enumerate() {
                    let a = chunk.first() + k;
                    *shift = [0.0; 3];
                    if role[a] != Role::Liquid {
                        continue;
                    }
                    let mut stretched = 0.0;
                    for (&b, &slope) in chunk.row(k).iter().zip(&pairs.slope[chunk.range(k)]) {
                        let b = b as usize;
                        let dx = difference(position[a], position[b]);
                        let weight = f64::from(slope) * (error[a] + error[b]);
                        *shift = along(*shift, -scale * weight, dx);
                        stretched -= weight * squared(dx);
                    }
                    *virial += share * stretched;
                }
            });
    }

    /// Smooths the moves (eq. 3.103).
    fn smooth(&mut self, near: &Near, lattice: Lattice) {
        let (shift, role) = (&self.shift, &near.role);
        let exchange = EXCHANGE / lattice.number;
        near.each_row(&mut self.smooth, |a, row, out| {
            *out = shift[a];
            if role[a] == Role::Liquid {
                for (b, w) in row.values().filter(|(b, _)| role[*b] == Role::Liquid) {
                    *out = along(*out, exchange * w, difference(shift[b], shift[a]));
                }
            }
        });
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        (3 * 24 + 8) * self.start.capacity()
    }
}
