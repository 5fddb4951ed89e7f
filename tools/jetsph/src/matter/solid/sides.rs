//! Links are seen from both sides: a particle feels its own cell, and all cells that count it.

use super::fit::Fitted;
use super::quadratic::scale;

/// Neighbours in order, with their weights in metres.
pub(super) fn in_order<const T: usize>(fitted: &Fitted<T>, cell: [f64; 3]) -> Fitted<T> {
    let (others, weights) = fitted;
    let scale = scale::<T>(cell);
    let mut all: Vec<(u32, [f64; T])> = others
        .iter()
        .zip(weights)
        .map(|(b, w)| (*b, std::array::from_fn(|m| scale[m] * w[m])))
        .collect();
    all.sort_by_key(|(b, _)| *b);
    all.into_iter().unzip()
}

/// Weight of neighbour `b` among neighbours in order; 0 where it is none of them.
pub(super) fn of_pair<const T: usize>(others: &[u32], weights: &[[f64; T]], b: u32) -> [f64; T] {
    let at = others.binary_search(&b);
    at.map_or([0.0; T], |at| weights[at])
}

/// Neighbours of a particle that count from either side.
#[derive(Default)]
pub(super) struct Seen<const T: usize> {
    pub(super) other: Vec<u32>,
    pub(super) weight: Vec<[f64; T]>,
    pub(super) back: Vec<[f64; T]>,
}

/// Of those that are near a particle all that count from either side.
pub(super) fn seen<const T: usize>(
    a: usize,
    mut near: Vec<u32>,
    particles: usize,
    weight: &impl Fn(usize, u32) -> [f64; T],
) -> Seen<T> {
    near.sort_unstable();
    near.dedup();
    let mut seen = Seen::default();
    for b in near {
        let own = weight(a, b);
        let back = if (b as usize) < particles {
            weight(b as usize, a as u32)
        } else {
            [0.0; T]
        };
        if own.iter().chain(&back).any(|w| *w != 0.0) {
            seen.other.push(b);
            seen.weight.push(own);
            seen.back.push(back);
        }
    }
    seen
}
