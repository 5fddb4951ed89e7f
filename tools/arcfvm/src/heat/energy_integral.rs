//! Heat between cells by the integral of the conductivity over temperature (Kirchhoff 1894).
//!
//! Two cells of one material are joined by the mean of the conductivity between their temperatures,
//!
//! ```text
//! k = 1/(T_E - T_P) integral of k(T) from T_P to T_E
//! ```
//!
//! with which the heat between them is that of a steady state with the law k(T); a cell and an edge of given temperature
//! alike. From a clear bed to another body each half of the way is joined so to the temperature T_f of the face, at which both
//! pass the same heat. All are of second order. The heat then changes with either temperature by no more than the conductivity
//! there: where k(T) jumps it bends, and where halves conduct as their cells do it jumps.

use crate::case::{Case, HeatEdge};
use crate::grid::FaceIndex;
use crate::heat::energy::Energy;
use crate::heat::reads::Around;
use crate::material::{GAS, Law};
use crate::properties::Properties;

/// Halvings of the span in which the temperature of a face is looked for.
const HALVINGS: usize = 40;

/// Two cells that conduct by integrals, through an area of 1 m2 or through their face.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Link {
    /// Heat over the difference of temperatures \[W/(m2 K)\] or \[W/K\].
    conductance: f64,
    /// Change of the heat with either temperature, where the equation takes it along.
    slopes: Option<[f64; 2]>,
}

impl Energy {
    /// Conductances between cells that conduct by integrals, and to edges of given temperature.
    pub(crate) fn integrate(&mut self, around: Around<'_>) {
        let Around {
            case, properties, ..
        } = around;
        let (grid, edges) = (&case.grid, &around.heat.edges);
        let between = Between {
            case,
            properties,
            temperature: &self.temperature,
            bed: case.clear_bed().map(|bed| bed.material),
        };
        for j in 0..grid.nz {
            for i in 1..grid.nr {
                let cells = [grid.cell(i - 1, j), grid.cell(i, j)];
                let ways = [0.5 * grid.dr[i - 1], 0.5 * grid.dr[i]];
                let face = grid.radial_face(i, j);
                let mass = around.mass(FaceIndex::Radial(face));
                let passed = Face::new([grid.rf[i], grid.zc[j]], grid.area(i, j), mass);
                let link = between.through(cells, ways, passed);
                if let Some(link) = link {
                    self.radial[face] = link.conductance;
                }
                if let Some(slopes) = &mut self.slopes {
                    slopes.radial[face] = link.and_then(|link| link.slopes);
                }
            }
            let ends = [edges.inner[j], edges.outer[j]];
            for (edge, (i, face)) in ends.into_iter().zip([(0, 0), (grid.nr - 1, grid.nr)]) {
                let place = [grid.rf[face], grid.zc[j]];
                if let Some(mean) = between.edge(grid.cell(i, j), edge, place) {
                    let conductance = grid.area(face, j) * mean / (0.5 * grid.dr[i]);
                    self.radial[grid.radial_face(face, j)] = conductance;
                }
            }
        }
        for i in 0..grid.nr {
            for j in 1..grid.nz {
                let cells = [grid.cell(i, j - 1), grid.cell(i, j)];
                let ways = [0.5 * grid.dz[j - 1], 0.5 * grid.dz[j]];
                let face = grid.axial_face(i, j);
                let mass = around.mass(FaceIndex::Axial(face));
                let passed = Face::new([grid.rc[i], grid.zf[j]], grid.ring[i], mass);
                let link = between.through(cells, ways, passed);
                if let Some(link) = link {
                    self.axial[face] = link.conductance;
                }
                if let Some(slopes) = &mut self.slopes {
                    slopes.axial[face] = link.and_then(|link| link.slopes);
                }
            }
            let ends = [edges.bottom[i], edges.top[i]];
            for (edge, (j, face)) in ends.into_iter().zip([(0, 0), (grid.nz - 1, grid.nz)]) {
                let place = [grid.rc[i], grid.zf[face]];
                if let Some(mean) = between.edge(grid.cell(i, j), edge, place) {
                    let conductance = grid.ring[i] * mean / (0.5 * grid.dz[j]);
                    self.axial[grid.axial_face(i, face)] = conductance;
                }
            }
        }
    }
}

/// A face between two cells: its middle \[m\], its area \[m2\], and the mass that passes \[kg/s\].
#[derive(Debug, Clone, Copy)]
struct Face {
    place: [f64; 2],
    area: f64,
    mass: f64,
}

impl Face {
    fn new(place: [f64; 2], area: f64, mass: f64) -> Self {
        Self { place, area, mass }
    }
}

/// Cells, their temperatures, and the material of the clear bed, where there is one.
struct Between<'a> {
    case: &'a Case,
    properties: &'a Properties,
    temperature: &'a [f64],
    bed: Option<usize>,
}

