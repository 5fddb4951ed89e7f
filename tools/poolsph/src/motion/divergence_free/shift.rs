//! Shifting of particles to where they lie evenly (Lind, Xu, Stansby and Rogers 2012).
//!
//! ```text
//! dx_a = -D sum of grad W / n        D = d^2 min(8 u dt/d, 0.3)
//! ```
//!
//! with the fastest speed u and the lattice's density of particles n: a cloud is made even as fast as it can be made
//! uneven, and one at rest stays. Particles of the surface are not shifted, so that it goes with the flow. What is
//! shifted takes its velocity and its heat along: momentum and energy are kept, and the error is that of a diffusion by
//! the ways of the shifts, which are a few per cent of a spacing at most.

use rayon::prelude::*;

use super::operators::Filled;
use crate::near::{Near, Role};
use crate::sweep::GRAIN;
use crate::vector::{plus, squared};

/// D in d^2 for a way of one spacing in a step, and its bound (a half would overshoot).
const STRENGTH: [f64; 2] = [8.0, 0.3];
/// Longest shift in spacings.
const FARTHEST: f64 = 0.05;
/// Lack of neighbours from which on a particle counts as one of the surface.
const SURFACE: f64 = 0.1;

/// Scratch, `[m]` in the order of [`Near`].
#[derive(Debug, Clone, Default)]
pub(super) struct Shift {
    /// \[m\].
    way: Vec<[f64; 3]>,
}

impl Shift {
    /// Shifts the liquid by its density at the beginning of the step of `dt` \[s\].
    pub(super) fn apply(&mut self, near: &mut Near, dt: f64, filled: Filled) {
        let (d, own) = (filled.spacing, near.kernel.value(0.0));
        let [gain, most] = STRENGTH;
        let reach = d * d * (gain * near.fastest_squared().sqrt() * dt / d).min(most);
        let full = filled.number - own;
        let rows = near.gradient.par_iter().zip(&near.number).zip(&near.role);
        rows.with_min_len(GRAIN)
            .map(|((gradient, number), role)| {
                if *role != Role::Liquid || number - own < (1.0 - SURFACE) * full {
                    return [0.0; 3];
                }
                let way = gradient.map(|x| -reach * x / filled.number);
                let size = squared(way).sqrt();
                let part = if size > FARTHEST * d {
                    FARTHEST * d / size
                } else {
                    1.0
                };
                way.map(|x| part * x)
            })
            .collect_into_vec(&mut self.way);
        let points = near.position.par_iter_mut().zip(&self.way);
        points
            .with_min_len(GRAIN)
            .for_each(|(x, way)| *x = plus(*x, 1.0, *way));
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        24 * self.way.capacity()
    }
}
