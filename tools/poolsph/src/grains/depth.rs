//! How deeply cells of grains sleep, and what that spares.

use contact::Grain;

/// Rows of a cell.
pub const CELL: usize = 8;

/// A cell that is awake.
pub(super) const AWAKE: u8 = 0;
/// One that sleeps beside one that is awake.
pub(super) const BORDER: u8 = 1;
/// One that sleeps beside a border.
pub(super) const EDGE: u8 = 2;
/// One that sleeps among such as sleep deeper than a border.
pub(super) const DEEP: u8 = 3;

/// Grains, and which of them are reckoned.
#[derive(Debug, Clone, Copy)]
pub struct Reckoned<'a> {
    /// All grains.
    pub grains: &'a [Grain],
    /// Whose forces stay as they are.
    pub depth: Depth<'a>,
}

/// How deeply cells sleep, and from which depth on their forces stay as they are.
///
/// What sleeps stands still, so that contacts between sleepers do the same at all times. The forces of a border are asked for only
/// when its cells wake, after a step of the run: they are reckoned in the last step of the grains within it. In the others only
/// contacts of grains that are awake are reckoned.
#[derive(Debug, Clone, Copy)]
pub struct Depth<'a> {
    cells: &'a [u8],
    kept: u8,
}

impl<'a> Depth<'a> {
    /// Of `cells`, none where all are awake; forces of a border are reckoned in the `last` step.
    #[must_use]
    pub fn of(cells: &'a [u8], last: bool) -> Self {
        let kept = if last { EDGE } else { BORDER };
        Self { cells, kept }
    }

    /// Whether nothing is reckoned between two rows.
    #[inline(always)]
    #[must_use]
    pub fn still(self, a: usize, b: usize) -> bool {
        self.kept(a) && self.kept(b)
    }

    /// Whether the forces of a row stay as they are.
    #[inline(always)]
    #[must_use]
    pub fn kept(self, row: usize) -> bool {
        !self.cells.is_empty() && self.cells[row / CELL] >= self.kept
    }

    /// Whether a row sleeps.
    #[inline(always)]
    #[must_use]
    pub fn asleep(self, row: usize) -> bool {
        asleep(self.cells, row)
    }

    /// As in the last step.
    #[inline(always)]
    #[must_use]
    pub fn always(self) -> Self {
        Self::of(self.cells, true)
    }

    /// Which part of a chunk is reckoned; none where all of it is.
    #[inline(always)]
    #[must_use]
    pub fn part(self) -> Option<usize> {
        (!self.cells.is_empty()).then(|| usize::from(self.kept == EDGE))
    }

    /// Both: in all steps but the last, and in the last.
    #[must_use]
    pub fn both(cells: &'a [u8]) -> [Self; 2] {
        [false, true].map(|last| Self::of(cells, last))
    }
}

/// Whether the forces of a row stay as they are in all steps.
#[inline(always)]
#[must_use]
pub fn kept(depth: &[u8], row: usize) -> bool {
    Depth::of(depth, true).kept(row)
}

/// Whether a row sleeps.
#[inline(always)]
#[must_use]
pub fn asleep(depth: &[u8], row: usize) -> bool {
    !depth.is_empty() && depth[row / CELL] > AWAKE
}
