//! The force of the pressure that was found, in double precision: what one particle gets its neighbour loses, to round-off.

use rayon::prelude::*;
use shapes::frame::along;

use super::step::Step;
use crate::near::{Near, Role};
use crate::sweep::GRAIN;

/// Scratch of the force, `[m]` in the order of [`Near`].
#[derive(Debug, Clone, Default)]
pub struct Push {
    /// x \[m\] and p \[Pa\].
    carried: Vec<[f64; 4]>,
    /// Sum of (p_a + p_b) grad W, and that of its products with x_ab.
    sums: Vec<([f64; 3], f64)>,
}

impl Push {
    /// Adds dt acc(p) to the velocities and the virial of p to that of the forces; `scale` is nu/(rho kappa).
    ///
    /// In a disordered cloud the sum of `p_a + p_b` stands for a pressure that differs from p by
    /// some per cent; the virial is what balances the outer forces. Wet solid particles lack
    /// neighbours behind, they get p itself.
    pub fn apply(
        &mut self,
        near: &mut Near,
        pressure: &[f32],
        predicted: &mut [[f64; 3]],
        step: Step,
        scale: f64,
    ) {
        self.sum(near, pressure);
        let share = step.share * step.metal.density * scale / 6.0;
        let points = near.virial.par_iter_mut().zip(predicted).zip(&near.role);
        points
            .zip(&self.sums)
            .zip(pressure)
            .with_min_len(GRAIN)
            .for_each(|((((virial, u), role), (sum, stretched)), p)| {
                if *role == Role::Liquid {
                    *virial -= share * stretched;
                    *u = along(*u, -step.dt * scale, *sum);
                } else {
                    *virial = f64::from(*p);
                }
            });
    }

    fn sum(&mut self, near: &Near, pressure: &[f32]) {
        let points = pressure.par_iter().zip(&near.position);
        points
            .with_min_len(GRAIN)
            .map(|(p, x)| [x[0], x[1], x[2], f64::from(*p)])
            .collect_into_vec(&mut self.carried);
        near.complete(&mut self.carried, |[.., p], k, _| {
            let [x, y, z] = near.position[k];
            [x, y, z, p]
        });
        self.sums.resize(near.len(), ([0.0; 3], 0.0));
        let carried = &self.carried;
        near.each_row(
            &mut self.sums,
            #[inline(always)]
            |a, row, out| {
                // The fourth numbers mean nothing.
                let (mut sum, mut stretched, at) = ([0.0; 4], [0.0; 4], carried[a]);
                if near.role[a] == Role::Liquid {
                    for (b, slope) in row.slopes() {
                        let to = carried[b];
                        let weight = slope * (at[3] + to[3]);
                        for i in 0..4 {
                            let dx = at[i] - to[i];
                            sum[i] += weight * dx;
                            stretched[i] += weight * dx * dx;
                        }
                    }
                }
                let [x, y, z, _] = sum;
                *out = ([x, y, z], stretched[0] + stretched[1] + stretched[2]);
            },
        );
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        32 * (self.carried.capacity() + self.sums.capacity())
    }
}
