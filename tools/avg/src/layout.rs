//! Cells seen from above, and how a place is shared between them.
//!
//! A place belongs to the four nearest cells, bilinearly, and in the outer half of a cell at the end to those along it. The parts of a
//! place within the cells add up to 1.

/// Cells seen from above, and places whose fluxes are told.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Centres of the cells across and along the weld \[m\].
    pub centres: [Vec<f64>; 2],
    /// Side of a cell \[m\].
    pub side: f64,
    /// Least length of an interval \[s\].
    pub interval: f64,
    /// Names and places \[m\].
    pub places: Vec<(String, [f64; 2])>,
}

/// How many cells a map over `ranges` \[m\] has, before any is made.
#[must_use]
pub fn wanted(ranges: [[f64; 2]; 2], side: f64) -> f64 {
    ranges
        .iter()
        .map(|range| (range[1] - range[0]) / side)
        .product()
}

impl Layout {
    /// Cells of `side` \[m\] that fill `ranges` \[m\] from their lower ends on; the last may reach beyond.
    #[must_use]
    pub fn new(ranges: [[f64; 2]; 2], side: f64, interval: f64) -> Self {
        let centres = ranges.map(|[from, to]| {
            // A millionth of a cell keeps an end that is meant to be that of a cell.
            let count = ((to - from) / side - 1e-6).ceil().max(1.0) as usize;
            (0..count).map(|i| from + (i as f64 + 0.5) * side).collect()
        });
        Self {
            centres,
            side,
            interval,
            places: Vec::new(),
        }
    }

    /// Number of cells.
    #[must_use]
    pub fn len(&self) -> usize {
        self.centres[0].len() * self.centres[1].len()
    }

    /// True without cells.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The cells around a place and its parts in them, second axis fastest; what lies beyond the map is in none.
    pub(crate) fn shares(&self, place: [f64; 2]) -> impl Iterator<Item = (usize, f64)> {
        let axes = [0, 1].map(|k| {
            let centres = &self.centres[k];
            let (at, last) = (
                (place[k] - centres[0]) / self.side,
                (centres.len() - 1) as f64,
            );
            // A millionth of a cell keeps what stands on the edge.
            let lies = at >= -0.5 - 1e-6 && at <= last + 0.5 + 1e-6;
            let at = at.clamp(0.0, last);
            let (low, part) = (at.floor(), at - at.floor());
            let cell = |i: f64| lies.then_some(i.min(last) as usize);
            [(cell(low), 1.0 - part), (cell(low + 1.0), part)]
        });
        let row = self.centres[1].len();
        axes[0].into_iter().flat_map(move |(i, a)| {
            let cells = axes[1].into_iter();
            cells.filter_map(move |(j, b)| Some((i? * row + j?, a * b)))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_add_up_within_the_cells_and_nothing_is_in_them_beyond() {
        let layout = Layout::new([[0.0, 2.5], [1.0, 3.0]], 1.0, 0.0);
        assert_eq!(layout.centres, [vec![0.5, 1.5, 2.5], vec![1.5, 2.5]]);
        assert!((wanted([[0.0, 2.5], [1.0, 3.0]], 1.0) - 5.0).abs() < 1e-15);
        for place in [[0.0, 1.0], [0.2, 2.9], [1.3, 2.2], [3.0, 3.0]] {
            let whole: f64 = layout.shares(place).map(|(_, part)| part).sum();
            assert!((whole - 1.0).abs() < 1e-12, "{place:?}: {whole}");
        }
        for place in [[-0.1, 2.0], [3.1, 2.0], [1.0, 0.9], [1.0, 3.1]] {
            assert_eq!(layout.shares(place).count(), 0, "{place:?}");
        }
        let quarter: Vec<(usize, f64)> = layout.shares([1.0, 2.0]).collect();
        assert_eq!(quarter, [(0, 0.25), (1, 0.25), (2, 0.25), (3, 0.25)]);
    }
}
