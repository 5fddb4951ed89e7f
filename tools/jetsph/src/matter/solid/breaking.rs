//! What fracture knows of a solid: who is broken, and who was next to whom.

use super::cracks::Cracks;
use super::fracture::Criterion;
use super::tensor::Matrix;

/// What fracture knows.
#[derive(Debug, Clone)]
pub struct Breaking {
    pub(super) criterion: Criterion,
    /// Size of a cell \[m\].
    pub(super) size: f64,
    /// F of a cell at rest: the axes of the lattice.
    pub(super) axes: Matrix,
    pub(super) cracks: Cracks,
    pub(super) broken: Vec<bool>,
    /// The broken ones in order.
    pub(super) list: Vec<usize>,
    /// Energy that cracks have taken \[J\].
    pub(super) energy: f64,
}

impl Breaking {
    /// Of an unbroken solid.
    #[must_use]
    pub fn new(
        criterion: Criterion,
        cracks: Cracks,
        (size, particles): (f64, usize),
        axes: Matrix,
    ) -> Self {
        Self {
            criterion,
            size,
            axes,
            cracks,
            broken: vec![false; particles],
            list: Vec::new(),
            energy: 0.0,
        }
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.cracks.bytes() + self.broken.len()
    }
}
