//! Sums over the pairs of each grain.

use rayon::prelude::*;

use super::lists::{AT_ONCE, Lists, ROWS};

impl Lists {
    /// Sums `link(chunk, place)` times `weight(a, b)` over the pairs of each grain a of the chunks that `get` something, in the
    /// order of the list.
    pub(super) fn sum(
        &self,
        get: &[bool],
        sums: &mut [f64],
        link: impl Fn(usize, usize) -> f64 + Sync,
        weight: impl Fn(usize, usize) -> f64 + Sync,
    ) {
        let chunks = sums.par_chunks_mut(ROWS).zip(&self.chunks).enumerate();
        let chunks = chunks.with_max_len(AT_ONCE);
        chunks.for_each(|(c, (sums, chunk))| {
            let first = c * ROWS;
            sums.fill(0.0);
            if !get[c] {
                return;
            }
            for (place, pair) in chunk.pairs.iter().enumerate() {
                let (own, b, h) = (pair.own as usize, pair.other as usize, link(c, place));
                if h > 0.0 {
                    sums[own] += h * weight(first + own, b);
                    if place < chunk.inner {
                        sums[b - first] += h * weight(b, first + own);
                    }
                }
            }
            for incoming in &chunk.incoming {
                let from = &self.chunks[incoming.chunk as usize];
                let place = from.place(*incoming);
                let h = link(incoming.chunk as usize, place);
                if h > 0.0 {
                    let row = incoming.row as usize;
                    let b = incoming.chunk as usize * ROWS + from.pairs[place].own as usize;
                    sums[row] += h * weight(first + row, b);
                }
            }
        });
    }
}
