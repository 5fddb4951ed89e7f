//! Neighbours within a set, and of one set in another.

use neighbours::Grid;
use rayon::prelude::*;

/// Rows per chunk.
const ROWS: usize = 256;

/// Neighbours of [`ROWS`] consecutive particles.
#[derive(Debug, Clone, Default)]
struct Chunk {
    /// Ends of the rows within `index`.
    ends: Vec<u32>,
    index: Vec<u32>,
}

/// For each particle of a set, the particles of a set closer than a radius, in the order of cells and index: it depends
/// on places alone, never on threads.
#[derive(Debug, Clone, Default)]
pub struct Rows {
    chunks: Vec<Chunk>,
    rows: usize,
}

impl Rows {
    /// No rows.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Finds the neighbours of `points` among those last given to `grid`, which are other ones.
    pub fn between(&mut self, points: &[[f64; 3]], grid: &Grid, radius: f64) {
        self.fill(points, grid, radius, |_, _| true);
    }

    /// Finds the neighbours of `points` among themselves, as last given to `grid`; none is its own.
    pub fn within(&mut self, points: &[[f64; 3]], grid: &Grid, radius: f64) {
        self.fill(points, grid, radius, |a, b| a != b);
    }

    fn fill(
        &mut self,
        points: &[[f64; 3]],
        grid: &Grid,
        radius: f64,
        wanted: impl Fn(usize, usize) -> bool + Sync,
    ) {
        self.rows = points.len();
        let chunks = points.len().div_ceil(ROWS);
        self.chunks.resize_with(chunks, Chunk::default);
        let limit = radius * radius;
        let filling = self.chunks.par_iter_mut().zip(points.par_chunks(ROWS));
        filling.enumerate().for_each(|(k, (chunk, points))| {
            chunk.ends.clear();
            chunk.index.clear();
            for (a, x) in points.iter().enumerate() {
                grid.runs(*x, radius, |run| {
                    let near = grid.sorted()[run.clone()].iter().zip(&grid.order()[run]);
                    let near = near.filter(|(y, _)| squared_distance(*x, **y) < limit);
                    let near = near.filter(|(_, b)| wanted(k * ROWS + a, **b as usize));
                    chunk.index.extend(near.map(|(_, b)| *b));
                });
                chunk.ends.push(chunk.index.len() as u32);
            }
        });
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

    /// Neighbours of particle `a`.
    #[inline]
    #[must_use]
    pub fn row(&self, a: usize) -> &[u32] {
        let chunk = &self.chunks[a / ROWS];
        let k = a % ROWS;
        let start = if k == 0 { 0 } else { chunk.ends[k - 1] };
        &chunk.index[start as usize..chunk.ends[k] as usize]
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let chunks = self.chunks.iter();
        let words: usize = chunks.map(|c| c.ends.capacity() + c.index.capacity()).sum();
        4 * words
    }
}

fn squared_distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let dx = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn cloud(n: usize) -> impl Strategy<Value = Vec<[f64; 3]>> {
        prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 0..n)
    }

    fn naive(points: &[[f64; 3]], others: &[[f64; 3]], radius: f64, own: bool) -> Vec<Vec<u32>> {
        let near = |(a, x): (usize, &[f64; 3])| {
            let all = others.iter().enumerate();
            let near = all
                .filter(|(b, y)| squared_distance(*x, **y) < radius * radius && (own || a != *b));
            near.map(|(b, _)| b as u32).collect()
        };
        points.iter().enumerate().map(near).collect()
    }

    fn sorted(rows: &Rows) -> Vec<Vec<u32>> {
        let row = |a| {
            let mut row = rows.row(a).to_vec();
            row.sort_unstable();
            row
        };
        (0..rows.len()).map(row).collect()
    }

    proptest! {
        #[test]
        fn rows_are_those_of_a_plain_search(points in cloud(600), others in cloud(60), radius in 0.05..0.7_f64) {
            let mut rows = Rows::new();
            let mut grid = Grid::new(radius);
            grid.bin(&others);
            rows.between(&points, &grid, radius);
            prop_assert_eq!(sorted(&rows), naive(&points, &others, radius, true));
            grid.bin(&points);
            rows.within(&points, &grid, radius);
            prop_assert_eq!(sorted(&rows), naive(&points, &points, radius, false));
        }
    }
}
