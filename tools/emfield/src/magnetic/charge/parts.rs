//! What the equations of A and phi are made of, and sums over columns.

use crate::magnetic::charge::potential::Charge;
use crate::magnetic::charge::rate::Rate;
use crate::magnetic::diffusion::Conductors;
use crate::stencils::region::Region;
use crate::stencils::sides::Sides;

/// Rows that one task gathers.
pub(crate) const ROWS: usize = 512;

/// What the equations are made of.
#[derive(Debug, Clone, Copy)]
pub struct Parts<'a> {
    /// Points.
    pub region: &'a Region<3>,
    /// Stencils of A.
    pub sides: &'a Sides<3>,
    /// `mu sigma` by medium.
    pub conductors: &'a Conductors,
    /// Conductivity by medium \[S/m\].
    pub conductivity: &'a [f64],
    /// Stencils of phi.
    pub charge: &'a Charge,
}

/// Numbers as rows of one column.
pub(crate) fn ones<S>(values: &[S]) -> &[[S; 1]] {
    values.as_chunks::<1>().0
}

/// Adds `w x` to a sum, column by column.
pub(crate) fn add<S: Rate, const K: usize>(sum: &mut [S; K], x: &[S; K], w: f64) {
    for (sum, x) in sum.iter_mut().zip(x) {
        *sum += x.times_real(w);
    }
}
