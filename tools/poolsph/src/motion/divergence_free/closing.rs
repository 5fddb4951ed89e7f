//! How fast neighbours move against one another.
//!
//! A particle that strikes others at the speed u runs into them by u dt before their pressure answers, and what lies
//! too close is pushed out too far: drops of three particles across threw off single ones at three times their speed where
//! they went 0.3 d in a step. What flies as a whole has no such limit, nor has a pool that a wall carries along.

use crate::near::{Near, Role};
use crate::vector::{minus, squared};

/// Way of neighbours against one another in a step, in spacings.
const LONGEST: f64 = 0.1;

/// The speed of neighbours against one another with its scratch.
#[derive(Debug, Clone, Default)]
pub struct Meeting {
    /// Greatest square of it, `[m]` \[m2/s2\].
    squares: Vec<f64>,
}

impl Meeting {
    /// Longest step \[s\] for the velocities in `near`, of particles `d` apart; infinite where all move as one.
    pub fn limit(&mut self, near: &Near, d: f64) -> f64 {
        self.squares.resize(near.len(), 0.0);
        near.each_row(&mut self.squares, |a, row, most| {
            *most = 0.0;
            if near.role[a] == Role::Liquid {
                let u = near.velocity[a];
                let others = row.index.iter().map(|b| near.velocity[*b as usize]);
                *most = others.fold(0.0, |most, other| squared(minus(other, u)).max(most));
            }
        });
        let most = self.squares.iter().fold(0.0, |most: f64, x| most.max(*x));
        LONGEST * d / most.sqrt()
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        8 * self.squares.capacity()
    }
}
