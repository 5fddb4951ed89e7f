//! How fast neighbours close in on one another.
//!
//! A particle that strikes others at the speed u runs into them by u dt before their pressure answers, and what lies
//! too close is pushed out too far: drops of three particles across threw off single ones at three times their speed where
//! they went 0.3 d in a step. So no pair comes nearer in a step than by a tenth of its distance, or of the spacing where it is closer:
//!
//! ```text
//! dt max_ab -(u_ab . x_ab) / (r max(r, d)) <= 0.1
//! ```
//!
//! What slides past another, or parts from it, has no such limit: layers that are sheared come nearer by half of the rate, and what
//! goes along a wall by half of its speed over d. Nor has what flies as a whole, or a pool that a wall carries along.

use shapes::frame::{difference, dot, squared};

use crate::near::{Near, Role};

/// Part of their distance by which neighbours may come nearer in a step.
const LONGEST: f64 = 0.1;

/// The rate at which neighbours come nearer, with its scratch.
#[derive(Debug, Clone, Default)]
pub struct Closing {
    /// Greatest of a particle, in parts of the distance, `[m]` \[1/s\].
    rates: Vec<f64>,
}

impl Closing {
    /// Longest step \[s\] for the velocities in `near`, of particles `d` apart; infinite where none come nearer.
    pub fn limit(&mut self, near: &Near, d: f64) -> f64 {
        self.rates.resize(near.len(), 0.0);
        near.each_row(
            &mut self.rates,
            #[inline(always)]
            |a, row, most| {
                *most = 0.0;
                if near.role[a] == Role::Liquid {
                    let (x, u) = (near.position[a], near.velocity[a]);
                    for b in row.index.iter().map(|b| *b as usize) {
                        let way = difference(near.position[b], x);
                        let nearer = -dot(difference(near.velocity[b], u), way);
                        let square = squared(way);
                        let apart = square.max(d * square.sqrt());
                        if nearer > *most * apart {
                            *most = nearer / apart;
                        }
                    }
                }
            },
        );
        let most = self.rates.iter().fold(0.0, |most: f64, x| most.max(*x));
        LONGEST / most
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        8 * self.rates.capacity()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::tests::{METAL, block};
    use crate::state::phase;

    fn limit(velocity: fn([f64; 3]) -> [f64; 3]) -> f64 {
        let mut state = block([4, 4, 6], |_| phase::LIQUID, velocity);
        state.gather();
        Closing::default().limit(&state.near, METAL.spacing)
    }

    #[test]
    fn what_flies_as_a_whole_or_parts_has_no_limit() {
        assert!(limit(|_| [3.0, 1.0, -20.0]).is_infinite());
        assert!(limit(|[x, y, z]| [x, y, z].map(|x| 5.0 * x)).is_infinite());
    }

    #[test]
    fn layers_that_strike_have_that_of_their_speed_and_layers_that_slide_twice_as_much() {
        // Neighbours straight ahead, d apart; neighbours ahead in the layer below, sqrt(2) d apart at 45 degrees.
        let told = LONGEST * METAL.spacing / 2.0;
        let struck = limit(|[_, _, z]| {
            let upper = f64::from(u8::from(z > 3.0 * METAL.spacing));
            [5.0, 0.0, -2.0 * upper]
        });
        assert!((struck / told - 1.0).abs() < 1e-12, "{struck} {told}");
        let slid = limit(|[_, _, z]| {
            let upper = f64::from(u8::from(z > 3.0 * METAL.spacing));
            [5.0 + 2.0 * upper, 0.0, 0.0]
        });
        assert!((slid / (2.0 * told) - 1.0).abs() < 1e-12, "{slid} {told}");
    }
}
