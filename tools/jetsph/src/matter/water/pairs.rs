//! Pairs of water, each computed once for both of its particles.
//!
//! Particles are taken in the order of their cells, and a row lists those that come later. A block of rows adds what its pairs
//! give, to its own rows and to those behind it, in sums of its own; a particle takes what all blocks have for it, one after the
//! other. So every sum has an order that depends on places alone, whatever the threads.

use kernels::{Kernel, Number};
use neighbours::Grid;
use particles::{Rows, sweep};
use rayon::prelude::*;

use super::exchange::{Exchange, Pair, Side};
use super::near::Lists;
use super::seen::Seen;
use crate::matter::four::{Lanes, Work, on_this_machine};

/// Rows that are listed at once; a block has some of these.
const ROWS: usize = 256;
/// Most blocks.
const BLOCKS: usize = 64;
/// Pairs that are computed at once.
const LANES: usize = 4;

/// What others need to know of a particle.
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
struct Sight {
    /// x and V.
    place: [f64; 4],
    /// u and value.
    motion: [f64; 4],
}

/// Later neighbours of some rows, each filled up with itself to a whole number of fours.
#[derive(Debug, Clone, Default)]
struct Chunk {
    ends: Vec<u32>,
    index: Vec<u32>,
    /// Beyond the last of all.
    top: usize,
}

/// The sums of some rows and of what stands behind them.
#[derive(Debug, Clone, Default)]
struct Block {
    /// The first row, and beyond the last one that its pairs reach.
    first: usize,
    top: usize,
    /// The first block that reaches rows of this one.
    since: usize,
    sums: Vec<[f64; 4]>,
}

/// Pairs of a set.
#[derive(Debug, Clone, Default)]
pub(super) struct Pairs {
    /// Row of each particle, and particle of each row.
    row: Vec<u32>,
    order: Vec<u32>,
    chunks: Vec<Chunk>,
    blocks: Vec<Block>,
    /// Chunks of a block.
    length: usize,
    sights: Vec<Sight>,
    aids: Vec<[f64; 4]>,
    /// Particles beside walls, and all neighbours of each.
    beside: Vec<u32>,
    all: Rows,
}

impl Lists for Pairs {
    fn find(&mut self, listed: &[[f64; 3]], grid: &Grid, radius: f64) {
        self.order.clear();
        self.order.extend_from_slice(grid.order());
        self.row.resize(listed.len(), 0);
        for (k, a) in self.order.iter().enumerate() {
            self.row[*a as usize] = k as u32;
        }
        let chunks = listed.len().div_ceil(ROWS);
        self.chunks.resize_with(chunks, Chunk::default);
        let chunks = self.chunks.par_iter_mut().enumerate();
        chunks.for_each(|(c, chunk)| chunk.find(c * ROWS, grid, radius));
        self.part();
    }

    fn stand_beside(&mut self, beside: &[u32], listed: (&[[f64; 3]], &Grid, f64)) {
        let (listed, grid, radius) = listed;
        self.beside.clear();
        self.beside.extend_from_slice(beside);
        let places: Vec<[f64; 3]> = beside.iter().map(|a| listed[*a as usize]).collect();
        self.all.between(&places, grid, radius);
    }

    fn row(&self, a: usize) -> &[u32] {
        let place = self.beside.binary_search(&(a as u32));
        place.map_or(&[], |place| self.all.row(place))
    }

    fn bytes(&self) -> usize {
        let chunks = self.chunks.iter();
        let words: usize = chunks.map(|c| c.ends.capacity() + c.index.capacity()).sum();
        let sums: usize = self.blocks.iter().map(|b| b.sums.capacity()).sum();
        let rows = 64 * self.sights.len() + 8 * self.row.len() + 32 * self.aids.len();
        4 * words + 32 * sums + rows + self.all.bytes()
    }
}

