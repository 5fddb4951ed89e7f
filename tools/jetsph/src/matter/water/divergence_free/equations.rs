//! The equation of the pressure, row by row.

use kernels::Kernel;
use particles::{POSITION, sweep};
use rayon::prelude::*;

use super::DivergenceFree;
use super::operators::{Couplings, Sums, is_led};
use super::poisson::ROWS;
use crate::stage::{Stage, StageError};
use crate::state::State;

/// Excess that counts, and the most of it: cells that are a little wider than deep have some at rest.
const EXCESS: [f64; 2] = [0.01, 0.06];
/// Least weight of what tells the pressure of a particle, in parts of the lattice's.
const LEAST: f64 = 0.25;
/// Change of volume in a step that may be left, in the mean.
const TOLERANCE: f64 = 1e-5;

impl<const D: usize, K: Kernel> DivergenceFree<D, K> {
    /// Solves for the pressure of a step of `dt` \[s\]. Water that does not pull has none below zero where it meets a solid: it parts from it.
    pub(super) fn solve(
        &mut self,
        p: &mut [f64],
        state: &State,
        dt: f64,
    ) -> Result<(), StageError> {
        let density = self.liquid.density;
        self.poisson.yielding = self.beside.yielding(state, density);
        let mut floor = self.equations(dt);
        if self.beside.len() > 0 {
            // Steps of a solid may be much shorter than those of the water: in the same time as much may be left.
            let limit = self.limit(state).map_or(dt, |limit| limit.seconds);
            floor *= (dt / limit).min(1.0);
        }
        self.level(p);
        let solved = self.poisson.solve(p, floor);
        self.sweeps += solved.map_err(|what| StageError::Diverged {
            set: "water".to_owned(),
            particle: 0,
            place: state.sets[self.liquid.set].column(&POSITION)[0],
            quantity: "pressure [Pa]",
            what,
        })? as u64;
        if !self.liquid.pulls {
            for (row, _) in &self.poisson.yielding.rows {
                let p = &mut p[*row as usize];
                *p = p.max(0.0);
            }
        }
        self.beside.note(p, &self.poisson.yielding);
        Ok(())
    }

    /// What the operators know of each row, and whom its pressure is coupled to.
    pub(super) fn sum(&mut self) {
        let (around, filled, is_beside) = (&self.around, &self.filled, &self.is_beside);
        let beside = &self.beside;
        let n = around.seen.len();
        self.rows.resize(n, Sums::default());
        self.poisson
            .chunks
            .resize_with(n.div_ceil(ROWS), Couplings::default);
        let chunks = self.rows.par_chunks_mut(ROWS).zip(&mut self.poisson.chunks);
        chunks.enumerate().for_each(|(chunk, (rows, couplings))| {
            couplings.ends.clear();
            couplings.with.clear();
            for (k, row) in rows.iter_mut().enumerate() {
                let a = chunk * ROWS + k;
                *row = Sums::default();
                if !is_led(&around.seen[a]) {
                    *row = Sums::of::<D, K>(
                        around,
                        a,
                        is_beside[a],
                        filled,
                        beside.of(a),
                        &mut couplings.with,
                    );
                }
                couplings.ends.push(couplings.with.len() as u32);
            }
        });
    }

    /// sum of w (p_a - p_b) + 2 w_missing p_a = rho m/2 (e/dt^2 - div u*/dt); gives the residual that may be left.
    pub(super) fn equations(&mut self, dt: f64) -> f64 {
        let (rows, seen, filled) = (&self.rows, &self.around.seen, &self.filled);
        let density = self.liquid.density;
        self.poisson.diagonal.resize(rows.len(), [1.0; 2]);
        self.poisson.right.resize(rows.len(), 0.0);
        let equations = self
            .poisson
            .diagonal
            .par_iter_mut()
            .zip(&mut self.poisson.right);
        equations
            .zip(rows)
            .enumerate()
            .with_min_len(sweep::GRAIN)
            .for_each(|(a, ((diagonal, right), row))| {
                (*diagonal, *right) = ([1.0; 2], 0.0);
                if is_led(&seen[a]) {
                    return;
                }
                let [some, most] = EXCESS;
                let excess = (row.number / filled.number - 1.0 - some).clamp(0.0, most - some);
                let gone = dt * (row.strain() * excess - row.divergence);
                // What walls enclose so that no water tells its pressure is as far from the surface as from the water.
                let enclosed = (LEAST * filled.weight - row.free - 2.0 * row.missing).max(0.0);
                let beyond = 2.0 * row.missing + enclosed;
                *diagonal = [row.coupled + beyond, seen[a].volume];
                *right = seen[a].volume * density * 0.5 * row.moment * gone / (dt * dt);
            });
        let [square] = sweep::sum(rows.len(), |a| {
            let one = seen[a].volume * density * 0.5 * filled.moment * TOLERANCE / (dt * dt);
            [one * one]
        });
        square.sqrt()
    }

    /// A box that is full has a pressure but for a constant, if nothing yields: what its equations sum to cannot be met and is
    /// shared by all.
    pub(super) fn level(&mut self, p: &mut [f64]) {
        let (rows, seen) = (&self.rows, &self.around.seen);
        let yields = !self.poisson.yielding.is_empty();
        if yields || rows.iter().any(|row| row.missing > 0.0) {
            return;
        }
        let right = &self.poisson.right;
        let [volume, sum, mean] = sweep::sum(rows.len(), |a| {
            if is_led(&seen[a]) {
                [0.0; 3]
            } else {
                [seen[a].volume, right[a], seen[a].volume * p[a]]
            }
        });
        for (a, (right, p)) in self.poisson.right.iter_mut().zip(p).enumerate() {
            if !is_led(&seen[a]) {
                *right -= sum / volume * seen[a].volume;
                *p -= mean / volume;
            }
        }
    }
}
