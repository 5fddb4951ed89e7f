//! Cells of a solid that flows: their energy and its slopes, by what each has suffered.

use particles::Column;

use super::cell::{Cell, Derivatives, dimensions, gradient, slope};
use super::plastic::{Flowing, History, Plasticity, inverse};
use super::tensor::{Matrix, inner, times_transposed, trace};

/// Equivalent plastic strain.
pub(super) const PLASTIC_STRAIN: Column<f64> = Column::new("plastic_strain", "1", 0.0).shown();

/// The law of flow and what each cell has suffered.
#[derive(Debug, Clone)]
pub(super) struct Plastic {
    pub(super) law: Plasticity,
    pub(super) histories: Vec<History>,
}

/// Answer of a cell that flows on from a history: slopes of its energy, and how many times stiffer it is than at rest.
pub(super) fn answer<const L: usize, const T: usize>(
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
        let strain = elastic(&f, &slope(derivatives, k), &history.bent[k]);
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
    (cell.slopes(derivatives, &f, &middle, &varying), stiffer)
}

/// Energy of a cell with its history \[J\].
pub(super) fn energy<const L: usize, const T: usize>(
    cell: &Cell,
    law: &Plasticity,
    derivatives: &Derivatives<L, T>,
    history: &History,
) -> f64 {
    let d = dimensions(T);
    let f = gradient(derivatives);
    let mut energy = law.flow(&cell.law, &f, &mut history.clone()).energy;
    for k in 0..d {
        let strain = elastic(&f, &slope(derivatives, k), &history.bent[k]);
        energy += 0.5 * cell.moment[k] * inner(&strain, &cell.bent(&strain, d));
    }
    cell.volume * energy
}

/// The elastic part of the strain that varies along an axis.
fn elastic(f: &Matrix, slope: &Matrix, bent: &Matrix) -> Matrix {
    sum(&Cell::bending(f, slope), bent, -1.0)
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
