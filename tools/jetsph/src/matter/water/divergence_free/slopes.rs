//! What a pressure does: the slopes at free water, and the forces across walls and exits of nozzles.

use kernels::Kernel;
use kernels::moments::times;
use particles::sweep;
use rayon::prelude::*;

use super::DivergenceFree;
use super::bodies::Forces;
use super::operators::is_led;

impl<const D: usize, K: Kernel> DivergenceFree<D, K> {
    /// The pressure that water led by a nozzle seems to have: p + rho f.(x_w - x_b), the mean over free neighbours b (Adami, Hu and
    /// Adams 2012, eq. 27).
    pub(super) fn reach_led(&self, p: &mut [f64]) {
        let density = self.liquid.density;
        let led: Vec<usize> = (0..p.len())
            .filter(|a| is_led(&self.around.seen[*a]))
            .collect();
        let found: Vec<f64> = led
            .par_iter()
            .map(|a| {
                let (mut sum, mut weight) = (0.0, 0.0);
                self.around.each(*a, |b, other, x, _, slope| {
                    if !is_led(other) {
                        let w = -other.volume * slope;
                        let rise: f64 = (0..3).map(|k| self.pushed[b][k] * x[k]).sum();
                        sum += w * (p[b] + density * rise);
                        weight += w;
                    }
                });
                if weight > 0.0 { sum / weight } else { 0.0 }
            })
            .collect();
        for (a, found) in led.into_iter().zip(found) {
            p[a] = found;
        }
    }

    /// -grad p/rho = -B/rho sum of s x_ab (p_b - p_a), with what is missing beyond the surface.
    pub(super) fn accelerations(&self, p: &[f64]) -> Vec<[f64; 3]> {
        let (around, density) = (&self.around, self.liquid.density);
        let mut accelerations = vec![[0.0; 3]; p.len()];
        sweep::fill(&mut accelerations, |a| {
            if is_led(&around.seen[a]) {
                return [0.0; 3];
            }
            let mut sum = self.rows[a].open.map(|x| 2.0 * p[a] * x);
            around.each(a, |b, other, x, _, slope| {
                let part = other.volume * slope * (p[b] - p[a]);
                (0..3).for_each(|k| sum[k] += part * x[k]);
            });
            if self.is_beside[a] {
                around.mirrored(a, |(_, b), other, x, _, slope| {
                    let part = other.volume * slope * (self.beyond(p, b, other.x) - p[a]);
                    (0..3).for_each(|k| sum[k] += part * x[k]);
                });
            }
            for partner in self.beside.of(a) {
                let other = self.beside.pressure(partner);
                let part = partner.seen.volume * partner.slope * (other - p[a]);
                (0..3).for_each(|k| sum[k] += part * partner.dx[k]);
            }
            times(self.rows[a].inverse, sum).map(|x| -x / density)
        });
        accelerations
    }

    /// The pressure of the image at `place` \[m\] of particle `b`.
    fn beyond(&self, p: &[f64], b: usize, place: [f64; 3]) -> f64 {
        let at = self.around.seen[b].x;
        let rise: f64 = (0..3).map(|k| self.pushed[b][k] * (place[k] - at[k])).sum();
        p[b] + self.liquid.density * rise
    }

    /// What pairs across walls and exits of nozzles tell of the forces there: V_a V_b (p_a + p_b) grad W.
    pub(super) fn across(&self, p: &[f64]) -> Vec<(u32, Forces)> {
        let (around, beside) = (&self.around, &self.beside);
        let holders = around.bodies.len() + beside.len() + 1;
        let all = (0..p.len()).into_par_iter().with_min_len(sweep::GRAIN);
        let each = all.filter_map(|a| {
            let own = &around.seen[a];
            if is_led(own) {
                return None;
            }
            let mut forces: Forces = Vec::new();
            let mut add = |holder: usize, other: f64, volume: f64, (x, slope): ([f64; 3], f64)| {
                forces.resize(holders, [0.0; 3]);
                let scale = own.volume * volume * slope * (p[a] + other);
                (0..3).for_each(|k| forces[holder][k] += scale * x[k]);
            };
            around.each(a, |b, other, x, _, slope| {
                if is_led(other) {
                    add(holders - 1, p[b], other.volume, (x, slope));
                }
            });
            if self.is_beside[a] {
                around.mirrored(a, |(wall, b), other, x, _, slope| {
                    add(wall, self.beyond(p, b, other.x), other.volume, (x, slope));
                });
            }
            if !beside.of(a).is_empty() {
                forces.resize(holders, [0.0; 3]);
                beside.across(a, p[a], &mut forces);
            }
            (!forces.is_empty()).then_some((a as u32, forces))
        });
        each.collect()
    }
}
