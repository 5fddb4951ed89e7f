//! Shifting of particles to where they lie evenly (Lind, Xu, Stansby and Rogers 2012).
//!
//! ```text
//! dx_a = -D sum of grad W / n        D = d^2 min(8 u dt/d, 0.3)
//! ```
//!
//! with the fastest speed u and the lattice's density of particles n: a cloud is made even as fast as it can be made
//! uneven, and one at rest stays. Particles of the surface are shifted along it alone (Lind et al., eq. 27), so that it
//! goes with the flow; not at all where tension acts, which keeps it even.
//!
//! Inside, what is shifted gets the velocity of the place to which it comes, u + dx.grad u (Xu, Stansby and Laurence 2009,
//! eq. 22): without that, shifts act as a viscosity, which let vortices of 20 spacings at Re 1000 decay a quarter too fast.
//! The sum of these changes is taken from each body that touches no wall, so that its momentum is kept. Particles of the
//! surface keep their velocity: the few neighbours of a tip tell too steep a slope, and it would throw them off. So does
//! all where tension acts: a drop without viscosity lives by what damps single particles. Heat goes along.

use rayon::prelude::*;
use shapes::frame::{along, dot, squared};

use super::filled::Filled;
use super::interface::Interface;
use super::normals::Normals;
use super::operators::Sums;
use crate::near::{Near, Role};
use crate::sweep::GRAIN;

/// D in d^2 for a way of one spacing in a step, and its bound (a half would overshoot).
const STRENGTH: [f64; 2] = [8.0, 0.3];
/// Lack of neighbours from which on a particle of a surface with tension counts as one of it.
const SURFACE: f64 = 0.1;
/// Longest shift in spacings.
const FARTHEST: f64 = 0.05;

/// Scratch, `[m]` in the order of [`Near`].
#[derive(Debug, Clone, Default)]
pub(super) struct Shift {
    /// \[m\].
    way: Vec<[f64; 3]>,
    /// \[m/s\].
    change: Vec<[f64; 3]>,
}

/// The surfaces that particles are shifted along.
#[derive(Clone, Copy)]
pub(super) struct Surfaces<'a> {
    /// Tell where the free surface is.
    pub(super) rows: &'a [Sums],
    /// Normals of it.
    pub(super) normals: &'a Normals,
    /// That between two liquids.
    pub(super) interface: &'a Interface,
}

impl Shift {
    /// Finds ways by the density at the beginning of the step of `dt` \[s\], as far as they lead through no interface; gives the changes of
    /// velocity \[m/s\], to be balanced over each body.
    pub(super) fn find(
        &mut self,
        near: &Near,
        filled: Filled,
        surfaces: Surfaces<'_>,
        dt: f64,
    ) -> &mut Vec<[f64; 3]> {
        let Surfaces {
            rows,
            normals,
            interface,
        } = surfaces;
        let (d, own) = (filled.spacing, near.kernel.value(0.0));
        let [gain, most] = STRENGTH;
        let reach = d * d * (gain * near.fastest_squared().sqrt() * dt / d).min(most);
        let tense = !near.tension.is_empty();
        let points = near.gradient.par_iter().zip(rows).zip(&near.role);
        points
            .enumerate()
            .with_min_len(GRAIN)
            .map(|(a, ((gradient, row), role))| {
                let open = if tense {
                    near.number[a] - own < (1.0 - SURFACE) * (filled.number - own)
                } else {
                    row.missing > 0.0
                };
                if *role != Role::Liquid || (open && tense) {
                    return [0.0; 3];
                }
                let mut way = gradient.map(|x| -reach * x / filled.number);
                if open {
                    let normal = normals.at(a);
                    if squared(normal) <= 0.0 {
                        return [0.0; 3];
                    }
                    way = along(way, -dot(way, normal), normal);
                }
                let way = interface.along(a, way);
                let size = squared(way).sqrt();
                let part = if size > FARTHEST * d {
                    FARTHEST * d / size
                } else {
                    1.0
                };
                way.map(|x| part * x)
            })
            .collect_into_vec(&mut self.way);
        let ways = self.way.par_iter().zip(rows).with_min_len(GRAIN);
        let along = |(way, row): (&[f64; 3], &Sums)| {
            if tense || row.missing > 0.0 {
                return [0.0; 3];
            }
            let [x, y, z] = *way;
            let [u, v, w] = row.slope;
            std::array::from_fn(|i| x * u[i] + y * v[i] + z * w[i])
        };
        ways.map(along).collect_into_vec(&mut self.change);
        &mut self.change
    }

    /// Shifts the liquid.
    pub(super) fn apply(&self, near: &mut Near) {
        let points = near.position.par_iter_mut().zip(&mut near.velocity);
        points
            .zip(&self.way)
            .zip(&self.change)
            .with_min_len(GRAIN)
            .for_each(|(((x, u), way), change)| {
                *x = along(*x, 1.0, *way);
                *u = along(*u, 1.0, *change);
            });
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        24 * (self.way.capacity() + self.change.capacity())
    }
}
