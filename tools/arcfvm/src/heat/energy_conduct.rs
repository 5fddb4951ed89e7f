//! How heat is conducted from one cell to the next: conductances of all faces.
//!
//! Half of the way conducts as its cell does, in series with the other half; or as the integral of the conductivity over
//! temperature says, where the scene asks for that (`energy_integral`).

use crate::heat::energy::Energy;
use crate::heat::reads::Around;

impl Energy {
    /// Conductances at the present temperatures.
    pub fn conduct(&mut self, around: Around<'_>) {
        let case = around.case;
        let (grid, kappa) = (&case.grid, &around.properties.thermal);
        let series = |a: f64, b: f64, area: f64| if a + b > 0.0 { area / (a + b) } else { 0.0 };
        for j in 0..grid.nz {
            for i in 0..=grid.nr {
                let half = |c: usize| 0.5 * grid.dr[c] / kappa[grid.cell(c, j)];
                let west = if i > 0 { half(i - 1) } else { 0.0 };
                let east = if i < grid.nr { half(i) } else { 0.0 };
                self.radial[grid.radial_face(i, j)] = series(west, east, grid.area(i, j));
            }
        }
        for j in 0..=grid.nz {
            for i in 0..grid.nr {
                let half = |c: usize| 0.5 * grid.dz[c] / kappa[grid.cell(i, c)];
                let south = if j > 0 { half(j - 1) } else { 0.0 };
                let north = if j < grid.nz { half(j) } else { 0.0 };
                self.axial[grid.axial_face(i, j)] = series(south, north, grid.ring[i]);
            }
        }
        if case.integrates_conduction() || case.clear_bed().is_some() {
            self.integrate(around);
        }
        if let Some(surfaces) = &case.surfaces {
            self.resist(around, surfaces);
            self.conduct_surfaces(around, surfaces);
        }
    }
}