impl Chunk {
    fn find(&mut self, first: usize, grid: &Grid, radius: f64) {
        let sorted = grid.sorted();
        self.ends.clear();
        self.index.clear();
        self.top = sorted.len().min(first + ROWS);
        for k in first..self.top {
            let own = sorted[k];
            grid.runs(own, radius, |run| {
                let first = run.start.max(k + 1).min(run.end);
                for (other, later) in sorted[first..run.end].iter().zip(first..) {
                    let dx = [0, 1, 2].map(|i: usize| own[i] - other[i]);
                    if dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2] < radius * radius {
                        self.index.push(later as u32);
                    }
                }
            });
            let filled = self.index.len().next_multiple_of(LANES);
            self.index.resize(filled, k as u32);
            self.ends.push(filled as u32);
        }
        let last = self.index.iter().max().map_or(0, |last| *last as usize + 1);
        self.top = self.top.max(last);
    }
}

impl Pairs {
    /// Makes blocks: as long as what they reach beyond themselves, so that sums are twice the rows, and not too many.
    fn part(&mut self) {
        let chunks = self.chunks.iter().enumerate();
        let reach = chunks.map(|(c, chunk)| (chunk.top - c * ROWS).saturating_sub(ROWS));
        let length = reach.max().unwrap_or(0).div_ceil(2 * ROWS);
        self.length = length.max(self.chunks.len().div_ceil(BLOCKS)).max(1);
        let blocks = self.chunks.len().div_ceil(self.length);
        self.blocks.resize_with(blocks, Block::default);
        let parts = self.chunks.chunks(self.length);
        for (b, (block, chunks)) in self.blocks.iter_mut().zip(parts).enumerate() {
            block.first = b * self.length * ROWS;
            block.top = chunks.iter().map(|chunk| chunk.top).max().unwrap_or(0);
        }
        let mut since = 0;
        for b in 0..blocks {
            while self.blocks[since].top <= self.blocks[b].first {
                since += 1;
            }
            self.blocks[b].since = since;
        }
    }

    /// Looks at all particles.
    pub(super) fn look(&mut self, seen: &[Seen]) {
        let order = &self.order;
        self.sights.resize(seen.len(), Sight::default());
        sweep::fill(&mut self.sights, |k| {
            let Seen {
                x,
                u,
                volume,
                value,
            } = seen[order[k] as usize];
            Sight {
                place: [x[0], x[1], x[2], volume],
                motion: [u[0], u[1], u[2], value],
            }
        });
    }

    /// Takes up three more numbers of each particle.
    pub(super) fn aid(&mut self, of: &[[f64; 3]]) {
        let order = &self.order;
        self.aids.resize(of.len(), [0.0; 4]);
        sweep::fill(&mut self.aids, |k| {
            let [x, y, z] = of[order[k] as usize];
            [x, y, z, 0.0]
        });
    }

    /// Sums what all pairs give.
    pub(super) fn sum<const G: usize, K: Kernel>(
        &mut self,
        kernel: &K,
        exchange: &impl Exchange<G>,
    ) {
        let (sights, aids) = (&self.sights, &self.aids);
        let chunks = self.chunks.par_chunks(self.length);
        self.blocks
            .par_iter_mut()
            .zip(chunks)
            .for_each(|(block, chunks)| {
                block.sums.clear();
                block.sums.resize(G * (block.top - block.first), [0.0; 4]);
                on_this_machine(Sum {
                    kernel,
                    exchange,
                    sights: &sights[block.first..block.top],
                    aids: aids.get(block.first..block.top).unwrap_or(&[]),
                    first: block.first as u32,
                    chunks,
                    sums: block.sums.as_chunks_mut().0,
                });
            });
    }

