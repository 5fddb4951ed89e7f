//! Values on the four sides of the domain.

use crate::grid::Grid;

/// One value per face of the four sides of the domain.
#[derive(Debug, Clone, PartialEq)]
pub struct Edges<T> {
    /// Smallest radius (the axis, if that is zero), `[nz]`.
    pub inner: Vec<T>,
    /// Largest radius, `[nz]`.
    pub outer: Vec<T>,
    /// Lowest height, `[nr]`.
    pub bottom: Vec<T>,
    /// Greatest height, `[nr]`.
    pub top: Vec<T>,
}

impl<T: Clone> Edges<T> {
    /// The same value everywhere.
    #[must_use]
    pub fn uniform(grid: &Grid, value: T) -> Self {
        Self {
            inner: vec![value.clone(); grid.nz],
            outer: vec![value.clone(); grid.nz],
            bottom: vec![value.clone(); grid.nr],
            top: vec![value; grid.nr],
        }
    }
}
