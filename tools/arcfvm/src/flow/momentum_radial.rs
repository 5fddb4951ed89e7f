//! Radial momentum on the radially staggered cells (Komen 2019, eqs 3.3, 3.7 to 3.33, 5.1).
//!
//! The cell of radial face `i` of row `j` reaches from centre `i - 1` to centre `i`. Mass fluxes
//! through its faces are means of the fluxes of the two scalar cells, so they balance when those do.
//! The indices of the cross terms are those of eq. 3.20, `u_z[i] - u_z[i-1]` (eq. 3.32 prints
//! others). At a wall the shear acts over half a cell (eq. 5.6), and the neighbour's coefficient is
//! left out there. Neglected: the dilatation part of the stress.

use std::f64::consts::PI;

use relax::Coefficients;

use crate::case::{Case, Face, FlowCase, FlowEdge};
use crate::equation::transport::{hybrid, unbalanced};
use crate::flow::edge_shear::Rows;
use crate::flow::field::Flow;
use crate::flow::momentum_side::{Across, Half, Side, corner_viscosity};

/// What the radial momentum equation reads.
pub struct RadialMomentum<'a> {
    /// The problem.
    pub case: &'a Case,
    /// The flow's setup.
    pub setup: &'a FlowCase,
    /// The flow of the last iteration.
    pub flow: &'a Flow,
    /// Viscosity of each cell \[Pa s\].
    pub viscosity: &'a [f64],
    /// Lorentz force at radial faces \[N/m3\].
    pub lorentz: Option<&'a [f64]>,
}

