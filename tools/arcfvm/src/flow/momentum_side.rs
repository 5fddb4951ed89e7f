//! The sides of a staggered cell along which its velocity runs (Komen 2019, eqs 3.20 to 3.33, 5.6).
//!
//! Each side has two halves, in the two scalar cells that the staggered one overlaps: they open to gas, meet a wall or
//! are edges of the domain. At a wall the shear acts over half a cell. The slope of the other velocity along the side is
//! the other part of the shear.

use crate::case::Case;
use crate::equation::transport::{dirichlet, hybrid};
use crate::flow::edge_shear::Rows;

/// What lies across half of a side.
pub(crate) enum Across {
    /// Gas, in the next cell.
    Gas,
    /// A body, at rest.
    Body,
    /// An edge of this velocity, with the rows inward of it where there are two.
    Moves(f64, Option<Rows>),
    /// An edge that gas passes.
    Open,
    /// An edge without shear.
    Slip,
}

impl Across {
    /// Within the domain.
    pub(crate) fn inside(gas: bool) -> Self {
        if gas { Self::Gas } else { Self::Body }
    }
}

/// Half of a side.
pub(crate) struct Half {
    /// Area \[m2\].
    pub(crate) area: f64,
    /// Mass that leaves through it \[kg/s\].
    pub(crate) flux: f64,
    /// Viscosity of the scalar cell on this side of it \[Pa s\].
    pub(crate) viscosity: f64,
    /// Distance from the middle of the cell \[m\].
    pub(crate) depth: f64,
    /// What lies across.
    pub(crate) across: Across,
}

/// What a side puts into the equation of its cell.
#[derive(Default)]
pub(crate) struct Side {
    /// Coefficient of the velocity in the next cell \[kg/s\].
    pub(crate) neighbour: f64,
    /// What it adds to the central coefficient beside that \[kg/s\].
    pub(crate) centre: f64,
    /// Force \[N\].
    pub(crate) source: f64,
    /// Mass that leaves \[kg/s\].
    pub(crate) outflow: f64,
}

impl Side {
    /// A side of these halves, across which the other velocity has the slope `cross` \[1/s\], positive outward; `beyond`
    /// gives viscosity \[Pa s\] and distance \[m\] between the middles of the cells, where there is gas in the next one.
    pub(crate) fn of(
        cross: f64,
        halves: impl Iterator<Item = Half>,
        beyond: impl FnOnce() -> (f64, f64),
    ) -> Self {
        let mut side = Self::default();
        let (mut open_flux, mut open_area) = (0.0, 0.0);
        for half in halves {
            let Half { area, flux, .. } = half;
            let wall = half.viscosity * area / half.depth;
            side.outflow += flux;
            match half.across {
                Across::Gas => {
                    open_flux += flux;
                    open_area += area;
                }
                Across::Body => side.centre += wall,
                Across::Moves(value, rows) => {
                    let a = dirichlet(flux, wall);
                    let viscosity = rows.map_or(half.viscosity, |r| r.edge_viscosity());
                    let excess = rows.map_or(0.0, |r| r.excess());
                    side.centre += a;
                    side.source += a * value + area * (excess + viscosity * cross);
                }
                Across::Open => {
                    // No slope of this velocity along the outflow; the other part of the shear stays.
                    side.centre += (-flux).max(0.0);
                    side.source += half.viscosity * area * cross;
                }
                Across::Slip => {}
            }
        }
        if open_area > 0.0 {
            let (viscosity, distance) = beyond();
            let shear = viscosity * open_area;
            side.neighbour = hybrid(open_flux, shear / distance);
            side.source += shear * cross;
        }
        side
    }
}

/// Harmonic mean over those of the cells around a corner that are gas \[Pa s\].
pub(crate) fn corner_viscosity(
    case: &Case,
    viscosity: &[f64],
    cells: impl Iterator<Item = (usize, usize)>,
) -> f64 {
    let (mut count, mut sum) = (0.0, 0.0);
    for (column, row) in cells.filter(|(column, row)| case.is_gas(*column, *row)) {
        count += 1.0;
        sum += 1.0 / viscosity[case.grid.cell(column, row)];
    }
    count / sum
}
