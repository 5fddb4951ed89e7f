//! Axial momentum on the axially staggered cells (Komen 2019, eqs 3.4, 5.2).
//!
//! The cell of axial face `j` of column `i` reaches from centre `j - 1` to centre `j`. Treated as
//! the radial momentum is; gravity acts on the excess over the density of the gas at rest, whose
//! weight the pressure leaves out, so that a fixed pressure at open edges lets gas rest there.

use std::f64::consts::PI;

use relax::Coefficients;

use crate::case::{Case, Face, FlowCase, FlowEdge};
use crate::equation::transport::{hybrid, unbalanced};
use crate::flow::edge_shear::Rows;
use crate::flow::field::Flow;
use crate::flow::momentum_side::{Across, Half, Side, corner_viscosity};

/// What the axial momentum equation reads.
pub struct AxialMomentum<'a> {
    /// The problem.
    pub case: &'a Case,
    /// The flow's setup.
    pub setup: &'a FlowCase,
    /// The flow of the last iteration.
    pub flow: &'a Flow,
    /// Viscosity of each cell \[Pa s\].
    pub viscosity: &'a [f64],
    /// Density of each cell \[kg/m3\].
    pub density: &'a [f64],
    /// Lorentz force at axial faces \[N/m3\].
    pub lorentz: Option<&'a [f64]>,
}

