//! Which of two liquids each particle of the copy is, where there are two.

use super::Near;
use crate::state::slag::{SLAG, Slag};
use crate::state::{State, marked};

/// Metal and slag.
#[derive(Debug, Clone)]
pub struct Liquids {
    /// Is slag, `[m + images]`.
    slag: Vec<bool>,
    /// rho of metal and slag \[kg/m3\].
    density: [f64; 2],
    /// Tension of the interface \[N/m\].
    pub tension: f64,
    /// 2 rho_0/(rho_a + rho_b) with the density rho_0 of the metal.
    shares: [[f64; 2]; 2],
}

impl Liquids {
    /// Of metal of a `density` \[kg/m3\] and `slag`; nobody yet.
    pub(super) fn new(density: f64, slag: Slag) -> Self {
        let both = [density, slag.density];
        let share = |a: f64, b: f64| 2.0 * density / (a + b);
        Self {
            slag: Vec::new(),
            density: both,
            tension: slag.interface_tension,
            shares: both.map(|a| both.map(|b| share(a, b))),
        }
    }

    /// Takes the marks of the members `ids`.
    pub(super) fn gather(&mut self, state: &State, ids: &[u32]) {
        let marks = state.metal.column(&SLAG);
        self.slag.clear();
        let each = ids.iter().map(|id| marked(marks, *id as usize));
        self.slag.extend(each);
    }

    /// The marks, images included.
    pub(super) fn marks(&mut self) -> &mut Vec<bool> {
        &mut self.slag
    }

    /// Whether `a` is slag.
    #[must_use]
    #[inline(always)]
    pub fn is_slag(&self, a: usize) -> bool {
        self.slag[a]
    }

    /// Whether both are of one liquid.
    #[must_use]
    #[inline(always)]
    pub fn alike(&self, a: usize, b: usize) -> bool {
        self.slag[a] == self.slag[b]
    }

    /// rho of `a` \[kg/m3\].
    #[must_use]
    #[inline(always)]
    pub fn density(&self, a: usize) -> f64 {
        self.density[usize::from(self.slag[a])]
    }

    /// rho of metal and slag \[kg/m3\].
    #[must_use]
    pub fn densities(&self) -> [f64; 2] {
        self.density
    }

    /// 2 rho_0/(rho_a + rho_b): how much easier than metal the liquid between both is set in motion.
    #[must_use]
    #[inline(always)]
    pub fn share(&self, a: usize, b: usize) -> f64 {
        self.shares[usize::from(self.slag[a])][usize::from(self.slag[b])]
    }

    /// The shares of `a` beside metal and beside slag, in single precision.
    #[must_use]
    #[inline(always)]
    pub fn shares(&self, a: usize) -> [f32; 2] {
        self.shares[usize::from(self.slag[a])].map(|share| share as f32)
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.slag.capacity()
    }
}

impl Near {
    /// rho of the particle `a` \[kg/m3\].
    #[must_use]
    #[inline]
    pub fn density(&self, a: usize) -> f64 {
        match &self.liquids {
            Some(liquids) => liquids.density(a),
            None => self.density,
        }
    }

    /// rho of the particle `a` over that of the metal.
    #[must_use]
    #[inline]
    pub fn heaviness(&self, a: usize) -> f64 {
        self.density(a) / self.density
    }

    /// rho of the lightest liquid over that of the particle `a`.
    #[must_use]
    #[inline]
    pub fn slowness(&self, a: usize) -> f64 {
        let lightest = match &self.liquids {
            Some(liquids) => liquids.densities().into_iter().fold(f64::MAX, f64::min),
            None => self.density,
        };
        lightest / self.density(a)
    }
}
