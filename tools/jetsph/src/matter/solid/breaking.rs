//! What fracture knows of a solid: who is broken, and who was next to whom.

use std::collections::BTreeMap;

use super::cracks::{AROUND, Cracks};
use super::fracture::Criterion;
use super::nonlocal::Boxes;
use super::tensor::Matrix;
use super::trial::Trial;

/// What fracture knows.
#[derive(Debug, Clone)]
pub struct Breaking<const T: usize> {
    pub(super) criterion: Criterion,
    /// Over what it takes the mean; a cell alone if none.
    pub(super) boxes: Option<Boxes>,
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
    /// Energy that the body was to release for them \[J\], by the criterion of the energy.
    pub(super) released: f64,
    /// Time \[s\] and place \[m\] where it first broke; no numbers before.
    pub(super) first: [f64; 4],
    /// What is left around those that may break next, where the criterion asks.
    pub(super) trials: BTreeMap<usize, Trial<T>>,
    /// How stiff each cell is for its neighbours \[1/m2\], 0 of broken ones, and the most that any was at rest.
    pub(super) stiffness: (Vec<f64>, f64),
}

impl<const T: usize> Breaking<T> {
    /// Of an unbroken solid.
    #[must_use]
    pub fn new(
        criterion: Criterion,
        cracks: Cracks,
        size: f64,
        stiffness: Vec<f64>,
        axes: Matrix,
    ) -> Self {
        let particles = stiffness.len();
        let most = stiffness.iter().fold(0.0, |most: f64, x| most.max(*x));
        Self {
            criterion,
            boxes: None,
            size,
            axes,
            cracks,
            broken: vec![false; particles],
            list: Vec::new(),
            energy: 0.0,
            released: 0.0,
            first: [f64::NAN; 4],
            trials: BTreeMap::new(),
            stiffness: (stiffness, most),
        }
    }

    /// Forgets what was tried near those that broke.
    pub(super) fn forget(&mut self, fresh: &[usize]) {
        let cracks = &self.cracks;
        let far = |a: &usize| {
            fresh
                .iter()
                .all(|b| cracks.distance(*a, *b) >= 2.0 * AROUND)
        };
        self.trials.retain(|a, _| far(a));
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let boxes = self.boxes.as_ref().map_or(0, Boxes::bytes);
        self.cracks.bytes() + boxes + 9 * self.broken.len()
    }
}
