//! What would be left around a particle if it broke.

use super::cracks::Cracks;
use super::quadratic::scale;

/// A particle whose fit changes, and what is left of it: nothing where it breaks, too.
#[derive(Debug, Clone)]
pub(super) struct Left<const T: usize> {
    pub(super) particle: usize,
    pub(super) other: Vec<u32>,
    pub(super) weight: Vec<[f64; T]>,
}

/// What is left around a particle if it breaks.
#[derive(Debug, Clone)]
pub struct Trial<const T: usize> {
    /// The particle first.
    pub(super) left: Vec<Left<T>>,
    /// What goes in all over the energy of the cell, when it was last reckoned.
    pub(super) ratio: f64,
    /// The energy of the cell then, or its least since \[J\].
    pub(super) asked: f64,
}

impl<const T: usize> Trial<T> {
    /// Of a particle, from those that are broken already.
    pub(super) fn new(cracks: &Cracks, a: usize, broken: &[bool], cell: [f64; 3]) -> Self {
        let mut all = broken.to_vec();
        all[a] = true;
        let scale = scale::<T>(cell);
        let touched = cracks.touched(&[a], &all).into_iter();
        let refit = |b: usize| {
            let row = cracks.left(b, &all);
            (row.len() != cracks.left(b, broken).len()).then(|| {
                let (weights, held) = cracks.refit::<T>(b, &row);
                let scaled = weights
                    .iter()
                    .map(|w| std::array::from_fn(|m| scale[m] * w[m]));
                Left {
                    particle: b,
                    weight: if held { scaled.collect() } else { Vec::new() },
                    other: if held { row } else { Vec::new() },
                }
            })
        };
        let own = Left {
            particle: a,
            other: Vec::new(),
            weight: Vec::new(),
        };
        let left = std::iter::once(own).chain(touched.filter_map(refit));
        Self {
            left: left.collect(),
            ratio: f64::INFINITY,
            asked: 0.0,
        }
    }
}
