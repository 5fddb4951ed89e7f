//! What a solid body is made of, and what holds and loads it.

use particles::sweep;

use super::bound::{Anchor, Load};
use super::cell::{Cell, Derivatives};
use crate::matter::shares::Shares;

/// A solid body and what holds and loads it.
#[derive(Debug, Clone)]
pub struct Body {
    /// Number of its set.
    pub set: usize,
    /// Its cells.
    pub cell: Cell,
    /// Size of a cell \[m\].
    pub size: [f64; 3],
    /// What each cell has of the body; nothing where all are whole.
    pub shares: Shares,
    /// Places of the anchors at rest, along the axes of the lattice \[m\].
    pub anchor_rest: Vec<[f64; 3]>,
    /// Anchors.
    pub anchors: Vec<Anchor>,
    /// Loads.
    pub loads: Vec<Load>,
    /// Rate at which velocities die away \[1/s\]; 0 where nothing damps them.
    pub damping: f64,
}

impl Body {
    /// What cell `a` has of a whole one.
    #[inline]
    #[must_use]
    pub fn share(&self, a: usize) -> f64 {
        self.shares.part.get(a).copied().unwrap_or(1.0)
    }

    /// Takes of the slopes of the energies of whole cells what the body has of each.
    pub(super) fn part<const L: usize, const T: usize>(&self, answers: &mut [Derivatives<L, T>]) {
        if !self.shares.part.is_empty() {
            sweep::change(answers, |a, answer| {
                let all = answer.iter_mut().flatten();
                all.for_each(|x| *x *= self.shares.part[a]);
            });
        }
    }
}
