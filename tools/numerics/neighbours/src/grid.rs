//! Points sorted into cubic cells.

use std::ops::Range;

use rayon::prelude::*;

use crate::sieve::{AWAY, LANES, Lanes};

/// More cells than this many per point make the cells grow: a lone far point must not cost
/// memory in proportion to the empty space before it.
const CELLS_PER_POINT: usize = 16;
/// Points per unit of parallel work.
const GRAIN: usize = 4096;

/// Cells that are always allowed.
const CELLS_FREE: usize = 4096;

/// Cells along an axis whose distance is kept; a search that spans more takes the others whole.
const CELLS: usize = 8;
/// Cells on each side of a point that may be left out of a run.
const SIDE: usize = 2;
/// Part of an edge by which cells may be nearer than they should, by rounding.
const SLACK: f64 = 1e-6;

/// Cells along one axis within reach of a point.
struct Gaps {
    low: usize,
    high: usize,
    /// Squared distance of the first cells from the point \[m2\].
    squares: [f64; CELLS],
    /// That of the outermost cells on the left, and on the right; 0 for the point's own cell and
    /// beyond.
    left: [f64; SIDE],
    right: [f64; SIDE],
}

impl Gaps {
    #[inline]
    fn square(&self, cell: usize) -> f64 {
        self.squares.get(cell - self.low).copied().unwrap_or(0.0)
    }
}

/// A cell list: points sorted into cubic cells, x fastest.
#[derive(Debug, Clone)]
pub struct Grid {
    finest: f64,
    edge: f64,
    origin: [f64; 3],
    end: [f64; 3],
    counts: [usize; 3],
    start: Vec<u32>,
    cell_of: Vec<u32>,
    order: Vec<u32>,
    sorted: Vec<[f64; 3]>,
    /// The sorted points once more, each axis a column, with [`LANES`] points far away behind them.
    columns: [Vec<f64>; 3],
}

/// Rows of cells that come closer than a radius to a cell: how many cells away each is along y and z,
/// and to its ends along x.
pub(crate) type Reach = Vec<([isize; 2], usize)>;

/// The points of a cloud, and how near to each others are looked for.
#[derive(Debug, Clone, Copy)]
pub struct Search<'a> {
    /// Their cells.
    pub(crate) grid: &'a Grid,
    /// All of them \[m\].
    pub(crate) points: &'a [[f64; 3]],
    /// Points closer than this are neighbours \[m\].
    pub(crate) radius: f64,
}

impl Grid {
    /// An empty grid with cells of `edge` \[m\]; the search radius or half of it is a good choice.
    #[must_use]
    pub fn new(edge: f64) -> Self {
        Self {
            finest: edge,
            edge,
            origin: [0.0; 3],
            end: [0.0; 3],
            counts: [1; 3],
            start: vec![0, 0],
            cell_of: Vec::new(),
            order: Vec::new(),
            sorted: Vec::new(),
            columns: [const { Vec::new() }; 3],
        }
    }

    /// Sorts `points`, which must be finite, into cells.
    pub fn bin(&mut self, points: &[[f64; 3]]) {
        self.enclose(points);
        let cells = self.counts.iter().product::<usize>();
        let mut cell_of = std::mem::take(&mut self.cell_of);
        points
            .par_iter()
            .with_min_len(GRAIN)
            .map(|point| number(self.index(self.cell(*point))))
            .collect_into_vec(&mut cell_of);
        self.cell_of = cell_of;
        self.start.clear();
        self.start.resize(cells + 1, 0);
        for cell in &self.cell_of {
            self.start[*cell as usize + 1] += 1;
        }
        for cell in 0..cells {
            self.start[cell + 1] += self.start[cell];
        }
        self.order.resize(points.len() + LANES, 0);
        // Filling backwards from the ends keeps the sort stable and turns `start` of the next
        // cell into the start of this one.
        for a in (0..points.len()).rev() {
            let end = &mut self.start[self.cell_of[a] as usize + 1];
            *end -= 1;
            self.order[*end as usize] = number(a);
        }
        self.start.remove(0);
        self.start.push(number(points.len()));
        let order = self.order[..points.len()].par_iter();
        order
            .with_min_len(GRAIN)
            .map(|a| points[*a as usize])
            .collect_into_vec(&mut self.sorted);
        let sorted = &self.sorted;
        let columns = self.columns.par_iter_mut().enumerate();
        columns.for_each(|(axis, column)| {
            column.clear();
            column.extend(sorted.iter().map(|place| place[axis]));
            column.extend([AWAY; LANES]);
        });
    }

