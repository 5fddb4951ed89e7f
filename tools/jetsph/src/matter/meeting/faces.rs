//! The face of a solid through which the water presses on it.
//!
//! A kernel reaches some rows into a solid. Where its forces act on the cells that they reach, the first rows bear less
//! than the pressure. Here the line from a point of the solid to a particle of water is followed through unbroken cells to
//! the face where it leaves them, and the force acts there, as that of a load:
//!
//! ```text
//! u_face = u_b + sum_k G_k s_k + sum_k B_k (s_k^2 + n_k^2)/2 + sum_kl W_kl s_k s_l
//! ```
//!
//! with the place s of the face seen from the middle of its cell b, its part n along the normal, and the rates G, B and W
//! of first, second and mixed derivatives. The second-order part counts twice along the normal, so that an even pressure
//! is in balance with an even stress (see [`crate::matter::solid::bound::Load`]).

use particles::{Column, Set};

use crate::matter::solid::fracture::BROKEN;
use crate::matter::solid::tensor::Matrix;
use crate::state::VELOCITY;

/// dF/dt \[1/s\].
pub const DEFORMATION_RATE: Column<Matrix> = Column::new("deformation_rate", "1/s", [[0.0; 3]; 3]);
/// Rates of the derivatives d2x/dX_k^2, by columns \[1/(m s)\].
pub const BEND_RATE: Column<Matrix> = Column::new("bend_rate", "1/(m s)", [[0.0; 3]; 3]);
/// Rates of the derivatives d2x/dX dY, d2x/dX dZ, d2x/dY dZ, by columns \[1/(m s)\].
pub const WARP_RATE: Column<Matrix> = Column::new("warp_rate", "1/(m s)", [[0.0; 3]; 3]);
/// Whether water without sound presses on a cell: it wants to know how its faces are accelerated.
pub const PRESSED: Column<u8> = Column::new("pressed", "1", 0).saved();
/// How much the faces of a pressed cell give way to an impulse at once \[1/kg\].
pub const GIVING: Column<f64> = Column::new("giving", "1/kg", 0.0);
/// What the last forces of water without sound give each particle \[m/s2\].
pub const PULLED: Column<[f64; 3]> = Column::new("pulled", "m/s2", [0.0; 3]);
/// d2F/dt2 \[1/s2\] of pressed cells.
pub const DEFORMATION_PUSH: Column<Matrix> = Column::new("deformation_push", "1/s2", [[0.0; 3]; 3]);
/// Like [`BEND_RATE`], of accelerations \[1/(m s2)\].
pub const BEND_PUSH: Column<Matrix> = Column::new("bend_push", "1/(m s2)", [[0.0; 3]; 3]);
/// Like [`WARP_RATE`], of accelerations \[1/(m s2)\].
pub const WARP_PUSH: Column<Matrix> = Column::new("warp_push", "1/(m s2)", [[0.0; 3]; 3]);
/// Force of the water on a cell \[N\].
pub const PULL: Column<[f64; 3]> = Column::new("water_force", "N", [0.0; 3]).shown();
/// Moment of it: force by offset at rest \[N m\].
pub const TWIST: Column<Matrix> = Column::new("water_moment", "N m", [[0.0; 3]; 3]);
/// Force of the water by what [`BEND_RATE`] multiplies \[N m2\].
pub const BEND: Column<Matrix> = Column::new("water_bend", "N m2", [[0.0; 3]; 3]);
/// Force of the water by what [`WARP_RATE`] multiplies \[N m2\].
pub const WARP: Column<Matrix> = Column::new("water_warp", "N m2", [[0.0; 3]; 3]);

/// A line goes through so many cells at most: it leaves a solid through the first or the second face of a row.
const CELLS_MOST: usize = 8;
/// No particle.
const NONE: u32 = u32::MAX;
/// Pairs of axes of mixed derivatives.
pub const MIXED: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

/// Which cells of a lattice are there.
#[derive(Debug, Clone, PartialEq)]
pub struct Cells {
    /// Size of a cell \[m\].
    size: [f64; 3],
    dimensions: usize,
    /// Number of cells along each axis.
    counts: [usize; 3],
    /// The particle of each cell.
    particle: Vec<u32>,
    /// The cell of each particle.
    cell: Vec<[u32; 3]>,
}

/// A place of a solid on which the water acts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Its cell.
    pub cell: usize,
    /// Seen from the middle of the cell, along the axes of the lattice \[m\].
    pub offset: [f64; 3],
    /// The part of it along the normal of a face; nothing inside.
    pub depth: [f64; 3],
}

impl Place {
    /// What second derivatives along the axes are multiplied by \[m2\].
    fn squares(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| 0.5 * (self.offset[k] * self.offset[k] + self.depth[k] * self.depth[k]))
    }

    /// What mixed derivatives are multiplied by \[m2\].
    fn products(&self) -> [f64; 3] {
        MIXED.map(|(k, l)| self.offset[k] * self.offset[l])
    }
}

