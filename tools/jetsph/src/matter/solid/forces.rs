//! Forces of an elastic solid: the two loops over links in which it spends its time.

use particles::sweep;
use rayon::prelude::*;

use super::cell::Derivatives;
use super::elastic::{Elastic, GRAIN};

impl<const L: usize, const T: usize> Elastic<L, T> {
    /// Derivatives of the deformation of cell `a`.
    #[inline(always)]
    pub(super) fn derivatives(&self, a: usize) -> Derivatives<L, T> {
        self.derivatives_of(&self.places, a)
    }

    /// Derivatives in cell `a` of what all particles and anchors have.
    #[inline(always)]
    pub(super) fn derivatives_of(&self, field: &[[f64; L]], a: usize) -> Derivatives<L, T> {
        let row = self.links.row(a);
        let own = field[a];
        let mut sum = [[0.0; L]; T];
        for (b, weight) in row.other.iter().zip(row.weight) {
            let other = field[*b as usize];
            let dx: [f64; L] = std::array::from_fn(|k| other[k] - own[k]);
            for (column, w) in sum.iter_mut().zip(weight) {
                (0..L).for_each(|k| column[k] += w * dx[k]);
            }
        }
        sum
    }

    /// Slopes of the energy of all cells that are elastic.
    fn answer_whole(&self, answers: &mut [Derivatives<L, T>], stiffer: &mut [f64]) {
        let each = answers
            .par_chunks_mut(GRAIN)
            .zip(stiffer.par_chunks_mut(GRAIN));
        each.enumerate().for_each(|(chunk, (answers, stiffer))| {
            sweep::wide(
                #[inline(always)]
                || {
                    let all = answers.iter_mut().zip(stiffer.iter_mut()).enumerate();
                    for (k, (answer, stiffer)) in all {
                        let derivatives = self.derivatives(chunk * GRAIN + k);
                        (*answer, *stiffer) = self.body.cell.answer(&derivatives);
                    }
                },
            );
        });
    }

    /// Slopes of the energy of all cells, less the work of the loads at a time \[s\].
    pub(super) fn answer(&mut self, time: f64) {
        let mut answers = std::mem::take(&mut self.answers);
        let mut stiffer = std::mem::take(&mut self.stiffer);
        if let Some(mut plastic) = self.plastic.take() {
            self.answer_flowing(&mut plastic, &mut answers, &mut stiffer);
            self.plastic = Some(plastic);
        } else {
            self.answer_whole(&mut answers, &mut stiffer);
        }
        self.body.part(&mut answers);
        for load in &self.body.loads {
            let parts: [f64; T] = load.parts();
            let (force, columns) = (load.at(time), answers[load.particle].iter_mut().zip(parts));
            columns.for_each(|(column, part)| {
                (0..L.min(3)).for_each(|k| column[k] -= force[k] * part);
            });
        }
        self.answers = answers;
        self.stiffer = stiffer;
        self.let_go();
    }

    /// Adds the accelerations of all particles: what their own cell does to them, less what those of the others do.
    pub(super) fn accelerate(&self, acceleration: &mut [[f64; 3]], mass: &[f64]) {
        let each = acceleration.par_chunks_mut(GRAIN).enumerate();
        each.for_each(|(chunk, acceleration)| {
            sweep::wide(
                #[inline(always)]
                || {
                    for (k, own) in acceleration.iter_mut().enumerate() {
                        let a = chunk * GRAIN + k;
                        let row = self.links.row(a);
                        let mut force = [0.0; L];
                        add(&mut force, &self.answers[a], row.total);
                        // Term by term: sums that do not wait for one another.
                        let mut others = [[0.0; L]; T];
                        for (b, back) in row.other.iter().zip(row.back) {
                            // Anchors stand behind the particles.
                            let Some(answer) = self.answers.get(*b as usize) else {
                                break;
                            };
                            for ((sum, column), w) in others.iter_mut().zip(answer).zip(back) {
                                (0..L).for_each(|k| sum[k] += w * column[k]);
                            }
                        }
                        for column in &others {
                            (0..L).for_each(|k| force[k] -= column[k]);
                        }
                        let inverse = 1.0 / mass[a];
                        (0..L.min(3)).for_each(|i| own[i] += inverse * force[i]);
                    }
                },
            );
        });
    }
}

/// sum += slopes of the energy . weights.
#[inline(always)]
pub(super) fn add<const L: usize, const T: usize>(
    sum: &mut [f64; L],
    answer: &Derivatives<L, T>,
    weight: &[f64; T],
) {
    for (column, w) in answer.iter().zip(weight) {
        (0..L).for_each(|k| sum[k] += w * column[k]);
    }
}
