//! What the particles of a pair give each other, for one pair or for four.

use kernels::{Kernel, Number};

/// One number or four of a particle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Side<N> {
    /// x \[m\].
    pub(super) x: [N; 3],
    /// u \[m/s\].
    pub(super) u: [N; 3],
    /// Density in the middle of a step, pressure at its end.
    pub(super) value: N,
    /// What [`Exchange::AIDED`] asks for.
    pub(super) aid: [N; 3],
}

/// A pair, or four.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair<N> {
    pub(super) own: Side<N>,
    pub(super) other: Side<N>,
    /// Offset of the own particle from the other \[m\].
    pub(super) dx: [N; 3],
    /// Its square \[m2\].
    pub(super) square: N,
    /// grad W = slope . dx.
    pub(super) slope: N,
}

impl<N: Number> Pair<N> {
    /// A pair by its particles.
    #[inline(always)]
    pub(super) fn of(kernel: &impl Kernel, own: Side<N>, other: Side<N>) -> Self {
        let [x, y, z] = own.x;
        let dx = [x - other.x[0], y - other.x[1], z - other.x[2]];
        let square = dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2];
        Self {
            own,
            other,
            dx,
            square,
            slope: kernel.slope(square.root()),
        }
    }

    /// u_ij . x_ij \[m2/s\]; negative where both approach.
    #[inline(always)]
    pub(super) fn parting(&self) -> N {
        let ([u, v, w], other) = (self.own.u, self.other.u);
        (u - other[0]) * self.dx[0] + (v - other[1]) * self.dx[1] + (w - other[2]) * self.dx[2]
    }
}

/// What the particles of a pair give each other: `G` times four numbers.
///
/// They must be 0 for a particle and itself, by which rows are filled up, and beyond the support, where `slope` is 0.
pub(super) trait Exchange<const G: usize>: Sync {
    /// Whether it asks for three more numbers of each particle.
    const AIDED: bool = false;

    /// The numbers of a pair, of a unit of volume each.
    fn pair<N: Number>(&self, pair: &Pair<N>) -> [[N; 4]; G];

    /// What they are times for the own and for the other particle, by the volumes \[m3\] of the own and of the other.
    fn weights(own: f64, other: f64) -> [[f64; 4]; 2];
}
