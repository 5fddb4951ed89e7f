//! Balls by which different bodies touch: each is inside its body and touches the surface.
//!
//! ```text
//! s_a = depth of the particle below the surface at rest,   w_a = 2 s_a d/D^2 where s_a < D, else 0,   D = 3 d at most
//! delta = s_a + s_b - r,   k_ab = w_a w_b k
//! ```
//!
//! Balls of one size at the particles make a surface of bumps and steps that bodies on turned lattices catch in. These
//! touch the surface itself, and the wider they are the more they count. Those of a lattice along its face begin to push
//! where the faces meet, and the weights of a row of them across the surface add up to one.

use neighbours::Grid;
use particles::Rows;

/// Depth from which on particles take no part, in spacings.
const DEPTH: f64 = 3.0;

/// A ball around a particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ball {
    /// s \[m\].
    pub(super) radius: f64,
    /// w.
    pub(super) weight: f64,
}

/// The balls of particles so deep below the surface \[m\].
pub(super) fn balls(depths: &[f64], spacing: f64) -> Vec<Ball> {
    let deepest = depths.iter().fold(0.0_f64, |most, s| most.max(*s));
    // A body of two rows has balls of half a spacing.
    let depth = (DEPTH * spacing).min(deepest + 0.5 * spacing);
    let ball = |s: &f64| Ball {
        radius: *s,
        weight: if *s < depth {
            2.0 * s * spacing / (depth * depth)
        } else {
            0.0
        },
    };
    depths.iter().map(ball).collect()
}

/// Who may touch particles of other bodies.
#[derive(Debug, Clone)]
pub(super) struct Across {
    /// Twice the greatest radius \[m\].
    reach: f64,
    grid: Grid,
    /// Particles near other bodies.
    pub(super) who: Vec<u32>,
    places: Vec<[f64; 3]>,
    /// For each of them the others, by their number among them.
    pub(super) rows: Rows,
}

impl Across {
    /// Nobody yet; balls have at most this radius \[m\].
    pub(super) fn new(radius: f64) -> Self {
        Self {
            reach: 2.0 * radius,
            grid: Grid::new(2.0 * radius),
            who: Vec::new(),
            places: Vec::new(),
            rows: Rows::new(),
        }
    }

    /// Finds who may touch; `at` gives place, body and weight of each of `n` particles.
    pub(super) fn find(
        &mut self,
        n: usize,
        bodies: usize,
        at: impl Fn(usize) -> ([f64; 3], usize, f64),
    ) {
        let mut boxes = vec![[[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]]; bodies];
        for a in 0..n {
            let (x, body, _) = at(a);
            let [low, high] = &mut boxes[body];
            for k in 0..3 {
                low[k] = low[k].min(x[k] - self.reach);
                high[k] = high[k].max(x[k] + self.reach);
            }
        }
        let near = |a: usize| {
            let (x, own, weight) = at(a);
            let others = boxes.iter().enumerate().filter(|(body, _)| *body != own);
            let mut holds =
                others.map(|(_, [low, high])| (0..3).all(|k| low[k] < x[k] && x[k] < high[k]));
            weight > 0.0 && holds.any(|holds| holds)
        };
        self.who.clear();
        self.who.extend((0..n as u32).filter(|a| near(*a as usize)));
        self.places.clear();
        self.places
            .extend(self.who.iter().map(|a| at(*a as usize).0));
        self.grid.bin(&self.places);
        self.rows.within(&self.places, &self.grid, self.reach);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_below_a_face_add_up_to_one() {
        for rows in 2..9_u32 {
            let depth = |i: u32| (f64::from(i) + 0.5).min(f64::from(rows - i) - 0.5) * 0.1;
            let depths: Vec<f64> = (0..rows).map(depth).collect();
            let near = balls(&depths, 0.1);
            let near = near.iter().take(rows.div_ceil(2) as usize);
            let sum: f64 = near.map(|ball| ball.weight).sum();
            assert!((sum - 1.0).abs() < 1e-12, "{rows}: {sum}");
        }
    }

    #[test]
    fn bodies_that_are_far_do_not_meet() {
        let mut across = Across::new(0.1);
        let at = |gap: f64| {
            move |a: usize| {
                (
                    [0.04 * a as f64 + gap * (a / 4) as f64, 0.0, 0.0],
                    a / 4,
                    1.0,
                )
            }
        };
        across.find(8, 2, at(0.3));
        assert!(across.who.is_empty() && across.rows.is_empty());
        across.find(8, 2, at(0.0));
        assert_eq!(across.who, [0, 1, 2, 3, 4, 5, 6, 7]);
    }
}