    /// Point indices sorted by cell: the order in which a compact copy has the best locality.
    #[inline]
    #[must_use]
    pub fn order(&self) -> &[u32] {
        &self.order[..self.sorted.len()]
    }

    /// The indices of the sorted points from `first` on, with numbers of no meaning behind the last.
    #[inline(always)]
    pub(crate) fn order_from(&self, first: usize) -> Option<&[u32; LANES]> {
        self.order.get(first..)?.first_chunk()
    }

    /// Renumbers the points as sorted: for a caller that has reordered its own columns by
    /// [`Grid::order`].
    pub fn renumber(&mut self) {
        for (place, index) in self.order.iter_mut().enumerate() {
            *index = number(place);
        }
    }

    /// Positions in the order of [`Grid::order`].
    #[inline]
    #[must_use]
    pub fn sorted(&self) -> &[[f64; 3]] {
        &self.sorted
    }

    /// Edge of the cells in use \[m\]: the one asked for, doubled while the cloud is too sparse.
    #[inline]
    #[must_use]
    pub fn edge(&self) -> f64 {
        self.edge
    }

    /// Calls `visit` with each run of sorted points that may lie within `radius` of `point`.
    #[inline]
    pub fn runs(&self, point: [f64; 3], radius: f64, mut visit: impl FnMut(Range<usize>)) {
        self.any_run(point, radius, |run| {
            visit(run);
            false
        });
    }

    /// True if some point is closer than `radius`; points far from the whole cloud are told apart
    /// at the cost of a few comparisons.
    #[must_use]
    pub fn any_within(&self, point: [f64; 3], radius: f64) -> bool {
        let outside =
            |k: usize| point[k] < self.origin[k] - radius || point[k] > self.end[k] + radius;
        if outside(0) || outside(1) || outside(2) {
            return false;
        }
        let limit = radius * radius;
        self.any_run(point, radius, |run| {
            self.sorted[run]
                .iter()
                .any(|&other| distance_squared(point, other) < limit)
        })
    }

    /// Calls `stop` with the runs of [`Grid::runs`] until it says true; tells whether it did.
    ///
    /// Cells that the sphere does not touch are left out: rows of cells by their distance across
    /// x, and of the other rows the cells to the left and to the right that lie beyond the rest.
    #[inline]
    fn any_run(
        &self,
        point: [f64; 3],
        radius: f64,
        mut stop: impl FnMut(Range<usize>) -> bool,
    ) -> bool {
        let limit = radius * radius;
        let [x, y, z] = [0, 1, 2].map(|axis| self.gaps(point, radius, axis));
        for k in z.low..=z.high {
            let across = limit - z.square(k);
            for j in y.low..=y.high {
                let rest = across - y.square(j);
                if rest <= 0.0 {
                    continue;
                }
                let (mut low, mut high) = (x.low, x.high);
                for (left, right) in x.left.iter().zip(&x.right) {
                    low += usize::from(*left >= rest);
                    high -= usize::from(*right >= rest);
                }
                let row = self.counts[0] * (j + self.counts[1] * k);
                let run = self.start[row + low] as usize..self.start[row + high + 1] as usize;
                if !run.is_empty() && stop(run) {
                    return true;
                }
            }
        }
        false
    }

    /// All points, as they were last given to [`Self::bin`], and the radius \[m\] within which others are neighbours.
    #[must_use]
    pub fn search<'a>(&'a self, points: &'a [[f64; 3]], radius: f64) -> Search<'a> {
        Search {
            grid: self,
            points,
            radius,
        }
    }

    /// Rows of cells with points closer than `radius` to those of a cell.
    pub(crate) fn reach(&self, radius: f64) -> Reach {
        // In edges, from the faces of the cell on.
        let radius = radius / self.edge;
        let cells = radius.ceil() as isize;
        let gap = |cell: isize| cell.unsigned_abs().saturating_sub(1) as f64;
        let mut reach = Reach::new();
        for above in -cells..=cells {
            for beside in -cells..=cells {
                let rest = radius * radius - gap(beside).powi(2) - gap(above).powi(2);
                if rest > 0.0 {
                    reach.push(([beside, above], rest.sqrt().ceil() as usize));
                }
            }
        }
        reach
    }

