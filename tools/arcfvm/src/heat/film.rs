//! The film of gas on an electrode, of a thickness that does not follow the cells.
//!
//! The source takes the gas of the first cell as that beyond the film (Komen 2019, eqs 5.17, 5.18 and the text
//! under 5.21): heat crosses it by the conductivity at the mean of both temperatures, and its iron tells the
//! ionisation voltage. On its grid the film is half of 0.1 mm thick, in the range of the layer between
//! sheath and column that it tells of (tens to hundreds of um, section 5.2.2). With a thickness d of its
//! own the gas at d is looked up between the cells, or between the surface and the first cell, and each way
//! between centres conducts at film temperature as far as it lies within d. Half a cell thick, it is the
//! film of the source.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::grid::{FaceIndex, Grid};
use crate::heat::Contact;
use crate::material::GAS;

/// Part of its thickness by which a film may miss the middle of a cell.
const ROUNDING: f64 = 1e-9;

/// Way of the heat from gas into an electrode, at film temperature (Komen 2019, eq. 5.17).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Film {
    /// Half a cell of gas, then half a cell of metal.
    #[default]
    HalfCells,
    /// The distance between both centres through gas: half of the difference over half of the way (Komen
    /// 2019, eq. 5.18).
    Centres,
}

/// A way between two centres, or from the surface to the first, that lies within the film at least in part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// Face on the way.
    pub face: FaceIndex,
    /// Its area \[m2\].
    pub area: f64,
    /// Part of the way within the film \[m\].
    pub inside: f64,
    /// Parts beyond it, in the cell that the way begins in and in that where it ends \[m\].
    pub outside: [f64; 2],
    /// Both cells; off the surface the first of the gas alone.
    pub cells: [usize; 2],
}

/// The film off one contact.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Thickness \[m\].
    pub depth: f64,
    /// Ways through it, from the surface outward, one or more.
    pub links: Vec<Link>,
    /// Cell below its edge; none: the surface.
    below: Option<usize>,
    /// Cell above its edge, or the last of the gas.
    above: usize,
    /// How far the edge is from the one to the other, in (0, 1\].
    part: f64,
}

impl Layer {
    /// The film of `depth` \[m\] off `contact`.
    #[must_use]
    pub fn new(grid: &Grid, material: &[usize], contact: &Contact, depth: f64) -> Self {
        let first = Link {
            face: contact.face,
            area: contact.area,
            inside: contact.gas_half.min(depth),
            outside: [0.0, (contact.gas_half - depth).max(0.0)],
            cells: [contact.gas; 2],
        };
        let mut layer = Self {
            depth,
            links: vec![first],
            below: None,
            above: contact.gas,
            part: (depth / contact.gas_half).min(1.0),
        };
        let (mut here, mut reached) = (contact.gas, contact.gas_half);
        while reached < (1.0 - ROUNDING) * depth {
            let Some((face, area, there, [half, way])) = beyond(grid, here, contact.normal) else {
                break;
            };
            if material[there] != GAS {
                break;
            }
            let inside = way.min(depth - reached);
            let near = (half - inside).max(0.0);
            layer.links.push(Link {
                face,
                area,
                inside,
                outside: [near, way - inside - near],
                cells: [here, there],
            });
            (layer.below, layer.above, layer.part) = (Some(here), there, inside / way);
            (here, reached) = (there, reached + way);
        }
        layer
    }

    /// Whether the gas ends before it does.
    #[must_use]
    pub fn is_cut(&self) -> bool {
        let inside: f64 = self.links.iter().map(|link| link.inside).sum();
        inside < (1.0 - ROUNDING) * self.depth
    }

    /// A quantity at the edge of the film, linear between the values `of` cells and that at the `surface`.
    #[must_use]
    pub fn at(&self, surface: f64, of: &[f64]) -> f64 {
        let below = self.below.map_or(surface, |k| of[k]);
        below + self.part * (of[self.above] - below)
    }
}

