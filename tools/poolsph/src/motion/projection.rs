//! Projection: the pressure that keeps every particle's density at or below that of the metal.
//!
//! With the relative density excess C_a = nu (W_0 + sum_b W_ab) - 1, nu the lattice's volume, and
//! its rate (J u)_a = nu sum_b grad W_ab . (u_a - u_b), the step asks for
//!
//! ```text
//! u = u* + dt acc(p),   acc_a = -nu/(rho kappa) sum_b (p_a + p_b) grad W_ab      (eq. 3.94)
//! 0 <= p   complementary to   C + dt J u <= 0
//! ```
//!
//! The acceleration is the pair-symmetric gradient of Komen (2019), eq. 3.94, at constant density,
//! divided by the lattice moment kappa. It is -J^T p, so the problem is a convex quadratic
//! programme; it is solved by accelerated projected gradients with the diagonal as metric and
//! restart (Nesterov; O'Donoghue and Candes 2015; Mazhar et al. 2015 for contacts), two pair
//! sweeps per iteration, starting from the last pressure. Wet solid particles have a pressure of
//! their own, by the same condition on their density, and infinite mass: walls push, never pull.
//! A particle of the free surface lacks neighbours, so its condition is slack and its p zero.

use rayon::prelude::*;

use neighbours::{Chunk, ROWS};

use super::lattice::Lattice;
use crate::near::{Near, PairChunk, Role, dot, minus, plus, squared};
use crate::state::Metal;

/// Step of the gradient in units of the diagonal. The largest eigenvalue of D^-1 A is 2.82 on the
/// filled cubic lattice; disordered clouds come somewhat above.
const STEP: f64 = 0.31;

/// When to stop.
#[derive(Debug, Clone, Copy)]
pub struct Tolerance {
    /// Mean over all particles with pressure or excess of |C + dt J u|.
    pub density: f64,
    /// Fewest sweeps.
    pub sweeps_min: u32,
    /// Most sweeps.
    pub sweeps_max: u32,
}

/// How a solve ended.
#[derive(Debug, Clone, Copy, Default)]
pub struct Solved {
    /// Sweeps made.
    pub sweeps: u32,
    /// Mean of |C + dt J u| over the particles bound by it, predicted for the end of the step.
    pub density_error: f64,
}

/// Scratch of the solver; all slices `[m]` in the order of [`Near`].
#[derive(Debug, Clone, Default)]
pub struct Projection {
    /// p \[Pa\].
    pub pressure: Vec<f64>,
    /// Relative density excess C before the step.
    pub excess: Vec<f64>,
    extrapolated: Vec<f64>,
    advanced: Vec<f64>,
    diagonal: Vec<f64>,
    residual: Vec<f64>,
    acceleration: Vec<[f64; 3]>,
    partial: Vec<Partial>,
    scales: Scales,
}

/// Sums over one chunk of rows, added in the order of the chunks.
#[derive(Debug, Clone, Copy, Default)]
struct Partial {
    error: f64,
    bound: f64,
    turn: f64,
}

/// nu, nu/(rho kappa), W_0.
#[derive(Debug, Clone, Copy, Default)]
struct Scales {
    volume: f64,
    force: f64,
    own: f64,
}

impl Projection {
    /// Density excess and diagonal at the present positions.
    pub fn prepare(&mut self, near: &Near, metal: Metal, dt: f64) {
        let lattice = Lattice::of(metal);
        let volume = 1.0 / lattice.number;
        let force = volume / (metal.density * lattice.moment);
        self.scales = Scales {
            volume,
            force,
            own: near.kernel.value(0.0),
        };
        let n = near.len();
        for column in [
            &mut self.excess,
            &mut self.diagonal,
            &mut self.extrapolated,
            &mut self.advanced,
        ] {
            column.resize(n, 0.0);
        }
        self.residual.resize(n, 0.0);
        self.acceleration.resize(n, [0.0; 3]);
        self.partial.resize(n.div_ceil(ROWS), Partial::default());
        let scales = self.scales;
        self.excess
            .par_chunks_mut(ROWS)
            .zip(self.diagonal.par_chunks_mut(ROWS))
            .zip(near.lists.chunks())
            .zip(&near.pairs)
            .for_each(|(((excess, diagonal), chunk), pairs)| {
                for k in 0..chunk.rows() {
                    let (sum, squares) = density_row(near, chunk, pairs, k);
                    excess[k] = scales.volume * (scales.own + sum) - 1.0;
                    diagonal[k] = dt * dt * scales.volume * scales.force * squares;
                }
            });
    }

