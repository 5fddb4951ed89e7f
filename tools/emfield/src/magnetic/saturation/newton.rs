//! Fields of a stage with media in which currents flow and permeability depends on the field, by Newton's method.
//!
//! With L the rows of one reluctivity, factorised, b what drives them and R what the media put on their right, P on faces from B at
//! once, the field obeys
//!
//! ```text
//! a = inv(L) (b + R(a)),    (1 - inv(L) R'(a)) d = inv(L) (b + R(a)) - a,    a <- a + s d.
//! ```
//!
//! The linear equations are solved by GMRES, with `R'(a) v` from a difference of R along v, so that no rows of tangents are made
//! (Knoll and Keyes 2004, J. Comput. Phys. 193, 357, section 2). The step s is halved until the flux density changes less
//! from a to `inv(L) (b + R(a))` than before.

use std::sync::Mutex;

use krylov::{Identity, Operator, Rule, Scratch, Solved, gmres};

use crate::magnetic::saturation::equations::{Saturation, Seen};
use crate::march::scheme::Stage;

/// Change of the flux density in a step, over the largest, at which the field is found.
pub(crate) const STILL: f64 = 1e-8;
/// Most steps.
const MOST: usize = 40;
/// Most halvings of a step, and part of what a step promises that it must keep.
const HALVINGS: (i32, f64) = (10, 1e-4);
/// Columns of GMRES, and its reduction.
const LINEAR: (usize, f64) = (120, 1e-3);
/// Change of the flux density along which R is differentiated, over the largest.
const SHIFT: f64 = 1e-6;

/// The largest length of vectors, and where; no number where one is none.
pub(crate) fn largest(vectors: &[[f64; 3]]) -> (f64, usize) {
    // What is no number may have either sign, and is the largest by that of its size.
    let square = |k: usize| vectors[k].iter().map(|v| v * v).sum::<f64>().abs();
    let worst = (0..vectors.len()).max_by(|a, b| square(*a).total_cmp(&square(*b)));
    worst.map_or((0.0, 0), |k| (square(k).sqrt(), k))
}

/// A stage, its media and what drives them.
pub(crate) struct Newton<'a, 'b, const D: usize> {
    pub(crate) stage: &'a mut (dyn Stage + 'b),
    pub(crate) media: &'a Saturation<'b, D>,
    pub(crate) driven: &'a [f64],
    pub(crate) wave: f64,
    pub(crate) rule: Rule<'a>,
    /// Solves and products so far.
    pub(crate) taken: (u64, usize),
}

/// A field, and where it leads.
struct Place {
    unknown: Vec<f64>,
    /// What media put on the right.
    right: Vec<f64>,
    /// To the field that this leads to.
    way: Vec<f64>,
    /// The largest change of the flux density on that way \[T\], and its entry.
    most: (f64, usize),
    /// The root of the sum of their squares \[T\].
    change: f64,
    /// The largest flux density \[T\].
    flux: f64,
    /// How the solve on that way ended.
    solved: Solved,
}

/// How a solve ended.
pub(crate) struct Ended {
    pub(crate) unknown: Vec<f64>,
    /// The largest change of the flux density \[T\], and its entry.
    pub(crate) most: (f64, usize),
    pub(crate) found: bool,
    /// The last solve with L, and the products of all.
    pub(crate) solved: Solved,
}

/// `1 - inv(L) R'(a)`.
struct Tangent<'n, 'a, 'b, const D: usize, const K: usize> {
    newton: Mutex<&'n mut Newton<'a, 'b, D>>,
    at: &'n Place,
}

impl<const D: usize, const K: usize> Operator<f64> for Tangent<'_, '_, '_, D, K> {
    fn len(&self) -> usize {
        self.at.unknown.len()
    }

    fn apply(&self, x: &[[f64; 1]], out: &mut [[f64; 1]]) {
        let (x, out) = (x.as_flattened(), out.as_flattened_mut());
        out.copy_from_slice(x);
        let Ok(mut newton) = self.newton.lock() else {
            return;
        };
        let flux = newton
            .media
            .look::<K>(x.as_chunks::<K>().0, 0.0, &[])
            .largest();
        if flux == 0.0 {
            return;
        }
        let step = SHIFT * self.at.flux.max(f64::MIN_POSITIVE) / flux;
        let shifted = self.at.unknown.iter().zip(x).map(|(a, x)| a + step * x);
        let (_, right) = newton.right::<K>(&shifted.collect::<Vec<f64>>());
        let both = right.iter().zip(&self.at.right);
        let turned: Vec<f64> = both.map(|(then, now)| (then - now) / step).collect();
        let (none, mut led) = (vec![0.0; x.len()], vec![0.0; x.len()]);
        let rule = newton.rule;
        let solved = newton.stage.solve(&none, 0.0, &turned, &mut led, rule);
        newton.count(solved.products);
        out.iter_mut().zip(led).for_each(|(out, led)| *out -= led);
    }
}

