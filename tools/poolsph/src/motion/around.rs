//! What viscosity and damping both need of the liquid around a particle.

use rayon::prelude::*;

use crate::near::{Near, Role};
use crate::sweep::{GRAIN, summed_double};

/// Sums over the liquid neighbours of each liquid particle, `[m]` in the order of [`Near`].
#[derive(Debug, Clone, Default)]
pub struct Around {
    /// Sum of W times the field, and of W \[1/m3\]; zero for solid particles.
    pub sums: Vec<[f64; 4]>,
    /// The field and 1 for liquid particles, zero for solid ones.
    carried: Vec<[f64; 4]>,
}

impl Around {
    /// Sums `field`, with its images, over all rows.
    pub fn sum(&mut self, near: &Near, field: &[[f64; 3]]) {
        let points = field.par_iter().zip(&near.role).with_min_len(GRAIN);
        points
            .map(|([x, y, z], role)| match role {
                Role::Liquid | Role::Image => [*x, *y, *z, 1.0],
                _ => [0.0; 4],
            })
            .collect_into_vec(&mut self.carried);
        self.sums.resize(near.len(), [0.0; 4]);
        let carried = &self.carried;
        near.each_row(
            &mut self.sums,
            #[inline(always)]
            |a, row, out| {
                *out = match near.role[a] {
                    Role::Liquid => summed_double(row.index, row.value, carried),
                    _ => [0.0; 4],
                };
            },
        );
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        32 * (self.sums.capacity() + self.carried.capacity())
    }
}