impl Between<'_> {
    /// Between two cells with halves of the way `ways` \[m\], where they conduct by integrals.
    fn cells(&self, cells: [usize; 2], ways: [f64; 2], place: [f64; 2]) -> Option<Link> {
        let materials = cells.map(|k| self.case.material[k]);
        let t = cells.map(|k| self.temperature[k]);
        let [first, second] = cells.map(|k| self.case.of(k).thermal_conductivity.as_ref());
        let (first, second) = (first?, second?);
        if materials[0] == materials[1] {
            if !self.case.integrates_conduction() && !self.bed_at(cells) {
                return None;
            }
            let iron = cells.map(|k| self.properties.iron_at(k));
            let iron = 0.5 * (iron[0] + iron[1]);
            let way = ways[0] + ways[1];
            return Some(Link {
                conductance: first.mean(place, t, iron) / way,
                slopes: Some(t.map(|t| first.within(place[0], place[1], t, iron) / way)),
            });
        }
        let solid = materials.iter().all(|m| *m != GAS);
        (solid && self.bed_at(cells)).then(|| meet([first, second], ways, t, place))
    }

    /// Between two cells through a face; slopes only in and around a clear bed, and where no mass passes.
    fn through(&self, cells: [usize; 2], ways: [f64; 2], face: Face) -> Option<Link> {
        let link = self.cells(cells, ways, face.place)?;
        let slopes = link
            .slopes
            .filter(|_| face.mass == 0.0 && self.bed_at(cells));
        Some(Link {
            conductance: face.area * link.conductance,
            slopes: slopes.map(|slopes| slopes.map(|s| face.area * s)),
        })
    }

    /// Whether one of two cells is of the clear bed.
    fn bed_at(&self, cells: [usize; 2]) -> bool {
        let bed = |k: usize| Some(self.case.material[k]) == self.bed;
        cells.into_iter().any(bed)
    }

    /// Between a cell and an edge, where that has a temperature.
    fn edge(&self, k: usize, edge: HeatEdge, place: [f64; 2]) -> Option<f64> {
        let HeatEdge::Temperature(t) = edge else {
            return None;
        };
        if !self.case.integrates_conduction() {
            return None;
        }
        let law = self.case.of(k).thermal_conductivity.as_ref()?;
        Some(law.mean(place, [self.temperature[k], t], self.properties.iron_at(k)))
    }
}

/// Two bodies that meet at a face: each half of the way conducts by the mean between its cell and the face.
fn meet(laws: [&Law; 2], ways: [f64; 2], t: [f64; 2], place: [f64; 2]) -> Link {
    let half = |n: usize, face: f64| laws[n].mean(place, [t[n], face], 0.0) / ways[n];
    // More heat reaches a face that is too near to the second temperature than leaves it.
    let [mut low, mut high] = t;
    for _ in 0..HALVINGS {
        let face = 0.5 * (low + high);
        let beyond = half(0, face) * (t[0] - face) - half(1, face) * (face - t[1]);
        if beyond * (t[0] - t[1]) > 0.0 {
            high = face;
        } else {
            low = face;
        }
    }
    let face = 0.5 * (low + high);
    let at = |n: usize, t: f64| laws[n].at(place[0], place[1], t) / ways[n];
    let [first, second] = [at(0, face), at(1, face)];
    let [near, far] = [half(0, face), half(1, face)];
    Link {
        conductance: near * far / (near + far),
        slopes: Some([
            at(0, t[0]) * second / (first + second),
            at(1, t[1]) * first / (first + second),
        ]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use props::Table;

    /// Flux that conducts forty times as well once it has melted, and metal.
    fn laws() -> [Law; 2] {
        let flux = Table::new(
            vec![300.0, 2550.0, 2600.0, 3000.0],
            vec![1.0, 1.5, 60.0, 70.0],
        );
        [Law::Table(flux.unwrap()), Law::Constant(30.0)]
    }

    #[test]
    fn what_leaves_one_body_reaches_the_other() {
        let laws = laws();
        let [flux, metal] = [&laws[0], &laws[1]];
        let place = [0.0, 0.0];
        for t in [
            [2700.0, 2100.0],
            [2560.0, 2500.0],
            [2000.0, 2900.0],
            [2700.0, 2650.0],
        ] {
            let link = meet([flux, metal], [1e-4, 2e-4], t, place);
            let heat = link.conductance * (t[0] - t[1]);
            // The temperature of the face, from the metal.
            let face = t[1] + heat * 2e-4 / 30.0;
            let given = flux.mean(place, [t[0], face], 0.0) * (t[0] - face) / 1e-4;
            assert!((given / heat - 1.0).abs() < 1e-6, "{t:?}: {given} {heat}");
            let turned = meet([metal, flux], [2e-4, 1e-4], [t[1], t[0]], place);
            assert!((turned.conductance / link.conductance - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn slopes_are_those_of_the_heat() {
        let laws = laws();
        let heat = |t: [f64; 2]| {
            meet([&laws[0], &laws[1]], [1e-4, 2e-4], t, [0.0, 0.0]).conductance * (t[0] - t[1])
        };
        for t in [[2700.0, 2100.0], [2575.0, 2500.0], [2000.0, 2900.0]] {
            let link = meet([&laws[0], &laws[1]], [1e-4, 2e-4], t, [0.0, 0.0]);
            let slopes = link.slopes.unwrap();
            let step = 0.01;
            let own = (heat([t[0] + step, t[1]]) - heat([t[0] - step, t[1]])) / (2.0 * step);
            let other = (heat([t[0], t[1] - step]) - heat([t[0], t[1] + step])) / (2.0 * step);
            assert!(
                (slopes[0] / own - 1.0).abs() < 1e-3,
                "{t:?}: {slopes:?} {own}"
            );
            assert!(
                (slopes[1] / other - 1.0).abs() < 1e-3,
                "{t:?}: {slopes:?} {other}"
            );
        }
    }
}