impl<const K: usize> Seen<K> {
    /// The largest flux density \[T\].
    pub(crate) fn largest(&self) -> f64 {
        let on = largest(self.on.as_flattened()).0;
        largest(&self.inside).0.max(on)
    }
}

impl<const D: usize> Newton<'_, '_, D> {
    fn count(&mut self, products: usize) {
        self.taken = (self.taken.0 + 1, self.taken.1 + products);
    }

    fn look<const K: usize>(&self, unknown: &[f64]) -> Seen<K> {
        let moved = self.stage.moved(self.driven, unknown);
        let (unknown, moved) = (unknown.as_chunks::<K>().0, moved.as_chunks::<K>().0);
        self.media.look(unknown, self.wave, moved)
    }

    /// A field as the media see it, and what they put on the right.
    fn right<const K: usize>(&self, unknown: &[f64]) -> (Seen<K>, Vec<f64>) {
        let seen = self.look(unknown);
        let right = self.media.right(&seen, &self.media.sheets(&seen));
        (seen, right.into_flattened())
    }

    fn place<const K: usize>(&mut self, unknown: Vec<f64>) -> Place {
        let (seen, right) = self.right::<K>(&unknown);
        let mut next = unknown.clone();
        let solved = self
            .stage
            .solve(self.driven, self.wave, &right, &mut next, self.rule);
        self.count(solved.products);
        let then = self.look::<K>(&next);
        let inside = then.inside.iter().zip(&seen.inside);
        let on = then.on.as_flattened().iter().zip(seen.on.as_flattened());
        let change = inside.chain(on);
        let change: Vec<[f64; 3]> = change
            .map(|(a, b)| std::array::from_fn(|k| a[k] - b[k]))
            .collect();
        let squares = change.as_flattened().iter().map(|c| c * c);
        Place {
            way: next.iter().zip(&unknown).map(|(n, a)| n - a).collect(),
            most: largest(&change),
            change: squares.sum::<f64>().sqrt(),
            flux: seen.largest(),
            unknown,
            right,
            solved,
        }
    }

    /// Solves from a first guess.
    pub(crate) fn solve<const K: usize>(&mut self, guess: Vec<f64>) -> Ended {
        let mut here = self.place::<K>(guess);
        let mut scratch = Scratch::default();
        for _ in 0..MOST {
            if here.most.0 <= STILL * here.flux || !here.change.is_finite() {
                break;
            }
            match self.step::<K>(&here, &mut scratch) {
                Some(next) => here = next,
                None => break,
            }
        }
        Ended {
            found: here.most.0 <= STILL * here.flux,
            most: here.most,
            unknown: here.unknown,
            solved: Solved {
                products: self.taken.1,
                ..here.solved
            },
        }
    }

    /// The next place; none where no step leads on.
    fn step<const K: usize>(&mut self, here: &Place, scratch: &mut Scratch<f64>) -> Option<Place> {
        let mut way = vec![0.0; here.unknown.len()];
        // Two cycles, each with a residual.
        let rule = Rule::to(LINEAR.1, 2 * (LINEAR.0 + 1));
        let tangent = Tangent::<D, K> {
            newton: Mutex::new(&mut *self),
            at: here,
        };
        gmres(
            &tangent,
            &here.way,
            &mut way,
            &mut Identity, // the stage has been applied already
            rule.restarted(LINEAR.0),
            scratch,
        )
        .sound()
        .ok()?;
        (0..=HALVINGS.0).find_map(|halvings| {
            let share = 0.5_f64.powi(halvings);
            let next = here.unknown.iter().zip(&way).map(|(a, d)| a + share * d);
            let next = self.place::<K>(next.collect());
            (next.change < (1.0 - HALVINGS.1 * share) * here.change).then_some(next)
        })
    }
}
