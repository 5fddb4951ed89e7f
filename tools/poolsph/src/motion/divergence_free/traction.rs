//! What viscosity does at a free surface.
//!
//! Pairs of particles that slow each other ([`crate::motion::viscosity`]) are mu times the Laplacian inside, and leave the surface to a stress
//! mu (n . grad) u. The surface bears none of mu (grad u + grad u^T): what the transposed part has there,
//!
//! ```text
//! F = 2 mu grad(u).grad C        F_i = 2 mu (d u_j/d x_i) (d C/d x_j)
//! ```
//!
//! is a force on the surface layer. The gradient of the colour C is the normal times what the surface has in a volume, half of it within
//! the metal. Inside the transposed part is the gradient of the divergence, which is zero, so that over a closed surface it adds up to nothing. Without it a drop that stretches pays half
//! of what it should, and one that turns as a whole is slowed. A shear along a plane surface has none of it.

use rayon::prelude::*;
use shapes::frame::{along, difference, dot, squared};

use super::normals::Normals;
use crate::motion::viscosity::Viscosity;
use crate::near::{Near, Row};
use crate::sweep::GRAIN;

/// Least determinant of the moments, over the cube of their mean, that tells a gradient.
const FLAT: f64 = 1e-3;

/// The force with its scratch.
#[derive(Debug, Clone, Default)]
pub(super) struct Traction {
    /// 2 mu grad(u).grad C, `[m]` \[N/m3\].
    pull: Vec<[f64; 3]>,
}

impl Traction {
    /// What the surface does with `near.velocity` \[N/m3\], to be balanced over each body.
    pub(super) fn pull(
        &mut self,
        near: &Near,
        viscosity: &Viscosity,
        normals: &Normals,
    ) -> &mut [[f64; 3]] {
        self.pull.resize(near.len(), [0.0; 3]);
        near.each_row(&mut self.pull, |a, row, pull| {
            let steep = normals.steep(a);
            *pull = [0.0; 3];
            if squared(steep) > 0.0 {
                let strength = -2.0 * viscosity.at(a);
                *pull = turned(near, a, row, steep).map(|x| strength * x);
            }
        });
        &mut self.pull
    }

    /// Adds it to `predicted` over `dt` \[s\].
    pub(super) fn apply(&self, near: &Near, dt: f64, predicted: &mut [[f64; 3]]) {
        let rows = predicted.par_iter_mut().zip(&self.pull).enumerate();
        rows.with_min_len(GRAIN)
            .for_each(|(a, (u, pull))| *u = along(*u, dt / near.density(a), *pull));
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        24 * self.pull.capacity()
    }
}

/// grad(u) . v at `a`, with the velocities of the liquid around: by M^-1 of the moments, sum of w x_i (u_b - u_a) . v;
/// zero where the neighbours span no space.
fn turned(near: &Near, a: usize, row: Row<'_>, v: [f64; 3]) -> [f64; 3] {
    let (mut sum, mut moment) = ([0.0; 3], [[0.0; 3]; 3]);
    for (b, slope) in row.slopes().filter(|(b, _)| near.role[*b].flows()) {
        let x = difference(near.position[b], near.position[a]);
        let rise = dot(difference(near.velocity[b], near.velocity[a]), v);
        sum = along(sum, -slope * rise, x);
        for (line, part) in moment.iter_mut().zip(x) {
            *line = along(*line, -slope * part, x);
        }
    }
    let minor = |i: usize, j: usize| {
        let (r, s, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        moment[r][c] * moment[s][d] - moment[r][d] * moment[s][c]
    };
    let determinant: f64 = (0..3).map(|j| moment[0][j] * minor(0, j)).sum();
    let size = (moment[0][0] + moment[1][1] + moment[2][2]) / 3.0;
    if size <= 0.0 || determinant <= FLAT * size.powi(3) {
        return [0.0; 3];
    }
    [0, 1, 2].map(|i| (0..3).map(|j| minor(i, j) * sum[j]).sum::<f64>() / determinant)
}
