//! Rows of neighbours, chunk by chunk.

use std::ops::Range;

use rayon::prelude::*;

use crate::grid::{Grid, Reach, Search};
use crate::sieve::{AWAY, Candidates, Centre, LANES, Lanes, Sieve, Sifting, on_this_machine};

/// Cells along x of which the neighbourhood is found at once: consecutive rows mostly share it.
const LENGTH: usize = 3;

/// Rows per chunk.
pub const ROWS: usize = 256;

/// Neighbour rows of [`ROWS`] consecutive points (fewer in the last chunk).
#[derive(Debug, Clone, Default)]
pub struct Chunk {
    first: usize,
    offsets: Vec<u32>,
    index: Vec<u32>,
    square: Vec<f64>,
    brick: Brick,
}

/// What may be near the points of some cells.
#[derive(Debug, Clone, Default)]
struct Brick {
    /// Number of the brick along x, and of its cells along y and z.
    place: Option<[usize; 3]>,
    /// Runs of sorted points.
    runs: Vec<Range<usize>>,
    /// Points in all runs.
    points: usize,
    /// The points of all runs side by side, each axis a column, with [`LANES`] points far away behind
    /// them; columns may be longer.
    columns: [Vec<f64>; 3],
    /// Their indices.
    index: Vec<u32>,
}

impl Brick {
    /// Makes the brick the one of `point`.
    #[inline(always)]
    fn settle(&mut self, grid: &Grid, reach: &Reach, point: [f64; 3]) {
        let [i, j, k] = grid.cell(point);
        let place = Some([i / LENGTH, j, k]);
        if self.place != place {
            self.place = place;
            let first = [i - i % LENGTH, j, k];
            grid.runs_around(first, LENGTH, reach, &mut self.runs);
            self.pack(grid);
        }
    }

    /// Puts the points of the runs side by side, [`LANES`] at once: what is copied beyond the end of a
    /// run is overwritten by the next one.
    #[inline(always)]
    fn pack(&mut self, grid: &Grid) {
        self.points = self.runs.iter().map(Range::len).sum();
        let end = self.points + 2 * LANES;
        if self.index.len() < end {
            self.columns
                .iter_mut()
                .for_each(|column| column.resize(end, AWAY));
            self.index.resize(end, 0);
        }
        let [x, y, z] = self.columns.each_mut().map(|column| &mut column[..end]);
        let index = &mut self.index[..end];
        let mut used = 0;
        for run in &self.runs {
            for first in run.clone().step_by(LANES) {
                // All hold as many.
                if let (Some(lanes), Some(order), Some(x), Some(y), Some(z), Some(index)) = (
                    grid.lanes(first),
                    grid.order_from(first),
                    x[used..].first_chunk_mut(),
                    y[used..].first_chunk_mut(),
                    z[used..].first_chunk_mut(),
                    index[used..].first_chunk_mut(),
                ) {
                    // One by one: a tuple of all would go by way of the stack.
                    *x = *lanes.x;
                    *y = *lanes.y;
                    *z = *lanes.z;
                    *index = *order;
                }
                used += LANES.min(run.end - first);
            }
        }
        x[used..used + LANES].fill(AWAY);
    }

    /// The points side by side, the last ones far away.
    #[inline(always)]
    fn candidates(&self) -> impl Iterator<Item = Candidates<'_>> {
        let vectors = self.points.div_ceil(LANES);
        let [x, y, z] = self.columns.each_ref().map(|column| column.as_chunks().0);
        let lanes = x[..vectors].iter().zip(y).zip(z);
        lanes
            .zip(self.index.as_chunks().0)
            .map(|(((x, y), z), index)| Candidates {
                lanes: Lanes { x, y, z },
                index,
            })
    }
}

impl Chunk {
    /// Index of the first row.
    #[inline]
    #[must_use]
    pub fn first(&self) -> usize {
        self.first
    }

