//! Viscous acceleration by the Laplacian of the moving-particle method.
//!
//! ```text
//! (1/rho) div(mu grad u)_a = 2 D / (rho lambda N) sum_b mu_ab (u_b - u_a) W_ab
//! lambda = sum |x_ab|^2 W_ab / sum W_ab,   N = sum W_ab      Komen (2019), eqs 3.95-3.99
//! mu_ab = 2 mu_a mu_b / (mu_a + mu_b)                        Komen (2019), eq. 5.32
//! ```
//!
//! The 1/rho stands once, as the errata say of eq. 3.99. lambda N is the sum of r^2 W; here it is
//! that of the filled lattice for every particle, so that a pair force is the same seen from both
//! sides and momentum is kept (the local one would also overstate the force at a free surface).
//! Solid neighbours stand still: the wall sticks, with the viscosity of the liquid at it.
//!
//! Eq. 3.99 prints the arithmetic mean of both viscosities, eq. 5.32 the harmonic one. The harmonic mean is that of two
//! layers in series: where the viscosity jumps, the stress comes out as on either side of it, and the thin side alone
//! tells how fast a stiff one drags it. Where the viscosity is smooth both are of second order.
//!
//! Viscosity acts on what the particles resolve. With L of [`super::noise`] the equation above is -c L u, and what is
//! taken is -c L (u - L u): the same to second order, where u - L u is the kernel mean, and next to nothing for single
//! particles, whose motion is none of the flow's. Damped by viscosity they lock into layers, which carry part of what
//! the surface pulls like a solid: a drop of 14 particles along the edge of its cube read 1.15 of its pressure at
//! 0.02 Pa s, one of 15 read 0.90. L is at most 1, but for the small negative lobes of the kernel's transform, so that no motion
//! gains energy. What is given back, c L L u, is summed together with the damping of [`super::noise`].
//!
//! With velocities without divergence nothing locks, no part is given back, and walls hold the velocity at their face.
//! There w = -(dW/dr)/r stands for W (Brookshaw 1985), and the moment of each particle for that of the lattice:
//!
//! ```text
//! (1/rho) div(mu grad u)_a = 1/rho sum_b mu_ab (1/m_a + 1/m_b) w_ab (u_b - u_a),    m = 1/3 sum w r^2
//! ```
//!
//! A lattice that the flow has strained has 3 % less moment, and 4 % less in the plane of the flow. The mean of both sides keeps
//! momentum. What a particle of the surface lacks counts as the lattice has it: nothing pulls there.

use kernels::CubicSpline;
use particles::Matter;
use rayon::prelude::*;
use shapes::frame::{along, difference, squared};

use super::around::Around;
use super::lattice::Lattice;
use super::law::Law;
use crate::near::{Near, Role};
use crate::stage::StageError;
use crate::state::slag::Slag;
use crate::sweep::GRAIN;

/// Newtonian viscosity of the liquid.
#[derive(Debug, Clone)]
pub struct Viscosity {
    law: Law,
    metal: Matter,
    /// That of slag beside the metal.
    slag: Option<Law>,
    /// 2 D / (rho lambda N) \[m3/s per Pa s\].
    scale: f64,
    /// Largest explicit step \[s\], and that times mu/rho \[m2\].
    limit: f64,
    spread: f64,
    /// 1/nu \[1/m3\].
    number: f64,
    /// mu of each particle \[Pa s\], `[m]` in the order of [`Near`]; empty where it is the same for all.
    each: Vec<f64>,
    /// Sum of mu_ab (u_b - u_a) W_ab, and the smallest mu_ab of the row \[Pa s\].
    sums: Vec<([f64; 3], f64)>,
    /// Sum of W but for the own one, and m of the lattice \[1/m3\].
    filled: [f64; 2],
    /// 1/m of each particle and image \[m3\], `[m + images]`.
    inverse: Vec<f64>,
}

/// Lack of neighbours, in parts of the lattice's, from which on a particle lies at the surface.
const LACKS: f64 = 0.10;

