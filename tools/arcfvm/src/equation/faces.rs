//! The four faces of a cell as a transported quantity sees them.

use crate::edges::Side;
use crate::grid::{FaceIndex, Grid};

/// What lies beyond a face.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Beyond {
    Cell(usize),
    Edge(Side),
}

/// A face as its cell sees it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FaceOf {
    pub(crate) own: usize,
    pub(crate) beyond: Beyond,
    pub(crate) at: FaceIndex,
    /// Whether the face lies at the smaller radius or height of its cell.
    pub(crate) before: bool,
    pub(crate) mass_out: f64,
    pub(crate) conductance: f64,
    pub(crate) area: f64,
}

/// Mass fluxes and conductances at the faces of the grid.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Carriers<'a, M> {
    /// Mass flux through a face, outward or upward \[kg/s\].
    pub(crate) mass: M,
    /// Conductance of radial faces.
    pub(crate) radial: &'a [f64],
    /// Conductance of axial faces.
    pub(crate) axial: &'a [f64],
}

impl<M: Fn(FaceIndex) -> f64> Carriers<'_, M> {
    /// East, west, north and south of cell `(i, j)`.
    pub(crate) fn faces(&self, grid: &Grid, i: usize, j: usize) -> [FaceOf; 4] {
        let own = grid.cell(i, j);
        let radial = |at: usize, sign: f64, beyond: Beyond| {
            let face = grid.radial_face(at, j);
            let index = FaceIndex::Radial(face);
            FaceOf {
                own,
                beyond,
                at: index,
                before: sign < 0.0,
                mass_out: sign * (self.mass)(index),
                conductance: self.radial[face],
                area: grid.area(at, j),
            }
        };
        let axial = |at: usize, sign: f64, beyond: Beyond| {
            let face = grid.axial_face(i, at);
            let index = FaceIndex::Axial(face);
            FaceOf {
                own,
                beyond,
                at: index,
                before: sign < 0.0,
                mass_out: sign * (self.mass)(index),
                conductance: self.axial[face],
                area: grid.ring[i],
            }
        };
        let side = |inside: bool, cell: usize, edge: Side| {
            if inside {
                Beyond::Cell(cell)
            } else {
                Beyond::Edge(edge)
            }
        };
        [
            radial(i + 1, 1.0, side(i + 1 < grid.nr, own + 1, Side::Outer(j))),
            radial(i, -1.0, side(i > 0, own.wrapping_sub(1), Side::Inner(j))),
            axial(
                j + 1,
                1.0,
                side(j + 1 < grid.nz, own + grid.nr, Side::Top(i)),
            ),
            axial(
                j,
                -1.0,
                side(j > 0, own.wrapping_sub(grid.nr), Side::Bottom(i)),
            ),
        ]
    }
}