    /// Number of rows.
    #[inline]
    #[must_use]
    pub fn rows(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Offsets of the rows into [`Chunk::index`], one more than there are rows.
    #[must_use]
    pub fn offsets(&self) -> &[u32] {
        &self.offsets
    }

    /// Neighbours of all rows of the chunk, row after row.
    #[must_use]
    pub fn index(&self) -> &[u32] {
        &self.index[..self.offsets[self.offsets.len() - 1] as usize]
    }

    /// Range of the chunk's row `k` within [`Chunk::index`].
    #[inline]
    #[must_use]
    pub fn range(&self, k: usize) -> std::ops::Range<usize> {
        self.offsets[k] as usize..self.offsets[k + 1] as usize
    }

    /// Appends the row of `centre` to the chunk, which holds `used` pairs; returns the new number.
    #[inline(always)]
    fn search(
        &mut self,
        grid: &Grid,
        reach: &Reach,
        centre: Centre,
        used: usize,
        sieve: impl Sieve,
    ) -> usize {
        self.brick.settle(grid, reach, centre.point);
        let end = used + self.brick.points + LANES;
        self.hold(end);
        let (slots, squares) = (&mut self.index[used..end], &mut self.square[used..end]);
        let mut hits = 0;
        for candidates in self.brick.candidates() {
            // Both hold as many.
            if let (Some(slots), Some(squares)) = (
                slots[hits..].first_chunk_mut(),
                squares[hits..].first_chunk_mut(),
            ) {
                hits += sieve.sift(centre, candidates, slots, squares);
            }
        }
        used + hits
    }

    /// Makes room for so many pairs.
    #[inline(always)]
    fn hold(&mut self, pairs: usize) {
        if self.index.len() < pairs {
            self.index.resize(2 * pairs, 0);
        }
        if self.square.len() < pairs {
            self.square.resize(2 * pairs, 0.0);
        }
    }

    /// Leaves out the pairs that `accepts` refuses.
    fn prune(&mut self, accepts: &impl Fn(usize, usize) -> bool) {
        let (mut from, mut used) = (0, 0);
        for (k, end) in self.offsets[1..].iter_mut().enumerate() {
            for at in std::mem::replace(&mut from, *end as usize)..*end as usize {
                let b = self.index[at];
                self.index[used] = b;
                used += usize::from(accepts(self.first + k, b as usize));
            }
            *end = used as u32;
        }
    }

    /// Neighbours of the chunk's row `k`.
    #[inline]
    #[must_use]
    pub fn row(&self, k: usize) -> &[u32] {
        &self.index[self.range(k)]
    }
}

/// The filling of a chunk.
struct Fill<'a, W> {
    chunk: &'a mut Chunk,
    search: Search<'a>,
    reach: &'a Reach,
    wanted: &'a W,
}

impl<W: Fn(usize) -> bool> Sifting for Fill<'_, W> {
    #[inline(always)]
    fn run(self, sieve: impl Sieve) {
        let Self { chunk, reach, .. } = self;
        let Search {
            grid,
            points,
            radius,
        } = self.search;
        let end = points.len().min(chunk.first + ROWS);
        chunk.offsets.clear();
        chunk.offsets.push(0);
        // The grid has changed.
        chunk.brick.place = None;
        let mut used = 0;
        for (a, &point) in points[..end].iter().enumerate().skip(chunk.first) {
            if (self.wanted)(a) {
                let own = a as u32;
                let centre = Centre { point, radius, own };
                used = chunk.search(grid, reach, centre, used, sieve);
            }
            chunk.offsets.push(used as u32);
        }
    }
}

/// Neighbours of each point of a cloud.
#[derive(Debug, Clone, Default)]
pub struct Lists {
    chunks: Vec<Chunk>,
    rows: usize,
}

impl Lists {
    /// Lists without rows.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Fills the rows of all points with their neighbours.
    ///
    /// A row for which `wanted` is false stays empty; a pair (row, neighbour) for which
    /// `accepts` is false is left out.
    pub fn build(
        &mut self,
        search: Search<'_>,
        wanted: impl Fn(usize) -> bool + Sync,
        accepts: impl Fn(usize, usize) -> bool + Sync,
    ) {
        self.resize(search.points.len());
        let reach = &search.grid.reach(search.radius);
        self.chunks.par_iter_mut().for_each(|chunk| {
            on_this_machine(Fill {
                chunk,
                search,
                reach,
                wanted: &wanted,
            });
            chunk.prune(&accepts);
        });
    }

    /// As [`Lists::build`] with all pairs, and hands each chunk over as soon as it is filled, while
    /// it is at hand, with the squared distances of its pairs and an item of `extra`. The vector of
    /// squares may be swapped for another one; it holds numbers beyond those of the pairs.
    pub fn build_with<T: Send>(
        &mut self,
        search: Search<'_>,
        wanted: impl Fn(usize) -> bool + Sync,
        extra: impl IndexedParallelIterator<Item = T>,
        visit: impl Fn(&Chunk, &mut Vec<f64>, T) + Sync,
    ) {
        self.resize(search.points.len());
        let reach = &search.grid.reach(search.radius);
        self.chunks
            .par_iter_mut()
            .zip(extra)
            .for_each(|(chunk, extra)| {
                on_this_machine(Fill {
                    chunk,
                    search,
                    reach,
                    wanted: &wanted,
                });
                let mut squares = std::mem::take(&mut chunk.square);
                visit(chunk, &mut squares, extra);
                chunk.square = squares;
            });
    }

