//! The sums of water over pairs: each particle gathers over its neighbours, and those near walls over their images.

use kernels::Kernel;
use particles::sweep;
use rayon::prelude::*;

use super::around::GRAIN;
use super::diffusion::{Form, corrected};
use super::flow::Flow;
use super::friction::{Friction, Viscous};
use super::seen::Seen;

impl<const D: usize, K: Kernel> Flow<D, K> {
    /// d(rho)/dt of a pair, over rho (22).
    #[inline(always)]
    fn closing(own: &Seen, other: &Seen, dx: [f64; 3], slope: f64) -> f64 {
        let du = [0, 1, 2].map(|k| own.u[k] - other.u[k]);
        other.volume * slope * (du[0] * dx[0] + du[1] * dx[1] + du[2] * dx[2])
    }

    /// What density diffuses from a pair.
    #[inline(always)]
    fn evening(own: &Seen, other: &Seen, slope: f64, along: f64) -> f64 {
        (2.0 * (other.value - own.value) - along) * -slope * other.volume
    }

    /// Rates of density \[kg/(m3 s)\] and the part of them that diffuses.
    pub(super) fn rates(&mut self) -> Vec<[f64; 2]> {
        let scale = self.water.diffusion.map(|diffusion| {
            diffusion.delta * self.water.smoothing_length * self.water.law.sound_speed
        });
        let form = self.water.diffusion.map(|diffusion| diffusion.form);
        let mut slopes = std::mem::take(&mut self.slopes);
        if form == Some(Form::Antuono) {
            slopes.resize(self.around.seen.len(), [0.0; 3]);
            sweep::fill(&mut slopes, |a| self.slope(a));
        }
        self.slopes = slopes;
        let mut rates = vec![[0.0; 2]; self.around.seen.len()];
        let closing = |a: usize| {
            let own = &self.around.seen[a];
            let mut sum = 0.0;
            self.around.each(a, |_, other, dx, _, slope| {
                sum += Self::closing(own, other, dx, slope)
            });
            [sum * own.value, 0.0]
        };
        match (scale, form) {
            (Some(scale), Some(Form::Molteni)) => sweep::fill(&mut rates, |a| {
                let own = &self.around.seen[a];
                let (mut sum, mut even) = (0.0, 0.0);
                self.around.each(a, |_, other, dx, _, slope| {
                    sum += Self::closing(own, other, dx, slope);
                    even += Self::evening(own, other, slope, 0.0);
                });
                [sum * own.value, scale * even]
            }),
            (Some(scale), Some(Form::Antuono)) => {
                sweep::fill(&mut rates, |a| self.rate_by_slopes(a, scale));
            }
            _ => sweep::fill(&mut rates, closing),
        }
        let images = |a: &u32| {
            let own = &self.around.seen[*a as usize];
            let mut sum = 0.0;
            self.around.mirrored(*a as usize, |_, other, dx, _, slope| {
                sum += Self::closing(own, other, dx, slope);
            });
            sum * own.value
        };
        let found: Vec<f64> = self
            .around
            .beside
            .par_iter()
            .with_min_len(GRAIN)
            .map(images)
            .collect();
        for (a, rate) in self.around.beside.iter().zip(found) {
            rates[*a as usize][0] += rate;
        }
        rates
    }

