//! Undirected links: what both ends share is reckoned once.

use std::ops::Range;

use krylov::Pattern;
use rayon::prelude::*;

/// Links that one task evaluates.
const EDGES: usize = 1024;

/// Undirected links, in the order of their lower ends.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Edges {
    /// Number of each directed link among the undirected ones.
    number: Vec<u32>,
    /// The lower and the higher end.
    ends: Vec<[u32; 2]>,
}

impl Edges {
    /// Those of a symmetric pattern; `add` is called with the ends of each in turn.
    ///
    /// # Errors
    /// Those of `add`.
    pub(super) fn new<E>(
        pattern: &Pattern,
        mut add: impl FnMut(usize, usize) -> Result<(), E>,
    ) -> Result<Self, E> {
        let mut number = vec![0; pattern.columns().len()];
        let mut ends = Vec::with_capacity(number.len() / 2);
        for i in 0..pattern.rows() {
            for k in pattern.row(i) {
                let j = pattern.columns()[k] as usize;
                if i < j {
                    number[k] = ends.len() as u32;
                    ends.push([i as u32, j as u32]);
                    add(i, j)?;
                } else {
                    // The other end came first.
                    let mut row = pattern.row(j);
                    let other = row.find(|m| pattern.columns()[*m] as usize == i);
                    number[k] = other.map_or(0, |m| number[m]);
                }
            }
        }
        Ok(Self { number, ends })
    }

    /// Number of undirected links.
    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    /// Numbers of the undirected links of a row.
    #[inline]
    pub(super) fn of(&self, row: Range<usize>) -> &[u32] {
        &self.number[row]
    }

    /// Sets one value for each undirected link, of its number and its ends.
    pub(super) fn each<T: Clone + Default + Send>(
        &self,
        values: &mut Vec<T>,
        value: impl Fn(usize, [u32; 2]) -> T + Sync,
    ) {
        values.resize(self.len(), T::default());
        values
            .par_iter_mut()
            .zip(&self.ends)
            .enumerate()
            .with_min_len(EDGES)
            .for_each(|(edge, (out, ends))| *out = value(edge, *ends));
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> u64 {
        (4 * self.number.len() + 8 * self.ends.len()) as u64
    }
}
