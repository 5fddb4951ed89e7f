//! Cells around points, to tell at once what lies far from all of them.

use crate::grid::cells_that_fit;

/// Cells along the reach.
const FINE: f64 = 2.0;

/// Marked cubic cells: all that come within a reach of a point.
#[derive(Debug, Clone)]
pub struct Halo {
    reach: f64,
    edge: f64,
    origin: [f64; 3],
    counts: [usize; 3],
    marked: Vec<bool>,
    occupied: Vec<[usize; 3]>,
}

impl Halo {
    /// No points yet; `reach` \[m\].
    #[must_use]
    pub fn new(reach: f64) -> Self {
        Self {
            reach,
            edge: reach / FINE,
            origin: [0.0; 3],
            counts: [0; 3],
            marked: Vec::new(),
            occupied: Vec::new(),
        }
    }

    /// Marks the cells around `points`, which must be finite.
    pub fn mark(&mut self, points: &[[f64; 3]]) {
        self.marked.clear();
        self.occupied.clear();
        if points.is_empty() {
            return;
        }
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for point in points {
            for k in 0..3 {
                low[k] = low[k].min(point[k] - self.reach);
                high[k] = high[k].max(point[k] + self.reach);
            }
        }
        self.origin = low;
        (self.edge, self.counts) = cells_that_fit(low, high, self.reach / FINE, points.len());
        let cells = self.counts.iter().product();
        self.marked.resize(cells, false);
        for point in points {
            if let Some(cell) = self.cell(*point) {
                let index = self.index(cell);
                if !self.marked[index] {
                    self.marked[index] = true;
                    self.occupied.push(cell);
                }
            }
        }
        let around = (self.reach / self.edge).ceil() as usize;
        for &cell in &self.occupied {
            let low = cell.map(|i| i.saturating_sub(around));
            let high: [usize; 3] =
                std::array::from_fn(|k| (cell[k] + around).min(self.counts[k] - 1));
            for z in low[2]..=high[2] {
                for y in low[1]..=high[1] {
                    let row = self.index([0, y, z]);
                    self.marked[row + low[0]..=row + high[0]].fill(true);
                }
            }
        }
    }

    /// False only if no point is closer to `place` than the reach.
    #[must_use]
    #[inline]
    pub fn may_touch(&self, place: [f64; 3]) -> bool {
        !self.marked.is_empty()
            && self
                .cell(place)
                .is_some_and(|cell| self.marked[self.index(cell)])
    }

    #[inline]
    fn cell(&self, place: [f64; 3]) -> Option<[usize; 3]> {
        let mut cell = [0; 3];
        for k in 0..3 {
            let at = (place[k] - self.origin[k]) / self.edge;
            // No number is within no range.
            if !(0.0..self.counts[k] as f64).contains(&at) {
                return None;
            }
            cell[k] = at as usize;
        }
        Some(cell)
    }

    #[inline]
    fn index(&self, cell: [usize; 3]) -> usize {
        cell[0] + self.counts[0] * (cell[1] + self.counts[1] * cell[2])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_is_within_reach_is_never_missed(
            points in prop::collection::vec(prop::array::uniform3(-9.0..9.0_f64), 0..30),
            places in prop::collection::vec(prop::array::uniform3(-14.0..14.0_f64), 1..200),
            reach in 0.3..4.0_f64,
        ) {
            let mut halo = Halo::new(reach);
            halo.mark(&points);
            for place in places {
                let near = points.iter().any(|p| {
                    (0..3).map(|k| (p[k] - place[k]).powi(2)).sum::<f64>() < reach * reach
                });
                prop_assert!(!near || halo.may_touch(place));
            }
        }
    }

    #[test]
    fn what_is_far_is_told_apart() {
        let mut halo = Halo::new(1.0);
        assert!(!halo.may_touch([0.0; 3]));
        halo.mark(&[[0.0; 3], [10.0, 0.0, 0.0]]);
        assert!(halo.may_touch([0.9, 0.0, 0.0]) && halo.may_touch([10.9, 0.0, 0.0]));
        assert!(!halo.may_touch([5.0, 0.0, 0.0]) && !halo.may_touch([0.0, 1.6, 0.0]));
        assert!(!halo.may_touch([1e9, 0.0, 0.0]) && !halo.may_touch([f64::NAN; 3]));
    }
}