impl RadialMomentum<'_> {
    /// The equation of radial face `i` of row `j`.
    #[must_use]
    pub fn equation(&self, i: usize, j: usize) -> Coefficients {
        let (grid, flow) = (&self.case.grid, self.flow);
        let face = grid.radial_face(i, j);
        if let Face::Fixed(value) = self.setup.faces.radial[face] {
            return Coefficients::fixed(value);
        }
        let mut c = Coefficients::default();
        let (start, end) = (
            grid.rc[i - 1],
            if i < grid.nr { grid.rc[i] } else { grid.rf[i] },
        );
        let width = 2.0 * PI * grid.dz[j];
        let west = grid.cell(i - 1, j);
        let through = |at: usize| 0.5 * (flow.mass_radial[at] + flow.mass_radial[at + 1]);
        let stretch = 2.0 * self.viscosity[west] * width * start / grid.dr[i - 1];
        c.west = hybrid(-through(face - 1), stretch);
        let mut pressure_beyond = 0.0;
        if i < grid.nr {
            let east = grid.cell(i, j);
            let stretch = 2.0 * self.viscosity[east] * width * end / grid.dr[i];
            c.east = hybrid(through(face), stretch);
            pressure_beyond = flow.pressure[east];
        } else {
            // Gas drawn in comes from rest, so that its dynamic pressure is lost.
            c.centre += (-flow.mass_radial[face]).max(0.0);
            if let FlowEdge::Open(p) = self.setup.edges.outer[j] {
                pressure_beyond = p;
            }
        }
        let (south, north) = (self.side(i, j, false), self.side(i, j, true));
        (c.south, c.north) = (south.neighbour, north.neighbour);
        let mean = self.mean_viscosity(i, j);
        // The integral of u / r for u in proportion to r, as at the axis.
        let hoop = 2.0 * mean * width * (end - start) / grid.rf[i];
        c.centre += c.east + c.west + c.south + c.north + south.centre + north.centre + hoop;
        c.source = south.source + north.source;
        c.source += grid.area(i, j) * (flow.pressure[west] - pressure_beyond);
        let volume = 0.5 * width * (end * end - start * start);
        c.source += volume * self.force(face);
        let east = if i < grid.nr {
            through(face)
        } else {
            flow.mass_radial[face]
        };
        let outflow = east - through(face - 1) + south.outflow + north.outflow;
        unbalanced(&mut c, outflow, flow.radial[face]);
        c
    }

    fn force(&self, face: usize) -> f64 {
        let lorentz = self.lorentz.map_or(0.0, |f| f[face]);
        lorentz + self.setup.force.as_ref().map_or(0.0, |f| f[0][face])
    }

    /// Harmonic mean of the two cells beside the face.
    fn mean_viscosity(&self, i: usize, j: usize) -> f64 {
        let grid = &self.case.grid;
        let west = self.viscosity[grid.cell(i - 1, j)];
        if i == grid.nr {
            return west;
        }
        let east = self.viscosity[grid.cell(i, j)];
        2.0 * west * east / (west + east)
    }

    /// The northern or southern side, its halves in the scalar cells `i - 1` and `i`.
    fn side(&self, i: usize, j: usize, north: bool) -> Side {
        let (grid, flow) = (&self.case.grid, self.flow);
        let (at, sign) = if north { (j + 1, 1.0) } else { (j, -1.0) };
        let inside = if north { j + 1 < grid.nz } else { j > 0 };
        let row = if north { j + 1 } else { j.wrapping_sub(1) };
        let columns = i - 1..=i.min(grid.nr - 1);
        let across = |column: usize| {
            if inside {
                return Across::inside(self.case.is_gas(column, row));
            }
            let edge = if north {
                self.setup.edges.top[column]
            } else {
                self.setup.edges.bottom[column]
            };
            match edge {
                FlowEdge::Velocity([own, _]) => {
                    let value = self.at_corner(i, north).unwrap_or(own);
                    Across::Moves(value, self.rows(i, j, column, value))
                }
                FlowEdge::Open(_) => Across::Open,
                FlowEdge::Slip => Across::Slip,
            }
        };
        let halves = columns.clone().map(|column| {
            let area = PI * (grid.rf[i] * grid.rf[i] - grid.rc[column] * grid.rc[column]).abs();
            Half {
                area,
                flux: 0.5 * sign * flow.mass_axial[grid.axial_face(column, at)],
                viscosity: self.viscosity[grid.cell(column, j)],
                depth: 0.5 * grid.dz[j],
                across: across(column),
            }
        });
        Side::of(sign * self.cross(i, at), halves, || {
            let cells = columns.flat_map(|column| [j, row].map(|row| (column, row)));
            let viscosity = corner_viscosity(self.case, self.viscosity, cells);
            (viscosity, (grid.zc[row] - grid.zc[j]).abs())
        })
    }

    /// The given velocity of the upper or lower edge at radial face `i`, where it is given on both
    /// sides of it.
    fn at_corner(&self, i: usize, north: bool) -> Option<f64> {
        let grid = &self.case.grid;
        let edges = if north {
            &self.setup.edges.top
        } else {
            &self.setup.edges.bottom
        };
        match (edges[i - 1], edges.get(i)) {
            (FlowEdge::Velocity([west, _]), Some(FlowEdge::Velocity([east, _]))) => {
                let part = (grid.rf[i] - grid.rc[i - 1]) / (grid.rc[i] - grid.rc[i - 1]);
                Some(west + part * (east - west))
            }
            _ => None,
        }
    }

    /// The rows inward of an edge of the domain beside row `j`, where the second one is gas as well.
    fn rows(&self, i: usize, j: usize, column: usize, edge: f64) -> Option<Rows> {
        let grid = &self.case.grid;
        let inner = if j + 1 == grid.nz {
            j.checked_sub(1)?
        } else {
            j + 1
        };
        if j > 0 && j + 1 < grid.nz || inner >= grid.nz || !self.case.is_gas(column, inner) {
            return None;
        }
        let viscosity = |row| self.viscosity[grid.cell(column, row)];
        let velocity = |row| self.flow.radial[grid.radial_face(i, row)];
        let near = 0.5 * grid.dz[j];
        Some(Rows {
            velocity: [edge, velocity(j), velocity(inner)],
            viscosity: [viscosity(j), viscosity(inner)],
            distance: [near, near + (grid.zc[inner] - grid.zc[j]).abs()],
        })
    }

    /// Radial slope of the axial velocity at the corner of radial face `i` and axial face `at`.
    fn cross(&self, i: usize, at: usize) -> f64 {
        let grid = &self.case.grid;
        if i == grid.nr {
            return 0.0;
        }
        let east = self.flow.axial[grid.axial_face(i, at)];
        let west = self.flow.axial[grid.axial_face(i - 1, at)];
        (east - west) / (grid.rc[i] - grid.rc[i - 1])
    }
}