    /// Finds p for the predicted velocities and turns these into the final ones.
    pub fn solve(
        &mut self,
        near: &Near,
        predicted: &mut [[f64; 3]],
        dt: f64,
        tolerance: Tolerance,
    ) -> Solved {
        let mut solved = Solved::default();
        if near.is_empty() {
            return solved;
        }
        self.start(near, predicted, dt);
        let mut momentum = 1.0_f64;
        while solved.sweeps < tolerance.sweeps_max {
            self.accelerate(near);
            self.relax(near, dt);
            let (error, turn) = self.gathered();
            solved.sweeps += 1;
            solved.density_error = error;
            if solved.sweeps >= tolerance.sweeps_min && error <= tolerance.density {
                std::mem::swap(&mut self.pressure, &mut self.extrapolated);
                break;
            }
            let next = if turn > 0.0 {
                1.0
            } else {
                0.5 * (1.0 + (1.0 + 4.0 * momentum * momentum).sqrt())
            };
            let weight = if turn > 0.0 {
                0.0
            } else {
                (momentum - 1.0) / next
            };
            momentum = next;
            self.extrapolate(weight);
        }
        if solved.sweeps == tolerance.sweeps_max {
            std::mem::swap(&mut self.pressure, &mut self.extrapolated);
            self.accelerate(near);
        }
        let acceleration = &self.acceleration;
        predicted
            .par_iter_mut()
            .zip(acceleration)
            .with_min_len(1024)
            .for_each(|(u, acc)| *u = plus(*u, dt, *acc));
        solved
    }

    /// Fixed part of the residual, C + dt J u*, and the first point.
    fn start(&mut self, near: &Near, predicted: &[[f64; 3]], dt: f64) {
        let (excess, scales) = (&self.excess, self.scales);
        self.residual
            .par_chunks_mut(ROWS)
            .zip(near.lists.chunks())
            .zip(&near.pairs)
            .for_each(|((residual, chunk), pairs)| {
                for (k, residual) in residual.iter_mut().enumerate() {
                    let rate = scales.volume * rate_row(near, chunk, pairs, (k, predicted));
                    *residual = excess[chunk.first() + k] + dt * rate;
                }
            });
        for (p, (&diagonal, role)) in self
            .pressure
            .iter_mut()
            .zip(self.diagonal.iter().zip(&near.role))
        {
            if diagonal <= 0.0 || *role == Role::Backing {
                *p = 0.0;
            }
        }
        self.extrapolated.copy_from_slice(&self.pressure);
    }

    /// acc = -J^T y / mass (eq. 3.94).
    fn accelerate(&mut self, near: &Near) {
        let (pressure, scale) = (&self.extrapolated, self.scales.force);
        self.acceleration
            .par_chunks_mut(ROWS)
            .zip(near.lists.chunks())
            .zip(&near.pairs)
            .for_each(|((out, chunk), pairs)| {
                for (k, out) in out.iter_mut().enumerate() {
                    let a = chunk.first() + k;
                    if near.role[a] != Role::Liquid {
                        *out = [0.0; 3];
                        continue;
                    }
                    let (place, own) = (near.position[a], pressure[a]);
                    let mut sum = [0.0; 3];
                    for (&b, &slope) in chunk.row(k).iter().zip(&pairs.slope[chunk.range(k)]) {
                        let b = b as usize;
                        sum = plus(
                            sum,
                            slope * (own + pressure[b]),
                            minus(place, near.position[b]),
                        );
                    }
                    *out = sum.map(|x| -scale * x);
                }
            });
    }

