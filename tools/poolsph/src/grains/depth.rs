//! How deeply cells of grains sleep, and what that spares.

/// Rows of a cell.
pub const CELL: usize = 64;

/// A cell that is awake.
pub(super) const AWAKE: u8 = 0;
/// One that sleeps beside one that is awake.
pub(super) const BORDER: u8 = 1;
/// One that sleeps beside a border.
pub(super) const EDGE: u8 = 2;
/// One that sleeps among such as sleep deeper than a border.
pub(super) const DEEP: u8 = 3;

/// Whether nothing is reckoned between rows of these depths.
#[inline(always)]
#[must_use]
pub fn still(depth: &[u8], a: usize, b: usize) -> bool {
    !depth.is_empty() && depth[a / CELL].min(depth[b / CELL]) >= EDGE
}

/// Whether the forces of a row stay as they are.
#[inline(always)]
#[must_use]
pub fn kept(depth: &[u8], row: usize) -> bool {
    !depth.is_empty() && depth[row / CELL] >= EDGE
}

/// Whether a row sleeps.
#[inline(always)]
#[must_use]
pub fn asleep(depth: &[u8], row: usize) -> bool {
    !depth.is_empty() && depth[row / CELL] > AWAKE
}
