//! Media whose permeability depends on the field, where currents flow in them.
//!
//! `nu_0 curl B = -mu_a sigma dA/dt + curl P` with the values of P at points and on the sides of interfaces, by the first derivatives
//! of the rows: as much of H as leaves one point comes to others, so that fronts of saturation move as far as the flux
//! that they hold lets them.

use rayon::prelude::*;

use crate::magnetic::saturation::equations::{Saturation, Seen};
use crate::magnetic::unknown::Unknown;
use crate::stencils::region::Kind;

impl<const D: usize> Saturation<'_, D> {
    /// Puts `-curl P / nu_0` into the rows of points where currents flow.
    pub(crate) fn flow<const K: usize>(&self, seen: &mut Seen<K>) {
        let rest = |medium: u16, flux: [f64; 3]| match &self.media[medium as usize] {
            Some(medium) => medium.rest(flux),
            None => [0.0; 3],
        };
        let inside = self.points.par_iter().zip(&seen.inside);
        let inside: Vec<[f64; 3]> = inside.map(|(p, b)| rest(p.medium, *b)).collect();
        let on = self.sheets(seen);
        let rows = self.points.par_iter().map(|point| {
            let medium = self.media[point.medium as usize].as_ref();
            let medium = medium.filter(|_| point.flows)?;
            let at = |j: usize| {
                let slot = self.slots[j] as usize;
                match self.region.kinds[j] {
                    Kind::Interface(face) => {
                        let inner = self.region.faces[face as usize].inner == point.medium;
                        on[slot][usize::from(!inner)]
                    }
                    _ => inside[slot],
                }
            };
            let turned: [f64; K] = self.turned(point.number, at);
            Some(turned.map(|t| -t / medium.level))
        });
        let rows: Vec<Option<[f64; K]>> = rows.collect();
        for (row, own) in seen.rows.iter_mut().zip(rows) {
            *row = own.unwrap_or(*row);
        }
    }

    /// The curl of a vector in space at point `i`, as the unknown has it, from its values at points.
    pub(crate) fn turned<const K: usize>(
        &self,
        i: usize,
        vector: impl Fn(usize) -> [f64; 3],
    ) -> [f64; K] {
        let own = &self.sides.own;
        let along = |axis: usize, k: usize| own.derivative(i, axis).apply_with(|j| vector(j)[k]);
        if K == 3 {
            let d = |k: usize, axis: usize| along(axis, k);
            let curl = [d(2, 1) - d(1, 2), d(0, 2) - d(2, 0), d(1, 0) - d(0, 1)];
            return std::array::from_fn(|k| curl[k]);
        }
        if self.unknown == Unknown::Potential {
            return [along(0, 1) - along(1, 0); K];
        }
        // (d P_r/dz - d P_z/dr) / r of what is odd and even about the axis.
        let radial = own.derivative(i, 1);
        let radial: f64 = radial.apply_with(|j| vector(j)[0] / self.beside(j)[0]);
        let r = self.region.places[i][0];
        let axial = match r > 0.0 {
            true => along(0, 2) / r,
            false => own.second(i, 0, 0).apply_with(|j| vector(j)[2]),
        };
        [radial - axial; K]
    }
}