impl Cells {
    /// Cells of a size \[m\] with the numbers of those that hold particles, in their order.
    #[must_use]
    pub fn new(size: [f64; 3], cell: Vec<[u32; 3]>, dimensions: usize) -> Self {
        let counts = [0, 1, 2].map(|k| {
            let last = cell.iter().map(|at| at[k]).max();
            last.map_or(0, |last| last as usize + 1)
        });
        let mut cells = Self {
            size,
            dimensions,
            counts,
            particle: vec![NONE; counts.iter().product()],
            cell,
        };
        for a in 0..cells.cell.len() {
            let at = cells.cell[a].map(i64::from);
            if let Some(row) = cells.row(at) {
                cells.particle[row] = a as u32;
            }
        }
        cells
    }

    /// Number of a cell; none outside.
    fn row(&self, at: [i64; 3]) -> Option<usize> {
        let mut row = 0;
        for k in (0..3).rev() {
            let inside = usize::try_from(at[k])
                .ok()
                .filter(|i| *i < self.counts[k])?;
            row = row * self.counts[k] + inside;
        }
        Some(row)
    }

    /// The unbroken particle of a cell.
    fn at(&self, at: [i64; 3], broken: &[u8]) -> Option<usize> {
        let a = self.row(at).map(|row| self.particle[row])?;
        let whole = a != NONE && broken.get(a as usize).is_none_or(|b| *b == 0);
        whole.then_some(a as usize)
    }

    /// A walk that begins in the unbroken cell of particle `a`, at an offset \[m\] from its middle along the axes of the lattice at
    /// rest; none from a broken cell.
    #[must_use]
    pub fn walk<'a>(&'a self, broken: &'a [u8], a: usize, offset: [f64; 3]) -> Option<Walk<'a>> {
        let at = self.cell[a].map(i64::from);
        Some(Walk {
            own: self.at(at, broken)?,
            cells: self,
            broken,
            at,
            inside: [0, 1, 2].map(|k| offset[k] / self.size[k]),
            cells_left: CELLS_MOST,
        })
    }

    /// Where a line leaves the solid that begins in the cell of particle `a` at an offset \[m\] and goes a way \[m\], both along
    /// the axes of the lattice at rest; none from a broken cell or too deep inside.
    #[must_use]
    pub fn leave(&self, broken: &[u8], a: usize, offset: [f64; 3], way: [f64; 3]) -> Option<Place> {
        match self.walk(broken, a, offset)?.go(way, f64::INFINITY) {
            Reached::Face(place, _) => Some(place),
            Reached::End | Reached::Nothing => None,
        }
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        4 * self.particle.len() + 12 * self.cell.len()
    }
}

/// A straight walk through the unbroken cells of a solid; it may go on in another direction.
#[derive(Debug, Clone, Copy)]
pub struct Walk<'a> {
    cells: &'a Cells,
    broken: &'a [u8],
    /// The cell that it is in.
    at: [i64; 3],
    own: usize,
    /// Where it is in this cell, in cells from its middle.
    inside: [f64; 3],
    cells_left: usize,
}

/// Where a walk has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reached {
    /// To the end of its way, within the solid.
    End,
    /// To a face of the solid, after a part of its way.
    Face(Place, f64),
    /// Nowhere: it went through too many cells.
    Nothing,
}

impl Walk<'_> {
    /// Goes along a way at rest \[m\], as often it as `until` tells, but no further than the face of the solid.
    #[must_use]
    pub fn go(&mut self, way: [f64; 3], until: f64) -> Reached {
        let (size, dimensions) = (self.cells.size, self.cells.dimensions);
        let way = [0, 1, 2].map(|k| {
            if k < dimensions {
                way[k] / size[k]
            } else {
                0.0
            }
        });
        let mut gone = 0.0;
        while self.cells_left > 0 {
            let time = |k: usize| (0.5 * way[k].signum() - self.inside[k]) / way[k];
            let axes = (0..dimensions).filter(|k| way[*k] != 0.0);
            let Some(axis) = axes.min_by(|k, l| time(*k).total_cmp(&time(*l))) else {
                break;
            };
            let (time, step) = (time(axis).max(0.0), way[axis].signum());
            let ends = gone + time >= until;
            let part = if ends { until - gone } else { time };
            (0..dimensions).for_each(|k| self.inside[k] += part * way[k]);
            if ends {
                return Reached::End;
            }
            gone += time;
            self.inside[axis] = 0.5 * step;
            let mut next = self.at;
            next[axis] += step as i64;
            let Some(other) = self.cells.at(next, self.broken) else {
                return Reached::Face(self.face(axis), gone);
            };
            (self.own, self.at) = (other, next);
            self.inside[axis] = -0.5 * step;
            self.cells_left -= 1;
        }
        Reached::Nothing
    }

    /// The place on the face of the present cell across an axis.
    fn face(&self, axis: usize) -> Place {
        let offset = [0, 1, 2].map(|k| self.inside[k] * self.cells.size[k]);
        let mut depth = [0.0; 3];
        depth[axis] = offset[axis];
        Place {
            cell: self.own,
            offset,
            depth,
        }
    }
}

