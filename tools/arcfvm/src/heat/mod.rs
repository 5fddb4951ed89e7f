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
                    all.push(radial_contact(grid, material, i, j, electrode));
                }
            }
            if j + 1 < grid.nz {
                let there = grid.cell(i, j + 1);
                if let Some(electrode) = meeting(material, here, there, &electrode_of) {
                    all.push(axial_contact(grid, material, i, j, electrode));
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

/// The contact at the outer face of cell `(i, j)`.
fn radial_contact(
    grid: &Grid,
    material: &[usize],
    i: usize,
    j: usize,
    electrode: usize,
) -> Contact {
    let (inner, outer) = (grid.cell(i, j), grid.cell(i + 1, j));
    let inner_is_gas = material[inner] == GAS;
    let halves = (0.5 * grid.dr[i], 0.5 * grid.dr[i + 1]);
    let (gas, metal) = if inner_is_gas {
        (inner, outer)
    } else {
        (outer, inner)
    };
    let (gas_half, metal_half) = if inner_is_gas {
        halves
    } else {
        (halves.1, halves.0)
    };
    Contact {
        gas,
        metal,
        electrode,
        face: FaceIndex::Radial(grid.radial_face(i + 1, j)),
        area: grid.area(i + 1, j),
        gas_half,
        metal_half,
        place: [grid.rf[i + 1], grid.zc[j]],
        normal: [if inner_is_gas { -1.0 } else { 1.0 }, 0.0],
    }
}

/// The contact at the upper face of cell `(i, j)`.
fn axial_contact(grid: &Grid, material: &[usize], i: usize, j: usize, electrode: usize) -> Contact {
    let (lower, upper) = (grid.cell(i, j), grid.cell(i, j + 1));
    let lower_is_gas = material[lower] == GAS;
    let halves = (0.5 * grid.dz[j], 0.5 * grid.dz[j + 1]);
    let (gas, metal) = if lower_is_gas {
        (lower, upper)
    } else {
        (upper, lower)
    };
    let (gas_half, metal_half) = if lower_is_gas {
        halves
    } else {
        (halves.1, halves.0)
    };
    Contact {
        gas,
        metal,
        electrode,
        face: FaceIndex::Axial(grid.axial_face(i, j + 1)),
        area: grid.ring[i],
        gas_half,
        metal_half,
        place: [grid.rc[i], grid.zf[j + 1]],
        normal: [0.0, if lower_is_gas { -1.0 } else { 1.0 }],
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
