//! The sums of water over pairs: each pair is computed once for both, and those near walls gather over their images.

use kernels::{Kernel, Number};
use particles::sweep;
use rayon::prelude::*;

use super::around::GRAIN;
use super::diffusion::{Form, corrected};
use super::exchange::{Exchange, Pair, Side};
use super::flow::Flow;
use super::friction::{Friction, Viscous};
use super::seen::Seen;

/// d(rho)/dt over rho (22).
#[inline(always)]
fn closing<N: Number>(pair: &Pair<N>) -> N {
    pair.slope * pair.parting()
}

/// 2 (rho_j - rho_i) of what density diffuses.
#[inline(always)]
fn uneven<N: Number>(pair: &Pair<N>) -> N {
    let rise = pair.other.value - pair.own.value;
    rise + rise
}

/// Density closes where all part.
struct Closing;

impl Exchange<1> for Closing {
    #[inline(always)]
    fn pair<N: Number>(&self, pair: &Pair<N>) -> [[N; 4]; 1] {
        let none = pair.slope.of(0.0);
        [[closing(pair), none, none, none]]
    }

    #[inline(always)]
    fn weights(own: f64, other: f64) -> [[f64; 4]; 2] {
        [[other; 4], [own; 4]]
    }
}

/// It closes and evens out.
struct Evening;

impl Exchange<1> for Evening {
    #[inline(always)]
    fn pair<N: Number>(&self, pair: &Pair<N>) -> [[N; 4]; 1] {
        let none = pair.slope.of(0.0);
        [[closing(pair), uneven(pair) * pair.slope, none, none]]
    }

    #[inline(always)]
    fn weights(own: f64, other: f64) -> [[f64; 4]; 2] {
        [[other, -other, other, other], [own; 4]]
    }
}

/// It closes and evens out, but for what the mean of both slopes says.
struct EveningBySlopes;

impl Exchange<1> for EveningBySlopes {
    const AIDED: bool = true;

    #[inline(always)]
    fn pair<N: Number>(&self, pair: &Pair<N>) -> [[N; 4]; 1] {
        let none = pair.slope.of(0.0);
        let (g, f) = (pair.own.aid, pair.other.aid);
        let [x, y, z] = pair.dx;
        let along = x * (g[0] + f[0]) + y * (g[1] + f[1]) + z * (g[2] + f[2]);
        let uneven = uneven(pair) + along;
        [[closing(pair), uneven * pair.slope, none, none]]
    }

    #[inline(always)]
    fn weights(own: f64, other: f64) -> [[f64; 4]; 2] {
        Evening::weights(own, other)
    }
}

/// Moments xx, yy, zz, xy, xz, yz and the rise of density.
struct Slopes;

impl Exchange<3> for Slopes {
    #[inline(always)]
    fn pair<N: Number>(&self, pair: &Pair<N>) -> [[N; 4]; 3] {
        let ([x, y, z], none) = (pair.dx, pair.slope.of(0.0));
        let weight = none - pair.slope;
        let rise = pair.slope * (pair.other.value - pair.own.value);
        [
            [weight * x * x, weight * y * y, weight * z * z, none],
            [weight * x * y, weight * x * z, weight * y * z, none],
            [rise * x, rise * y, rise * z, none],
        ]
    }

    #[inline(always)]
    fn weights(own: f64, other: f64) -> [[f64; 4]; 2] {
        [[other; 4], [own; 4]]
    }
}

/// Forces of pressure and friction \[N\] (26), and half of the power that friction takes \[W\].
struct Pull<'a, F>(&'a F);

impl<F: Friction> Exchange<1> for Pull<'_, F> {
    #[inline(always)]
    fn pair<N: Number>(&self, pair: &Pair<N>) -> [[N; 4]; 1] {
        let parting = pair.parting();
        let q = self.0.pressure(parting, pair.square);
        let scale = pair.slope * (pair.own.value + pair.other.value + q);
        let lost = q.of(0.5) * pair.slope * q * parting;
        let [x, y, z] = pair.dx;
        [[scale * x, scale * y, scale * z, lost]]
    }

    #[inline(always)]
    fn weights(own: f64, other: f64) -> [[f64; 4]; 2] {
        let both = own * other;
        [[-both, -both, -both, both], [both; 4]]
    }
}

