//! A body whose cells flow: the part of its stage that only plasticity needs.

use particles::sweep;
use rayon::prelude::*;

use super::cell::{Derivatives, gradient};
use super::elastic::{Elastic, GRAIN};
use super::flowing::{Plastic, answer, energy};
use super::plastic::{History, Plasticity};
use super::tensor::{Matrix, determinant};

impl<const L: usize, const T: usize> Elastic<L, T> {
    /// With plastic flow.
    #[must_use]
    pub fn flowing(mut self, law: Plasticity) -> Self {
        let histories = vec![History::NONE; self.answers.len()];
        self.plastic = Some(Plastic { law, histories });
        self
    }

    /// Slopes of the energy of all cells, which flow.
    pub(super) fn answer_flowing(
        &self,
        plastic: &mut Plastic,
        answers: &mut [Derivatives<L, T>],
        stiffer: &mut [f64],
    ) {
        let law = plastic.law;
        let each = answers
            .par_chunks_mut(GRAIN)
            .zip(stiffer.par_chunks_mut(GRAIN))
            .zip(plastic.histories.par_chunks_mut(GRAIN));
        each.enumerate()
            .for_each(|(chunk, ((answers, stiffer), histories))| {
                let all = answers.iter_mut().zip(stiffer.iter_mut()).zip(histories);
                for (k, ((out, stiffer), history)) in all.enumerate() {
                    let a = chunk * GRAIN + k;
                    if self.is_whole(a) {
                        let derivatives = self.derivatives(a);
                        (*out, *stiffer) = answer(&self.body.cell, &law, &derivatives, history);
                    }
                }
            });
    }

    /// Whether a particle is not broken.
    pub(super) fn is_whole(&self, a: usize) -> bool {
        self.breaking.as_ref().is_none_or(|b| !b.broken[a])
    }

    /// Energy of a cell \[J\].
    pub(super) fn cell_energy(&self, a: usize) -> f64 {
        let (cell, derivatives) = (&self.body.cell, self.derivatives(a));
        let whole = match &self.plastic {
            None => cell.energy(&derivatives),
            Some(plastic) => energy(cell, &plastic.law, &derivatives, &plastic.histories[a]),
        };
        self.body.share(a) * whole
    }

    /// Cauchy stress of a cell that flows \[Pa\].
    pub(super) fn flowing_stress(&self, a: usize) -> Option<Matrix> {
        let plastic = self.plastic.as_ref()?;
        let f = gradient(&self.derivatives(a));
        let mut history = plastic.histories[a];
        let found = plastic.law.flow(&self.body.cell.law, &f, &mut history);
        let volume = determinant(&f);
        Some(found.kirchhoff.map(|row| row.map(|x| x / volume)))
    }

    /// What flow has taken \[J\].
    pub(super) fn taken(&self) -> f64 {
        let Some(Plastic { law, histories }) = &self.plastic else {
            return 0.0;
        };
        let [sum] = sweep::sum(histories.len(), |a| {
            [self.body.share(a) * law.taken(&histories[a])]
        });
        self.body.cell.volume * sum
    }
}
