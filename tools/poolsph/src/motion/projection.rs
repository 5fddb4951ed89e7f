//! Projection: the pressure that keeps every particle's density at or below that of the metal.
//!
//! With the relative density excess C_a = nu (W_0 + sum_b W_ab) + G_a - 1, nu the lattice's volume, G_a what grains take, and
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
//! restart (Nesterov; O'Donoghue and Candes 2015; Mazhar et al. 2015 for contacts), two sums over
//! pairs per iteration, starting from the last pressure. What that does to the velocities is part of
//! the first residual; the sums are those of its change alone, and the first iteration needs none. It
//! is the pressure tried last whose residual meets the tolerance; the step on from there, which costs
//! no sum, is taken too, and leaves less (3.9e-5 for 5e-5). Wet solid particles have a pressure of
//! their own, by the same condition on their density, and infinite mass: walls push, never pull.
//! A particle of the free surface lacks neighbours, so its condition is slack and its p zero.
//!
//! Sweeps run in single precision; the force of the p found is added in double precision, so that
//! momentum is kept to round-off. Sums of differences over a row are taken apart, so that a pair
//! costs four products: what cancels is larger than what is left by the size L of the cloud over
//! h. The error in C, 1e-7 (L/h) times the share dt^2 J acc, stays far below the tolerance; the
//! part by u* is summed in the same way in double precision.

use neighbours::ROWS;
use particles::Matter;
use rayon::prelude::*;
use shapes::frame::{difference, dot, squared};

use super::lattice::Lattice;
use super::push::Push;
use super::step::{Solved, Step, Tolerance};
use crate::near::{Near, Role};
use crate::sweep::{GRAIN, carried, middle, summed, summed_double};

/// Step of the gradient in parts of what the stiffest mode of the filled lattice allows; disorder is somewhat stiffer.
const STEP: f64 = 0.87;

/// Momentum of the first sweep, as of accelerated gradients that are some sweeps old: the last pressure
/// is near, and what it lacks is smooth. From 1, that of a cold start, the same falls take longer.
const MOMENTUM: f64 = 4.0;

/// Least diagonal in parts of the lattice's: a particle at the edge of another's reach must not answer with a pressure
/// without bound, which would strike when they come closer.
const DIAGONAL_LEAST: f64 = 0.1;

/// Most excess of density that a whole step takes away. Flow stays far below it; what begins to flow too densely, such
/// as droplets that have frozen into one another, must come apart and not burst.
const RELEASE: f64 = 0.01;

/// Density that a solid particle leaves to a layer of liquid over what solid ones beside it have too much by themselves.
const YIELD: f64 = 10.0;

/// Scratch of the solver; all slices `[m]` in the order of [`Near`].
#[derive(Debug, Clone)]
pub struct Projection {
    /// p \[Pa\].
    pub pressure: Vec<f32>,
    /// The pressure y that the sweep tries \[Pa\].
    tried: Vec<f32>,
    /// Pressure of the last step, whose response is part of the residual \[Pa\].
    before: Vec<f32>,
    /// x from the middle of the cloud on \[m\].
    place: Vec<[f32; 3]>,
    /// q x and q, q what y has over the last pressure: their sums over a row by (dW/dr)/r give the row of J^T q.
    change: Vec<[f32; 4]>,
    /// acc and acc . x, which give the row of J acc in the same way.
    field: Vec<[f32; 4]>,
    /// Middle of the cloud \[m\].
    origin: [f64; 3],
    /// u and u . x, x from the middle on.
    moved: Vec<[f64; 4]>,
    /// Sum of grad W.
    sums: Vec<[f32; 3]>,
    advanced: Vec<f32>,
    diagonal: Vec<f32>,
    /// C + dt J u with the velocities u that the last pressure gives.
    residual: Vec<f32>,
    /// That of y.
    error: Vec<f32>,
    partial: Vec<Partial>,
    push: Push,
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
    pub fn new(metal: Matter) -> Self {
        let lattice = Lattice::of(metal);
        let volume = 1.0 / lattice.number;
        Self {
            pressure: Vec::new(),
            place: Vec::new(),
            tried: Vec::new(),
            before: Vec::new(),
            change: Vec::new(),
            field: Vec::new(),
            origin: [0.0; 3],
            moved: Vec::new(),
            sums: Vec::new(),
            advanced: Vec::new(),
            diagonal: Vec::new(),
            residual: Vec::new(),
            error: Vec::new(),
            partial: Vec::new(),
            push: Push::default(),
            lattice,
            scales: Scales {
                volume,
                force: volume / (metal.density * lattice.moment),
                step: (STEP / lattice.stiffest) as f32,
            },
        }
    }