    fn resize(&mut self, rows: usize) {
        self.rows = rows;
        self.chunks.resize_with(rows.div_ceil(ROWS), Chunk::default);
        for (c, chunk) in self.chunks.iter_mut().enumerate() {
            chunk.first = c * ROWS;
        }
    }

    /// Neighbours of point `a`.
    #[inline]
    #[must_use]
    pub fn row(&self, a: usize) -> &[u32] {
        self.chunks[a / ROWS].row(a % ROWS)
    }

    /// All chunks, in order.
    #[must_use]
    pub fn chunks(&self) -> &[Chunk] {
        &self.chunks
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows
    }

    /// True without rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// Number of directed pairs.
    #[must_use]
    pub fn pairs(&self) -> usize {
        self.chunks.iter().map(|chunk| chunk.index().len()).sum()
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.chunks
            .iter()
            .map(|chunk| {
                let indices = chunk.index.capacity() + chunk.offsets.capacity();
                4 * indices + 8 * chunk.square.capacity()
            })
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::naive;
    use proptest::prelude::*;

    fn rows(points: &[[f64; 3]], edge: f64, radius: f64) -> Vec<Vec<u32>> {
        let (mut grid, mut lists) = (Grid::new(edge), Lists::new());
        grid.bin(points);
        lists.build(grid.search(points, radius), |_| true, |_, _| true);
        (0..points.len()).map(|a| lists.row(a).to_vec()).collect()
    }

    fn ascending(mut rows: Vec<Vec<u32>>) -> Vec<Vec<u32>> {
        rows.iter_mut().for_each(|row| row.sort_unstable());
        rows
    }

    fn cloud(n: usize, span: f64, seed: u64) -> Vec<[f64; 3]> {
        let mut state = seed;
        let mut next = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..n)
            .map(|_| std::array::from_fn(|_| span * (next() - 0.5)))
            .collect()
    }

    #[test]
    fn inside_at_and_outside_the_radius() {
        let points = [
            [-1.0, 2.0, 3.0],
            [-0.0, 2.0, 3.0],
            [-1.0, 2.0, 4.0 - 1e-12],
            [-1.0, 1.0 - 1e-12, 3.0],
        ];
        let found = rows(&points, 1.0, 1.0);
        assert_eq!(found[0], [2], "at the radius and outside are left out");
    }

    #[test]
    fn random_clouds_as_the_naive_search() {
        for (n, span, edge) in [
            (0, 1.0, 1.0),
            (1, 1.0, 1.0),
            (700, 8.0, 1.0),
            (700, 8.0, 0.5),
            (300, 0.9, 1.0),
            (200, 300.0, 1.0),
        ] {
            let points = cloud(n, span, 7 + n as u64);
            assert_eq!(
                ascending(rows(&points, edge, 1.0)),
                naive::search(&points, 1.0),
                "{n} {span} {edge}"
            );
        }
    }

    #[test]
    fn far_points_do_not_cost_the_empty_space() {
        let mut points = cloud(100, 4.0, 3);
        points.push([1e6, -1e6, 1e6]);
        assert_eq!(
            ascending(rows(&points, 1.0, 1.0)),
            naive::search(&points, 1.0)
        );
    }

    #[test]
    fn unwanted_rows_and_pairs_are_left_out() {
        let points = cloud(400, 4.0, 11);
        let (mut grid, mut lists) = (Grid::new(1.0), Lists::new());
        grid.bin(&points);
        let search = grid.search(&points, 1.0);
        lists.build(search, |a| a % 2 == 0, |_, b| b % 3 == 0);
        for (a, row) in naive::search(&points, 1.0).into_iter().enumerate() {
            let mut found = lists.row(a).to_vec();
            found.sort_unstable();
            let kept: Vec<u32> = row
                .into_iter()
                .filter(|b| a % 2 == 0 && b % 3 == 0)
                .collect();
            assert_eq!(found, kept);
        }
    }

    #[test]
    fn order_does_not_depend_on_threads() {
        let points = cloud(3000, 10.0, 5);
        let with = |n: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(n)
                .build()
                .unwrap();
            pool.install(|| rows(&points, 1.0, 1.0))
        };
        assert_eq!(with(1), with(2));
    }

    proptest! {
        #[test]
        fn neighbourhood_is_symmetric(seed in 0_u64..1000, span in 0.5..20.0_f64) {
            let points = cloud(200, span, seed);
            let found = rows(&points, 1.0, 1.0);
            for (a, row) in found.iter().enumerate() {
                for &b in row {
                    prop_assert!(found[b as usize].contains(&(a as u32)));
                }
            }
        }
    }
}
