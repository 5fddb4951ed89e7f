//! How heat is conducted from one cell to the next: conductances of all faces.
//!
//! Half of the way conducts as its cell does, in series with the other half. Where the scene asks for integrals, two cells of
//! one material are joined by the mean of the conductivity between their temperatures,
//!
//! ```text
//! k = 1/(T_E - T_P) integral of k(T) from T_P to T_E
//! ```
//!
//! with which the heat between them is that of a steady state with the law k(T) (Kirchhoff 1894); a cell and an edge of given
//! temperature alike. Both are of second order. The heat `k (T_E - T_P)` then changes with either temperature by no more than
//! the conductivity there: where k(T) jumps it bends, and where halves conduct as their cells do it jumps.

use crate::case::{Case, HeatEdge};
use crate::fields::energy::Energy;
use crate::heat::Surfaces;
use crate::properties::Properties;

impl Energy {
    /// Conductances at the present temperatures.
    pub fn conduct(&mut self, case: &Case, surfaces: Option<&Surfaces>, properties: &Properties) {
        let (grid, kappa) = (&case.grid, &properties.thermal);
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
        if case.integrates_conduction() {
            self.integrate(case, properties);
        }
        if let Some(surfaces) = surfaces {
            self.resist(case, surfaces, properties);
            self.conduct_surfaces(case, surfaces, properties);
        }
    }

    /// Conductances between cells of one material, and to edges of given temperature, by the mean between their
    /// temperatures.
    fn integrate(&mut self, case: &Case, properties: &Properties) {
        let grid = &case.grid;
        let between = Between {
            case,
            properties,
            temperature: &self.temperature,
        };
        for j in 0..grid.nz {
            for i in 1..grid.nr {
                let cells = [grid.cell(i - 1, j), grid.cell(i, j)];
                if let Some(mean) = between.cells(cells, [grid.rf[i], grid.zc[j]]) {
                    let way = 0.5 * (grid.dr[i - 1] + grid.dr[i]);
                    self.radial[grid.radial_face(i, j)] = grid.area(i, j) * mean / way;
                }
            }
            let edges = case
                .heat
                .as_ref()
                .map(|h| [h.edges.inner[j], h.edges.outer[j]]);
            for (edge, (i, face)) in edges.iter().flatten().zip([(0, 0), (grid.nr - 1, grid.nr)]) {
                let place = [grid.rf[face], grid.zc[j]];
                if let Some(mean) = between.edge(grid.cell(i, j), *edge, place) {
                    let conductance = grid.area(face, j) * mean / (0.5 * grid.dr[i]);
                    self.radial[grid.radial_face(face, j)] = conductance;
                }
            }
        }
        for i in 0..grid.nr {
            for j in 1..grid.nz {
                let cells = [grid.cell(i, j - 1), grid.cell(i, j)];
                if let Some(mean) = between.cells(cells, [grid.rc[i], grid.zf[j]]) {
                    let way = 0.5 * (grid.dz[j - 1] + grid.dz[j]);
                    self.axial[grid.axial_face(i, j)] = grid.ring[i] * mean / way;
                }
            }
            let edges = case
                .heat
                .as_ref()
                .map(|h| [h.edges.bottom[i], h.edges.top[i]]);
            for (edge, (j, face)) in edges.iter().flatten().zip([(0, 0), (grid.nz - 1, grid.nz)]) {
                let place = [grid.rc[i], grid.zf[face]];
                if let Some(mean) = between.edge(grid.cell(i, j), *edge, place) {
                    let conductance = grid.ring[i] * mean / (0.5 * grid.dz[j]);
                    self.axial[grid.axial_face(i, face)] = conductance;
                }
            }
        }
    }
}

/// Mean conductivities between temperatures.
struct Between<'a> {
    case: &'a Case,
    properties: &'a Properties,
    temperature: &'a [f64],
}

impl Between<'_> {
    /// Between two cells, where they are of one material.
    fn cells(&self, [a, b]: [usize; 2], place: [f64; 2]) -> Option<f64> {
        let law = self.case.of(a).thermal_conductivity.as_ref();
        let law = law.filter(|_| self.case.material[a] == self.case.material[b])?;
        let iron = 0.5 * (self.properties.iron_at(a) + self.properties.iron_at(b));
        Some(law.mean(place, [a, b].map(|k| self.temperature[k]), iron))
    }

    /// Between a cell and an edge, where that has a temperature.
    fn edge(&self, k: usize, edge: HeatEdge, place: [f64; 2]) -> Option<f64> {
        let HeatEdge::Temperature(t) = edge else {
            return None;
        };
        let law = self.case.of(k).thermal_conductivity.as_ref()?;
        Some(law.mean(place, [self.temperature[k], t], self.properties.iron_at(k)))
    }
}