impl<const D: usize, K: Kernel> Flow<D, K> {
    /// Rates of density \[kg/(m3 s)\] and the part of them that diffuses.
    pub(super) fn rates(&mut self) -> Vec<[f64; 2]> {
        let kernel = &self.around.kernel;
        let pairs = &mut self.around.near.rows;
        let mut scale = 0.0;
        match self.water.diffusion {
            None => pairs.sum(kernel, &Closing),
            Some(diffusion) => {
                let (h, law) = (self.water.smoothing_length, self.water.law);
                scale = diffusion.delta * h * law.sound_speed;
                match diffusion.form {
                    Form::Molteni => pairs.sum(kernel, &Evening),
                    Form::Antuono => {
                        pairs.sum(kernel, &Slopes);
                        self.slopes.resize(self.around.seen.len(), [0.0; 3]);
                        sweep::fill(&mut self.slopes, |a| {
                            let [[xx, yy, zz, _], [xy, xz, yz, _], [x, y, z, _]] = pairs.total(a);
                            let moment = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
                            corrected(moment, [x, y, z], D)
                        });
                        pairs.aid(&self.slopes);
                        pairs.sum(kernel, &EveningBySlopes);
                    }
                }
            }
        }
        let (around, mut rates) = (&self.around, vec![[0.0; 2]; self.around.seen.len()]);
        sweep::fill(&mut rates, |a| {
            let [[closing, even, ..]] = around.near.rows.total(a);
            [closing * around.seen[a].value, scale * even]
        });
        self.close_to_images(&mut rates);
        rates
    }

    /// What images beyond walls add to the rates.
    fn close_to_images(&self, rates: &mut [[f64; 2]]) {
        let images = |a: &u32| {
            let own = &self.around.seen[*a as usize];
            let mut sum = 0.0;
            let kernel = &self.around.kernel;
            self.around.mirrored(*a as usize, |_, other, _, _, _| {
                sum += other.volume * closing(&Pair::of(kernel, side(own), side(other)));
            });
            sum * own.value
        };
        let beside = self.around.beside.par_iter().with_min_len(GRAIN);
        let found: Vec<f64> = beside.map(images).collect();
        for (a, rate) in self.around.beside.iter().zip(found) {
            rates[*a as usize][0] += rate;
        }
    }

    /// Forces on all \[N\] and what friction takes \[W\] (26).
    fn forces(&mut self, friction: &impl Friction) -> Vec<[f64; 4]> {
        let pull = Pull(friction);
        let around = &mut self.around;
        around.near.rows.sum(&around.kernel, &pull);
        let mut forces = vec![[0.0; 4]; around.seen.len()];
        sweep::fill(&mut forces, |a| {
            let [total] = around.near.rows.total(a);
            total
        });
        self.pull_of_images(&pull, &mut forces);
        forces
    }

    /// Forces of images beyond walls, which the walls bear.
    fn pull_of_images<F: Friction>(&mut self, pull: &Pull<'_, F>, forces: &mut [[f64; 4]]) {
        let (around, walls) = (&self.around, self.around.bodies.len());
        let images = |a: &u32| {
            let own = &around.seen[*a as usize];
            let mut sums = vec![[0.0; 4]; walls];
            around.mirrored(*a as usize, |(wall, _), other, _, _, _| {
                let [part] = pull.pair(&Pair::of(&around.kernel, side(own), side(other)));
                let [weights, _] = Pull::<F>::weights(own.volume, other.volume);
                (0..4).for_each(|i| sums[wall][i] += weights[i] * part[i]);
            });
            sums
        };
        let beside = around.beside.par_iter().with_min_len(GRAIN);
        let found: Vec<Vec<[f64; 4]>> = beside.map(images).collect();
        self.walls.forces.fill([0.0; 3]);
        for (a, sums) in around.beside.iter().zip(&found) {
            for (wall, part) in self.walls.forces.iter_mut().zip(sums) {
                (0..4).for_each(|i| forces[*a as usize][i] += part[i]);
                (0..3).for_each(|i| wall[i] -= part[i]);
            }
        }
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

/// A particle of a pair.
#[inline(always)]
fn side(seen: &Seen) -> Side<f64> {
    Side {
        x: seen.x,
        u: seen.u,
        value: seen.value,
        aid: [0.0; 3],
    }
}
