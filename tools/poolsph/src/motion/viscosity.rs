//! Viscous acceleration by the Laplacian of the moving-particle method.
//!
//! ```text
//! (1/rho) div(mu grad u)_a = 2 D / (rho lambda N) sum_b mu_ab (u_b - u_a) W_ab
//! lambda = sum |x_ab|^2 W_ab / sum W_ab,   N = sum W_ab      Komen (2019), eqs 3.95-3.99
//! mu_ab = 2 mu_a mu_b / (mu_a + mu_b)                        Komen (2019), eq. 5.32
//! ```
//!
//! The 1/rho stands once, as the errata say of eq. 3.99. lambda N is the sum of r^2 W; here it is
//! that of the filled lattice for every particle, so that a pair force is the same seen from both
//! sides and momentum is kept (the local one would also overstate the force at a free surface).
//! Solid neighbours stand still: the wall sticks, with the viscosity of the liquid at it.
//!
//! Eq. 3.99 prints the arithmetic mean of both viscosities, eq. 5.32 the harmonic one. The harmonic mean is that of two
//! layers in series: where the viscosity jumps, the stress comes out as on either side of it, and the thin side alone
//! tells how fast a stiff one drags it. Where the viscosity is smooth both are of second order.

use kernels::CubicSpline;
use rayon::prelude::*;

use super::around::Around;
use super::law::Law;
use crate::near::{Near, Role, minus, plus};
use crate::stage::StageError;
use crate::state::Metal;
use crate::sweep::GRAIN;

/// Newtonian viscosity of the liquid.
#[derive(Debug, Clone)]
pub struct Viscosity {
    law: Law,
    /// 2 D / (rho lambda N) \[m3/s per Pa s\].
    scale: f64,
    /// Largest explicit step \[s\].
    limit: f64,
    /// mu of each particle \[Pa s\], `[m]` in the order of [`Near`]; empty where it is the same for all.
    each: Vec<f64>,
    /// Sum of mu_ab (u_b - u_a) W_ab.
    sums: Vec<[f64; 3]>,
}

impl Viscosity {
    /// The viscosity of a `law` in `metal`.
    #[must_use]
    pub fn new(law: Law, metal: Metal) -> Self {
        let kernel = CubicSpline::<3>::new(metal.smoothing_length);
        let reach = (kernel.support() / metal.spacing).ceil() as i32;
        let (mut moment, mut number) = (0.0, 0.0);
        for i in -reach..=reach {
            for j in -reach..=reach {
                for k in -reach..=reach {
                    let r = metal.spacing * f64::from(i * i + j * j + k * k).sqrt();
                    moment += r * r * kernel.value(r);
                    number += kernel.value(r);
                }
            }
        }
        number -= kernel.value(0.0);
        // In this order: a change in the last digit would change all runs.
        let largest = 6.0 * law.largest() / (metal.density * moment);
        Self {
            scale: match law {
                Law::Uniform(_) => largest,
                Law::OfTemperature { .. } => 6.0 / (metal.density * moment),
            },
            law,
            limit: 1.0 / (largest * number),
            each: Vec::new(),
            sums: Vec::new(),
        }
    }

    /// True if there is any.
    #[must_use]
    pub fn acts(&self) -> bool {
        self.law.largest() > 0.0
    }

    /// True if one viscosity holds for all liquid.
    #[must_use]
    pub fn uniform(&self) -> bool {
        matches!(self.law, Law::Uniform(_))
    }

    /// Takes the viscosity of each particle from its temperature \[K\], by index in the state.
    ///
    /// # Errors
    /// When liquid has a temperature for which the scene has no viscosity.
    pub fn take(&mut self, near: &Near, temperature: &[f64]) -> Result<(), StageError> {
        if self.uniform() {
            return Ok(());
        }
        let law = &self.law;
        for (&id, role) in near.id.iter().zip(&near.role) {
            if *role == Role::Liquid {
                law.covers(temperature[id as usize])?;
            }
        }
        let ids = near.id.par_iter().with_min_len(GRAIN);
        ids.map(|&id| law.at(temperature, id as usize))
            .collect_into_vec(&mut self.each);
        Ok(())
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        8 * self.each.capacity() + 24 * self.sums.capacity()
    }

    /// Largest explicit step that damps every mode without overshoot \[s\].
    #[must_use]
    pub fn limit(&self) -> f64 {
        self.limit
    }

    /// Adds `dt` times the viscous acceleration of `near.velocity` to `predicted`; `around` holds the
    /// sums of this velocity, which one viscosity for all goes by. The velocity of solid neighbours is zero.
    pub fn apply(&mut self, near: &Near, around: &Around, dt: f64, predicted: &mut [[f64; 3]]) {
        if self.uniform() {
            self.same(near, around, dt, predicted);
        } else {
            self.pairs(near, dt, predicted);
        }
    }

    fn same(&self, near: &Near, around: &Around, dt: f64, predicted: &mut [[f64; 3]]) {
        let own = near.kernel.value(0.0);
        let rows = near.velocity.par_iter().zip(&near.role).zip(&near.number);
        predicted
            .par_iter_mut()
            .zip(&around.sums)
            .zip(rows)
            .with_min_len(GRAIN)
            .for_each(|((out, sum), ((u, role), number))| {
                if *role == Role::Liquid {
                    // Without neighbours the number is zero.
                    let weight = (number - own).max(0.0);
                    let sum = std::array::from_fn(|i| sum[i] - weight * u[i]);
                    *out = plus(*out, dt * self.scale, sum);
                }
            });
    }

    fn pairs(&mut self, near: &Near, dt: f64, predicted: &mut [[f64; 3]]) {
        let (each, scale) = (&self.each, self.scale);
        self.sums.resize(near.len(), [0.0; 3]);
        near.each_row(&mut self.sums, |a, row, out| {
            *out = [0.0; 3];
            if near.role[a] != Role::Liquid {
                return;
            }
            let own = each[a];
            for (b, w) in row.values() {
                let mean = match near.role[b] {
                    Role::Liquid if own + each[b] > 0.0 => 2.0 * own * each[b] / (own + each[b]),
                    Role::Liquid => 0.0,
                    _ => own,
                };
                *out = plus(*out, w * mean, minus(near.velocity[b], near.velocity[a]));
            }
        });
        let sums = self.sums.par_iter().with_min_len(GRAIN);
        (predicted.par_iter_mut().zip(sums)).for_each(|(u, sum)| *u = plus(*u, dt * scale, *sum));
    }
}
