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
//!
//! Sweeps run in single precision; the force of the p found is added in double precision, so that
//! momentum is kept to round-off. Sums of differences over a row are taken apart, so that a pair
//! costs four products: what cancels is larger than what is left by the size L of the cloud over
//! h. The error in C, 1e-7 (L/h) times the share dt^2 J acc, stays far below the tolerance; the
//! part by u* is summed in the same way in double precision.

use rayon::prelude::*;

use neighbours::ROWS;

use super::lattice::Lattice;
use super::step::{Solved, Step, Tolerance};
use crate::near::{Near, Role};
use crate::state::Metal;
use crate::sweep::{GRAIN, carried, middle, summed, summed_double};
use crate::vector::{dot, minus, plus, squared};

/// Step of the gradient in parts of what the stiffest mode of the filled lattice allows;
/// disordered clouds are somewhat stiffer.
const STEP: f64 = 0.87;

/// Momentum of the first sweep, as of accelerated gradients that are two sweeps old: the last pressure
/// is near, and what it lacks is smooth. From 1, the start of a cold solution, the same falls take
/// longer.
const MOMENTUM: f64 = 3.0;

/// Least diagonal in parts of the lattice's: a particle at the edge of another's reach must not
/// answer with a pressure without bound, which would strike when the two come closer.
const DIAGONAL_LEAST: f64 = 0.1;

/// Most excess of density that a whole step takes away. Flow stays far below it; what begins to flow
/// too densely, such as droplets that have frozen into one another, must come apart and not burst.
const RELEASE: f64 = 0.01;

/// Density that a solid particle leaves to a layer of liquid over what solid ones beside it have too
/// much by themselves.
const YIELD: f64 = 10.0;

/// Scratch of the solver; all slices `[m]` in the order of [`Near`].
#[derive(Debug, Clone)]
pub struct Projection {
    /// p \[Pa\].
    pub pressure: Vec<f32>,
    /// x from the middle of the cloud on \[m\].
    place: Vec<[f32; 3]>,
    /// y x and y, of the pressure y that the sweep tries: summed over a row with the weights
    /// (dW/dr)/r, four numbers at once, they give the row of J^T y.
    tried: Vec<[f32; 4]>,
    /// acc and acc . x, which give the row of J acc in the same way.
    field: Vec<[f32; 4]>,
    /// Middle of the cloud \[m\].
    origin: [f64; 3],
    /// u* and u* . x, x from the middle on.
    moved: Vec<[f64; 4]>,
    /// Sum of grad W.
    sums: Vec<[f32; 3]>,
    advanced: Vec<f32>,
    diagonal: Vec<f32>,
    residual: Vec<f32>,
    partial: Vec<Partial>,
    lattice: Lattice,
    scales: Scales,
}

/// Sums over one chunk of rows, added in the order of the chunks.
#[derive(Debug, Clone, Copy, Default)]
struct Partial {
    excess: f64,
    lack: f64,
    turn: f64,
}

/// Factors of the step.
#[derive(Debug, Clone, Copy, Default)]
struct Scales {
    /// nu, the volume that makes the lattice exactly dense \[m3\].
    volume: f64,
    /// nu/(rho kappa).
    force: f64,
    /// Step of the gradient in units of the diagonal.
    step: f32,
}

impl Projection {
    /// A solver for particles of `metal`.
    #[must_use]
    pub fn new(metal: Metal) -> Self {
        let lattice = Lattice::of(metal);
        let volume = 1.0 / lattice.number;
        Self {
            pressure: Vec::new(),
            place: Vec::new(),
            tried: Vec::new(),
            field: Vec::new(),
            origin: [0.0; 3],
            moved: Vec::new(),
            sums: Vec::new(),
            advanced: Vec::new(),
            diagonal: Vec::new(),
            residual: Vec::new(),
            partial: Vec::new(),
            lattice,
            scales: Scales {
                volume,
                force: volume / (metal.density * lattice.moment),
                step: (STEP / lattice.stiffest) as f32,
            },
        }
    }

