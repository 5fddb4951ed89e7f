//! Viscous acceleration by the Laplacian of the moving-particle method.
//!
//! ```text
//! (1/rho) div(mu grad u)_a = 2 D / (rho lambda N) sum_b (mu_a + mu_b)/2 (u_b - u_a) W_ab
//! lambda = sum |x_ab|^2 W_ab / sum W_ab,   N = sum W_ab      Komen (2019), eqs 3.95-3.99
//! ```
//!
//! The 1/rho stands once, as the errata say of eq. 3.99. lambda N is the sum of r^2 W; here it is
//! that of the filled lattice for every particle, so that a pair force is the same seen from both
//! sides and momentum is kept (the local one would also overstate the force at a free surface).
//! Solid neighbours stand still: the wall sticks.

use kernels::CubicSpline;
use rayon::prelude::*;

use super::around::Around;
use crate::near::{Near, Role, plus};
use crate::state::Metal;
use crate::sweep::GRAIN;

/// Newtonian viscosity, one mu for all liquid.
#[derive(Debug, Clone, Copy)]
pub struct Viscosity {
    /// 2 D mu / (rho lambda N) \[m3/s\].
    scale: f64,
    /// Largest explicit step \[s\].
    limit: f64,
}

impl Viscosity {
    /// mu \[Pa s\] in `metal`.
    #[must_use]
    pub fn new(viscosity: f64, metal: Metal) -> Self {
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
        let scale = 6.0 * viscosity / (metal.density * moment);
        Self {
            scale,
            limit: 1.0 / (scale * number),
        }
    }

    /// Largest explicit step that damps every mode without overshoot \[s\].
    #[must_use]
    pub fn limit(&self) -> f64 {
        self.limit
    }

    /// Adds `dt` times the viscous acceleration of `near.velocity` to `predicted`; `around` holds the
    /// sums of this velocity. The velocity of solid neighbours is zero.
    pub fn apply(&self, near: &Near, around: &Around, dt: f64, predicted: &mut [[f64; 3]]) {
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
}
