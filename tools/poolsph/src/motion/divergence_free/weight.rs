//! What is known of the pressure beforehand: that upon the surface in the mean, and that which bears the weight.
//!
//! A uniform acceleration a does nothing to a liquid between walls but to press:
//!
//! ```text
//! p = p' + rho a.(x - x_0) + p_0
//! ```
//!
//! with the middle x_0 of the liquid, and p_0 such that p' is zero in the mean over the surface. Only p' is solved for,
//! with the velocities that a has not changed, so that a weight that walls bear costs no accuracy however large it is and
//! however the particles lie. Along axes on which nothing holds a body it falls: there a is zero. So it is along axes on
//! which the liquid is periodic.

use rayon::prelude::*;
use shapes::frame::{along, difference, dot, squared};

use super::islands::Islands;
use super::operators::Sums;
use crate::motion::step::Step;
use crate::near::{Near, Role};
use crate::sweep::GRAIN;

/// The known part of the pressure, `[m]` in the order of [`Near`].
#[derive(Debug, Clone, Default)]
pub(super) struct Weight {
    /// rho a \[N/m3\] where walls bear it.
    slope: [f64; 3],
    /// x_0 \[m\].
    middle: [f64; 3],
    /// p_0 of what walls bear, and of what falls \[Pa\].
    level: [f64; 2],
    /// p' upon the surface \[Pa\], `[m]`.
    upon: Vec<f64>,
}

impl Weight {
    /// Takes the acceleration `borne` \[m/s2\] out of the predicted velocities along the axes on which
    /// bodies are held.
    pub(super) fn lift(
        &mut self,
        near: &Near,
        islands: &Islands,
        predicted: &mut [[f64; 3]],
        borne: [f64; 3],
        step: Step,
    ) {
        self.slope = borne.map(|a| step.metal.density * a);
        self.middle = [0.0; 3];
        if squared(borne) <= 0.0 {
            return;
        }
        let mut count = 0.0;
        for (a, u) in predicted.iter_mut().enumerate() {
            if near.role[a] == Role::Liquid && !islands.free(a) {
                *u = along(*u, -step.dt, islands.borne(a, borne));
                self.middle = along(self.middle, 1.0, near.position[a]);
                count += 1.0;
            }
        }
        self.middle = self.middle.map(|x| x / f64::max(count, 1.0));
    }

    /// Finds the levels of the pressure upon the surface, and what is left of it there; gives the levels of what walls bear and
    /// of what falls \[Pa\].
    ///
    /// The surface lies where the mirror images of the neighbours that a particle lacks begin: half way to them.
    pub(super) fn settle(&mut self, near: &Near, islands: &Islands, rows: &[Sums]) -> [f64; 2] {
        self.level = [0.0; 2];
        let mut upon = std::mem::take(&mut self.upon);
        let known = |a: usize, row: &Sums| {
            if row.missing <= 0.0 {
                return 0.0;
            }
            let surface = along(near.position[a], 1.0, row.outwards());
            near.outer.get(a).copied().unwrap_or(0.0) - self.known(near, islands, a, surface)
        };
        let points = rows.par_iter().enumerate().with_min_len(GRAIN);
        points
            .map(|(a, row)| known(a, row))
            .collect_into_vec(&mut upon);
        let mut sums = [[0.0; 2]; 2];
        for (a, (row, upon)) in rows.iter().zip(&upon).enumerate() {
            let sum = &mut sums[usize::from(islands.free(a))];
            *sum = [sum[0] + row.missing * upon, sum[1] + row.missing];
        }
        self.level = sums.map(|[sum, weight]| if weight > 0.0 { sum / weight } else { 0.0 });
        for (a, (row, upon)) in rows.iter().zip(&mut upon).enumerate() {
            if row.missing > 0.0 {
                *upon -= self.level[usize::from(islands.free(a))];
            }
        }
        self.upon = upon;
        self.level
    }

    /// p' upon the surface \[Pa\], `[m]`; zero within.
    pub(super) fn upon(&self) -> &[f64] {
        &self.upon
    }

    /// p - p' at the place `x` of the particle `a` \[Pa\].
    #[inline]
    pub(super) fn known(&self, near: &Near, islands: &Islands, a: usize, x: [f64; 3]) -> f64 {
        self.above(self.level, near, islands, a, x)
    }

    /// The same above other levels \[Pa\], of what walls bear and of what falls.
    #[inline]
    pub(super) fn above(
        &self,
        level: [f64; 2],
        near: &Near,
        islands: &Islands,
        a: usize,
        x: [f64; 3],
    ) -> f64 {
        if islands.free(a) {
            level[1]
        } else {
            let borne = dot(islands.borne(a, self.slope), difference(x, self.middle));
            level[0] + near.heaviness(a) * borne
        }
    }

    /// What the weight of metal makes at the place `x` over x_0, in the body of the particle `a` \[Pa\].
    #[inline]
    pub(super) fn of_metal(&self, islands: &Islands, a: usize, x: [f64; 3]) -> f64 {
        dot(islands.borne(a, self.slope), difference(x, self.middle))
    }

    /// Takes a place of the interface for x_0.
    pub(super) fn about(&mut self, middle: [f64; 3]) {
        self.middle = middle;
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        8 * self.upon.capacity()
    }
}
