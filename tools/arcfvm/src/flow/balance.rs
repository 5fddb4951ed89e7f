//! The balance of mass and forces, and what each is measured by.

use crate::case::{Case, Face, FlowCase};
use crate::flow::field::Flow;
use crate::grid::Grid;
use crate::material::GAS;

impl Flow {
    /// Mass that leaves cell `(i, j)` more than enters it \[kg/s\].
    #[must_use]
    pub fn imbalance(&self, grid: &Grid, i: usize, j: usize) -> f64 {
        let (r, z) = (grid.radial_face(i, j), grid.axial_face(i, j));
        let out = self.mass_radial[r + 1] - self.mass_radial[r] + self.mass_axial[z + grid.nr]
            - self.mass_axial[z];
        match self.mass_source.get(grid.cell(i, j)) {
            Some(source) => out - source,
            None => out,
        }
    }

    /// Mean mass flow through a section \[kg/s\], for scale: that found, or that which the range of
    /// pressure could drive.
    #[must_use]
    pub fn throughput(&self, case: &Case, density: &[f64]) -> f64 {
        let grid = &case.grid;
        let sum = |fluxes: &[f64]| fluxes.iter().map(|m| m.abs()).sum::<f64>();
        let found = sum(&self.mass_radial) / (grid.nr + 1) as f64
            + sum(&self.mass_axial) / (grid.nz + 1) as f64;
        let gas = |k: &usize| case.material[*k] == GAS;
        let range = |values: &[f64]| {
            let cells = (0..grid.len()).filter(gas).map(|k| values[k]);
            cells.fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(v), b.max(v)))
        };
        let (low, high) = range(&self.pressure);
        let (_, densest) = range(density);
        let section: f64 = grid.ring.iter().sum();
        found + section * ((high - low).max(0.0) * densest.max(0.0)).sqrt()
    }

    /// Sum of the volume forces \[N\], for scale.
    #[must_use]
    pub fn forces(
        &self,
        case: &Case,
        setup: &FlowCase,
        lorentz: Option<[&[f64]; 2]>,
        density: &[f64],
    ) -> f64 {
        let grid = &case.grid;
        let given = setup
            .force
            .as_ref()
            .map(|f| [f[0].as_slice(), f[1].as_slice()]);
        let mut sum = 0.0;
        if let Some(g) = setup.gravity {
            for k in (0..grid.len()).filter(|k| case.material[*k] == GAS) {
                let volume = grid.volume(k % grid.nr, k / grid.nr);
                sum += g.acceleration * (density[k] - g.reference_density).abs() * volume;
            }
        }
        for [radial, axial] in [lorentz, given].into_iter().flatten() {
            for (k, force) in radial.iter().enumerate() {
                if setup.faces.radial[k] == Face::Solved {
                    let (i, j) = (k % (grid.nr + 1), k / (grid.nr + 1));
                    sum += force.abs() * grid.volume(i.min(grid.nr - 1), j);
                }
            }
            for (k, force) in axial.iter().enumerate() {
                if setup.faces.axial[k] == Face::Solved {
                    let (i, j) = (k % grid.nr, k / grid.nr);
                    sum += force.abs() * grid.volume(i, j.min(grid.nz - 1));
                }
            }
        }
        sum
    }

    /// Sum of the mass that cells lack or have too much of \[kg/s\].
    #[must_use]
    pub fn unbalanced(&self, grid: &Grid) -> f64 {
        let cells = (0..grid.nz).flat_map(|j| (0..grid.nr).map(move |i| (i, j)));
        cells.map(|(i, j)| self.imbalance(grid, i, j).abs()).sum()
    }
}
