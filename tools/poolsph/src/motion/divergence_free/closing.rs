//! How fast neighbours close in on one another, or part.
//!
//! A particle that strikes others at the speed u runs into them by u dt before their pressure answers, and what lies
//! too close is pushed out too far: drops of three particles across threw off single ones at three times their speed where
//! they went 0.3 d in a step. What flies as a whole has no such limit, nor has a pool that a wall carries along.

use shapes::frame::{difference, squared};

use crate::near::{Near, Role};

/// Way of neighbours against one another in a step, in spacings.
const LONGEST: f64 = 0.1;

/// The speed of neighbours against one another, with its scratch.
#[derive(Debug, Clone, Default)]
pub struct Closing {
    /// Greatest square of it, `[m]` \[m2/s2\].
    squares: Vec<f64>,
}

impl Closing {
    /// Longest step \[s\] for the velocities in `near`, of particles `d` apart; infinite where all move as one.
    pub fn limit(&mut self, near: &Near, d: f64) -> f64 {
        self.squares.resize(near.len(), 0.0);
        near.each_row(&mut self.squares, |a, row, most| {
            *most = 0.0;
            if near.role[a] == Role::Liquid {
                let u = near.velocity[a];
                let others = row.index.iter().map(|b| near.velocity[*b as usize]);
                *most = others.fold(0.0, |most, other| squared(difference(other, u)).max(most));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::tests::{METAL, block};
    use crate::state::phase;

    #[test]
    fn what_flies_as_a_whole_has_no_limit_and_layers_that_slide_have_that_of_their_difference() {
        let limit = |velocity: fn([f64; 3]) -> [f64; 3]| {
            let mut state = block([4, 4, 6], |_| phase::LIQUID, velocity);
            state.gather();
            Closing::default().limit(&state.near, METAL.spacing)
        };
        assert!(limit(|_| [3.0, 1.0, -20.0]).is_infinite());
        let slid = limit(|[_, _, z]| {
            [
                5.0 + f64::from(u8::from(z > 3.0 * METAL.spacing)) * 2.0,
                0.0,
                0.0,
            ]
        });
        let told = LONGEST * METAL.spacing / 2.0;
        assert!((slid / told - 1.0).abs() < 1e-12, "{slid} {told}");
    }
}
