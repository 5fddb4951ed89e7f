//! A fit is loaded with its support, its conditions and what is asked of it.

use crate::basis::Basis;
use crate::bench::{Bench, Work};
use crate::fit::Offsets;
use crate::functional::{Condition, Rows};
use crate::harmonic::Over;
use crate::metric::Metric;
use crate::search::Target;

impl<const D: usize> Bench<'_, D> {
    /// The basis of a fit of an order: of linear polynomials that a condition asks to bow, that of quadratics.
    pub(crate) fn basis(&self, order: u8, work: &Work<D>) -> &Basis<D> {
        let bows =
            |c: &Condition<D>| matches!(c, Condition::Laplacian { .. } | Condition::Drift { .. });
        let harmonic = work.conditions.contains(&Condition::Harmonic);
        let bowed = order == 1 && !harmonic && work.conditions.iter().any(bows);
        &self.bases[usize::from(order) - usize::from(!bowed)]
    }

    /// Loads the fit with the support, the conditions and the functionals.
    pub(crate) fn prepare(&self, target: &Target<D>, by_room: bool, order: u8, work: &mut Work<D>) {
        let basis = self.basis(order, work);
        let rows = Rows {
            basis,
            metric: &target.metric,
            radius: work.support.radius,
        };
        rows.functionals(&self.columns, &mut work.functionals);
        work.condition_rows.clear();
        work.powers.clear();
        work.harmonic.clear();
        for condition in &work.conditions {
            rows.condition(condition, target.place, |row, power| {
                if *condition == Condition::Harmonic {
                    work.harmonic.push(row);
                } else {
                    work.condition_rows.push(row);
                    work.powers.push(power);
                }
            });
        }
        self.weigh(target, by_room, basis.order(), work);
        let offsets = Offsets {
            s: &work.support.offsets,
            rooms: &work.rooms,
            radius: work.support.radius,
        };
        let over = if !work.harmonic.is_empty() {
            Over::Harmonic(&work.harmonic)
        } else if basis.order() > order {
            let side = self.rules.side(target.row);
            Over::Bowed(side.map(|n| target.metric.upward(n)))
        } else {
            Over::All
        };
        work.fit.load(basis, offsets, &work.condition_rows, over);
    }

    /// What the weights of points are multiplied by beside that of their distance; nothing where it is nothing.
    fn weigh(&self, target: &Target<D>, by_room: bool, order: u8, work: &mut Work<D>) {
        work.rooms.clear();
        let metrics = self.search.cloud().metrics;
        let level = |metric: &Metric<D>| metric.normal().is_none();
        let neighbours = || work.support.neighbours.iter();
        let by_room = by_room
            || self.plan.by_room
                && level(&target.metric)
                && neighbours().all(|j| level(&metrics[*j as usize]));
        if !by_room && !target.metric.follows() {
            return;
        }
        let above = target.metric.above(order);
        let points = neighbours().zip(&work.support.offsets);
        work.rooms.extend(points.map(|(j, s)| {
            let room = if by_room {
                metrics[*j as usize].volume() / target.metric.volume()
            } else {
                1.0
            };
            room * target.metric.heavier(s, above)
        }));
    }
}