    /// Fills `runs` with the runs of sorted points within reach of the `length` cells from `first` on
    /// along x.
    pub(crate) fn runs_around(
        &self,
        [i, j, k]: [usize; 3],
        length: usize,
        reach: &Reach,
        runs: &mut Vec<Range<usize>>,
    ) {
        runs.clear();
        for &([beside, above], along) in reach {
            let (j, k) = (j.wrapping_add_signed(beside), k.wrapping_add_signed(above));
            // What lies left of the grid has become very large.
            if j < self.counts[1] && k < self.counts[2] {
                let row = self.counts[0] * (j + self.counts[1] * k);
                let (low, high) = (i.saturating_sub(along), i + length + along);
                let (low, high) = (row + low, row + high.min(self.counts[0]));
                let run = self.start[low] as usize..self.start[high] as usize;
                if !run.is_empty() {
                    runs.push(run);
                }
            }
        }
    }

    /// The sorted points from `first` on.
    #[inline(always)]
    pub(crate) fn lanes(&self, first: usize) -> Option<Lanes<'_>> {
        let [x, y, z] = &self.columns;
        Some(Lanes {
            x: x.get(first..)?.first_chunk()?,
            y: y.get(first..)?.first_chunk()?,
            z: z.get(first..)?.first_chunk()?,
        })
    }

    /// Cells along `axis` that a sphere may touch, and how far from its centre they begin.
    #[inline]
    fn gaps(&self, point: [f64; 3], radius: f64, axis: usize) -> Gaps {
        let x = point[axis] - self.origin[axis];
        let inverse = 1.0 / self.edge;
        // A float cast saturates, so that what lies left of the origin lands in cell 0.
        let cell = |x: f64| ((x * inverse) as usize).min(self.counts[axis] - 1);
        let (low, high) = (cell(x - radius), cell(x + radius));
        let mut gaps = Gaps {
            low,
            high,
            squares: [0.0; CELLS],
            left: [0.0; SIDE],
            right: [0.0; SIDE],
        };
        for (i, square) in gaps.squares.iter_mut().enumerate() {
            let start = self.edge * (low + i) as f64;
            let gap = (start - x).max(x - start - self.edge) - SLACK * self.edge;
            *square = gap.max(0.0) * gap.max(0.0);
        }
        // The squares fall toward the point and rise behind it; a cell counts for one side only.
        let own = cell(x);
        for i in 0..SIDE {
            let (left, right) = (low + i, high.wrapping_sub(i));
            if left < own {
                gaps.left[i] = gaps.square(left);
            }
            if right > own && right <= high {
                gaps.right[i] = gaps.square(right);
            }
        }
        gaps
    }

    fn enclose(&mut self, points: &[[f64; 3]]) {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for point in points {
            for k in 0..3 {
                low[k] = low[k].min(point[k]);
                high[k] = high[k].max(point[k]);
            }
        }
        if points.is_empty() {
            (low, high) = ([0.0; 3], [0.0; 3]);
        }
        (self.origin, self.end) = (low, high);
        (self.edge, self.counts) = cells_that_fit(low, high, self.finest, points.len());
    }

    /// Cell coordinates, clamped into the grid.
    #[inline]
    pub(crate) fn cell(&self, point: [f64; 3]) -> [usize; 3] {
        let inverse = 1.0 / self.edge;
        // A float cast saturates, so that points left of the origin land in cell 0.
        std::array::from_fn(|k| {
            (((point[k] - self.origin[k]) * inverse) as usize).min(self.counts[k] - 1)
        })
    }

    fn index(&self, cell: [usize; 3]) -> usize {
        cell[0] + self.counts[0] * (cell[1] + self.counts[1] * cell[2])
    }
}

/// Edge of cells from `low` to `high` \[m\] and their numbers along the axes: the `finest`, doubled
/// until no more cells are asked for than the number of points allows.
pub(crate) fn cells_that_fit(
    low: [f64; 3],
    high: [f64; 3],
    finest: f64,
    points: usize,
) -> (f64, [usize; 3]) {
    let room = (CELLS_PER_POINT * points + CELLS_FREE) as f64;
    let mut edge = finest;
    loop {
        let spans = std::array::from_fn::<f64, 3, _>(|k| ((high[k] - low[k]) / edge).floor() + 1.0);
        if spans.iter().product::<f64>() <= room || !spans.iter().all(|s| s.is_finite()) {
            let counts = spans.map(|s| if s.is_finite() { s as usize } else { 1 });
            return (edge, counts);
        }
        edge *= 2.0;
    }
}

/// Squared distance of two points \[m2\].
#[inline]
pub(crate) fn distance_squared(a: [f64; 3], b: [f64; 3]) -> f64 {
    let dx = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2]
}

/// Indices are stored in 32 bits; a cloud of 4e9 points does not fit a machine.
#[inline]
pub(crate) fn number(index: usize) -> u32 {
    index as u32
}