    /// Rate of density with the diffusion of Antuono et al., and that.
    fn rate_by_slopes(&self, a: usize, scale: f64) -> [f64; 2] {
        let own = &self.around.seen[a];
        let (mut sum, mut even, g) = (0.0, 0.0, self.slopes[a]);
        for b in self.around.near.rows.row(a) {
            let (b, other) = (*b as usize, &self.around.seen[*b as usize]);
            let dx = [0, 1, 2].map(|k| own.x[k] - other.x[k]);
            let square = dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2];
            let slope = self.around.kernel.slope(square.sqrt());
            let f = self.slopes[b];
            let along: f64 = (0..3).map(|k| -dx[k] * (g[k] + f[k])).sum();
            sum += Self::closing(own, other, dx, slope);
            even += Self::evening(own, other, slope, along);
        }
        [sum * own.value, scale * even]
    }

    /// Corrected slope of density.
    fn slope(&self, a: usize) -> [f64; 3] {
        let own = &self.around.seen[a];
        let (mut moment, mut rise) = ([[0.0; 3]; 3], [0.0; 3]);
        self.around.each(a, |_, other, dx, _, slope| {
            let weight = other.volume * slope;
            for k in 0..3 {
                rise[k] += weight * (other.value - own.value) * dx[k];
                (0..3).for_each(|l| moment[k][l] -= weight * dx[k] * dx[l]);
            }
        });
        corrected(moment, rise, D)
    }

    /// Forces over the own volume: of pressure and friction \[N/m3\], and the power that friction takes \[W/m3\].
    #[inline(always)]
    fn pull(own: &Seen, other: &Seen, dx: [f64; 3], slope: f64, q: f64) -> [f64; 4] {
        let scale = -other.volume * slope * (own.value + other.value + q);
        let du = [0, 1, 2].map(|k| own.u[k] - other.u[k]);
        let approach = du[0] * dx[0] + du[1] * dx[1] + du[2] * dx[2];
        let lost = 0.5 * other.volume * slope * q * approach;
        [scale * dx[0], scale * dx[1], scale * dx[2], lost]
    }

    /// Forces on all \[N\] and what friction takes \[W\] (26).
    fn forces(&mut self, friction: &impl Friction) -> Vec<[f64; 4]> {
        let q = |own: &Seen, other: &Seen, dx: [f64; 3], square: f64| {
            let du = [0, 1, 2].map(|k| own.u[k] - other.u[k]);
            friction.pressure(du[0] * dx[0] + du[1] * dx[1] + du[2] * dx[2], square)
        };
        let mut forces = vec![[0.0; 4]; self.around.seen.len()];
        let each = forces.par_chunks_mut(GRAIN).enumerate();
        each.for_each(|(chunk, forces)| {
            sweep::wide(|| {
                for (k, force) in forces.iter_mut().enumerate() {
                    let own = &self.around.seen[chunk * GRAIN + k];
                    let mut sum = [0.0; 4];
                    self.around
                        .each(chunk * GRAIN + k, |_, other, dx, square, slope| {
                            let part = Self::pull(own, other, dx, slope, q(own, other, dx, square));
                            (0..4).for_each(|i| sum[i] += part[i]);
                        });
                    *force = sum.map(|x| own.volume * x);
                }
            });
        });
        let walls = self.around.bodies.len();
        let images = |a: &u32| {
            let own = &self.around.seen[*a as usize];
            let mut sums = vec![[0.0; 4]; walls];
            self.around
                .mirrored(*a as usize, |(wall, _), other, dx, square, slope| {
                    let part = Self::pull(own, other, dx, slope, q(own, other, dx, square));
                    (0..4).for_each(|i| sums[wall][i] += own.volume * part[i]);
                });
            sums
        };
        let found: Vec<Vec<[f64; 4]>> = self
            .around
            .beside
            .par_iter()
            .with_min_len(GRAIN)
            .map(images)
            .collect();
        self.walls.forces.fill([0.0; 3]);
        for (a, sums) in self.around.beside.iter().zip(&found) {
            for (wall, part) in self.walls.forces.iter_mut().zip(sums) {
                (0..4).for_each(|i| forces[*a as usize][i] += part[i]);
                (0..3).for_each(|i| wall[i] -= part[i]);
            }
        }
        forces
    }

    /// Forces by the friction that the scene has.
    pub(super) fn all_forces(&mut self) -> Vec<[f64; 4]> {
        let h = self.water.smoothing_length;
        let viscous = self.water.viscosity.map(|mu| Viscous::new(mu, h, D));
        match (self.water.artificial, viscous) {
            (None, None) => self.forces(&()),
            (Some(a), None) => self.forces(&a),
            (None, Some(b)) => self.forces(&b),
            (Some(a), Some(b)) => self.forces(&(a, b)),
        }
    }
}
