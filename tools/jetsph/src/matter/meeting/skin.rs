//! A solid as water sees it.
//!
//! Shinohara et al. (2004, figs 4 and 5) let water see the particles of the solid as they stand, and it slips between
//! them where they are coarser. Here each cell of the solid is divided into cells of the water's spacing, which stand
//! where the deformation of their cell puts them,
//!
//! ```text
//! x_p = x_a + F_a o_p,   V_p = J_a V_a/n
//! ```
//!
//! so that an unbroken solid has no gaps at any ratio of spacings. A force on x_p acts on the face between it and the water
//! (see [`super::faces`] and [`super::touch`]).

use particles::{Column, POSITION, Set, sweep};

use super::faces::{Cells, Place};
use crate::matter::solid::tensor::{Matrix, cofactor, determinant};

/// F along the axes of the lattice.
pub const DEFORMATION: Column<Matrix> = Column::new(
    "deformation",
    "1",
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
)
.saved();

/// Most parts of a cell along an axis.
const PARTS_MOST: f64 = 8.0;

/// A point of the solid that water sees.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    /// x \[m\].
    pub x: [f64; 3],
    /// V \[m3\].
    pub volume: f64,
    /// F^-T of its cell times abs(det F): turns ways back to those at rest.
    pub back: Matrix,
    /// Its cell.
    pub cell: u32,
    /// Its offset from the middle of the cell at rest, along the axes of the lattice \[m\].
    pub offset: [f64; 3],
}

/// How the cells of a solid are divided.
#[derive(Debug, Clone)]
pub struct Skin {
    /// Number of the solid's set.
    pub set: usize,
    /// Offsets of the parts \[m\].
    offsets: Vec<[f64; 3]>,
    /// Volume of a part at rest \[m3\].
    volume: f64,
    /// Spacing of the parts \[m\].
    pub spacing: f64,
    /// From the middle of a cell to its corner at rest \[m\].
    radius: f64,
    /// The cells of its lattice; none where water sees particles as they stand.
    pub(super) cells: Option<Cells>,
    /// Size of a cell \[m\] and number of its parts along each axis.
    size: [f64; 3],
    counts: [f64; 3],
    /// Half of the spacing of the water \[m\].
    closed_gap: f64,
    /// The points near water, by cell.
    pub points: Vec<Point>,
}

impl Skin {
    /// The skin of a solid with cells of `size` \[m\] for water of a spacing \[m\]. Without `cells` forces act on particles.
    #[must_use]
    pub fn new(
        set: usize,
        size: [f64; 3],
        cells: Option<Cells>,
        water: f64,
        dimensions: usize,
    ) -> Self {
        let parts = |k: usize| {
            if k < dimensions {
                (size[k] / water).round().clamp(1.0, PARTS_MOST)
            } else {
                1.0
            }
        };
        let counts = [0, 1, 2].map(parts);
        let part = [0, 1, 2].map(|k| {
            if k < dimensions {
                size[k] / counts[k]
            } else {
                0.0
            }
        });
        let mut offsets = Vec::new();
        for k in 0..counts[2] as usize {
            for j in 0..counts[1] as usize {
                for i in 0..counts[0] as usize {
                    let at = [i, j, k];
                    offsets.push(
                        [0, 1, 2]
                            .map(|axis| part[axis] * (at[axis] as f64 + 0.5 - 0.5 * counts[axis])),
                    );
                }
            }
        }
        let volume: f64 = part[..dimensions].iter().product();
        Self {
            set,
            offsets,
            volume,
            spacing: volume.powf(1.0 / dimensions as f64),
            radius: 0.5 * size[..dimensions].iter().map(|x| x * x).sum::<f64>().sqrt(),
            cells,
            size,
            counts,
            closed_gap: 0.5 * water,
            points: Vec::new(),
        }
    }

    /// Volume of a part at rest \[m3\].
    #[must_use]
    pub(super) fn part_volume(&self) -> f64 {
        self.volume
    }

    /// The part of a face that a place of it lies in: its number among all of the cell, and how many the face has. A cell that has
    /// no face there is one part.
    #[must_use]
    pub(crate) fn part_of_face(&self, place: &Place) -> (usize, f64) {
        let Some(normal) = (0..3).find(|k| place.depth[*k].abs() > 0.0) else {
            return (0, 1.0);
        };
        let side = usize::from(place.depth[normal] > 0.0);
        let (mut number, mut count) = (1 + 2 * normal + side, 1.0);
        for k in (0..3).filter(|k| *k != normal) {
            let within = (place.offset[k] / self.size[k] + 0.5) * self.counts[k];
            let part = within.floor().clamp(0.0, self.counts[k] - 1.0);
            number = number * PARTS_MOST as usize + part as usize;
            count *= self.counts[k];
        }
        (number, count)
    }

    /// A gap between a solid and a wall into which no water fits \[m\].
    #[must_use]
    pub(super) fn closed_gap(&self) -> f64 {
        self.closed_gap
    }

    /// Finds the points of cells within `reach` \[m\] of something, as `near` tells of a place and a distance.
    pub fn look(&mut self, set: &Set, reach: f64, near: impl Fn([f64; 3], f64) -> bool + Sync) {
        let position = set.column(&POSITION);
        let deformation = set.column(&DEFORMATION);
        let moved = |m: &Matrix, offset: &[f64; 3], i: usize| -> f64 {
            (0..3).map(|j| m[i][j] * offset[j]).sum()
        };
        let mut seen = vec![false; set.len()];
        sweep::fill(&mut seen, |a| near(position[a], reach + 2.0 * self.radius));
        self.points.clear();
        for a in (0..set.len()).filter(|a| seen[*a]) {
            let f = &deformation[a];
            let volume = determinant(f);
            let back = cofactor(f).map(|row| row.map(|x| x * volume.signum()));
            let volume = self.volume * volume.abs();
            self.points.extend(self.offsets.iter().map(|offset| Point {
                x: [0, 1, 2].map(|i| position[a][i] + moved(f, offset, i)),
                back,
                volume,
                cell: a as u32,
                offset: *offset,
            }));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_fill_the_cell() {
        let skin = Skin::new(0, [2e-3, 3e-3, 1.0], None, 1e-3, 2);
        assert_eq!(skin.offsets.len(), 6);
        assert!((skin.volume * 6.0 - 6e-6).abs() < 1e-18);
        let middle: f64 = skin.offsets.iter().map(|o| o[0] + o[1]).sum();
        assert!(middle.abs() < 1e-15 && skin.offsets[0][2].abs() <= 0.0);
    }
}
