//! What a solid shows the water: how its cells are deformed, and how they move.

use particles::{Set, sweep};
use rayon::prelude::*;

use super::cell::{Derivatives, gradient};
use super::elastic::{Elastic, GRAIN};
use super::quadratic::second;
use super::tensor::Matrix;
use crate::matter::meeting::faces::{
    BEND_PUSH, BEND_RATE, DEFORMATION_PUSH, DEFORMATION_RATE, MIXED, PRESSED, PULLED, WARP_PUSH,
    WARP_RATE,
};
use crate::matter::meeting::skin::DEFORMATION;
use crate::state::{ACCELERATION, VELOCITY};

/// Columns of a chunk of particles: the deformation, and rates of first, second and mixed derivatives.
struct Shown<'a> {
    shape: &'a mut [Matrix],
    first: &'a mut [Matrix],
    bend: &'a mut [Matrix],
    warp: &'a mut [Matrix],
}

impl<const L: usize, const T: usize> Elastic<L, T> {
    /// Shows the water how the cells are deformed and move; broken ones keep their shape and rest in it.
    pub(super) fn show_shape(&mut self, set: &mut Set) {
        let mut columns =
            [&DEFORMATION, &DEFORMATION_RATE, &BEND_RATE, &WARP_RATE].map(|c| set.take(c));
        let speeds = self.speeds(set.column(&VELOCITY));
        let [shape, first, bend, warp] = &mut columns;
        let rates = first
            .par_chunks_mut(GRAIN)
            .zip(bend.par_chunks_mut(GRAIN))
            .zip(warp.par_chunks_mut(GRAIN));
        let all = shape.par_chunks_mut(GRAIN).zip(rates).enumerate();
        all.for_each(|(chunk, (shape, ((first, bend), warp)))| {
            let mut shown = Shown {
                shape,
                first,
                bend,
                warp,
            };
            sweep::wide(
                #[inline(always)]
                || self.show_chunk(chunk * GRAIN, &speeds, &mut shown),
            );
        });
        for (column, values) in [&DEFORMATION, &DEFORMATION_RATE, &BEND_RATE, &WARP_RATE]
            .into_iter()
            .zip(columns)
        {
            set.put(column, values);
        }
    }

    /// Velocities of particles and anchors.
    fn speeds(&self, velocity: &[[f64; 3]]) -> Vec<[f64; L]> {
        let anchors = self.body.anchors.iter().map(|anchor| anchor.velocity);
        let all = velocity.iter().copied().chain(anchors);
        all.map(|u| std::array::from_fn(|k| if k < 3 { u[k] } else { 0.0 }))
            .collect()
    }

    /// Shows the water how the faces of pressed cells are accelerated, its last forces included; anchors move evenly.
    pub(super) fn show_push(&self, set: &mut Set) {
        let mut columns = [&DEFORMATION_PUSH, &BEND_PUSH, &WARP_PUSH].map(|c| set.take(c));
        let others = set.column(&ACCELERATION).iter();
        let both = others.zip(set.column(&PULLED));
        let mut field: Vec<[f64; L]> = both
            .map(|(a, b)| std::array::from_fn(|k| if k < 3 { a[k] + b[k] } else { 0.0 }))
            .collect();
        field.resize(self.places.len(), [0.0; L]);
        let pressed = set.column(&PRESSED).iter().enumerate();
        for (a, _) in pressed.filter(|(_, pressed)| **pressed > 0) {
            let [first, bend, warp] = &mut columns;
            (first[a], bend[a], warp[a]) = Default::default();
            if self.is_whole(a) {
                let rate = self.derivatives_of(&field, a);
                derived(&rate, &mut first[a], &mut bend[a], &mut warp[a]);
            }
        }
        for (column, values) in [&DEFORMATION_PUSH, &BEND_PUSH, &WARP_PUSH]
            .into_iter()
            .zip(columns)
        {
            set.put(column, values);
        }
    }

    #[inline(always)]
    fn show_chunk(&self, begin: usize, speeds: &[[f64; L]], shown: &mut Shown<'_>) {
        for k in 0..shown.shape.len() {
            let a = begin + k;
            (shown.first[k], shown.bend[k], shown.warp[k]) = Default::default();
            if !self.is_whole(a) {
                continue;
            }
            shown.shape[k] = gradient(&self.derivatives(a));
            let rate = self.derivatives_of(speeds, a);
            derived(
                &rate,
                &mut shown.first[k],
                &mut shown.bend[k],
                &mut shown.warp[k],
            );
        }
    }
}

/// Derivatives as the water wants them: first, second and mixed ones.
#[inline(always)]
fn derived<const L: usize, const T: usize>(
    rate: &Derivatives<L, T>,
    first: &mut Matrix,
    bend: &mut Matrix,
    warp: &mut Matrix,
) {
    let d = L.min(3);
    for (j, column) in rate.iter().enumerate().take(d) {
        for i in 0..d {
            first[i][j] = column[i];
            bend[i][j] = rate[second(d, j, j)][i];
        }
    }
    for (column, (l, m)) in MIXED.into_iter().enumerate().filter(|(_, p)| p.1 < d) {
        let mixed = &rate[second(d, l, m)];
        (0..d).for_each(|i| warp[i][column] = mixed[i]);
    }
}
