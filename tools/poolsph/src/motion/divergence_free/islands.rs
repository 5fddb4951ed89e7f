//! Bodies of liquid that touch no solid and no face that mirrors: what their particles do to each other adds up to
//! nothing.
//!
//! The gradient by differences is no sum of pair forces. In what hangs together without a wall the mean of grad p, but
//! for what presses on the surface, is taken from each particle; any field of forces whose sum is zero is one of pair
//! forces between neighbours, so that action and reaction hold. Liquid that touches a wall leaves its sum there.

use crate::faces::Turn;
use crate::near::{Near, Role};
use crate::vector::plus;

/// Scratch, `[m]` in the order of [`Near`].
#[derive(Debug, Clone, Default)]
pub(super) struct Islands {
    seen: Vec<bool>,
    /// Particles of the body at hand, in the order in which they were found.
    body: Vec<u32>,
}

impl Islands {
    /// Takes from the particles of every island what the mean of `slope` has over that of `upon`.
    pub(super) fn balance(
        &mut self,
        near: &Near,
        slope: &mut [[f64; 3]],
        upon: impl Fn(usize) -> [f64; 3],
    ) {
        self.seen.clear();
        self.seen.resize(near.len(), false);
        self.body.clear();
        let turned = |b: &u32| near.images().turn(*b as usize).is_some_and(Turn::is_turned);
        for a in 0..near.len() {
            if near.role[a] == Role::Wet {
                self.reach(near, a);
            } else if !near.images().is_empty() && near.lists.row(a).iter().any(turned) {
                self.take(near, a);
            }
        }
        self.spread(near);
        for a in 0..near.len() {
            if near.role[a] == Role::Liquid && !self.seen[a] {
                self.body.clear();
                self.take(near, a);
                self.spread(near);
                let sum = self.body.iter().fold([0.0; 3], |sum, b| {
                    let b = *b as usize;
                    plus(plus(sum, 1.0, slope[b]), -1.0, upon(b))
                });
                let part = -1.0 / self.body.len() as f64;
                for b in &self.body {
                    slope[*b as usize] = plus(slope[*b as usize], part, sum);
                }
            }
        }
    }

    /// Takes the liquid neighbours of `a` into the body.
    fn reach(&mut self, near: &Near, a: usize) {
        for &b in near.lists.row(a) {
            self.take(near, near.images().original(b as usize));
        }
    }

    /// Takes `a` into the body if it is liquid.
    fn take(&mut self, near: &Near, a: usize) {
        if near.role[a] == Role::Liquid && !self.seen[a] {
            self.seen[a] = true;
            self.body.push(a as u32);
        }
    }

    /// Takes in all that hangs together with the body.
    fn spread(&mut self, near: &Near) {
        let mut next = 0;
        while let Some(a) = self.body.get(next).copied() {
            self.reach(near, a as usize);
            next += 1;
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        self.seen.capacity() + 4 * self.body.capacity()
    }
}