    /// One projected gradient step from y; leaves the new point in `advanced`.
    fn relax(&mut self, near: &Near, dt: f64) {
        let (acceleration, scales) = (&self.acceleration, self.scales);
        let (residual, diagonal, y, old) = (
            &self.residual,
            &self.diagonal,
            &self.extrapolated,
            &self.pressure,
        );
        self.advanced
            .par_chunks_mut(ROWS)
            .zip(&mut self.partial)
            .zip(near.lists.chunks())
            .zip(&near.pairs)
            .for_each(|(((out, partial), chunk), pairs)| {
                *partial = Partial::default();
                for (k, out) in out.iter_mut().enumerate() {
                    let a = chunk.first() + k;
                    if diagonal[a] <= 0.0 || near.role[a] == Role::Backing {
                        *out = 0.0;
                        continue;
                    }
                    let rate = scales.volume * rate_row(near, chunk, pairs, (k, acceleration));
                    let error = residual[a] + dt * dt * rate;
                    *out = (y[a] + STEP * error / diagonal[a]).max(0.0);
                    if error > 0.0 || y[a] > 0.0 {
                        partial.error += error.abs();
                        partial.bound += 1.0;
                    }
                    partial.turn += diagonal[a] * (y[a] - *out) * (*out - old[a]);
                }
            });
    }

    /// y = p_new + weight (p_new - p); p = p_new.
    fn extrapolate(&mut self, weight: f64) {
        let points = self
            .extrapolated
            .iter_mut()
            .zip(&self.advanced)
            .zip(&mut self.pressure);
        for ((y, &new), p) in points {
            *y = (new + weight * (new - *p)).max(0.0);
            *p = new;
        }
    }

    /// Mean error over the bound particles, and whether the momentum points uphill.
    fn gathered(&self) -> (f64, f64) {
        let sum = self
            .partial
            .iter()
            .fold(Partial::default(), |sum, part| Partial {
                error: sum.error + part.error,
                bound: sum.bound + part.bound,
                turn: sum.turn + part.turn,
            });
        (sum.error / sum.bound.max(1.0), sum.turn)
    }

    /// Adds the pair forces of p to [`Near::virial`], so that this holds the pressure which the
    /// metal carries; wet solid particles get p itself, as they lack neighbours behind.
    ///
    /// In a disordered cloud the sum of `p_a + p_b` stands for a pressure that differs from p by
    /// some per cent; the virial is what balances the outer forces.
    pub fn add_virial(&self, near: &mut Near, metal: Metal) {
        let share = metal.density * self.scales.force / 6.0;
        let (pressure, role, position) = (&self.pressure, &near.role, &near.position);
        near.virial
            .par_chunks_mut(ROWS)
            .zip(near.lists.chunks())
            .zip(&near.pairs)
            .for_each(|((virial, chunk), pairs)| {
                for (k, virial) in virial.iter_mut().enumerate() {
                    let a = chunk.first() + k;
                    if role[a] != Role::Liquid {
                        *virial = pressure[a];
                        continue;
                    }
                    let mut sum = 0.0;
                    for (&b, &slope) in chunk.row(k).iter().zip(&pairs.slope[chunk.range(k)]) {
                        let b = b as usize;
                        let square = squared(minus(position[a], position[b]));
                        sum -= slope * square * (pressure[a] + pressure[b]);
                    }
                    *virial += share * sum;
                }
            });
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.excess.capacity() * (6 * 8 + 24)
    }
}

/// Sum of W and the sum of squares of J's row.
#[inline]
fn density_row(near: &Near, chunk: &Chunk, pairs: &PairChunk, k: usize) -> (f64, f64) {
    let a = chunk.first() + k;
    let (place, moves) = (near.position[a], near.role[a] == Role::Liquid);
    let (mut sum, mut squares, mut gradient) = (0.0, 0.0, [0.0; 3]);
    let range = chunk.range(k);
    for ((&b, &w), &slope) in chunk
        .row(k)
        .iter()
        .zip(&pairs.value[range.clone()])
        .zip(&pairs.slope[range])
    {
        let dx = minus(place, near.position[b as usize]);
        sum += w;
        gradient = plus(gradient, slope, dx);
        if near.role[b as usize] == Role::Liquid {
            squares += slope * slope * squared(dx);
        }
    }
    if moves {
        squares += squared(gradient);
    }
    (sum, squares)
}

/// Sum of grad W . (u_a - u_b).
#[inline]
fn rate_row(
    near: &Near,
    chunk: &Chunk,
    pairs: &PairChunk,
    (k, field): (usize, &[[f64; 3]]),
) -> f64 {
    let a = chunk.first() + k;
    let (place, own) = (near.position[a], field[a]);
    let mut sum = 0.0;
    for (&b, &slope) in chunk.row(k).iter().zip(&pairs.slope[chunk.range(k)]) {
        let b = b as usize;
        sum += slope * dot(minus(place, near.position[b]), minus(own, field[b]));
    }
    sum
}
