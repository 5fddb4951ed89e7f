//! Points that may be neighbours of any point in a few cells, side by side in memory.
//!
//! Rows of consecutive points mostly lie in the same brick of [`LENGTH`] cells along x. What may
//! be near any of them is collected once; for each of them all squared distances then come without
//! a branch, and one bit each tells the near ones.

use crate::grid::Grid;

/// Cells of a brick along x.
const LENGTH: usize = 4;
/// Candidates per word of bits.
const WORD: usize = 32;
/// Bit of each candidate of a word: a table is added up two at a time where shifts are not.
const BITS: [u64; WORD] = {
    let mut bits = [0; WORD];
    let mut k = 0;
    while k < WORD {
        bits[k] = 1 << k;
        k += 1;
    }
    bits
};
/// Farther than any point.
const AWAY: f64 = f64::INFINITY;

/// Candidates of the brick looked at last, each axis a column, filled up to whole words.
#[derive(Debug, Clone, Default)]
pub(crate) struct Brick {
    cells: Option<[usize; 3]>,
    x: Vec<[f64; WORD]>,
    y: Vec<[f64; WORD]>,
    z: Vec<[f64; WORD]>,
    index: Vec<u32>,
}

impl Brick {
    /// Forgets the brick: the grid has changed.
    pub(crate) fn clear(&mut self) {
        self.cells = None;
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        3 * size_of::<[f64; WORD]>() * self.x.capacity() + 4 * self.index.capacity()
    }

    /// Makes the brick the one of `point`; returns the number of candidates.
    #[inline(always)]
    pub(crate) fn settle(&mut self, grid: &Grid, (point, radius): ([f64; 3], f64)) -> usize {
        let [i, j, k] = grid.cell(point);
        let cells = [i / LENGTH, j, k];
        if self.cells != Some(cells) {
            self.collect(grid, cells, radius);
            self.cells = Some(cells);
        }
        self.index.len()
    }

    /// Calls `near` with the index and the squared distance of each candidate closer to `point`
    /// than `radius`, the point itself included, in the order of the cells.
    #[inline(always)]
    pub(crate) fn each(&self, (point, radius): ([f64; 3], f64), mut near: impl FnMut(u32, f64)) {
        let limit = radius * radius;
        let columns = self.x.iter().zip(&self.y).zip(&self.z);
        for (((x, y), z), index) in columns.zip(self.index.chunks(WORD)) {
            let mut squares = [0.0; WORD];
            let mut bits = 0;
            for k in 0..WORD {
                let dx = [point[0] - x[k], point[1] - y[k], point[2] - z[k]];
                let square = dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2];
                squares[k] = square;
                bits |= if square < limit { BITS[k] } else { 0 };
            }
            while bits != 0 {
                let k = bits.trailing_zeros() as usize % WORD;
                bits &= bits - 1;
                if let Some(b) = index.get(k) {
                    near(*b, squares[k]);
                }
            }
        }
    }

    /// Takes in what may be closer than `radius` to any point of the brick.
    #[inline(always)]
    fn collect(&mut self, grid: &Grid, [i, j, k]: [usize; 3], radius: f64) {
        self.index.clear();
        let mut n = 0;
        grid.runs_around([i * LENGTH, j, k], LENGTH, radius, |run| {
            let end = n + run.len();
            if WORD * self.x.len() < end {
                for column in [&mut self.x, &mut self.y, &mut self.z] {
                    column.resize(2 * end.div_ceil(WORD), [AWAY; WORD]);
                }
            }
            self.index.extend_from_slice(&grid.order()[run.clone()]);
            let (x, y, z) = (
                &mut self.x.as_flattened_mut()[n..end],
                &mut self.y.as_flattened_mut()[n..end],
                &mut self.z.as_flattened_mut()[n..end],
            );
            let places = x.iter_mut().zip(y).zip(z);
            for (((x, y), z), place) in places.zip(&grid.sorted()[run]) {
                [*x, *y, *z] = *place;
            }
            n = end;
        });
        // What is left of the last word.
        let whole = (n.div_ceil(WORD) * WORD).min(WORD * self.x.len());
        self.x.as_flattened_mut()[n..whole].fill(AWAY);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::naive;

    /// A plane of 13 x 9 points, somewhat uneven.
    fn plane() -> Vec<[f64; 3]> {
        let bend = |i: usize| i as f64 + 0.01 * (i * i % 7) as f64;
        (0..117)
            .map(|a| [bend(a % 13), bend(a / 13), 0.0])
            .collect()
    }

    #[test]
    fn points_of_all_bricks_find_what_a_plain_search_finds() {
        let points = plane();
        let rows = naive::search(&points, 2.1);
        for edge in [0.7, 1.05, 2.1, 50.0] {
            let mut grid = Grid::new(edge);
            grid.bin(&points);
            let mut brick = Brick::default();
            // Forwards, as rows are filled, and backwards, when each brick is another one.
            for a in (0..points.len()).chain((0..points.len()).rev()) {
                let place = (points[a], 2.1);
                let candidates = brick.settle(&grid, place);
                let mut found = Vec::new();
                brick.each(place, |b, square| {
                    assert!(square < 2.1 * 2.1);
                    found.push(b);
                });
                assert!(found.len() <= candidates);
                found.sort_unstable();
                let own = found.binary_search(&(a as u32)).unwrap();
                found.remove(own);
                assert_eq!(found, rows[a], "edge {edge}");
            }
        }
    }

    #[test]
    fn candidates_of_a_larger_brick_do_not_stay() {
        let mut points = plane();
        points.push([40.0, 0.0, 0.0]);
        let mut grid = Grid::new(1.0);
        grid.bin(&points);
        let mut brick = Brick::default();
        assert!(brick.settle(&grid, ([6.0, 4.0, 0.0], 2.0)) > 32);
        let alone = ([40.0, 0.0, 0.0], 2.0);
        assert_eq!(brick.settle(&grid, alone), 1);
        let mut found = Vec::new();
        brick.each(alone, |b, _| found.push(b));
        assert_eq!(found, [117]);
    }
}