impl Viscosity {
    /// The viscosity of a `law` in `metal`.
    #[must_use]
    pub fn new(law: Law, metal: Matter) -> Self {
        let kernel = CubicSpline::<3>::new(metal.smoothing_length);
        let reach = (kernel.support() / metal.spacing).ceil() as i32;
        let (mut moment, mut number) = (0.0, 0.0);
        for i in -reach..=reach {
            for j in -reach..=reach {
                for k in -reach..=reach {
                    let r = metal.spacing * f64::from(i * i + j * j + k * k).sqrt();
                    moment += r * r * kernel.value(r);
                    number += kernel.value(r);
                }
            }
        }
        number -= kernel.value(0.0);
        let lattice = Lattice::of(metal);
        // In this order: a change in the last digit would change all runs.
        let largest = 6.0 * law.largest() / (metal.density * moment);
        Self {
            scale: match law {
                Law::Uniform(_) => largest,
                Law::OfTemperature { .. } => 6.0 / (metal.density * moment),
            },
            law,
            limit: 1.0 / (largest * number),
            spread: moment / (6.0 * number),
            metal,
            slag: None,
            number: lattice.number,
            filled: [number, lattice.moment / metal.volume()],
            inverse: Vec::new(),
            each: Vec::new(),
            sums: Vec::new(),
        }
    }

    /// The same with slag of a viscosity by `law` beside the metal.
    #[must_use]
    pub fn beside(mut self, slag: Slag, law: Law) -> Self {
        self.limit = self.spread / slag.spreading(self.law.largest(), self.metal);
        self.slag = Some(law);
        self
    }

    /// True if there is any.
    #[must_use]
    pub fn acts(&self) -> bool {
        self.law.largest() > 0.0 || self.slag.as_ref().is_some_and(|law| law.largest() > 0.0)
    }

    /// True if one viscosity holds for all liquid.
    #[must_use]
    pub fn uniform(&self) -> bool {
        matches!(self.law, Law::Uniform(_)) && self.slag.is_none()
    }

    /// Takes the viscosity of each particle from its temperature \[K\], by index in the state.
    ///
    /// # Errors
    /// When liquid has a temperature for which the scene has no viscosity.
    pub fn take(&mut self, near: &Near, temperature: &[f64]) -> Result<(), StageError> {
        if self.uniform() {
            return Ok(());
        }
        let law = |a: usize| match (&self.slag, &near.liquids) {
            (Some(slag), Some(liquids)) if liquids.is_slag(a) => slag,
            _ => &self.law,
        };
        if self.varies() {
            for (a, (&id, role)) in near.id.iter().zip(&near.role).enumerate() {
                if *role == Role::Liquid {
                    let slag = near.liquids.as_ref().is_some_and(|both| both.is_slag(a));
                    let what = if slag {
                        "viscosity of slag"
                    } else {
                        "viscosity"
                    };
                    law(a).covers(temperature[id as usize], what)?;
                }
            }
        }
        let ids = near.id.par_iter().with_min_len(GRAIN).enumerate();
        ids.map(|(a, &id)| law(a).at(temperature, id as usize))
            .collect_into_vec(&mut self.each);
        Ok(())
    }

    /// Whether some viscosity depends on temperature.
    fn varies(&self) -> bool {
        let mut laws = std::iter::once(&self.law).chain(&self.slag);
        laws.any(|law| matches!(law, Law::OfTemperature { .. }))
    }

    /// mu of particle `a` \[Pa s\].
    #[must_use]
    #[inline]
    pub fn at(&self, a: usize) -> f64 {
        self.each.get(a).copied().unwrap_or(self.law.largest())
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        8 * (self.each.capacity() + self.inverse.capacity()) + 32 * self.sums.capacity()
    }

    /// Largest explicit step that damps every mode without overshoot \[s\].
    #[must_use]
    pub fn limit(&self) -> f64 {
        self.limit
    }

    /// Adds `dt` times the viscous acceleration of `near.velocity` to `predicted`; `around` holds the
    /// sums of this velocity, which one viscosity for all goes by. The velocity of solid neighbours is zero.
    pub fn apply(&mut self, near: &Near, around: &Around, dt: f64, predicted: &mut [[f64; 3]]) {
        match self.law {
            _ if !self.acts() => {}
            Law::Uniform(_) => self.same(near, around, dt, predicted),
            Law::OfTemperature { .. } => self.pairs(near, dt, predicted),
        }
    }