    /// The sums of a particle.
    pub(super) fn total<const G: usize>(&self, a: usize) -> [[f64; 4]; G] {
        let row = self.row[a] as usize;
        let last = row / (self.length * ROWS);
        let mut total = [[0.0; 4]; G];
        for block in &self.blocks[self.blocks[last].since..=last] {
            if row < block.top {
                let part = &block.sums.as_chunks::<G>().0[row - block.first];
                for (sum, part) in total.as_flattened_mut().iter_mut().zip(part.as_flattened()) {
                    *sum += part;
                }
            }
        }
        total
    }
}

/// The pairs of a block.
struct Sum<'a, const G: usize, K, E> {
    kernel: &'a K,
    exchange: &'a E,
    /// Particles from the first row of the block on.
    sights: &'a [Sight],
    aids: &'a [[f64; 4]],
    first: u32,
    chunks: &'a [Chunk],
    sums: &'a mut [[[f64; 4]; G]],
}

impl<const G: usize, K: Kernel, E: Exchange<G>> Work for Sum<'_, G, K, E> {
    #[inline(always)]
    fn run(mut self, lanes: impl Lanes) {
        let mut own = 0;
        for chunk in self.chunks {
            let mut start = 0;
            for end in &chunk.ends {
                let row = &chunk.index[std::mem::replace(&mut start, *end as usize)..*end as usize];
                self.row(lanes, own, row);
                own += 1;
            }
        }
    }
}

impl<const G: usize, K: Kernel, E: Exchange<G>> Sum<'_, G, K, E> {
    #[inline(always)]
    fn row<L: Lanes>(&mut self, lanes: L, own: usize, row: &[u32]) {
        let volume = self.sights[own].place[3];
        let side = self.side(lanes, [own; LANES]);
        let mut sums = [lanes.take([0.0; 4]); G];
        for [a, b, c, d] in row.as_chunks::<LANES>().0 {
            let others = [self.place(a), self.place(b), self.place(c), self.place(d)];
            let pair = Pair::of(self.kernel, side, self.side(lanes, others));
            let given = self.exchange.pair(&pair);
            for (g, (own, given)) in sums.iter_mut().zip(given).enumerate() {
                let given = lanes.turn(given);
                for (lane, b) in others.into_iter().enumerate() {
                    let [mine, theirs] = E::weights(volume, self.sights[b].place[3]);
                    *own = *own + given[lane] * lanes.take(mine);
                    let sum = lanes.take(self.sums[b][g]) + given[lane] * lanes.take(theirs);
                    self.sums[b][g] = lanes.give(sum);
                }
            }
        }
        for (to, sum) in self.sums[own].iter_mut().zip(sums) {
            *to = lanes.give(lanes.take(*to) + sum);
        }
    }

    /// Where a row is within the block.
    #[inline(always)]
    fn place(&self, row: &u32) -> usize {
        (row - self.first) as usize
    }

    /// Four particles.
    #[inline(always)]
    fn side<L: Lanes>(&self, lanes: L, [a, b, c, d]: [usize; LANES]) -> Side<L::Four> {
        let of = [
            &self.sights[a],
            &self.sights[b],
            &self.sights[c],
            &self.sights[d],
        ];
        let [x, y, z, _] = turned(lanes, [of[0].place, of[1].place, of[2].place, of[3].place]);
        let motion = [of[0].motion, of[1].motion, of[2].motion, of[3].motion];
        let [u, v, w, value] = turned(lanes, motion);
        let mut aid = [x.of(0.0); 3];
        if E::AIDED {
            let of = [self.aids[a], self.aids[b], self.aids[c], self.aids[d]];
            let [i, j, k, _] = turned(lanes, of);
            aid = [i, j, k];
        }
        Side {
            x: [x, y, z],
            u: [u, v, w],
            value,
            aid,
        }
    }
}

/// Takes up rows as columns.
#[inline(always)]
fn turned<L: Lanes>(lanes: L, [a, b, c, d]: [[f64; 4]; 4]) -> [L::Four; 4] {
    lanes.turn([lanes.take(a), lanes.take(b), lanes.take(c), lanes.take(d)])
}

#[cfg(test)]
mod tests;