impl AxialMomentum<'_> {
    /// The equation of axial face `j` of column `i`.
    #[must_use]
    pub fn equation(&self, i: usize, j: usize) -> Coefficients {
        let (grid, flow) = (&self.case.grid, self.flow);
        let face = grid.axial_face(i, j);
        if let Face::Fixed(value) = self.setup.faces.axial[face] {
            return Coefficients::fixed(value);
        }
        let mut c = Coefficients::default();
        let ring = grid.ring[i];
        let through = |at: usize| 0.5 * (flow.mass_axial[at] + flow.mass_axial[at + grid.nr]);
        let open = |edge: FlowEdge| if let FlowEdge::Open(p) = edge { p } else { 0.0 };
        let (start, below) = if j > 0 {
            let south = grid.cell(i, j - 1);
            let stretch = 2.0 * self.viscosity[south] * ring / grid.dz[j - 1];
            c.south = hybrid(-through(face - grid.nr), stretch);
            (grid.zc[j - 1], flow.pressure[south])
        } else {
            // Gas drawn in comes from rest, so that its dynamic pressure is lost.
            c.centre += flow.mass_axial[face].max(0.0);
            (grid.zf[0], open(self.setup.edges.bottom[i]))
        };
        let (end, above) = if j < grid.nz {
            let north = grid.cell(i, j);
            let stretch = 2.0 * self.viscosity[north] * ring / grid.dz[j];
            c.north = hybrid(through(face), stretch);
            (grid.zc[j], flow.pressure[north])
        } else {
            c.centre += (-flow.mass_axial[face]).max(0.0);
            (grid.zf[j], open(self.setup.edges.top[i]))
        };
        let (west, east) = (self.side(i, j, false), self.side(i, j, true));
        (c.west, c.east) = (west.neighbour, east.neighbour);
        c.centre += c.east + c.west + c.south + c.north + west.centre + east.centre;
        c.source = west.source + east.source + ring * (below - above);
        c.source += ring * (end - start) * self.force(i, j);
        let south = if j > 0 {
            -through(face - grid.nr)
        } else {
            -flow.mass_axial[face]
        };
        let north = if j < grid.nz {
            through(face)
        } else {
            flow.mass_axial[face]
        };
        let outflow = south + north + west.outflow + east.outflow;
        unbalanced(&mut c, outflow, flow.axial[face]);
        c
    }

    fn force(&self, i: usize, j: usize) -> f64 {
        let grid = &self.case.grid;
        let face = grid.axial_face(i, j);
        let mut force = self.lorentz.map_or(0.0, |f| f[face]);
        if let Some(g) = self.setup.gravity {
            let at = |row: usize| self.density[grid.cell(i, row)];
            let density = 0.5 * (at(j.saturating_sub(1)) + at(j.min(grid.nz - 1)));
            force -= g.acceleration * (density - g.reference_density);
        }
        force + self.setup.force.as_ref().map_or(0.0, |f| f[1][face])
    }

    /// The eastern or western side, its halves in the scalar cells `j - 1` and `j`.
    fn side(&self, i: usize, j: usize, east: bool) -> Side {
        let (grid, flow) = (&self.case.grid, self.flow);
        let (at, sign) = if east { (i + 1, 1.0) } else { (i, -1.0) };
        let inside = if east { i + 1 < grid.nr } else { i > 0 };
        let column = if east { i + 1 } else { i.wrapping_sub(1) };
        let rows = j.saturating_sub(1)..=j.min(grid.nz - 1);
        let across = |row: usize| {
            if inside {
                return Across::inside(self.case.is_gas(column, row));
            }
            let edge = if east {
                self.setup.edges.outer[row]
            } else {
                self.setup.edges.inner[row]
            };
            match edge {
                FlowEdge::Velocity([_, own]) => {
                    let value = self.at_corner(j, east).unwrap_or(own);
                    Across::Moves(value, self.columns(i, j, row, value))
                }
                FlowEdge::Open(_) => Across::Open,
                FlowEdge::Slip => Across::Slip,
            }
        };
        let halves = rows.clone().map(|row| Half {
            // The axis has no area.
            area: PI * grid.rf[at] * grid.dz[row],
            flux: 0.5 * sign * flow.mass_radial[grid.radial_face(at, row)],
            viscosity: self.viscosity[grid.cell(i, row)],
            depth: 0.5 * grid.dr[i],
            across: across(row),
        });
        Side::of(sign * self.cross(at, j), halves, || {
            let cells = rows.flat_map(|row| [i, column].map(|column| (column, row)));
            let viscosity = corner_viscosity(self.case, self.viscosity, cells);
            (viscosity, (grid.rc[column] - grid.rc[i]).abs())
        })
    }

    /// The given velocity of the outer or inner edge at axial face `j`, where it is given on both
    /// sides of it.
    fn at_corner(&self, j: usize, east: bool) -> Option<f64> {
        let grid = &self.case.grid;
        let edges = if east {
            &self.setup.edges.outer
        } else {
            &self.setup.edges.inner
        };
        match (edges[j.checked_sub(1)?], edges.get(j)) {
            (FlowEdge::Velocity([_, south]), Some(FlowEdge::Velocity([_, north]))) => {
                let part = (grid.zf[j] - grid.zc[j - 1]) / (grid.zc[j] - grid.zc[j - 1]);
                Some(south + part * (north - south))
            }
            _ => None,
        }
    }

    /// The columns inward of an edge of the domain beside column `i`, where the second one is gas.
    fn columns(&self, i: usize, j: usize, row: usize, edge: f64) -> Option<Rows> {
        let grid = &self.case.grid;
        let inner = if i + 1 == grid.nr {
            i.checked_sub(1)?
        } else {
            i + 1
        };
        if i > 0 && i + 1 < grid.nr || inner >= grid.nr || !self.case.is_gas(inner, row) {
            return None;
        }
        let viscosity = |column| self.viscosity[grid.cell(column, row)];
        let velocity = |column| self.flow.axial[grid.axial_face(column, j)];
        let near = 0.5 * grid.dr[i];
        Some(Rows {
            velocity: [edge, velocity(i), velocity(inner)],
            viscosity: [viscosity(i), viscosity(inner)],
            distance: [near, near + (grid.rc[inner] - grid.rc[i]).abs()],
        })
    }

    /// Axial slope of the radial velocity at the corner of radial face `at` and axial face `j`.
    fn cross(&self, at: usize, j: usize) -> f64 {
        let grid = &self.case.grid;
        if j == 0 || j == grid.nz {
            return 0.0;
        }
        let above = self.flow.radial[grid.radial_face(at, j)];
        let below = self.flow.radial[grid.radial_face(at, j - 1)];
        (above - below) / (grid.zc[j] - grid.zc[j - 1])
    }
}