    /// Finds p for the predicted velocities and turns these into the final ones. `near.virial`
    /// gets the share of p in the pressure which the metal carries.
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
        let dt = step.dt;
        self.prepare(near, dt);
        self.start(near, predicted, step);
        let mut momentum = MOMENTUM;
        let liquid = near.liquid_count().max(1) as f64;
        while solved.sweeps < tolerance.sweeps_max {
            self.accelerate(near);
            self.relax(near, dt);
            let sum = self.gathered();
            solved.sweeps += 1;
            solved.density_error = sum.excess.max(sum.lack) / liquid;
            if solved.sweeps >= tolerance.sweeps_min && solved.density_error <= tolerance.density {
                break;
            }
            let next = 0.5 * (1.0 + (1.0 + 4.0 * momentum * momentum).sqrt());
            let (weight, next) = if sum.turn > 0.0 {
                (0.0, MOMENTUM)
            } else {
                ((momentum - 1.0) / next, next)
            };
            momentum = next;
            self.extrapolate(weight as f32);
        }
        for (p, tried) in self.pressure.iter_mut().zip(&self.tried) {
            *p = tried[3];
        }
        self.push(near, predicted, step);
        solved
    }

    /// Columns of the present positions.
    fn prepare(&mut self, near: &Near, dt: f64) {
        let Scales { volume, force, .. } = self.scales;
        let n = near.len();
        self.pressure.resize(n, 0.0);
        self.advanced.resize(n, 0.0);
        self.residual.resize(n, 0.0);
        self.field.resize(n, [0.0; 4]);
        self.sums.resize(n, [0.0; 3]);
        self.partial.resize(n.div_ceil(ROWS), Partial::default());
        self.diagonal.resize(n, 0.0);
        self.place.resize(n, [0.0; 3]);
        self.tried.resize(n, [0.0; 4]);
        let scale = dt * dt * volume * force;
        let least = DIAGONAL_LEAST * self.lattice.gradient_squared;
        let origin = middle(&near.position);
        self.origin = origin;
        self.diagonal
            .par_iter_mut()
            .zip(&mut self.pressure)
            .zip(&mut self.place)
            .zip(&mut self.tried)
            .zip(&mut self.sums)
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(a, ((((diagonal, pressure), place), tried), sum))| {
                // The stiffest mode over the diagonal grows with the number of neighbours.
                let scale = scale * (volume * near.number[a]).max(1.0);
                let squares = near.squares[a];
                *diagonal = match near.role[a] {
                    Role::Liquid => {
                        (scale * (squares + squared(near.gradient[a])).max(least)) as f32
                    }
                    Role::Wet if squares > 0.0 => (scale * squares.max(least)) as f32,
                    _ => 0.0,
                };
                if *diagonal <= 0.0 {
                    *pressure = 0.0;
                }
                *sum = near.gradient[a].map(|x| x as f32);
                *place = minus(near.position[a], origin).map(|x| x as f32);
                *tried = carried(*place, *pressure);
            });
    }

    /// Fixed part of the residual, C + dt J u*, with
    /// (J u)_a = u_a . sum of grad W - D(u) . x_a + D(u . x).
    ///
    /// Where solid metal is packed too densely by itself, no liquid could mend it, and C leaves room
    /// for a layer of liquid all the same.
    fn start(&mut self, near: &Near, predicted: &[[f64; 3]], step: Step) {
        let (volume, beside) = (self.scales.volume, self.lattice.beside);
        let (scale, release) = (step.dt * volume, RELEASE * step.share);
        let (own, origin) = (near.kernel.value(0.0), self.origin);
        let points = predicted.par_iter().zip(&near.position);
        points
            .with_min_len(GRAIN)
            .map(|(u, x)| [u[0], u[1], u[2], dot(*u, minus(*x, origin))])
            .collect_into_vec(&mut self.moved);
        let moved = &self.moved;
        self.residual
            .par_chunks_mut(ROWS)
            .zip(near.lists.chunks())
            .zip(&near.pairs)
            .for_each(|((residual, chunk), pairs)| {
                for (k, residual) in residual.iter_mut().enumerate() {
                    let (a, range, row) = (chunk.first() + k, chunk.range(k), chunk.row(k));
                    let sum = summed_double(row, &pairs.slope[range.clone()], moved);
                    let (x, u) = (minus(near.position[a], origin), predicted[a]);
                    let rate = dot(u, near.gradient[a]) - dot([sum[0], sum[1], sum[2]], x) + sum[3];
                    let mut full = 1.0;
                    if near.role[a] != Role::Liquid {
                        let beside_it = row.iter().zip(&pairs.value[range]);
                        let solid = beside_it.fold(own, |solid, (&b, value)| {
                            let liquid = near.role[b as usize] == Role::Liquid;
                            solid + if liquid { 0.0 } else { *value }
                        });
                        let over = (volume * solid - 1.0).max(0.0);
                        full += over + (YIELD * over).min(volume * beside);
                    }
                    let excess = (volume * near.number[a] - full).min(release);
                    *residual = (excess + scale * rate) as f32;
                }
            });
    }

    /// acc = -J^T y / mass (eq. 3.94): with D the sum of (dW/dr)/r,
    /// sum of (y_a + y_b) grad W = y_a sum of grad W + D(y) x_a - D(y x).
    fn accelerate(&mut self, near: &Near) {
        let (tried, place, sums) = (&self.tried, &self.place, &self.sums);
        let scale = self.scales.force as f32;
        near.each_row(&mut self.field, |a, row, out| {
            *out = [0.0; 4];
            if near.role[a] == Role::Liquid {
                let sum = summed(row.index, row.slope, tried);
                let (x, own) = (place[a], tried[a][3]);
                let acc: [f32; 3] =
                    std::array::from_fn(|i| scale * (sum[i] - own * sums[a][i] - sum[3] * x[i]));
                let turned = acc[0] * x[0] + acc[1] * x[1] + acc[2] * x[2];
                *out = [acc[0], acc[1], acc[2], turned];
            }
        });
    }

    /// One projected gradient step from y; leaves the new point in `advanced`.
    ///
    /// (J acc)_a = acc_a . sum of grad W - D(acc) . x_a + D(acc . x).
    fn relax(&mut self, near: &Near, dt: f64) {
        let (tried, field, place, sums) = (&self.tried, &self.field, &self.place, &self.sums);
        let (residual, diagonal, old) = (&self.residual, &self.diagonal, &self.pressure);
        let scale = (dt * dt * self.scales.volume) as f32;
        let step = self.scales.step;
        self.advanced
            .par_chunks_mut(ROWS)
            .zip(&mut self.partial)
            .zip(near.lists.chunks())
            .zip(&near.pairs)
            .for_each(|(((out, partial), chunk), pairs)| {
                *partial = Partial::default();
                for (k, out) in out.iter_mut().enumerate() {
                    let a = chunk.first() + k;
                    *out = 0.0;
                    if diagonal[a] <= 0.0 {
                        continue;
                    }
                    let sum = summed(chunk.row(k), &pairs.slope[chunk.range(k)], field);
                    let (x, own) = (place[a], field[a]);
                    let mut rate = sum[3];
                    for i in 0..3 {
                        rate += own[i] * sums[a][i] - sum[i] * x[i];
                    }
                    let error = residual[a] + scale * rate;
                    let y = tried[a][3];
                    *out = (y + step * error / diagonal[a]).max(0.0);
                    if error > 0.0 {
                        partial.excess += f64::from(error);
                    } else if y > 0.0 {
                        partial.lack -= f64::from(error);
                    }
                    partial.turn += f64::from(diagonal[a] * (y - *out) * (*out - old[a]));
                }
            });
    }

    /// y = p_new + weight (p_new - p); p = p_new.
    fn extrapolate(&mut self, weight: f32) {
        let points = self.tried.par_iter_mut().zip(&self.place);
        points
            .zip(&self.advanced)
            .zip(&mut self.pressure)
            .with_min_len(GRAIN)
            .for_each(|(((y, x), &new), p)| {
                *y = carried(*x, (new + weight * (new - *p)).max(0.0));
                *p = new;
            });
    }

    /// Sums over all particles.
    fn gathered(&self) -> Partial {
        self.partial
            .iter()
            .fold(Partial::default(), |sum, part| Partial {
                excess: sum.excess + part.excess,
                lack: sum.lack + part.lack,
                turn: sum.turn + part.turn,
            })
    }

    /// Adds dt acc(p) to the velocities and the virial of p to that of the forces.
    ///
    /// In a disordered cloud the sum of `p_a + p_b` stands for a pressure that differs from p by
    /// some per cent; the virial is what balances the outer forces. Wet solid particles lack
    /// neighbours behind, they get p itself.
    fn push(&self, near: &mut Near, predicted: &mut [[f64; 3]], step: Step) {
        let scale = step.dt * self.scales.force;
        let share = step.share * step.metal.density * self.scales.force / 6.0;
        let (pressure, role, position) = (&self.pressure, &near.role, &near.position);
        near.virial
            .par_chunks_mut(ROWS)
            .zip(predicted.par_chunks_mut(ROWS))
            .zip(near.lists.chunks())
            .zip(&near.pairs)
            .for_each(|(((virial, predicted), chunk), pairs)| {
                for (k, (virial, u)) in virial.iter_mut().zip(predicted).enumerate() {
                    let a = chunk.first() + k;
                    let own = f64::from(pressure[a]);
                    if role[a] != Role::Liquid {
                        *virial = own;
                        continue;
                    }
                    let (mut sum, mut stretched) = ([0.0; 3], 0.0);
                    for (&b, &slope) in chunk.row(k).iter().zip(&pairs.slope[chunk.range(k)]) {
                        let b = b as usize;
                        let dx = minus(position[a], position[b]);
                        let weight = f64::from(slope) * (own + f64::from(pressure[b]));
                        sum = plus(sum, weight, dx);
                        stretched -= weight * squared(dx);
                    }
                    *virial += share * stretched;
                    *u = plus(*u, -scale, sum);
                }
            });
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.tried.capacity() * (4 * 4 + 2 * 12 + 2 * 16 + 32)
    }
}