    /// c \[1/s\] of particle `a`, the rate at which L L u is given back, with the smallest mu around it as of the last
    /// [`Viscosity::apply`]; `liquid` is the sum of W over its liquid neighbours. Zero beside a wall, which is no part
    /// of L.
    #[must_use]
    pub fn spared(&self, near: &Near, liquid: f64, a: usize) -> f64 {
        let walls = near.number[a] - near.kernel.value(0.0) - liquid;
        if !self.acts() || near.role[a] != Role::Liquid || walls > 1e-9 * self.number {
            return 0.0;
        }
        let mu = match self.law {
            Law::Uniform(_) => 1.0,
            Law::OfTemperature { .. } => self.sums[a].1,
        };
        mu * self.scale * self.number
    }

    /// Adds `dt` times the viscous acceleration of `near.velocity` to `predicted`, with moments of each particle and
    /// walls that hold the velocity at their face.
    pub fn apply_between_faces(&mut self, near: &Near, dt: f64, predicted: &mut [[f64; 3]]) {
        if !self.acts() {
            return;
        }
        let [number, moment] = self.filled;
        let own = near.kernel.value(0.0);
        self.inverse.clear();
        self.inverse.resize(near.len(), 0.0);
        near.each_row(&mut self.inverse, |a, row, inverse| {
            let from = near.position[a];
            let squares =
                |(b, slope): (usize, f64)| -slope * squared(difference(near.position[b], from));
            let present = row.slopes().map(squares).sum::<f64>() / 3.0;
            let lack = 1.0 - (near.number[a] - own) / number;
            let missing = if lack > LACKS { lack * moment } else { 0.0 };
            *inverse = 1.0 / (present + missing).max(0.1 * moment);
        });
        near.complete(&mut self.inverse, |m, _, _| m);
        let (law, each, inverse) = (&self.law, &self.each, &self.inverse);
        let largest = law.largest();
        let mu = |a: usize| if each.is_empty() { largest } else { each[a] };
        near.each_row(predicted, |a, row, out| {
            if near.role[a] != Role::Liquid {
                return;
            }
            let (u, own, m) = (near.velocity[a], mu(a), inverse[a]);
            let mut sum = [0.0; 3];
            for (b, slope) in row.slopes() {
                // The image of a velocity that sticks to the face between.
                let (mean, to) = if near.role[b].flows() {
                    let original = near.images().original(b);
                    (harmonic(own, mu(original)), near.velocity[b])
                } else {
                    (own, u.map(|u| -u))
                };
                sum = along(sum, -slope * mean * (m + inverse[b]), difference(to, u));
            }
            *out = along(*out, dt / near.density(a), sum);
        });
    }

    fn same(&self, near: &Near, around: &Around, dt: f64, predicted: &mut [[f64; 3]]) {
        let own = near.kernel.value(0.0);
        let rows = near.velocity.par_iter().zip(&near.role).zip(&near.number);
        predicted
            .par_iter_mut()
            .zip(&around.sums)
            .zip(rows)
            .with_min_len(GRAIN)
            .for_each(|((out, sum), ((u, role), number))| {
                if *role == Role::Liquid {
                    // Without neighbours the number is zero.
                    let weight = (number - own).max(0.0);
                    let sum = std::array::from_fn(|i| sum[i] - weight * u[i]);
                    *out = along(*out, dt * self.scale, sum);
                }
            });
    }

    fn pairs(&mut self, near: &Near, dt: f64, predicted: &mut [[f64; 3]]) {
        let (each, scale) = (&self.each, self.scale);
        self.sums.resize(near.len(), ([0.0; 3], 0.0));
        near.each_row(&mut self.sums, |a, row, (out, least)| {
            (*out, *least) = ([0.0; 3], each[a]);
            if near.role[a] != Role::Liquid {
                return;
            }
            let own = each[a];
            for (b, w) in row.values() {
                let mean = if near.role[b].flows() {
                    harmonic(own, each[b])
                } else {
                    own
                };
                *out = along(
                    *out,
                    w * mean,
                    difference(near.velocity[b], near.velocity[a]),
                );
                *least = least.min(mean);
            }
        });
        let sums = self.sums.par_iter().with_min_len(GRAIN);
        (predicted.par_iter_mut().zip(sums))
            .for_each(|(u, (sum, _))| *u = along(*u, dt * scale, *sum));
    }
}

/// 2 mu_a mu_b / (mu_a + mu_b).
#[inline(always)]
fn harmonic(one: f64, other: f64) -> f64 {
    if one + other > 0.0 {
        2.0 * one * other / (one + other)
    } else {
        0.0
    }
}
