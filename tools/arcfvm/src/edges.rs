//! Values on the four sides of the domain.

use crate::grid::Grid;

/// A side of the domain with the index along it.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Side {
    Inner(usize),
    Outer(usize),
    Bottom(usize),
    Top(usize),
}

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

impl<T> Edges<T> {
    /// The value at one face of the edge.
    pub(crate) fn at(&self, side: Side) -> &T {
        match side {
            Side::Inner(j) => &self.inner[j],
            Side::Outer(j) => &self.outer[j],
            Side::Bottom(i) => &self.bottom[i],
            Side::Top(i) => &self.top[i],
        }
    }
}
