//! Cells of a solid that flows: the part of its stage that only plasticity needs.

use particles::{Column, sweep};
use rayon::prelude::*;

use super::cell::{Cell, Derivatives, dimensions, gradient, slope};
use super::elastic::{Elastic, GRAIN};
use super::plastic::{Flowing, History, Plasticity, inverse};
use super::tensor::{Matrix, determinant, inner, times_transposed, trace};

/// Equivalent plastic strain.
pub(super) const PLASTIC_STRAIN: Column<f64> = Column::new("plastic_strain", "1", 0.0).shown();

/// The law of flow and what each cell has suffered.
#[derive(Debug, Clone)]
pub(super) struct Plastic {
    pub(super) law: Plasticity,
    pub(super) histories: Vec<History>,
}

/// Answer of a cell that flows on from a history: slopes of its energy, and how many times stiffer it is than at rest.
fn answer<const L: usize, const T: usize>(
    cell: &Cell,
    law: &Plasticity,
    derivatives: &Derivatives<L, T>,
    history: &mut History,
) -> (Derivatives<L, T>, f64) {
    let d = dimensions(T);
    let f = gradient(derivatives);
    let Flowing {
        kirchhoff, kept, ..
    } = law.flow(&cell.law, &f, history);
    let back = inverse(&f);
    let mut varying = [[[0.0; 3]; 3]; 3];
    for (k, stress) in varying.iter_mut().enumerate().take(d) {
        let strain = elastic(&f, &slope(derivatives, k), (d, &history.bent[k]));
        let away = deviator(&strain, d);
        let flown = away.map(|row| row.map(|e| (1.0 - kept) * e));
        if kept < 1.0 {
            let lost = cell.law.shear * (1.0 - kept * kept) * inner(&away, &away);
            history.lost += cell.moment[k] * lost;
            history.bent[k] = sum(&history.bent[k], &flown, 1.0);
        }
        *stress = cell.bent(&sum(&strain, &flown, -1.0), d);
    }
    let middle = times_transposed(&kirchhoff, &back);
    let stiffer = (inner(&back, &back) - 2.0).max(1.0);
    (cell.slopes(derivatives, (&f, &middle), &varying), stiffer)
}

/// Energy of a cell with its history \[J\].
fn energy<const L: usize, const T: usize>(
    cell: &Cell,
    law: &Plasticity,
    derivatives: &Derivatives<L, T>,
    history: &History,
) -> f64 {
    let d = dimensions(T);
    let f = gradient(derivatives);
    let mut energy = law.flow(&cell.law, &f, &mut history.clone()).energy;
    for k in 0..d {
        let strain = elastic(&f, &slope(derivatives, k), (d, &history.bent[k]));
        energy += 0.5 * cell.moment[k] * inner(&strain, &cell.bent(&strain, d));
    }
    cell.volume * energy
}

/// The elastic part of the strain that varies along an axis.
fn elastic(f: &Matrix, slope: &Matrix, (d, bent): (usize, &Matrix)) -> Matrix {
    sum(&Cell::bending(f, slope, d), bent, -1.0)
}

/// a + factor b.
fn sum(a: &Matrix, b: &Matrix, factor: f64) -> Matrix {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j: usize| a[i][j] + factor * b[i][j]))
}

/// The deviator, in the plane of that plane.
fn deviator(a: &Matrix, d: usize) -> Matrix {
    let mean = trace(a) / d as f64;
    let mut out = *a;
    (0..d).for_each(|k| out[k][k] -= mean);
    out
}

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
        match &self.plastic {
            None => cell.energy(&derivatives),
            Some(plastic) => energy(cell, &plastic.law, &derivatives, &plastic.histories[a]),
        }
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
        let [sum] = sweep::sum(histories.len(), |a| [law.taken(&histories[a])]);
        self.body.cell.volume * sum
    }
}
