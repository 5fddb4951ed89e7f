//! The balance of the current: what passes, and the power that it brings.

use crate::case::{PotentialCase, PotentialEdge};
use crate::current::potential::Potential;
use crate::grid::Grid;

impl Potential {
    /// Mean current through a section \[A\], for scale.
    #[must_use]
    pub fn throughput(&self, grid: &Grid) -> f64 {
        let sum = |currents: &[f64]| currents.iter().map(|i| i.abs()).sum::<f64>();
        sum(&self.radial) / (grid.nr + 1) as f64 + sum(&self.axial) / (grid.nz + 1) as f64
    }

    /// Power of the edges and, where there are any, of the cell sources \[W\]: current in times the
    /// potential at which it enters.
    #[must_use]
    pub fn power(&self, grid: &Grid, setup: &PotentialCase) -> f64 {
        let edges = &setup.edges;
        let mut power = 0.0;
        for j in 0..grid.nz {
            let last = grid.nr - 1;
            power += self.edge_power(
                edges.inner[j],
                self.radial[grid.radial_face(0, j)],
                grid.cell(0, j),
            );
            let out = self.radial[grid.radial_face(grid.nr, j)];
            power += self.edge_power(edges.outer[j], -out, grid.cell(last, j));
        }
        for i in 0..grid.nr {
            let last = grid.nz - 1;
            power += self.edge_power(
                edges.bottom[i],
                self.axial[grid.axial_face(i, 0)],
                grid.cell(i, 0),
            );
            let out = self.axial[grid.axial_face(i, grid.nz)];
            power += self.edge_power(edges.top[i], -out, grid.cell(i, last));
        }
        let sources = setup.source.iter().flatten().zip(&self.value);
        power + sources.map(|(s, v)| s * v).sum::<f64>()
    }

    fn edge_power(&self, edge: PotentialEdge, current: f64, k: usize) -> f64 {
        match edge {
            PotentialEdge::Voltage(v) => current * v,
            PotentialEdge::Driven => current * self.drive,
            PotentialEdge::Current(_) => current * self.value[k],
            PotentialEdge::Insulated => 0.0,
        }
    }
}