/// The next cell along `normal`, the face before it with its area, and the ways to the face and between both centres.
fn beyond(grid: &Grid, k: usize, normal: [f64; 2]) -> Option<(FaceIndex, f64, usize, [f64; 2])> {
    let (i, j) = (k % grid.nr, k / grid.nr);
    let radial = |face: usize, n: usize| {
        let way = (grid.rc[n] - grid.rc[i]).abs();
        let at = FaceIndex::Radial(grid.radial_face(face, j));
        (
            at,
            grid.area(face, j),
            grid.cell(n, j),
            [0.5 * grid.dr[i], way],
        )
    };
    let axial = |face: usize, n: usize| {
        let way = (grid.zc[n] - grid.zc[j]).abs();
        let at = FaceIndex::Axial(grid.axial_face(i, face));
        (at, grid.ring[i], grid.cell(i, n), [0.5 * grid.dz[j], way])
    };
    if normal[0] > 0.0 {
        (i + 1 < grid.nr).then(|| radial(i + 1, i + 1))
    } else if normal[0] < 0.0 {
        i.checked_sub(1).map(|n| radial(i, n))
    } else if normal[1] > 0.0 {
        (j + 1 < grid.nz).then(|| axial(j + 1, j + 1))
    } else {
        j.checked_sub(1).map(|n| axial(j, n))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::heat::contacts;

    fn over_a_plate(cells: usize, depth: f64) -> (Grid, Layer) {
        let size = 2.0 / cells as f64;
        let faces = (0..=cells + 1).map(|k| (k as f64 - 1.0) * size).collect();
        let grid = Grid::new(vec![0.0, 1.0], faces);
        let mut material = vec![GAS; grid.len()];
        material[0] = 1;
        let all = contacts(&grid, &material, |m| m.checked_sub(1));
        let layer = Layer::new(&grid, &material, &all[0], depth);
        (grid, layer)
    }

    #[test]
    fn a_line_is_found_at_the_edge_whatever_the_cells() {
        for cells in [1, 2, 4, 5, 8, 20, 64] {
            let (grid, layer) = over_a_plate(cells, 0.4);
            let values: Vec<f64> = grid.zc.iter().map(|z| 3.0 + 5.0 * z).collect();
            let found = layer.at(3.0, &values);
            assert!((found - 5.0).abs() < 1e-12, "{cells}: {found}");
        }
    }

    #[test]
    fn ways_within_add_up_to_the_thickness() {
        for cells in [1, 2, 4, 5, 8, 20, 64] {
            let (grid, layer) = over_a_plate(cells, 0.4);
            let inside: f64 = layer.links.iter().map(|l| l.inside).sum();
            assert!((inside - 0.4).abs() < 1e-12, "{cells}: {inside}");
            let all: f64 = layer
                .links
                .iter()
                .map(|l| l.inside + l.outside[0] + l.outside[1])
                .sum();
            let last = layer.links.last().unwrap().cells[1];
            assert!((all - grid.zc[last]).abs() < 1e-12);
        }
    }

    #[test]
    fn a_film_of_half_a_cell_ends_at_its_middle() {
        let (_, layer) = over_a_plate(4, 0.25);
        assert_eq!(layer.links.len(), 1);
        let edge = layer.at(0.0, &[0.0, 7.0, 8.0, 9.0, 10.0]);
        assert!((edge - 7.0).abs() < 1e-12);
        assert!(layer.links[0].outside[1].abs() < 1e-12);
    }

    #[test]
    fn the_other_wall_ends_a_film_that_is_too_thick() {
        let (_, layer) = over_a_plate(4, 9.0);
        assert_eq!(layer.links.len(), 4);
        assert!(layer.is_cut() && !over_a_plate(4, 0.4).1.is_cut());
        let edge = layer.at(0.0, &[0.0, 1.0, 2.0, 3.0, 4.0]);
        assert!((edge - 4.0).abs() < 1e-12);
    }
}
