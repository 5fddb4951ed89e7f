//! The stage of a march, or of fields that stand still, with media whose permeability depends on the field.
//!
//! With what the media make of a field on the right side ([`crate::magnetic::saturation::equations`]) the stage is solved for the next one, until
//! the flux density does not change: a fixed point, by Anderson's method, which needs no other rows than those of the
//! stage. These are factorised once. Where currents flow in such media it is found by `newton` instead.

use krylov::{Anderson, Ending, Error, Rescue, Rule, Solved};

use crate::magnetic::saturation::equations::{Saturation, Seen, Sheets};
use crate::magnetic::saturation::newton::{Newton, STILL, largest};
use crate::march::scheme::{Settled, Stage};

/// Steps that are kept.
const WINDOW: usize = 10;
/// Most steps.
const MOST: u64 = 1000;
/// Growth of what is left, over the least so far, at which steps that were kept no longer tell of those to come.
const GROWN: f64 = 2.0;

/// A stage and its media.
pub struct Saturated<'a, const D: usize, const K: usize> {
    stage: Box<dyn Stage + 'a>,
    media: Saturation<'a, D>,
    settled: Settled,
}

/// Where a step has led.
struct Step {
    /// How the flux density changed, by point inside and on both sides of faces \[T\].
    change: Vec<[f64; 3]>,
    /// The largest change \[T\], and its entry.
    most: (f64, usize),
    /// The largest flux density \[T\].
    flux: f64,
    /// P on faces that follows.
    sheets: Sheets,
}

impl<'a, const D: usize, const K: usize> Saturated<'a, D, K> {
    /// A stage with the rows of one reluctivity in each medium, and what the media add.
    #[must_use]
    pub fn new(stage: Box<dyn Stage + 'a>, media: Saturation<'a, D>) -> Self {
        Self {
            stage,
            media,
            settled: Settled::default(),
        }
    }

    /// The field of an unknown as the media see it.
    fn look(&self, wave: f64, unknown: &[f64]) -> Seen<K> {
        self.media.look(unknown.as_chunks::<K>().0, wave, &[])
    }

    /// The same solve where currents flow in such media.
    fn flowing(&mut self, driven: &[f64], wave: f64, unknown: &mut [f64], rule: Rule) -> Solved {
        let mut newton = Newton {
            stage: &mut *self.stage,
            media: &self.media,
            taken: (0, 0),
            driven,
            wave,
            rule,
        };
        let ended = newton.solve::<K>(unknown.to_vec());
        let steps = newton.taken.0;
        let (change, entry) = ended.most;
        let point = self.media.place(entry);
        self.settled.count(steps, change, point, ended.found);
        unknown.copy_from_slice(&ended.unknown);
        ended.solved
    }

    /// From one field to the next, which was solved for with P on faces.
    fn step(&self, here: &Seen<K>, then: &Seen<K>, sheets: &Sheets) -> Step {
        let (sheets, apart) = self.media.next(then, sheets);
        let both = then.inside.iter().zip(&here.inside);
        let inside = both.map(|(a, b)| std::array::from_fn(|k| a[k] - b[k]));
        let change: Vec<[f64; 3]> = inside.chain(apart.into_iter().flatten()).collect();
        let flux = largest(&then.inside).0;
        Step {
            most: largest(&change),
            flux: flux.max(largest(then.on.as_flattened()).0),
            change,
            sheets,
        }
    }
}

impl<const D: usize, const K: usize> Stage for Saturated<'_, D, K> {
    fn pace(&mut self, slope: f64) -> Result<(), Error> {
        self.stage.pace(slope)
    }

    fn rescued(&self) -> Option<Rescue> {
        self.stage.rescued()
    }

    fn rescue(&mut self, way: Rescue) -> Result<(), Error> {
        self.stage.rescue(way)
    }

    fn moved(&self, driven: &[f64], unknown: &[f64]) -> Vec<f64> {
        self.stage.moved(driven, unknown)
    }

    fn settled(&self) -> Option<Settled> {
        Some(self.settled)
    }

    fn solve(
        &mut self,
        driven: &[f64],
        wave: f64,
        _: &[f64],
        unknown: &mut [f64],
        rule: Rule,
    ) -> Solved {
        if self.media.conducts() {
            return self.flowing(driven, wave, unknown, rule);
        }
        let mut anderson = Anderson::new(WINDOW);
        let (mut products, mut steps, mut least) = (0, 0, f64::INFINITY);
        let mut here = self.look(wave, unknown);
        let mut sheets = self.media.sheets(&here);
        loop {
            let right = self.media.right(&here, &sheets);
            let mut next = unknown.to_vec();
            let right = right.as_flattened();
            let solved = self.stage.solve(driven, wave, right, &mut next, rule);
            (products, steps) = (products + solved.products, steps + 1);
            let then = self.look(wave, &next);
            let step = self.step(&here, &then, &sheets);
            let (moved, entry) = step.most;
            let found = moved <= STILL * step.flux;
            let broken = !moved.is_finite() || matches!(solved.ending, Ending::BrokenDown(_));
            if found || broken || steps == MOST {
                unknown.copy_from_slice(&next);
                let point = self.media.place(entry);
                self.settled.count(steps, moved, point, found);
                return Solved { products, ..solved };
            }
            let change = step.change.as_flattened();
            let left = change.iter().map(|c| c * c).sum::<f64>().sqrt();
            if left > GROWN * least {
                anderson.clear();
                least = left;
            }
            least = least.min(left);
            next.extend_from_slice(step.sheets.as_flattened().as_flattened());
            anderson.next(&mut next, change);
            let (a, rest) = next.split_at(unknown.len());
            unknown.copy_from_slice(a);
            let kept = sheets.as_flattened_mut().as_flattened_mut();
            kept.copy_from_slice(rest);
            here = self.look(wave, unknown);
        }
    }
}
