//! Bodies of liquid, what hangs together, and the axes along which something holds them.
//!
//! The gradient by differences is no sum of pair forces. Along an axis on which nothing holds a body the mean of grad p, but
//! for what presses on the surface, is taken from each particle; any field of forces whose sum is zero is one of pair
//! forces between neighbours, so that action and reaction hold. Solids and walls that the liquid sticks to hold it along
//! all axes, a mirror along its own, and take up the sum there: half a body beside a mirror moves as the whole.

use shapes::frame::along;

use crate::faces::Turn;
use crate::near::{Near, Role};

/// The bodies, and what holds them.
#[derive(Debug, Clone, Default)]
pub(super) struct Islands {
    /// Taken into a body, `[m]` in the order of [`Near`].
    seen: Vec<bool>,
    /// Axes along which the body of a particle is held, `[m]` in the order of [`Near`].
    held: Vec<[bool; 3]>,
    /// Particles of one body after the other, in the order in which they were found.
    members: Vec<u32>,
    /// Where each of these begins in `members`.
    begins: Vec<usize>,
}

impl Islands {
    /// Finds them.
    pub(super) fn find(&mut self, near: &Near) {
        self.seen.clear();
        self.seen.resize(near.len(), false);
        self.held.clear();
        self.held.resize(near.len(), [false; 3]);
        self.members.clear();
        self.begins.clear();
        for a in 0..near.len() {
            if near.role[a] == Role::Liquid && !self.seen[a] {
                let begin = self.members.len();
                self.begins.push(begin);
                self.take(near, a);
                let held = self.spread(near, begin);
                for b in &self.members[begin..] {
                    self.held[*b as usize] = held;
                }
            }
        }
    }

    /// Whether nothing holds the body of the particle `a`.
    pub(super) fn free(&self, a: usize) -> bool {
        self.held[a] == [false; 3]
    }

    /// The part of `vector` along the axes on which the body of the particle `a` is held.
    pub(super) fn borne(&self, a: usize, vector: [f64; 3]) -> [f64; 3] {
        let held = self.held[a];
        std::array::from_fn(|k| if held[k] { vector[k] } else { 0.0 })
    }

    /// Takes from the particles of every body, along the axes on which nothing holds it, what the mean of `slope` by the `weight` of
    /// each has over that of `upon`.
    pub(super) fn balance(
        &self,
        slope: &mut [[f64; 3]],
        weight: impl Fn(usize) -> f64,
        upon: impl Fn(usize) -> [f64; 3],
    ) {
        let ends = self.begins.iter().skip(1).copied();
        let ends = ends.chain([self.members.len()]);
        for (&begin, end) in self.begins.iter().zip(ends) {
            let body = &self.members[begin..end];
            let held = self.held[body[0] as usize];
            if held == [true; 3] {
                continue;
            }
            let (mut sum, mut all) = ([0.0; 3], 0.0);
            for b in body.iter().map(|b| *b as usize) {
                let part = weight(b);
                sum = along(along(sum, part, slope[b]), -part, upon(b));
                all += part;
            }
            for (sum, held) in sum.iter_mut().zip(held) {
                if held {
                    *sum = 0.0;
                }
            }
            let part = -1.0 / all;
            for b in body {
                slope[*b as usize] = along(slope[*b as usize], part, sum);
            }
        }
    }

    /// Takes `a` into the body at hand if it is liquid.
    fn take(&mut self, near: &Near, a: usize) {
        if near.role[a] == Role::Liquid && !self.seen[a] {
            self.seen[a] = true;
            self.members.push(a as u32);
        }
    }

    /// Takes in all that hangs together with the members from `next` on; the axes on which it is held.
    fn spread(&mut self, near: &Near, mut next: usize) -> [bool; 3] {
        let mut held = [false; 3];
        while let Some(a) = self.members.get(next).copied() {
            for &b in near.lists.row(a as usize) {
                let b = b as usize;
                match near.role[b] {
                    Role::Liquid => self.take(near, b),
                    Role::Wet => held = [true; 3],
                    Role::Backing | Role::Image => {
                        let by = near.images().turn(b).map_or([false; 3], Turn::holds);
                        held = std::array::from_fn(|k| held[k] || by[k]);
                        self.take(near, near.images().original(b));
                    }
                }
            }
            next += 1;
        }
        held
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        self.seen.capacity()
            + 3 * self.held.capacity()
            + 4 * self.members.capacity()
            + 8 * self.begins.capacity()
    }
}