/// How a solid moves, as water sees it.
#[derive(Debug, Clone, Copy)]
pub struct Moving<'a> {
    velocity: &'a [[f64; 3]],
    first: &'a [Matrix],
    bend: &'a [Matrix],
    warp: &'a [Matrix],
    /// Which particles are broken; nothing where none can break.
    pub broken: &'a [u8],
}

impl<'a> Moving<'a> {
    /// Of a set of particles.
    #[must_use]
    pub fn of(set: &'a Set) -> Self {
        Self {
            velocity: set.column(&VELOCITY),
            first: set.column(&DEFORMATION_RATE),
            bend: set.column(&BEND_RATE),
            warp: set.column(&WARP_RATE),
            broken: set.column(&BROKEN),
        }
    }

    /// Of a set, with accelerations \[m/s2\] in place of velocities; those of cells that are not pressed are even.
    #[must_use]
    pub fn pushed(set: &'a Set, accelerations: &'a [[f64; 3]]) -> Self {
        Self {
            velocity: accelerations,
            first: set.column(&DEFORMATION_PUSH),
            bend: set.column(&BEND_PUSH),
            warp: set.column(&WARP_PUSH),
            broken: set.column(&BROKEN),
        }
    }

    /// Velocity of a place \[m/s\].
    #[must_use]
    pub fn velocity(&self, place: &Place) -> [f64; 3] {
        let (b, squares, products) = (place.cell, place.squares(), place.products());
        [0, 1, 2].map(|i| {
            let part = |k: usize| {
                self.first[b][i][k] * place.offset[k]
                    + self.bend[b][i][k] * squares[k]
                    + self.warp[b][i][k] * products[k]
            };
            self.velocity[b][i] + part(0) + part(1) + part(2)
        })
    }
}

/// Forces of the water on a solid, by what its cells take of them.
#[derive(Debug, Default)]
pub struct Taken {
    pull: Vec<[f64; 3]>,
    moments: [Vec<Matrix>; 3],
}

impl Taken {
    /// Takes the columns of a set, without forces.
    #[must_use]
    pub fn begin(set: &mut Set) -> Self {
        let mut pull = set.take(&PULL);
        pull.fill([0.0; 3]);
        let moments = [&TWIST, &BEND, &WARP].map(|column| {
            let mut moments = set.take(column);
            moments.fill([[0.0; 3]; 3]);
            moments
        });
        Self { pull, moments }
    }

    /// Adds a force at a place \[N\].
    pub fn add(&mut self, place: &Place, force: [f64; 3]) {
        let b = place.cell;
        let parts = [place.offset, place.squares(), place.products()];
        for i in 0..3 {
            self.pull[b][i] += force[i];
            for (moments, part) in self.moments.iter_mut().zip(parts) {
                (0..3).for_each(|k| moments[b][i][k] += force[i] * part[k]);
            }
        }
    }

    /// Gives the columns back.
    pub fn end(self, set: &mut Set) {
        set.put(&PULL, self.pull);
        for (column, moments) in [&TWIST, &BEND, &WARP].into_iter().zip(self.moments) {
            set.put(column, moments);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_leaves_through_the_next_face_that_is_free() {
        // Two columns of three rows; the upper right cell is missing.
        let cell = vec![[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 2, 0]];
        let cells = Cells::new([0.1, 0.2, 1.0], cell, 2);
        let up = cells.leave(&[], 0, [0.01, -0.05, 0.0], [0.0, 1.0, 0.0]);
        let up = up.unwrap();
        assert_eq!(up.cell, 4);
        assert!((up.offset[0] - 0.01).abs() + (up.offset[1] - 0.1).abs() < 1e-15);
        assert!((up.depth[1] - 0.1).abs() + up.depth[0].abs() < 1e-15);
        // To the right and up, from the middle of the lower left cell: out of the cell beside it.
        let aside = cells.leave(&[], 0, [0.0; 3], [0.2, 0.1, 0.0]).unwrap();
        assert_eq!(aside.cell, 1);
        assert!((aside.offset[1] - 0.075).abs() < 1e-15, "{aside:?}");
        // What is broken is not there, and has no faces.
        let broken = [0, 0, 1, 0, 0];
        let up = cells.leave(&broken, 0, [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
        assert_eq!(up.cell, 0);
        assert!(cells.leave(&broken, 2, [0.0; 3], [0.0, 1.0, 0.0]).is_none());
    }
}
