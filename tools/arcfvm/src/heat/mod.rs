//! Heat at the surfaces of the electrodes (Komen 2019, eqs 5.16 to 5.21) and what moves with metal.

mod answer;
pub mod balance;
pub mod electrode;
pub mod electrons;
pub mod energy;
mod energy_conduct;
pub mod energy_edges;
mod energy_electrons;
mod energy_film;
mod energy_integral;
mod energy_skin;
mod feed;
pub(crate) mod figures;
pub mod film;
pub mod motion;
pub mod radiation;
pub mod reads;
pub mod setup;
pub mod skin;
pub mod sources;
mod step;
pub mod supply;
pub mod vapour;

pub use electrode::{Electrode, Emission, Evaporation, Role, SurfaceHeat};
pub use film::{Film, Layer};
pub use skin::{ElectrodeAt, Skin};

use crate::grid::{FaceIndex, Grid};
use crate::material::GAS;

/// A face between the gas and a metal with electrode heat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Gas cell.
    pub gas: usize,
    /// Metal cell.
    pub metal: usize,
    /// Electrode that the metal belongs to.
    pub electrode: usize,
    /// The face.
    pub face: FaceIndex,
    /// Area \[m2\].
    pub area: f64,
    /// Distance from the gas centre to the face \[m\].
    pub gas_half: f64,
    /// Distance from the metal centre to the face \[m\].
    pub metal_half: f64,
    /// Middle of the face, radius and height \[m\].
    pub place: [f64; 2],
    /// Unit vector from metal to gas, radial and axial.
    pub normal: [f64; 2],
}

/// The electrodes and their faces to the gas.
#[derive(Debug, Clone, PartialEq)]
pub struct Surfaces {
    /// Electrodes.
    pub electrodes: Vec<Electrode>,
    /// Faces, rows first.
    pub contacts: Vec<Contact>,
    /// Whether a cell is gas that touches an electrode, `[nr nz]`.
    pub beside: Vec<bool>,
    /// Part of all radiation that electrodes which absorb take up.
    pub absorbed: Option<f64>,
    /// The electrode that each material is.
    pub electrode_of: Vec<Option<usize>>,
    /// Where they answer.
    pub at: ElectrodeAt,
    /// Way of the heat from the gas into them.
    pub film: Film,
    /// Thickness of the film of gas on them \[m\]; none: half a cell.
    pub film_depth: Option<f64>,
    /// The film of each contact, if it has a thickness; else empty.
    pub layers: Vec<Layer>,
}

impl Surfaces {
    /// Takes the faces of `material` anew.
    pub fn renew(&mut self, grid: &Grid, material: &[usize]) {
        self.contacts = contacts(grid, material, |m| self.electrode_of[m]);
        self.beside.clear();
        self.beside.resize(grid.len(), false);
        for contact in &self.contacts {
            self.beside[contact.gas] = true;
        }
        self.layers.clear();
        if let Some(depth) = self.film_depth {
            let layers = self.contacts.iter();
            let layers = layers.map(|contact| Layer::new(grid, material, contact, depth));
            self.layers.extend(layers);
        }
    }
}

/// Every face between a gas cell and a cell of a material that `electrode_of` knows.
#[must_use]
pub fn contacts(
    grid: &Grid,
    material: &[usize],
    electrode_of: impl Fn(usize) -> Option<usize>,
) -> Vec<Contact> {
    let mut all = Vec::new();
    for j in 0..grid.nz {
        for i in 0..grid.nr {
            let here = grid.cell(i, j);
            if i + 1 < grid.nr {
                let there = grid.cell(i + 1, j);
                if let Some(electrode) = meeting(material, here, there, &electrode_of) {
                    all.push(Joined::radial(grid, i, j).contact(material, electrode));
                }
            }
            if j + 1 < grid.nz {
                let there = grid.cell(i, j + 1);
                if let Some(electrode) = meeting(material, here, there, &electrode_of) {
                    all.push(Joined::axial(grid, i, j).contact(material, electrode));
                }
            }
        }
    }
    all
}