    /// Finds p for the predicted velocities and makes these final; its share of the pressure goes to `near.virial`.
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
        self.accelerate(near);
        self.start(near, predicted, step);
        let mut momentum = MOMENTUM;
        let liquid = near.liquid_count().max(1) as f64;
        while solved.sweeps < tolerance.sweeps_max {
            if solved.sweeps > 0 {
                self.accelerate(near);
                self.respond(near, dt);
            }
            let sum = self.relax();
            solved.sweeps += 1;
            solved.density_error = sum.excess.max(sum.lack) / liquid;
            let next = 0.5 * (1.0 + (1.0 + 4.0 * momentum * momentum).sqrt());
            let (weight, next) = if sum.turn > 0.0 {
                (0.0, MOMENTUM)
            } else {
                ((momentum - 1.0) / next, next)
            };
            momentum = next;
            self.extrapolate(weight as f32);
            self.reflect(near);
            if solved.sweeps >= tolerance.sweeps_min && solved.density_error <= tolerance.density {
                break;
            }
        }
        self.pressure.copy_from_slice(&self.tried);
        let (pressure, scale) = (&self.pressure, self.scales.force);
        self.push.apply(near, pressure, predicted, step, scale);
        solved
    }

    /// Columns of the present positions.
    fn prepare(&mut self, near: &Near, dt: f64) {
        let Scales { volume, force, .. } = self.scales;
        let n = near.len();
        self.pressure.resize(n, 0.0);
        self.advanced.resize(n, 0.0);
        self.residual.resize(n, 0.0);
        self.error.resize(n, 0.0);
        self.field.resize(n, [0.0; 4]);
        self.sums.resize(n, [0.0; 3]);
        self.partial.resize(n.div_ceil(ROWS), Partial::default());
        self.diagonal.resize(n, 0.0);
        let origin = middle(&near.position);
        self.origin = origin;
        let places = near.position.par_iter().with_min_len(GRAIN);
        places
            .map(|x| difference(*x, origin).map(|x| x as f32))
            .collect_into_vec(&mut self.place);
        self.change.resize(n, [0.0; 4]);
        let scale = dt * dt * volume * force;
        let least = DIAGONAL_LEAST * self.lattice.gradient_squared;
        self.diagonal
            .par_iter_mut()
            .zip(&mut self.pressure)
            .zip(&self.place)
            .zip(&mut self.change)
            .zip(&mut self.sums)
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(a, ((((diagonal, pressure), place), change), sum))| {
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
                *change = carried(*place, *pressure);
            });
        self.reflect(near);
        self.before.clone_from(&self.pressure);
        self.tried.clone_from(&self.pressure);
    }

    /// The residual of the last pressure, C + dt J u with u = u* + dt acc, and
    /// (J u)_a = u_a . sum of grad W - D(u) . x_a + D(u . x).
    ///
    /// Where solid metal is packed too densely by itself, no liquid could mend it, and C leaves room
    /// for a layer of liquid all the same.
    fn start(&mut self, near: &Near, predicted: &[[f64; 3]], step: Step) {
        let (volume, beside) = (self.scales.volume, self.lattice.beside);
        let (scale, release) = (step.dt * volume, RELEASE * step.share);
        let (own, origin) = (near.kernel.value(0.0), self.origin);
        let points = predicted.par_iter().zip(&self.field).zip(&near.position);
        points
            .with_min_len(GRAIN)
            .map(|((u, acc), x)| {
                let u: [f64; 3] = std::array::from_fn(|i| u[i] + step.dt * f64::from(acc[i]));
                [u[0], u[1], u[2], dot(u, difference(*x, origin))]
            })
            .collect_into_vec(&mut self.moved);
        near.complete(&mut self.moved, |[u, v, w, _], k, turn| {
            let u = turn.vector([u, v, w]);
            let x = difference(near.position[k], origin);
            [u[0], u[1], u[2], dot(u, x)]
        });
        let moved = &self.moved;
        near.each_row(
            &mut self.residual,
            #[inline(always)]
            |a, row, residual| {
                let [p, q, r, turned] = summed_double(row.index, row.slope, moved);
                let (x, [u, v, w, _]) = (difference(near.position[a], origin), moved[a]);
                let rate = dot([u, v, w], near.gradient[a]) - dot([p, q, r], x) + turned;
                let mut full = 1.0;
                if near.role[a] != Role::Liquid {
                    let solid = row.values().fold(own, |solid, (b, value)| {
                        let liquid = near.role[b].flows();
                        solid + if liquid { 0.0 } else { value }
                    });
                    let over = (volume * solid - 1.0).max(0.0);
                    full += over + (YIELD * over).min(volume * beside);
                }
                full -= near.taken.get(a).copied().unwrap_or(0.0);
                let excess = (volume * near.number[a] - full).min(release);
                *residual = (excess + scale * rate) as f32;
            },
        );
        self.error.clone_from(&self.residual);
    }

    /// acc = -J^T q / mass (eq. 3.94): with D the sum of (dW/dr)/r,
    /// sum of (q_a + q_b) grad W = q_a sum of grad W + D(q) x_a - D(q x).
    fn accelerate(&mut self, near: &Near) {
        let (change, place, sums) = (&self.change, &self.place, &self.sums);
        let scale = self.scales.force as f32;
        near.each_row(
            &mut self.field,
            #[inline(always)]
            |a, row, out| {
                *out = [0.0; 4];
                if near.role[a] == Role::Liquid {
                    let sum = summed(row.index, row.slope, change);
                    let (x, own) = (place[a], change[a][3]);
                    let acc: [f32; 3] = std::array::from_fn(|i| {
                        scale * (sum[i] - own * sums[a][i] - sum[3] * x[i])
                    });
                    let turned = acc[0] * x[0] + acc[1] * x[1] + acc[2] * x[2];
                    *out = [acc[0], acc[1], acc[2], turned];
                }
            },
        );
        near.complete(&mut self.field, |[u, v, w, _], k, turn| {
            let [u, v, w] = turn.vector([u, v, w].map(f64::from)).map(|x| x as f32);
            let x = place[k];
            [u, v, w, u * x[0] + v * x[1] + w * x[2]]
        });
    }

    /// Gives the images beyond the faces the q of their originals.
    fn reflect(&mut self, near: &Near) {
        let place = &self.place;
        near.complete(&mut self.change, |[.., q], k, _| carried(place[k], q));
    }

    /// The residual of y, with (J acc)_a = acc_a . sum of grad W - D(acc) . x_a + D(acc . x).
    fn respond(&mut self, near: &Near, dt: f64) {
        let (field, place, sums) = (&self.field, &self.place, &self.sums);
        let (residual, diagonal) = (&self.residual, &self.diagonal);
        let scale = (dt * dt * self.scales.volume) as f32;
        near.each_row(
            &mut self.error,
            #[inline(always)]
            |a, row, error| {
                if diagonal[a] > 0.0 {
                    let sum = summed(row.index, row.slope, field);
                    let (x, own) = (place[a], field[a]);
                    let mut rate = sum[3];
                    for i in 0..3 {
                        rate += own[i] * sums[a][i] - sum[i] * x[i];
                    }
                    *error = residual[a] + scale * rate;
                }
            },
        );
    }

    /// One projected gradient step from y; leaves the new point in `advanced`.
    fn relax(&mut self) -> Partial {
        let step = self.scales.step;
        self.advanced
            .par_chunks_mut(ROWS)
            .zip(&mut self.partial)
            .zip(self.error.par_chunks(ROWS))
            .zip(self.diagonal.par_chunks(ROWS))
            .zip(self.tried.par_chunks(ROWS))
            .zip(self.pressure.par_chunks(ROWS))
            .for_each(|(((((out, partial), error), diagonal), tried), old)| {
                *partial = Partial::default();
                let columns = error.iter().zip(diagonal).zip(tried).zip(old);
                for (out, (((&error, &diagonal), &y), &old)) in out.iter_mut().zip(columns) {
                    *out = 0.0;
                    if diagonal <= 0.0 {
                        continue;
                    }
                    *out = (y + step * error / diagonal).max(0.0);
                    if error > 0.0 {
                        partial.excess += f64::from(error);
                    } else if y > 0.0 {
                        partial.lack -= f64::from(error);
                    }
                    partial.turn += f64::from(diagonal * (y - *out) * (*out - old));
                }
            });
        self.gathered()
    }

    /// y = p_new + weight (p_new - p); p = p_new.
    fn extrapolate(&mut self, weight: f32) {
        let points = (self.tried.par_iter_mut().zip(&mut self.change)).zip(&self.place);
        let points = points.zip(&self.before);
        points
            .zip(&self.advanced)
            .zip(&mut self.pressure)
            .with_min_len(GRAIN)
            .for_each(|(((((y, change), x), before), &new), p)| {
                *y = (new + weight * (new - *p)).max(0.0);
                *change = carried(*x, *y - before);
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

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.tried.capacity() * (7 * 4 + 2 * 12 + 2 * 16 + 32) + self.push.bytes()
    }
}
