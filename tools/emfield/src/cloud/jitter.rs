//! Random shifts that depend on seed, number and axis alone.

use shapes::jitter;

/// A number between -1 and 1.
pub(crate) fn signed(seed: u64, number: u64, axis: u64) -> f64 {
    let own = jitter::bits(seed ^ 0x5851_F42D_4C95_7F2D, 0);
    jitter::signed(own.wrapping_add(4 * number + axis), 0)
}