fn meeting(
    material: &[usize],
    a: usize,
    b: usize,
    electrode_of: &impl Fn(usize) -> Option<usize>,
) -> Option<usize> {
    match (material[a], material[b]) {
        (GAS, GAS) => None,
        (GAS, metal) | (metal, GAS) => electrode_of(metal),
        _ => None,
    }
}

/// A face and the cells that it joins, in the order of the axis across it.
struct Joined {
    axis: usize,
    cells: [usize; 2],
    /// Half their widths across the face \[m\].
    halves: [f64; 2],
    face: FaceIndex,
    area: f64,
    place: [f64; 2],
}

impl Joined {
    /// At the outer face of cell `(i, j)`.
    fn radial(grid: &Grid, i: usize, j: usize) -> Self {
        Self {
            axis: 0,
            cells: [grid.cell(i, j), grid.cell(i + 1, j)],
            halves: [0.5 * grid.dr[i], 0.5 * grid.dr[i + 1]],
            face: FaceIndex::Radial(grid.radial_face(i + 1, j)),
            area: grid.area(i + 1, j),
            place: [grid.rf[i + 1], grid.zc[j]],
        }
    }

    /// At the upper face of cell `(i, j)`.
    fn axial(grid: &Grid, i: usize, j: usize) -> Self {
        Self {
            axis: 1,
            cells: [grid.cell(i, j), grid.cell(i, j + 1)],
            halves: [0.5 * grid.dz[j], 0.5 * grid.dz[j + 1]],
            face: FaceIndex::Axial(grid.axial_face(i, j + 1)),
            area: grid.ring[i],
            place: [grid.rc[i], grid.zf[j + 1]],
        }
    }

    /// The contact of gas and metal; the normal points into the gas.
    fn contact(self, material: &[usize], electrode: usize) -> Contact {
        let first_is_gas = material[self.cells[0]] == GAS;
        let [gas, metal] = if first_is_gas { [0, 1] } else { [1, 0] };
        let mut normal = [0.0; 2];
        normal[self.axis] = if first_is_gas { -1.0 } else { 1.0 };
        Contact {
            gas: self.cells[gas],
            metal: self.cells[metal],
            electrode,
            face: self.face,
            area: self.area,
            gas_half: self.halves[gas],
            metal_half: self.halves[metal],
            place: self.place,
            normal,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Spacing, faces};

    #[test]
    fn contacts_cover_a_cylinder_above_a_plate() {
        let even = Spacing::uniform(0.1);
        let grid = Grid::new(
            faces(&[0.0, 0.3, 1.0], &even),
            faces(&[0.0, 0.2, 0.6, 1.0], &even),
        );
        let mut material = vec![GAS; grid.len()];
        for j in 0..grid.nz {
            for i in 0..grid.nr {
                if grid.zc[j] < 0.2 {
                    material[grid.cell(i, j)] = 1;
                } else if grid.zc[j] > 0.6 && grid.rc[i] < 0.3 {
                    material[grid.cell(i, j)] = 2;
                }
            }
        }
        let all = contacts(&grid, &material, |m| m.checked_sub(1));
        let area = |e: usize| {
            all.iter()
                .filter(|c| c.electrode == e)
                .map(|c| c.area)
                .sum::<f64>()
        };
        let pi = std::f64::consts::PI;
        assert!((area(0) - pi).abs() < 1e-12);
        assert!((area(1) - pi * 0.09 - 2.0 * pi * 0.3 * 0.4).abs() < 1e-12);
        assert!(
            all.iter()
                .all(|c| material[c.gas] == GAS && material[c.metal] == c.electrode + 1)
        );
        let tip = all
            .iter()
            .find(|c| c.electrode == 1 && c.normal[1] < 0.0)
            .unwrap();
        assert!((tip.place[1] - 0.6).abs() < 1e-12);
    }
}
