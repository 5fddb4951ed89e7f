//! The tension's part of the pressure upon the free surface.
//!
//! ```text
//! p_s = p_gas + gamma kappa      (Young 1805, Laplace 1806)
//! ```
//!
//! with the curvature kappa of the surface at each of its particles ([`crate::surface::curvature`]). A particle that
//! lacks neighbours where there is no surface to be seen, in a crack or beside a void, has the mean of the pressures around it, or
//! that of the whole surface. Over a closed surface gamma kappa n adds up to nothing: tension moves no body as a whole.

use particles::Matter;

use super::operators::Sums;
use crate::near::{Near, Role};
use crate::surface::curvature::Curvature;

/// gamma kappa with its scratch.
#[derive(Debug, Clone)]
pub(super) struct Pull {
    /// gamma kappa \[Pa\], `[m]`; empty without tension.
    pressure: Vec<f64>,
    /// `Near::outer` without it.
    gas: Vec<f64>,
    known: Vec<bool>,
    curvature: Curvature,
}

impl Pull {
    /// None yet upon the surface of `metal`.
    pub(super) fn new(metal: Matter) -> Self {
        Self {
            pressure: Vec::new(),
            gas: Vec::new(),
            known: Vec::new(),
            curvature: Curvature::new(metal),
        }
    }

    /// Adds gamma kappa to what presses on the surface; `rows` tell what it lacks.
    pub(super) fn press(&mut self, near: &mut Near, rows: &[Sums]) {
        self.pressure.clear();
        self.known.clear();
        if near.tension.is_empty() {
            return;
        }
        self.curvature.measure(near);
        let (mut sum, mut weight) = (0.0, 0.0);
        let curvatures = self.curvature.mean.iter().zip(&near.tension).zip(rows);
        for ((curvature, tension), row) in curvatures {
            let pressure = tension * curvature.unwrap_or(0.0);
            self.pressure.push(pressure);
            self.known.push(curvature.is_some());
            if curvature.is_some() {
                sum += row.missing * pressure;
                weight += row.missing;
            }
        }
        let level = if weight > 0.0 { sum / weight } else { 0.0 };
        self.complete(near, rows, level);
        self.gas.clear();
        self.gas.append(&mut near.outer);
        near.outer.extend_from_slice(&self.pressure);
        for (outer, gas) in near.outer.iter_mut().zip(&self.gas) {
            *outer += gas;
        }
    }

    /// Takes it away again.
    pub(super) fn release(&mut self, near: &mut Near) {
        if !near.tension.is_empty() {
            near.outer.clear();
            near.outer.append(&mut self.gas);
        }
    }

    /// Finds what presses where no surface is to be seen; `level` is the mean of all.
    fn complete(&mut self, near: &Near, rows: &[Sums], level: f64) {
        let known = &self.known;
        for a in 0..near.len() {
            if near.role[a] == Role::Liquid && rows[a].missing > 0.0 && !known[a] {
                let (mut sum, mut count) = (0.0, 0.0);
                for &b in near.lists.row(a) {
                    let b = near.images().original(b as usize);
                    if known[b] {
                        sum += self.pressure[b];
                        count += 1.0;
                    }
                }
                self.pressure[a] = if count > 0.0 { sum / count } else { level };
            }
        }
    }

    /// gamma kappa at `a` \[Pa\].
    #[inline]
    pub(super) fn at(&self, a: usize) -> f64 {
        self.pressure.get(a).copied().unwrap_or(0.0)
    }

    /// Particles at which the curvature is bounded.
    pub(super) fn bounded(&self) -> usize {
        self.curvature.bounded
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        (8 + 8 + 1) * self.pressure.capacity() + self.curvature.bytes()
    }
}
