//! The slope of the pressure, and the velocity that it leaves.

use kernels::moments::times;
use rayon::prelude::*;
use shapes::frame::{along, difference};

use super::DivergenceFree;
use crate::motion::step::Step;
use crate::near::{Near, Role};
use crate::sweep::GRAIN;

impl DivergenceFree {
    /// grad p = B sum of s x_ab (p_b - p_a), mirrored neighbours beyond the surface included.
    pub(super) fn differ(&mut self, near: &Near) {
        let (rows, upon) = (&self.rows, self.weight.upon());
        let total = if self.reflects(near) {
            &self.pushing
        } else {
            &self.total
        };
        self.slope.resize(near.len(), [0.0; 3]);
        if near.liquids.is_some() {
            (self.interface).differ(near, rows, total, upon, &mut self.slope);
            return;
        }
        near.each_row(
            &mut self.slope,
            #[inline(always)]
            |a, row, out| {
                *out = [0.0; 3];
                if near.role[a] == Role::Liquid {
                    let mut sum = rows[a].open.map(|x| 2.0 * (total[a] - upon[a]) * x);
                    for (b, slope) in row.slopes() {
                        let x = difference(near.position[a], near.position[b]);
                        sum = along(sum, slope * (total[b] - total[a]), x);
                    }
                    *out = times(rows[a].inverse, sum);
                }
            },
        );
    }

    /// Along axes on which nothing holds it a body moves as a whole by the pressure of the gas upon its surface alone, whose
    /// levels are `gas`.
    pub(super) fn balance(&mut self, near: &Near, gas: [f64; 2]) {
        let (rows, pull, moment) = (&self.rows, &self.pull, self.filled.moment);
        let (weight, islands) = (&self.weight, &self.islands);
        let upon = |a: usize| {
            if rows[a].missing <= 0.0 {
                return [0.0; 3];
            }
            let surface = along(near.position[a], 1.0, rows[a].outwards());
            let pressure = near.outer.get(a).map_or(0.0, |p| p - pull.at(a));
            let pressure = pressure - weight.above(gas, near, islands, a, surface);
            let pressure = pressure / near.heaviness(a);
            rows[a].open.map(|x| -2.0 * pressure * x / moment)
        };
        let weight = |b: usize| near.heaviness(b);
        islands.balance(&mut self.slope, weight, upon);
    }

    /// u = u* - dt/rho grad p.
    pub(super) fn push(&self, near: &mut Near, predicted: &mut [[f64; 3]], step: Step) {
        let (weight, islands) = (&self.weight, &self.islands);
        let mut virials = std::mem::take(&mut near.virial);
        let now = &*near;
        let points = virials.par_iter_mut().zip(predicted).zip(&now.role);
        points
            .zip(&self.slope)
            .zip(&self.total)
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(a, ((((virial, u), role), slope), p))| {
                let p = p + weight.known(now, islands, a, now.position[a]);
                if *role == Role::Liquid {
                    *virial += step.share * p;
                    *u = along(*u, -step.dt / step.metal.density, *slope);
                } else {
                    *virial = p;
                }
            });
        near.virial = virials;
    }
}
