//! A particle of water as others see it.

/// What the others need to know of a particle, in one line of memory.
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
pub(super) struct Seen {
    /// x \[m\].
    pub(super) x: [f64; 3],
    /// u \[m/s\].
    pub(super) u: [f64; 3],
    /// V \[m3\].
    pub(super) volume: f64,
    /// Density in the middle of a step, pressure at its end.
    pub(super) value: f64,
}
