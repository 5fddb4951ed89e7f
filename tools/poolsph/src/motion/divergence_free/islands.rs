//! Bodies of liquid that touch no solid and no face that mirrors: what their particles do to each other adds up to
//! nothing.
//!
//! The gradient by differences is no sum of pair forces. In what hangs together without a wall the mean of grad p, but
//! for what presses on the surface, is taken from each particle; any field of forces whose sum is zero is one of pair
//! forces between neighbours, so that action and reaction hold. Liquid that touches a wall leaves its sum there.

use crate::faces::Turn;
use crate::near::{Near, Role};
use crate::vector::plus;

/// Which liquid touches a wall, and the bodies that touch none.
#[derive(Debug, Clone, Default)]
pub(super) struct Islands {
    /// Taken into a body, `[m]` in the order of [`Near`].
    seen: Vec<bool>,
    /// What touches a wall, `[m]` in the order of [`Near`].
    stands: Vec<bool>,
    /// Particles of what touches a wall, and of one body after the other, in the order in which they were found.
    members: Vec<u32>,
    /// Where each of these begins in `members`.
    begins: Vec<usize>,
}

impl Islands {
    /// Finds them.
    pub(super) fn find(&mut self, near: &Near) {
        self.seen.clear();
        self.seen.resize(near.len(), false);
        self.members.clear();
        self.begins.clear();
        let turned = |b: &u32| near.images().turn(*b as usize).is_some_and(Turn::is_turned);
        for a in 0..near.len() {
            if near.role[a] == Role::Wet {
                self.reach(near, a);
            } else if !near.images().is_empty() && near.lists.row(a).iter().any(turned) {
                self.take(near, a);
            }
        }
        self.spread(near, 0);
        self.stands.clone_from(&self.seen);
        for a in 0..near.len() {
            if near.role[a] == Role::Liquid && !self.seen[a] {
                let begin = self.members.len();
                self.begins.push(begin);
                self.take(near, a);
                self.spread(near, begin);
            }
        }
    }

    /// Whether the liquid particle `a` belongs to a body that touches no wall.
    pub(super) fn hold(&self, a: usize) -> bool {
        !self.stands[a]
    }

    /// Takes from the particles of every island what the mean of `slope` has over that of `upon`.
    pub(super) fn balance(&self, slope: &mut [[f64; 3]], upon: impl Fn(usize) -> [f64; 3]) {
        let ends = self.begins.iter().skip(1).copied();
        let ends = ends.chain([self.members.len()]);
        for (&begin, end) in self.begins.iter().zip(ends) {
            let body = &self.members[begin..end];
            let sum = body.iter().fold([0.0; 3], |sum, b| {
                let b = *b as usize;
                plus(plus(sum, 1.0, slope[b]), -1.0, upon(b))
            });
            let part = -1.0 / body.len() as f64;
            for b in body {
                slope[*b as usize] = plus(slope[*b as usize], part, sum);
            }
        }
    }

    /// Takes the liquid neighbours of `a` into the body at hand.
    fn reach(&mut self, near: &Near, a: usize) {
        for &b in near.lists.row(a) {
            self.take(near, near.images().original(b as usize));
        }
    }

    /// Takes `a` into the body at hand if it is liquid.
    fn take(&mut self, near: &Near, a: usize) {
        if near.role[a] == Role::Liquid && !self.seen[a] {
            self.seen[a] = true;
            self.members.push(a as u32);
        }
    }

    /// Takes in all that hangs together with the members from `next` on.
    fn spread(&mut self, near: &Near, mut next: usize) {
        while let Some(a) = self.members.get(next).copied() {
            self.reach(near, a as usize);
            next += 1;
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        self.seen.capacity()
            + self.stands.capacity()
            + 4 * self.members.capacity()
            + 8 * self.begins.capacity()
    }
}
