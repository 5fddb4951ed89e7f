//! Whether weights are such as equations can be made of.

use crate::bench::{Bench, Work};
use crate::search::Target;

/// Weights of an operator, in units of the least spacing, sum up to this at most: some tens are
/// usual, and more come from points that tell little.
const TAME: f64 = 1e3;
/// Weights of a one-sided derivative of the sign of the own one add up to this part of it at most: those of a flat surface
/// have none with quadratics and up to three times as many with quartics, those beside edges up to 7 times as many; in a
/// narrow wedge, whose points tell little of the way out of its surfaces, or where quartics have few points to spare, the own
/// one has the sign of the others.
pub(crate) const LEANS: f64 = 10.0;

/// Weights of a plain fit add up to this at most without their signs, where a larger support gives less: of the gradient and
/// of the Laplacian, in spacings, by order from 1, in two and three dimensions. About one and a half of those of a corner
/// of a lattice. Lines have no such supports, and quartics in space err more by larger ones.
const LOUD: [[[f64; 2]; 4]; 2] = [
    [NO_BOUND, [6.0, 10.0], [9.0, 18.0], [14.0, 36.0]],
    [NO_BOUND, [7.0, 14.0], [10.0, 36.0], NO_BOUND],
];
const NO_BOUND: [f64; 2] = [f64::INFINITY; 2];

impl<const D: usize> Bench<'_, D> {
    /// Weights of a plain fit over what they add up to where points tell enough; nothing of one that obeys conditions. What
    /// the polynomial leaves of a field is multiplied by these, which the condition number does not know.
    pub(crate) fn loud(&self, order: u8, work: &Work<D>) -> f64 {
        if !work.conditions.is_empty() {
            return 0.0;
        }
        let points = work.support.offsets.len();
        let sum = |row: usize| -> f64 {
            let weights = &work.fit.weights[row * points..(row + 1) * points];
            weights.iter().map(|w| w.abs()).sum()
        };
        let [slope, bend] = LOUD[D - 2][usize::from(order) - 1];
        let slopes = self.columns.gradient.map_or(0..0, |g| g..g + D);
        let worst = slopes.map(|row| sum(row) / slope).fold(0.0, f64::max);
        let bent = self.columns.laplacian.map_or(0.0, |row| sum(row) / bend);
        worst.max(bent)
    }

    /// Weights of the Laplacian that have the sign of the own one, over that; nothing where none is wanted.
    pub(crate) fn uneven(&self, work: &Work<D>) -> f64 {
        let (Some(row), Some(own), true) = (
            self.columns.laplacian,
            work.support.own,
            self.plan.interpolating,
        ) else {
            return 0.0;
        };
        let points = work.support.offsets.len();
        let weights = &work.fit.weights[row * points..(row + 1) * points];
        let others = weights.iter().enumerate().filter(|(j, _)| *j != own);
        let wrong: f64 = others.map(|(_, w)| (-w).max(0.0)).sum();
        if weights[own] < 0.0 {
            wrong / -weights[own]
        } else {
            f64::INFINITY
        }
    }

    /// Weights of a one-sided derivative that have the sign of the own one, over that; without bound where the own one has
    /// the sign of the others, nothing where no derivative is one-sided. Quadratics that stand in for a higher order are
    /// not judged: nothing is left to stand in for them.
    pub(crate) fn leaning(&self, target: &Target<D>, order: u8, work: &Work<D>) -> f64 {
        let judged =
            self.plan.lowest() < 2 && (order > 2 || order == self.plan.order && order == 2);
        let (Some(gradient), Some(own), Some(side)) = (
            self.columns.gradient.filter(|_| judged),
            work.support.own.filter(|_| self.plan.interpolating),
            self.rules.side(target.row),
        ) else {
            return 0.0;
        };
        let points = work.support.offsets.len();
        let weight = |j: usize| -> f64 {
            let part = |a: usize| side[a] * work.fit.weights[(gradient + a) * points + j];
            (0..D).map(part).sum()
        };
        let others = (0..points).filter(|j| *j != own);
        let wrong: f64 = others.map(|j| (-weight(j)).max(0.0)).sum();
        let lean = wrong / (-weight(own)).max(0.0);
        if lean.is_nan() { 0.0 } else { lean }
    }

    /// Whether that is more than serves.
    pub(crate) fn leans(&self, target: &Target<D>, order: u8, work: &Work<D>) -> bool {
        order == 2 && self.leaning(target, order, work) > LEANS
    }
}

/// Whether no operator of the fit has wild weights.
pub(crate) fn tame<const D: usize>(target: &Target<D>, work: &Work<D>) -> bool {
    let most = TAME / (target.metric.narrowest * target.metric.narrowest);
    let mut rows = work.fit.weights.chunks(work.support.offsets.len());
    rows.all(|row| row.iter().map(|w| w.abs()).sum::<f64>() < most)
}
