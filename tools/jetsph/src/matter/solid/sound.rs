//! The fastest motion of a solid at rest, which bounds the step.

use particles::sweep;
use shapes::jitter::signed;

use super::elastic::Elastic;

/// Rounds in which the fastest motion is sought.
const ROUNDS: usize = 40;
/// The greatest frequency is found from below; it may be higher by this part.
const BEYOND: f64 = 1.03;

/// Greatest angular frequency \[rad/s\] of small motions about rest, by power iteration: `accelerate` gives the
/// accelerations of displacements from rest \[m\], `step` is a small length \[m\].
fn fastest(
    n: usize,
    step: f64,
    dimensions: usize,
    mut accelerate: impl FnMut(&[[f64; 3]]) -> Vec<[f64; 3]>,
) -> f64 {
    let part = |number: usize| {
        if number % 3 < dimensions {
            signed(0, number as u64)
        } else {
            0.0
        }
    };
    let mut motion: Vec<[f64; 3]> = (0..n)
        .map(|a| [0, 1, 2].map(|k| step * part(3 * a + k)))
        .collect();
    let length = |x: &[[f64; 3]]| {
        let square = |a: usize| [x[a][0] * x[a][0] + x[a][1] * x[a][1] + x[a][2] * x[a][2]];
        sweep::sum(x.len(), square)[0].sqrt()
    };
    let whole = length(&motion);
    let mut square = 0.0;
    for _ in 0..ROUNDS {
        // The odd part alone: what does not change sign with the motion is no part of a small one.
        let there = accelerate(&motion);
        let back: Vec<[f64; 3]> = motion.iter().map(|u| u.map(|x| -x)).collect();
        let back = accelerate(&back);
        for (u, (a, b)) in motion.iter_mut().zip(there.iter().zip(&back)) {
            *u = [0, 1, 2].map(|k| -0.5 * (a[k] - b[k]));
        }
        let grown = length(&motion);
        if grown <= 0.0 {
            return 0.0;
        }
        square = grown / whole;
        motion
            .iter_mut()
            .flatten()
            .for_each(|x| *x *= whole / grown);
    }
    BEYOND * square.sqrt()
}

impl<const L: usize, const T: usize> Elastic<L, T> {
    /// Greatest angular frequency of the body at rest, without loads \[rad/s\].
    pub(super) fn fastest_at_rest(&mut self, rest: &[[f64; 3]], mass: &[f64]) -> f64 {
        let (anchors, loads) = (
            self.body.anchor_rest.clone(),
            std::mem::take(&mut self.body.loads),
        );
        let step = 1e-6 * self.body.size[0];
        let dimensions = if T == 5 { 2 } else { 3 };
        let mut acceleration = vec![[0.0; 3]; rest.len()];
        let found = fastest(rest.len(), step, dimensions, |motion| {
            let moved = rest.iter().zip(motion);
            let moved = moved.map(|(x, u)| std::array::from_fn(|k| x[k] + u[k]));
            let all: Vec<[f64; 3]> = moved.chain(anchors.iter().copied()).collect();
            self.place(&all);
            self.answer(0.0);
            acceleration.fill([0.0; 3]);
            self.accelerate(&mut acceleration, mass);
            acceleration.clone()
        });
        self.body.loads = loads;
        found
    }
}
