//! Surfaces of conductors, with the rows of phi on them.

use crate::magnetic::charge::rate::Rate;

/// A point on the surface of a conductor towards what does not conduct.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// Its point.
    pub point: u32,
    /// Its unknown of phi.
    pub unknown: u32,
    /// The normal, as it stands in the row of phi.
    pub normal: [f64; 3],
    /// One over the size of the normal there.
    pub share: f64,
}

impl Surface {
    /// The part along the normal, of a column.
    pub(crate) fn normal_part<S: Rate, const K: usize>(&self, row: &[[S; K]; 3], c: usize) -> S {
        let parts = row.iter().zip(self.normal);
        parts.map(|(a, n)| a[c].times_real(n)).sum()
    }

    /// Adds along the normal.
    pub(crate) fn add<S: Rate, const K: usize>(&self, row: &mut [[S; K]; 3], c: usize, what: S) {
        for (a, n) in row.iter_mut().zip(self.normal) {
            a[c] += what.times_real(n);
        }
    }
}
